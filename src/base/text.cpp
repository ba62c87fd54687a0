#include "base/text.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>
#include <vector>

namespace steradian {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// Length of the valid UTF-8 sequence at the start of `s`, 0 when it is not valid.
size_t utf8_length(std::string_view s) {
    const auto byte = [&](size_t i) { return static_cast<unsigned char>(s[i]); };
    const unsigned char first = byte(0);
    const size_t n = first < 0x80                    ? 1
                     : first >= 0xc2 && first < 0xe0 ? 2
                     : (first & 0xf0) == 0xe0        ? 3
                     : first >= 0xf0 && first < 0xf5 ? 4
                                                     : 0;
    if (n == 0 || n > s.size()) return 0;
    for (size_t i = 1; i < n; ++i)
        if ((byte(i) & 0xc0) != 0x80) return 0;
    if (first == 0xe0 && byte(1) < 0xa0) return 0;   // overlong
    if (first == 0xed && byte(1) >= 0xa0) return 0;  // surrogate
    if (first == 0xf0 && byte(1) < 0x90) return 0;   // overlong
    if (first == 0xf4 && byte(1) >= 0x90) return 0;  // beyond U+10FFFF
    if (first == 0xc2 && byte(1) < 0xa0) return 0;   // C1 controls: terminals act on some of them
    return n;
}

size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<size_t> row(b.size() + 1);
    for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (size_t i = 1; i <= a.size(); ++i) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j) {
            const size_t substitute = diagonal + (lower(a[i - 1]) != lower(b[j - 1]));
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitute});
        }
    }
    return row[b.size()];
}

}  // namespace

std::string escape_for_display(std::string_view text, size_t max_bytes) {
    static constexpr char kHex[] = "0123456789abcdef";
    std::string out;
    for (size_t i = 0; i < text.size();) {
        if (out.size() >= max_bytes) return out + "…";
        const auto c = static_cast<unsigned char>(text[i]);
        const size_t n = utf8_length(text.substr(i));
        if (n == 0 || c < 0x20 || c == 0x7f) {
            out += {'\\', 'x', kHex[c >> 4], kHex[c & 15]};
            ++i;
        } else {
            out += text.substr(i, n);
            i += n;
        }
    }
    return out;
}

std::optional<std::string> closest_match(std::string_view word, std::span<const std::string_view> candidates) {
    if (word.empty() || word.size() > 64) return std::nullopt;
    std::string_view best;
    // A word with every letter wrong is another word.
    size_t best_distance = std::min(std::max<size_t>(1, word.size() / 3), word.size() - 1) + 1;
    for (const std::string_view candidate : candidates) {
        const size_t distance = edit_distance(word, candidate);
        if (distance < best_distance) best_distance = distance, best = candidate;
    }
    if (best.empty()) return std::nullopt;
    return std::string(best);
}

std::string suggestion(std::string_view word, std::span<const std::string_view> candidates) {
    if (const auto match = closest_match(word, candidates)) return "did you mean '" + *match + "'?";
    if (candidates.empty()) return {};
    std::string out = candidates.size() == 1 ? "expected " : "expected one of ";
    for (size_t i = 0; i < candidates.size(); ++i) {
        if (i) out += ", ";
        out += candidates[i];
    }
    return out;
}

TextPosition locate(std::string_view text, size_t offset) {
    offset = std::min(offset, text.size());
    size_t begin = 0;
    TextPosition at;
    for (size_t i = 0; i < offset; ++i) {
        const bool lone_cr = text[i] == '\r' && (i + 1 == text.size() || text[i + 1] != '\n');
        if (text[i] == '\n' || lone_cr) ++at.line, begin = i + 1;
    }
    at.column = static_cast<uint32_t>(std::min<size_t>(offset - begin + 1, std::numeric_limits<uint32_t>::max()));
    size_t end = text.find_first_of("\r\n", offset);
    end = std::min(end, text.size());
    if (end == offset && end > begin && end < text.size() && text[end] == '\n' && text[end - 1] == '\r') --end;
    if (offset > begin + kExcerptMargin) begin = offset - kExcerptMargin;
    at.excerpt = std::string(text.substr(begin, std::min(end - begin, kExcerptWidth)));
    return at;
}

namespace {

/// Whether a decimal number that from_chars found out of range is too small, not too large: the power of ten of its
/// first significant digit decides. The exponent saturates; no text is long enough to bring it back from there.
bool is_tiny(std::string_view magnitude) {
    constexpr int64_t kFar = int64_t(1) << 62;
    const size_t e = std::min(magnitude.find_first_of("eE"), magnitude.size());
    const std::string_view mantissa = magnitude.substr(0, e);
    const auto point = static_cast<int64_t>(std::min(mantissa.find('.'), mantissa.size()));
    const size_t first = mantissa.find_first_of("123456789");
    if (first == mantissa.npos) return true;
    const auto digit = static_cast<int64_t>(first);
    int64_t exponent = 0;
    if (e < magnitude.size()) {
        std::string_view digits = magnitude.substr(e + 1);
        if (digits.starts_with('+')) digits.remove_prefix(1);
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
        if (error == std::errc::result_out_of_range) exponent = digits.starts_with('-') ? -kFar : kFar;
    }
    exponent = std::clamp(exponent, -kFar, kFar);
    return exponent + (digit < point ? point - digit - 1 : point - digit) < 0;
}

}  // namespace

std::optional<double> parse_double(std::string_view text) {
    if (text.starts_with('+')) {
        text.remove_prefix(1);
        if (text.starts_with('-')) return std::nullopt;
    }
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size()) return std::nullopt;
    if (error == std::errc::result_out_of_range) {
        const bool negative = text.starts_with('-');
        value = is_tiny(text.substr(negative)) ? 0.0 : std::numeric_limits<double>::infinity();
        return negative ? -value : value;
    }
    if (error != std::errc()) return std::nullopt;
    return value;
}

const char* foreign_encoding(std::string_view text) noexcept {
    const auto byte = [&](size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 1; };
    const auto is = [&](int a, int b, int c, int d) {
        const auto matches = [&](size_t i, int wanted) { return wanted < 0 ? byte(i) != 0 : byte(i) == wanted; };
        return matches(0, a) && matches(1, b) && matches(2, c) && matches(3, d);
    };
    // UTF-32 first: its little-endian mark begins with that of UTF-16. No text begins with a NUL.
    if (is(0xff, 0xfe, 0, 0) || is(-1, 0, 0, 0)) return "UTF-32 (little-endian)";
    if (is(0, 0, 0xfe, 0xff) || is(0, 0, 0, -1)) return "UTF-32 (big-endian)";
    if (text.size() < 2) return nullptr;
    if ((byte(0) == 0xff && byte(1) == 0xfe) || (byte(0) != 0 && byte(1) == 0)) return "UTF-16 (little-endian)";
    if ((byte(0) == 0xfe && byte(1) == 0xff) || (byte(0) == 0 && byte(1) != 0)) return "UTF-16 (big-endian)";
    return nullptr;
}

bool iequals(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return lower(x) == lower(y); });
}

std::string extension_of(std::string_view path) {
    const size_t slash = path.find_last_of('/');
    const std::string_view name = slash == path.npos ? path : path.substr(slash + 1);
    const size_t dot = name.find_last_of('.');
    if (dot == name.npos || dot == 0) return {};
    std::string extension(name.substr(dot));
    std::transform(extension.begin(), extension.end(), extension.begin(), lower);
    return extension;
}

}  // namespace steradian
