// The line-oriented text that OBJ and MTL share: line ends, continuations, words and numbers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace steradian::obj {

/// Logical lines of a text. A line ends with LF, CR LF or CR; a backslash before the line end joins the next line,
/// except in comments. Comments and empty lines are left out.
class Lines {
public:
    Lines(std::string_view text, size_t begin, size_t end)
        : at_(text.data() + begin), end_(text.data() + end), newline_(nullptr) {}

    /// The next line that says something: from its first visible character to its end, trailing white space included.
    bool next(std::string_view& line);

private:
    const char* line_end(const char* from);

    const char* at_;
    const char* end_;
    const char* newline_;  ///< the next LF at or after at_, end_ when there is none, null when not known yet
};

/// Reads words and numbers from one line.
class Words {
public:
    explicit Words(std::string_view line) : at_(line.data()), end_(line.data() + line.size()) {}

    /// Skips white space; whether anything is left. With `comments`, a word that starts with '#' ends the line.
    bool more(bool comments = true);
    /// Where reading goes on; after `more`, the start of a word.
    const char* position() const { return at_; }
    /// The next word, empty at the end of the line.
    std::string_view word();
    /// The next word without consuming it.
    std::string_view peek();
    /// The rest of the line without surrounding white space.
    std::string_view rest();
    /// A number that fills the next word; nothing is consumed when it does not. Every spelling of infinity and NaN that
    /// C libraries print is understood; out-of-range values become infinity or zero.
    std::optional<float> number();

private:
    const char* at_;
    const char* end_;
};

/// A whole word as a number, as Words::number.
std::optional<float> parse_number(std::string_view word);

}  // namespace steradian::obj
