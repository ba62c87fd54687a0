#include "shading/texture.h"

#include <array>
#include <bit>
#include <cstring>

#include "image/tone.h"
#include "math/elementary.h"

namespace steradian {
namespace {

/// The sRGB curve at the 256 codes of a byte.
const std::array<float, 256>& srgb_bytes() {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> t{};
        for (size_t i = 0; i < t.size(); ++i) t[i] = srgb_decode(static_cast<float>(i) / 255.0f);
        return t;
    }();
    return table;
}

/// IEEE 754 binary16, exactly: the bits shifted into place are the number times 2^-112.
float half_to_float(uint16_t h) {
    const uint32_t magnitude = h & 0x7fffu;
    const uint32_t sign = static_cast<uint32_t>(h & 0x8000u) << 16;
    if (magnitude >= 0x7c00u) return std::bit_cast<float>(sign | 0x7f800000u | (magnitude & 0x3ffu) << 13);
    const float value = std::bit_cast<float>(magnitude << 13) * 0x1p112f;
    return std::bit_cast<float>(std::bit_cast<uint32_t>(value) | sign);
}

template <class T>
T load(const std::byte* data, size_t i) {
    T v;
    std::memcpy(&v, data + i * sizeof(T), sizeof v);
    return v;
}

float finite_or_zero(float x) { return is_finite(x) ? x : 0; }

/// The value of sample i of the image as stored, as a number: integers over their maximum.
float stored_value(const RawImage& image, size_t i) {
    switch (image.format) {
        case TexelFormat::u8:
            return static_cast<float>(load<uint8_t>(image.data.data(), i)) / 255.0f;
        case TexelFormat::u16:
            return static_cast<float>(load<uint16_t>(image.data.data(), i)) / 65535.0f;
        case TexelFormat::f16:
            return half_to_float(load<uint16_t>(image.data.data(), i));
        case TexelFormat::f32:
            return load<float>(image.data.data(), i);
    }
    return 0;
}

float linear_value(const RawImage& image, ColorSpace space, size_t i) {
    if (space == ColorSpace::srgb) {
        if (image.format == TexelFormat::u8) return srgb_bytes()[load<uint8_t>(image.data.data(), i)];
        const float v = stored_value(image, i);
        return is_finite(v) ? finite_or_zero(srgb_decode(v)) : 0;
    }
    return finite_or_zero(stored_value(image, i));
}

/// A coordinate brought to where its texels are found with small integers; what is not finite becomes 0.
double reduce(double u, Wrap wrap) {
    if (!std::isfinite(u)) return 0;
    switch (wrap) {
        case Wrap::repeat:
            return u - std::floor(u);
        case Wrap::mirror:
            return u - 2 * std::floor(u / 2);
        case Wrap::clamp:
            return clamp_to(u, 0.0, 1.0);
        case Wrap::black:
            return clamp_to(u, -1.0, 2.0);
    }
    return 0;
}

/// The texel that index i (of a reduced coordinate, so at most one period away) stands for; -1: none, black.
int64_t wrap_index(int64_t i, int64_t n, Wrap wrap) {
    switch (wrap) {
        case Wrap::repeat:
            return i < 0 ? i + n : i >= n ? i - n : i;
        case Wrap::mirror: {
            const int64_t j = i < 0 ? i + 2 * n : i >= 2 * n ? i - 2 * n : i;
            return j < n ? j : 2 * n - 1 - j;
        }
        case Wrap::clamp:
            return clamp_to<int64_t>(i, 0, n - 1);
        case Wrap::black:
            return i < 0 || i >= n ? -1 : i;
    }
    return -1;
}

/// The two texels around a coordinate and the weight of the second.
struct Taps {
    int64_t i0 = 0, i1 = 0;
    double w1 = 0;
};

Taps taps(double u, uint32_t size, Wrap wrap, bool bilinear) {
    const auto n = static_cast<int64_t>(size);
    const double s = reduce(u, wrap) * static_cast<double>(size) - (bilinear ? 0.5 : 0.0);
    const double lower = std::floor(s);
    const auto i = static_cast<int64_t>(lower);
    const int64_t i0 = wrap_index(i, n, wrap);
    if (!bilinear) return {i0, i0, 0};
    return {i0, wrap_index(i + 1, n, wrap), s - lower};
}

/// Where a texture is looked up.
struct TexturePoint {
    double x = 0, y = 0;
};
/// By how much it moves when (u, v) does.
struct TextureMatrix {
    double xu = 1, xv = 0, yu = 0, yv = 1;
};
template <class T>
TextureMatrix texture_matrix(const T& t) {
    const double sx = t.scale.x, sy = t.scale.y;
    if (t.rotation == 0) return {sx, 0, 0, sy};
    const double angle = t.rotation * (std::numbers::pi / 180), c = math::cos(angle), s = math::sin(angle);
    return {c * sx, s * sy, -s * sx, c * sy};
}
template <class T>
TexturePoint texture_point(const T& t, Vec2 uv) {
    if (t.rotation == 0)
        return {static_cast<double>(uv.x) * t.scale.x + t.offset.x, static_cast<double>(uv.y) * t.scale.y + t.offset.y};
    const TextureMatrix m = texture_matrix(t);
    return {m.xu * uv.x + m.xv * uv.y + t.offset.x, m.yu * uv.x + m.yv * uv.y + t.offset.y};
}

Rgb look_up(const Scene&, const CheckerTexture& t, TexturePoint at) {
    const auto square = [](double x) { return std::isfinite(x) ? std::floor(x) : 0.0; };
    const double sum = square(at.x) + square(at.y);
    return sum - 2 * std::floor(sum / 2) == 0 ? t.even : t.odd;
}

Rgb look_up(const Scene& scene, const ImageTexture& t, TexturePoint point) {
    const RawImage& image = scene.images[index(t.image)];
    const Taps x = taps(point.x, image.width, t.wrap_u, t.bilinear);
    const Taps y = taps(point.y, image.height, t.wrap_v, t.bilinear);
    const auto at = [&](int64_t i, int64_t j) {
        if (i < 0 || j < 0) return Rgb{};
        return texel(image, t.color_space, static_cast<uint32_t>(i), static_cast<uint32_t>(j));
    };
    if (!t.bilinear) return at(x.i0, y.i0);
    const auto wx = static_cast<float>(x.w1), wy = static_cast<float>(y.w1);
    const Rgb upper = at(x.i0, y.i0) * (1 - wx) + at(x.i1, y.i0) * wx;
    const Rgb lower = at(x.i0, y.i1) * (1 - wx) + at(x.i1, y.i1) * wx;
    return upper * (1 - wy) + lower * wy;
}

Rgb eval_kind(const Scene&, const ConstantTexture& t, Vec2) { return t.value; }
template <class T>
Rgb eval_kind(const Scene& scene, const T& t, Vec2 uv) {
    return look_up(scene, t, texture_point(t, uv));
}

/// What counts as one texel, in texture space.
Vec2 texel_size(const Scene&, const CheckerTexture&) { return {1 / 256.0f, 1 / 256.0f}; }
Vec2 texel_size(const Scene& scene, const ImageTexture& t) {
    const RawImage& image = scene.images[index(t.image)];
    return {1 / static_cast<float>(image.width), 1 / static_cast<float>(image.height)};
}

}  // namespace

