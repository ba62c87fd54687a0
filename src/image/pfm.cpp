// Portable float maps (Paul Debevec): "PF" or "Pf", width, height, scale, then rows from the bottom. A negative scale
// says little-endian; values are multiplied by its magnitude.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "base/text.h"
#include "image/codec.h"
#include "math/vector.h"

namespace steradian::codec {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// The next word of the header; exactly one whitespace character after it is consumed.
std::string_view next_word(const Source& source, size_t& position) {
    const std::string_view bytes = source.bytes;
    while (position < bytes.size() && is_space(bytes[position])) ++position;
    const size_t begin = position;
    while (position < bytes.size() && !is_space(bytes[position]) && position - begin < 64) ++position;
    if (position == begin || position >= bytes.size() || !is_space(bytes[position]))
        source.fail("the PFM header is cut short or malformed, expected width, height and scale", begin);
    return bytes.substr(begin, position++ - begin);
}

uint32_t next_size(const Source& source, size_t& position) {
    const size_t begin = position;
    const auto value = parse_double(next_word(source, position));
    if (!value || !(*value >= 1 && *value <= 0x7fffffff) || *value != std::floor(*value))
        source.fail("expected a positive whole number in the PFM header", begin);
    return static_cast<uint32_t>(*value);
}

}  // namespace

Decoded decode_pfm(const Source& source) {
    size_t position = 0;
    const std::string_view kind = next_word(source, position);
    if (kind != "PF" && kind != "Pf") source.fail("expected a PFM file, which begins with PF or Pf", 0);
    Decoded out;
    out.raw.channels = kind == "PF" ? 3 : 1;
    out.raw.format = TexelFormat::f32;
    out.raw.width = next_size(source, position);
    out.raw.height = next_size(source, position);
    const size_t scale_at = position;
    const auto scale = parse_double(next_word(source, position));
    // As a float, too: a scale that only a double can hold would make infinities of every value.
    const auto factor = static_cast<float>(scale ? clamp_to(std::fabs(*scale), 0.0, 1e39) : 0);
    if (!(factor > 0) || !is_finite(factor))
        source.fail("expected a finite scale other than 0 in the PFM header: -1.0 says little-endian", scale_at);

    const uint64_t row = uint64_t(out.raw.width) * out.raw.channels * sizeof(float);
    const uint64_t there = source.bytes.size() - position;
    source.check_size(out.raw.width, out.raw.height, row);
    if (there / row < out.raw.height)
        source.fail(fmt::format("the file ends early: {} × {} pixels need {} bytes, there are {}", out.raw.width,
                                out.raw.height, row * out.raw.height, there),
                    source.bytes.size());
    out.raw.data.resize(row * out.raw.height);
    const bool swap = *scale > 0;
    for (uint32_t y = 0; y < out.raw.height; ++y) {
        const char* from = source.bytes.data() + position + (out.raw.height - 1 - y) * row;
        std::byte* to = out.raw.data.data() + y * row;
        std::memcpy(to, from, row);
        if (!swap && factor == 1) continue;
        for (uint64_t i = 0; i < row; i += sizeof(float)) {
            uint32_t bits;
            std::memcpy(&bits, to + i, sizeof bits);
            if (swap) bits = __builtin_bswap32(bits);
            if (factor != 1) bits = std::bit_cast<uint32_t>(std::bit_cast<float>(bits) * factor);
            std::memcpy(to + i, &bits, sizeof bits);
        }
    }
    return out;
}

std::string encode_pfm(const Image& image, const std::string& path, Diagnostics& diagnostics) {
    const ColourChannels colour = colour_channels(image, "PFM", false, path, diagnostics);
    std::string out = fmt::format("{}\n{} {}\n-1.0\n", colour.count == 3 ? "PF" : "Pf", image.width, image.height);
    out.reserve(out.size() + size_t(image.width) * image.height * colour.count * sizeof(float));
    const size_t step = image.channels.size();
    for (size_t y = image.height; y-- > 0;)
        for (size_t x = 0; x < image.width; ++x)
            for (size_t c = 0; c < colour.count; ++c) {
                const float value = image.pixels[(y * image.width + x) * step + colour.index[c]];
                char bytes[sizeof value];
                std::memcpy(bytes, &value, sizeof value);
                out.append(bytes, sizeof bytes);
            }
    return out;
}

}  // namespace steradian::codec
