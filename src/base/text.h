// Small text helpers shared by messages and parsers.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace steradian {

/// Control characters, DEL and invalid UTF-8 as \xNN, so that foreign bytes never reach a terminal raw.
/// Longer than max_bytes: cut, with "…".
std::string escape_for_display(std::string_view text, size_t max_bytes = 200);

/// The candidate within a small edit distance of `word`, ignoring case; nothing when none is close.
std::optional<std::string> closest_match(std::string_view word, std::span<const std::string_view> candidates);

/// "did you mean 'x'?", or "one of a, b, c" when nothing is close.
std::string suggestion(std::string_view word, std::span<const std::string_view> candidates);

/// How much of a long line is shown, and how much of that before the place in question (in bytes).
inline constexpr size_t kExcerptWidth = 160, kExcerptMargin = 80;

/// Line and column (1-based) of a byte offset, and that line's text. Lines end with LF, CR LF or CR. A line longer than
/// kExcerptWidth is cut; where the column is beyond kExcerptMargin, to begin exactly that many bytes before the place,
/// which is how Error::str knows where to put the caret.
struct TextPosition {
    uint32_t line = 1, column = 1;
    std::string excerpt;
};
TextPosition locate(std::string_view text, size_t offset);

/// Whole-string number parse by std::from_chars, independent of locale; a leading '+' is accepted, and so are inf and
/// nan. Out-of-range values give infinity or zero with the right sign, as strtod would.
std::optional<double> parse_double(std::string_view text);

/// The name of the encoding when a text is plainly UTF-16 or UTF-32, told by its byte order mark or by the zeros that
/// ASCII has in them; nothing for what may be UTF-8.
const char* foreign_encoding(std::string_view text) noexcept;

bool iequals(std::string_view a, std::string_view b);
/// Lower-case extension with its dot, of the last path component: ".exr"; empty when there is none.
std::string extension_of(std::string_view path);

}  // namespace steradian
