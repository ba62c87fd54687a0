// Radiance pictures (Greg Ward, "Real Pixels", Graphics Gems II, 1991): three mantissas and a shared exponent.
#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

#include "base/text.h"
#include "image/codec.h"
#include "math/vector.h"

namespace steradian::codec {
namespace {

constexpr uint32_t kMinRleWidth = 8, kMaxRleWidth = 0x7fff;
constexpr size_t kMaxHeaderLine = 4096;

struct Rgbe {
    uint8_t v[4];  ///< red, green and blue mantissa, exponent
};

/// mantissa · 2^(exponent - 136), exactly; an exponent of 0 is black.
float channel_value(uint8_t mantissa, uint8_t exponent) {
    return exponent ? std::ldexp(static_cast<float>(mantissa), exponent - 136) : 0.0f;
}

/// The nearest value of the format; what it cannot hold (negative, NaN, too large) is clamped and counted.
Rgbe encode_pixel(Rgb c, uint64_t& clamped) {
    constexpr float kMax = 0x1.fep126f;  // 255 · 2^(255 - 136) is 0x1.fep126
    const Rgb kept{clamp_to(c.r, 0.0f, kMax), clamp_to(c.g, 0.0f, kMax), clamp_to(c.b, 0.0f, kMax)};
    if (!(kept == c)) ++clamped;
    const float largest = max_component(kept);
    if (largest < 0x1p-128f) return {{0, 0, 0, 0}};
    int exponent = 0;
    std::frexp(largest, &exponent);
    const auto mantissa = [&](float x) { return std::floor(std::ldexp(static_cast<double>(x), 8 - exponent) + 0.5); };
    if (mantissa(largest) > 255) ++exponent;  // rounded up to the next power of two
    const auto byte = [&](float x) { return static_cast<uint8_t>(mantissa(x)); };
    return {{byte(kept.r), byte(kept.g), byte(kept.b), static_cast<uint8_t>(exponent + 128)}};
}

/// The run-length code of one component of a row: 128 + n and a byte, or n and n bytes.
void encode_component(const std::vector<Rgbe>& row, int component, std::string& out) {
    const auto at = [&](size_t i) { return row[i].v[component]; };
    const auto run_at = [&](size_t i) {
        size_t n = 1;
        while (n < 127 && i + n < row.size() && at(i + n) == at(i)) ++n;
        return n;
    };
    constexpr size_t kWorthwhile = 4;
    for (size_t i = 0; i < row.size();) {
        size_t literal = 0, run = 0;
        while (i + literal < row.size() && literal < 128 && (run = run_at(i + literal)) < kWorthwhile) ++literal;
        if (literal) {
            out += static_cast<char>(literal);
            for (size_t k = 0; k < literal; ++k) out += static_cast<char>(at(i + k));
            i += literal;
        } else {
            out += static_cast<char>(128 + run);
            out += static_cast<char>(at(i));
            i += run;
        }
    }
}

struct Header {
    uint32_t width = 0, height = 0;
    bool bottom_up = false, right_to_left = false;
    double exposure = 1;
    size_t end = 0;  ///< where the pixels begin
};

std::string_view next_line(const Source& source, size_t& position) {
    const size_t end = source.bytes.substr(position, kMaxHeaderLine).find('\n');
    if (end == std::string_view::npos) source.fail("the Radiance header is cut short or malformed", position);
    std::string_view line = source.bytes.substr(position, end);
    position += end + 1;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
}

/// "-Y 512 +X 768": rows from the top, each from the left. Pictures stored by columns are refused.
void parse_resolution(const Source& source, std::string_view line, size_t at, Header& header) {
    const auto expect = [&](bool good) {
        if (!good)
            source.fail(fmt::format("expected a line such as -Y 512 +X 768, found '{}'", escape_for_display(line, 60)),
                        at);
    };
    const auto number = [&](size_t& i) {
        uint32_t value = 0;
        const auto [end, error] = std::from_chars(line.data() + i, line.data() + line.size(), value);
        expect(error == std::errc() && value <= 0x7fffffff);
        i = static_cast<size_t>(end - line.data());
        return value;
    };
    const auto axis = [&](size_t i, char name) {
        expect(i + 3 <= line.size() && (line[i] == '-' || line[i] == '+') && line[i + 2] == ' ');
        if (line[i + 1] != name && (line[i + 1] == 'X' || line[i + 1] == 'Y'))
            source.fail("a picture stored by columns is not supported, expected -Y … +X …", at);
        expect(line[i + 1] == name);
        return line[i] == '-';
    };
    size_t i = 0;
    header.bottom_up = !axis(i, 'Y');
    header.height = number(i += 3);
    expect(i < line.size() && line[i] == ' ');
    header.right_to_left = axis(++i, 'X');
    header.width = number(i += 3);
    expect(i == line.size());
}

Header parse_header(const Source& source) {
    Header header;
    size_t position = 0;
    if (!next_line(source, position).starts_with("#?"))
        source.fail("expected a Radiance picture, which begins with #?", 0);
    for (;;) {
        const size_t at = position;
        const std::string_view line = next_line(source, position);
        if (line.empty()) break;
        if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe")
            source.fail(fmt::format("pictures of '{}' are not supported, expected FORMAT=32-bit_rle_rgbe",
                                    escape_for_display(line, 60)),
                        at);
        if (line.starts_with("EXPOSURE=")) {
            std::string_view text = line.substr(9);
            while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
            while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
            const auto value = parse_double(text);
            if (!value || !(*value > 0) || !std::isfinite(*value))
                source.fail("expected a positive number after EXPOSURE=", at);
            header.exposure *= *value;  // several of them accumulate
        }
    }
    const size_t at = position;
    parse_resolution(source, next_line(source, position), at, header);
    // Its inverse multiplies floats.
    if (!(header.exposure >= 0x1p-126) || !(header.exposure <= 0x1p126))
        source.fail("the product of all EXPOSURE= is out of range", at);
    header.end = position;
    return header;
}

/// Reads rows of RGBE, whichever of the three ways each is stored in.
class RowReader {
public:
    RowReader(const Source& source, size_t position) : source_(source), position_(position) {}

