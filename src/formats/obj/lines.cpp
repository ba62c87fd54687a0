#include "formats/obj/lines.h"

#include <charconv>
#include <cstring>
#include <limits>

#include "base/text.h"

namespace steradian::obj {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
bool is_line_end(char c) { return c == '\n' || c == '\r'; }

/// White space inside a logical line: blanks, and a continuation with the line end that it swallows.
bool is_space(const char* p, const char* end) {
    return is_blank(*p) || is_line_end(*p) || (*p == '\\' && p + 1 < end && is_line_end(p[1]));
}

}  // namespace

/// The LF, CR or end of text that ends the physical line. The next LF is remembered, so that a text of CRs only is
/// searched once.
const char* Lines::line_end(const char* from) {
    if (newline_ == nullptr || newline_ < from) {
        const void* found = std::memchr(from, '\n', static_cast<size_t>(end_ - from));
        newline_ = found ? static_cast<const char*>(found) : end_;
    }
    const void* cr = std::memchr(from, '\r', static_cast<size_t>(newline_ - from));
    return cr ? static_cast<const char*>(cr) : newline_;
}

bool Lines::next(std::string_view& line) {
    while (at_ < end_) {
        while (at_ < end_ && is_space(at_, end_)) ++at_;
        if (at_ == end_) return false;
        const char* const begin = at_;
        const char* stop = line_end(begin);
        while (*begin != '#' && stop < end_ && stop[-1] == '\\' && stop > begin) {
            const bool crlf = *stop == '\r' && stop + 1 < end_ && stop[1] == '\n';
            const char* const following = stop + (crlf ? 2 : 1);
            stop = following < end_ ? line_end(following) : end_;
        }
        at_ = stop;
        if (*begin == '#') continue;
        line = {begin, static_cast<size_t>(stop - begin)};
        return true;
    }
    return false;
}

bool Words::more(bool comments) {
    while (at_ < end_ && is_space(at_, end_)) ++at_;
    return at_ < end_ && !(comments && *at_ == '#');
}

std::string_view Words::peek() {
    more(false);
    const char* stop = at_;
    while (stop < end_ && !is_space(stop, end_)) ++stop;
    return {at_, static_cast<size_t>(stop - at_)};
}

std::string_view Words::word() {
    const std::string_view found = peek();
    at_ += found.size();
    return found;
}

std::string_view Words::rest() {
    more(false);
    const char* stop = end_;
    while (stop > at_ && (is_blank(stop[-1]) || is_line_end(stop[-1]))) --stop;
    const std::string_view found{at_, static_cast<size_t>(stop - at_)};
    at_ = end_;
    return found;
}

std::optional<float> Words::number() {
    if (!more(false)) return std::nullopt;
    // The common case, without looking for the end of the word first.
    float value = 0;
    const auto [stop, error] = std::from_chars(at_, end_, value);
    if (error == std::errc() && (stop == end_ || is_space(stop, end_))) {
        at_ = stop;
        return value;
    }
    const std::string_view text = peek();
    const auto number = parse_number(text);
    if (number) at_ += text.size();
    return number;
}

std::optional<float> parse_number(std::string_view word) {
    if (!word.empty() && word.front() == '+') {
        word.remove_prefix(1);
        if (!word.empty() && (word.front() == '+' || word.front() == '-')) return std::nullopt;
    }
    float value = 0;
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    const std::string_view left(stop, static_cast<size_t>(end - stop));
    if (error == std::errc() && left.empty()) return value;
    if (error == std::errc::result_out_of_range && left.empty()) {
        const auto wide = parse_double(word);
        if (!wide) return std::nullopt;
        const bool huge = *wide > 1 || *wide < -1;
        const float magnitude = huge ? std::numeric_limits<float>::infinity() : 0.0f;
        return word.front() == '-' ? -magnitude : magnitude;
    }
    // "1.#INF", "-1.#IND", "1.#QNAN0": how older Microsoft libraries print what is not finite.
    if (error == std::errc() && left.size() >= 4 && left.front() == '#') {
        const std::string_view kind = left.substr(1, 3);
        if (iequals(kind, "inf"))
            return value < 0 ? -std::numeric_limits<float>::infinity() : std::numeric_limits<float>::infinity();
        if (iequals(kind, "ind") || iequals(left.substr(1, 4), "qnan") || iequals(left.substr(1, 4), "snan"))
            return std::numeric_limits<float>::quiet_NaN();
    }
    return std::nullopt;
}

}  // namespace steradian::obj
