#include "shading/mip_map.h"

#include <bit>
#include <cmath>
#include <cstring>

#include "math/vector.h"
#include "shading/texture.h"

namespace steradian {
namespace {

TexelFormat format_of_levels(const RawImage& image) {
    return image.format == TexelFormat::u8 ? TexelFormat::f16 : TexelFormat::f32;
}

uint32_t half_of(uint32_t size) { return size > 1 ? size / 2 : 1; }

/// To the nearest binary16, ties to even; for values from 0 to 1, so without infinities. Subnormals are multiples of
/// 2^-24, the rest has 11 bits: adding a power of two that is so much larger makes the addition round there.
uint16_t to_half(float x) {
    if (!(x > 0)) return 0;
    if (x < 0x1p-14f)
        return static_cast<uint16_t>(std::bit_cast<uint32_t>(x + 0x1p-1f) - std::bit_cast<uint32_t>(0x1p-1f));
    const uint32_t bits = std::bit_cast<uint32_t>(x), rounded = bits + 0xfffu + (bits >> 13 & 1u);
    return static_cast<uint16_t>((rounded >> 13) - (112u << 10));
}

/// Which texels of a row of `from` make up texel i of `to`, and with what weights: a box as wide as they are more, so
/// at most three where the number is odd.
struct Span {
    uint32_t first = 0, count = 0;
    double weight[3] = {};
};
Span span_of(uint32_t i, uint32_t from, uint32_t to) {
    const double scale = static_cast<double>(from) / to, lo = i * scale, hi = (i + 1) * scale;
    Span out;
    out.first = static_cast<uint32_t>(std::floor(lo));
    for (uint32_t k = out.first; k < from && out.count < 3; ++k) {
        const double covered = min_of(hi, k + 1.0) - max_of(lo, static_cast<double>(k));
        if (!(covered > 1e-9)) break;
        out.weight[out.count++] = covered / scale;
    }
    return out;
}

RawImage halved(const RawImage& from, ColorSpace space, TexelFormat format) {
    RawImage to{half_of(from.width), half_of(from.height), static_cast<uint8_t>(from.channels < 3 ? 1 : 3), format, {}};
    const size_t size = format == TexelFormat::f16 ? 2 : 4;
    to.data.resize(size_t(to.width) * to.height * to.channels * size);
    std::byte* out = to.data.data();
    for (uint32_t y = 0; y < to.height; ++y) {
        const Span rows = span_of(y, from.height, to.height);
        for (uint32_t x = 0; x < to.width; ++x) {
            const Span columns = span_of(x, from.width, to.width);
            double sum[3] = {};
            for (uint32_t j = 0; j < rows.count; ++j)
                for (uint32_t i = 0; i < columns.count; ++i) {
                    const Rgb c = texel(from, space, columns.first + i, rows.first + j);
                    const double weight = rows.weight[j] * columns.weight[i];
                    for (int k = 0; k < 3; ++k) sum[k] += weight * c[k];
                }
            for (int k = 0; k < to.channels; ++k, out += size) {
                const auto value = static_cast<float>(sum[k]);
                const uint16_t half = format == TexelFormat::f16 ? to_half(value) : uint16_t{0};
                std::memcpy(out, format == TexelFormat::f16 ? static_cast<const void*>(&half) : &value, size);
            }
        }
    }
    return to;
}

}  // namespace

MipMap MipMap::make(const RawImage& image, ColorSpace space) {
    MipMap out;
    const RawImage* last = &image;
    while (last->width > 1 || last->height > 1) {
        const ColorSpace of_last = out.levels.empty() ? space : ColorSpace::linear;
        RawImage next = halved(*last, of_last, format_of_levels(image));
        out.levels.push_back(std::move(next));
        last = &out.levels.back();
    }
    return out;
}

uint64_t MipMap::bytes(const RawImage& image) noexcept {
    const uint64_t texel = (image.channels < 3 ? 1u : 3u) * (image.format == TexelFormat::u8 ? 2u : 4u);
    uint64_t texels = 0;
    for (uint32_t w = image.width, h = image.height; w > 1 || h > 1;) {
        w = half_of(w), h = half_of(h);
        texels += uint64_t(w) * h;
    }
    return texels * texel;
}

}  // namespace steradian