    void read(std::vector<Rgbe>& row) {
        const std::string_view rest = source_.bytes.substr(position_);
        const bool fits = row.size() >= kMinRleWidth && row.size() <= kMaxRleWidth && rest.size() >= 4;
        if (fits && rest[0] == 2 && rest[1] == 2 && static_cast<uint8_t>(rest[2]) < 128)
            read_components(row);
        else
            read_pixels(row);
    }

private:
    uint8_t byte() {
        if (position_ >= source_.bytes.size()) source_.fail("the file ends early", position_);
        return static_cast<uint8_t>(source_.bytes[position_++]);
    }

    /// Since 1991: the four components after each other, each run-length coded.
    void read_components(std::vector<Rgbe>& row) {
        const size_t at = position_;
        position_ += 2;
        const size_t high = byte();
        if ((high << 8 | byte()) != row.size()) source_.fail("a row's length differs from the picture's width", at);
        for (int component = 0; component < 4; ++component) {
            for (size_t i = 0; i < row.size();) {
                const size_t code_at = position_;
                const uint8_t code = byte();
                const size_t n = code > 128 ? code - 128u : code;
                if (n == 0 || n > row.size() - i) source_.fail("a run goes beyond the end of its row", code_at);
                if (code > 128) {
                    const uint8_t value = byte();
                    for (size_t k = 0; k < n; ++k) row[i++].v[component] = value;
                } else {
                    for (size_t k = 0; k < n; ++k) row[i++].v[component] = byte();
                }
            }
        }
    }

    /// Before that: whole pixels, where (1, 1, 1, n) repeats the last one; consecutive counts are digits of base 256.
    void read_pixels(std::vector<Rgbe>& row) {
        int shift = 0;
        for (size_t i = 0; i < row.size();) {
            const size_t at = position_;
            Rgbe pixel;
            for (uint8_t& value : pixel.v) value = byte();
            if (pixel.v[0] == 1 && pixel.v[1] == 1 && pixel.v[2] == 1) {
                const uint64_t n = shift < 32 ? uint64_t(pixel.v[3]) << shift : ~uint64_t(0);
                if (i == 0 || n > row.size() - i) source_.fail("a run goes beyond its row", at);
                for (uint64_t k = 0; k < n; ++k, ++i) row[i] = row[i - 1];
                shift += 8;
            } else {
                row[i++] = pixel;
                shift = 0;
            }
        }
    }

    const Source& source_;
    size_t position_;
};

}  // namespace

Decoded decode_hdr(const Source& source) {
    const Header header = parse_header(source);
    Decoded out;
    out.raw.width = header.width;
    out.raw.height = header.height;
    out.raw.format = TexelFormat::f32;
    source.check_size(header.width, header.height, uint64_t(header.width) * header.height * 12);
    // Every row takes at least one pixel or one row header.
    if ((source.bytes.size() - header.end) / 4 < header.height)
        source.fail(fmt::format("the file ends early: it is too short for {} rows", header.height),
                    source.bytes.size());
    out.raw.data.resize(size_t(header.width) * header.height * 3 * sizeof(float));
    const auto scale = static_cast<float>(1 / header.exposure);
    std::vector<Rgbe> row(header.width);
    RowReader reader(source, header.end);
    for (uint32_t y = 0; y < header.height; ++y) {
        reader.read(row);
        const size_t to = header.bottom_up ? header.height - 1 - y : y;
        for (size_t x = 0; x < row.size(); ++x) {
            const Rgbe& pixel = row[header.right_to_left ? row.size() - 1 - x : x];
            float rgb[3];
            for (int c = 0; c < 3; ++c) rgb[c] = channel_value(pixel.v[c], pixel.v[3]) * scale;
            std::memcpy(out.raw.data.data() + (to * row.size() + x) * sizeof rgb, rgb, sizeof rgb);
        }
    }
    return out;
}

std::string encode_hdr(const Image& image, const std::string& path, Diagnostics& diagnostics) {
    const ColourChannels colour = colour_channels(image, "HDR", false, path, diagnostics);
    std::string out = fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", image.height, image.width);
    const bool rle = image.width >= kMinRleWidth && image.width <= kMaxRleWidth;
    uint64_t clamped = 0;
    std::vector<Rgbe> row(image.width);
    for (size_t y = 0; y < image.height; ++y) {
        for (size_t x = 0; x < image.width; ++x) {
            const float* pixel = &image.pixels[(y * image.width + x) * image.channels.size()];
            row[x] = encode_pixel(
                {pixel[colour.index[0]], pixel[colour.index[colour.count / 2]], pixel[colour.index[colour.count - 1]]},
                clamped);
        }
        if (rle) {
            out += {2, 2, static_cast<char>(image.width >> 8), static_cast<char>(image.width & 255)};
            for (int component = 0; component < 4; ++component) encode_component(row, component, out);
        } else {
            for (const Rgbe& pixel : row) out.append(reinterpret_cast<const char*>(pixel.v), 4);
        }
    }
    if (clamped)
        diagnostics.warn("a pixel that the HDR format cannot hold (negative, not a number or too large) was clamped",
                         {path, 0, 0, {}}, clamped);
    return out;
}

}  // namespace steradian::codec
