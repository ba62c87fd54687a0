#include "formats/ply/source.h"

#include "base/text.h"

namespace steradian::ply {

double AsciiSource::number(Scalar type) {
    const std::string_view text = word();
    const char* const end = text.data() + text.size();
    if (type == Scalar::f32) {
        // Rounded once, to float: by way of double it would be rounded twice.
        float value = 0;
        const auto [stop, error] = std::from_chars(text.data(), end, value);
        if (error == std::errc() && stop == end) return static_cast<double>(value);
    }
    if (const auto value = parse_double(text)) {
        if (type != Scalar::f32 || text.front() != '+') return *value;
        float rounded = 0;
        const auto [stop, error] = std::from_chars(text.data() + 1, end, rounded);
        return error == std::errc() && stop == end ? static_cast<double>(rounded) : *value;
    }
    at_ -= text.size();
    throw ParseFailure{at_, "'" + escape_for_display(text, 40) + "' is not a number", {}};
}

}  // namespace steradian::ply
