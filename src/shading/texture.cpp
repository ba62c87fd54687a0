#include "shading/texture.h"

#include <array>
#include <bit>
#include <cstring>

#include "image/tone.h"
#include "math/elementary.h"
#include "shading/mip_map.h"
#include "shading/shading_scene.h"

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

Rgb look_up(const RawImage& image, ColorSpace space, const ImageTexture& t, TexturePoint point) {
    const Taps x = taps(point.x, image.width, t.wrap_u, t.bilinear);
    const Taps y = taps(point.y, image.height, t.wrap_v, t.bilinear);
    const auto at = [&](int64_t i, int64_t j) {
        if (i < 0 || j < 0) return Rgb{};
        return texel(image, space, static_cast<uint32_t>(i), static_cast<uint32_t>(j));
    };
    if (!t.bilinear) return at(x.i0, y.i0);
    const auto wx = static_cast<float>(x.w1), wy = static_cast<float>(y.w1);
    const Rgb upper = at(x.i0, y.i0) * (1 - wx) + at(x.i1, y.i0) * wx;
    const Rgb lower = at(x.i0, y.i1) * (1 - wx) + at(x.i1, y.i1) * wx;
    return upper * (1 - wy) + lower * wy;
}
Rgb look_up(const Scene& scene, const ImageTexture& t, TexturePoint point) {
    return look_up(scene.images[index(t.image)], t.color_space, t, point);
}

Rgb eval_kind(const Scene&, const ConstantTexture& t, Vec2) { return t.value; }
Rgb eval_kind(const Scene&, const VertexColorTexture&, Vec2) { return {1, 1, 1}; }
Rgb eval_kind(const Scene& scene, const ProductTexture& t, Vec2 uv) {
    return eval_texture(scene, t.first, uv) * eval_texture(scene, t.second, uv);
}
template <class T>
Rgb eval_kind(const Scene& scene, const T& t, Vec2 uv) {
    return look_up(scene, t, texture_point(t, uv));
}

/// An image and its MIP map at a level of detail, which need not be whole: 0 is the image itself.
struct Filtered {
    const ImageTexture& texture;
    const RawImage& image;
    const MipMap* map = nullptr;
    double level = 0;

    Rgb at(TexturePoint point) const {
        const double whole = std::floor(level);
        const auto first = static_cast<size_t>(whole);
        const auto weight = static_cast<float>(level - whole);
        const Rgb fine = of_level(first, point);
        return weight > 0 ? fine * (1 - weight) + of_level(first + 1, point) * weight : fine;
    }

private:
    Rgb of_level(size_t i, TexturePoint point) const {
        return i == 0 ? look_up(image, texture.color_space, texture, point)
                      : look_up(map->levels[i - 1], ColorSpace::linear, texture, point);
    }
};

/// λ such that a texel of that level is as wide as the footprint, as an area (Akenine-Möller et al. 2021, equation 4,
/// with the derivatives of the surface for the triangle's areas).
Filtered filtered(const ShadingScene& scene, TextureId id, const ImageTexture& t, const SurfacePoint& point) {
    Filtered out{t, scene.scene.images[index(t.image)]};
    if (!t.mip_map || !t.bilinear || !(point.footprint > 0) || scene.mip_maps.empty()) return out;
    out.map = scene.mip_maps[index(id)].get();
    if (!out.map || out.map->levels.empty()) return out;
    const SurfaceDerivatives d = derivatives_at(scene, point, t.uv_set);
    const TextureMatrix m = texture_matrix(t);
    const double area = length(cross(d.du, d.dv)), uv_area = d.determinant * d.determinant;
    const double texels = double(out.image.width) * out.image.height * std::fabs(m.xu * m.yv - m.xv * m.yu);
    const double footprint = point.footprint, across = texels * uv_area / area * footprint * footprint;
    if (across > 1) out.level = min_of(math::log2(across) / 2, static_cast<double>(out.map->levels.size()));
    return out;
}

Rgb eval_at(const ShadingScene&, TextureId, const ConstantTexture& t, const SurfacePoint&) { return t.value; }
Rgb eval_at(const ShadingScene& scene, TextureId, const CheckerTexture& t, const SurfacePoint& point) {
    return eval_kind(scene.scene, t, point.uv);
}
Rgb eval_at(const ShadingScene& scene, TextureId id, const ImageTexture& t, const SurfacePoint& point) {
    return filtered(scene, id, t, point).at(texture_point(t, uv_at(scene, point, t.uv_set)));
}
Rgb eval_at(const ShadingScene& scene, TextureId, const ProductTexture& t, const SurfacePoint& point) {
    return eval_texture(scene, t.first, point) * eval_texture(scene, t.second, point);
}