Rgb texel(const RawImage& image, ColorSpace space, uint32_t x, uint32_t y) noexcept {
    const size_t i = (static_cast<size_t>(y) * image.width + x) * image.channels;
    const float first = linear_value(image, space, i);
    if (image.channels < 3) return {first, first, first};
    return {first, linear_value(image, space, i + 1), linear_value(image, space, i + 2)};
}

uint64_t count_bad_texels(const RawImage& image, bool negative_too) noexcept {
    if (image.format != TexelFormat::f16 && image.format != TexelFormat::f32) return 0;
    const size_t colors = image.channels < 3 ? 1 : 3;
    const size_t texels = static_cast<size_t>(image.width) * image.height;
    uint64_t bad = 0;
    for (size_t i = 0; i < texels; ++i) {
        bool fine = true;
        for (size_t c = 0; c < colors; ++c) {
            const float v = stored_value(image, i * image.channels + c);
            fine = fine && is_finite(v) && !(negative_too && v < 0);
        }
        bad += fine ? 0 : 1;
    }
    return bad;
}

Rgb eval_texture(const Scene& scene, TextureId id, Vec2 uv) noexcept {
    return std::visit([&](const auto& t) { return eval_kind(scene, t, uv); }, scene.textures[index(id)]);
}

Vec2 texture_slope(const Scene& scene, TextureId id, Vec2 uv) noexcept {
    return std::visit(
        [&](const auto& t) {
            if constexpr (std::is_same_v<std::decay_t<decltype(t)>, ConstantTexture>) {
                return Vec2{0, 0};
            } else {
                const Vec2 texel = texel_size(scene, t);
                const TexturePoint at = texture_point(t, uv);
                const auto height = [&](double x, double y) {
                    return static_cast<double>(look_up(scene, t, {at.x + x * texel.x, at.y + y * texel.y}).r);
                };
                const double ds = (height(0.5, 0) - height(-0.5, 0)) / texel.x;
                const double dt = (height(0, 0.5) - height(0, -0.5)) / texel.y;
                const TextureMatrix m = texture_matrix(t);
                return Vec2{static_cast<float>(ds * m.xu + dt * m.yu), static_cast<float>(ds * m.xv + dt * m.yv)};
            }
        },
        scene.textures[index(id)]);
}

}  // namespace steradian