Rgb eval_at(const ShadingScene& scene, TextureId, const VertexColorTexture& t, const SurfacePoint& point) {
    const Scene& s = scene.scene;
    const auto* id = std::get_if<MeshId>(&s.shapes[index(s.instances[point.instance].shape)]);
    if (!id) return {1, 1, 1};
    const Mesh& mesh = s.meshes[index(*id)];
    if (t.alpha ? mesh.alphas.empty() : mesh.colors.empty()) return {1, 1, 1};
    const uint32_t* i = mesh.indices.data() + size_t(3) * point.prim;
    const float b1 = point.hit_uv.x, b2 = point.hit_uv.y, b0 = max_of(1 - b1 - b2, 0.0f);
    if (t.alpha) {
        const float a = mesh.alphas[i[0]] * b0 + mesh.alphas[i[1]] * b1 + mesh.alphas[i[2]] * b2;
        return {a, a, a};
    }
    return mesh.colors[i[0]] * b0 + mesh.colors[i[1]] * b1 + mesh.colors[i[2]] * b2;
}

/// By differences over `step`, in texture space; `height` at a place there.
template <class T, class Height>
Vec2 slope_of(const T& t, Vec2 uv, double step_x, double step_y, const Height& height) {
    const TexturePoint at = texture_point(t, uv);
    const double ds =
        (height(TexturePoint{at.x + step_x / 2, at.y}) - height(TexturePoint{at.x - step_x / 2, at.y})) / step_x;
    const double dt =
        (height(TexturePoint{at.x, at.y + step_y / 2}) - height(TexturePoint{at.x, at.y - step_y / 2})) / step_y;
    const TextureMatrix m = texture_matrix(t);
    return {static_cast<float>(ds * m.xu + dt * m.yu), static_cast<float>(ds * m.xv + dt * m.yv)};
}

Vec2 slope_at(const ShadingScene&, TextureId, const ConstantTexture&, const SurfacePoint&) { return {0, 0}; }
/// Heights of vertices and products of heights: validate() refuses them.
Vec2 slope_at(const ShadingScene&, TextureId, const VertexColorTexture&, const SurfacePoint&) { return {0, 0}; }
Vec2 slope_at(const ShadingScene&, TextureId, const ProductTexture&, const SurfacePoint&) { return {0, 0}; }
Vec2 slope_at(const ShadingScene& scene, TextureId, const CheckerTexture& t, const SurfacePoint& point) {
    return slope_of(t, point.uv, 1 / 256.0, 1 / 256.0,
                    [&](TexturePoint at) { return double{look_up(scene.scene, t, at).r}; });
}
Vec2 slope_at(const ShadingScene& scene, TextureId id, const ImageTexture& t, const SurfacePoint& point) {
    const Filtered image = filtered(scene, id, t, point);
    const double texel = image.level > 0 ? math::pow(2.0, image.level) : 1;
    return slope_of(t, uv_at(scene, point, t.uv_set), texel / image.image.width, texel / image.image.height,
                    [&](TexturePoint at) { return double{image.at(at).r}; });
}

}  // namespace

Rgb texel(const RawImage& image, ColorSpace space, uint32_t x, uint32_t y) noexcept {
    const size_t i = (static_cast<size_t>(y) * image.width + x) * image.channels;
    if (image.format == TexelFormat::f32 && space == ColorSpace::linear && image.channels >= 3) {  // most skies
        float c[3];
        std::memcpy(c, image.data.data() + i * sizeof(float), sizeof c);
        return {finite_or_zero(c[0]), finite_or_zero(c[1]), finite_or_zero(c[2])};
    }
    const float first = linear_value(image, space, i);
    if (image.channels < 3) return {first, first, first};
    return {first, linear_value(image, space, i + 1), linear_value(image, space, i + 2)};
}

uint32_t uv_set_of(const Scene& scene, TextureId id) noexcept {
    const auto* image = std::get_if<ImageTexture>(&scene.textures[index(id)]);
    return image ? image->uv_set : 0;
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

Rgb eval_texture(const ShadingScene& scene, TextureId id, const SurfacePoint& point) noexcept {
    return std::visit([&](const auto& t) { return eval_at(scene, id, t, point); }, scene.scene.textures[index(id)]);
}

Rgb eval_color(const ShadingScene& scene, TextureId id, const SurfacePoint& point) noexcept {
    const Rgb c = eval_texture(scene, id, point);
    return {max_of(c.r, 0.0f), max_of(c.g, 0.0f), max_of(c.b, 0.0f)};
}

Vec2 texture_slope(const ShadingScene& scene, TextureId id, const SurfacePoint& point) noexcept {
    return std::visit([&](const auto& t) { return slope_at(scene, id, t, point); }, scene.scene.textures[index(id)]);
}

}  // namespace steradian
