#include "lint/texels.h"

#include <cmath>

#include "base/parallel.h"
#include "image/tone.h"
#include "math/vector.h"
#include "shading/texture.h"

namespace steradian::lint_detail {
namespace {

void add(TexelRange& r, Rgb c) {
    for (int k = 0; k < 3; ++k) {
        r.lowest[k] = min_of(r.lowest[k], c[k]);
        r.highest[k] = max_of(r.highest[k], c[k]);
        r.black_and_white = r.black_and_white && (c[k] == 0 || c[k] == 1);
    }
}

TexelRange empty_range() { return {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}}; }

TexelRange range_of(const RawImage& image, ColorSpace space) {
    std::vector<TexelRange> rows(image.height, empty_range());
    parallel_for(image.height, 16, [&](size_t begin, size_t end) {
        for (size_t y = begin; y < end; ++y)
            for (uint32_t x = 0; x < image.width; ++x) add(rows[y], texel(image, space, x, static_cast<uint32_t>(y)));
    });
    TexelRange out = empty_range();
    for (const TexelRange& row : rows) {
        const bool grey = out.black_and_white && row.black_and_white;
        add(out, row.lowest), add(out, row.highest);
        out.black_and_white = grey;
    }
    out.not_finite = count_bad_texels(image, false);
    return out;
}

Rgb larger(Rgb a, Rgb b) { return {max_of(a.r, b.r), max_of(a.g, b.g), max_of(a.b, b.b)}; }

}  // namespace

NormalTexels normal_texels(const RawImage& image) {
    constexpr uint64_t kMostLookedAt = 1 << 16;
    constexpr double kRoughly = 0.25, kNearly = 0.06;
    const uint64_t texels = uint64_t(image.width) * image.height, step = texels / kMostLookedAt + 1;
    NormalTexels out;
    Vec3d sum, sum_decoded;
    Rgb first;
    for (uint64_t i = 0; i < texels; i += step, ++out.looked_at) {
        const Rgb c = texel(image, ColorSpace::linear, static_cast<uint32_t>(i % image.width),
                            static_cast<uint32_t>(i / image.width));
        const auto normal = [](double r, double g, double b) { return Vec3d{2 * r - 1, 2 * g - 1, 2 * b - 1}; };
        const auto is_unit = [](Vec3d n, double slack) { return std::fabs(length(n) - 1) < slack; };
        const Vec3d n = normal(c.r, c.g, c.b), decoded = normal(srgb_decode(c.r), srgb_decode(c.g), srgb_decode(c.b));
        out.roughly_unit += is_unit(n, kRoughly) ? 1 : 0;
        out.unit += is_unit(n, kNearly) && n.z > 0 ? 1 : 0;
        out.unit_decoded += is_unit(decoded, kNearly) && decoded.z > 0 ? 1 : 0;
        out.inwards += n.z < 0 ? 1 : 0;
        sum = sum + n;
        sum_decoded = sum_decoded + decoded;
        if (i == 0) first = c;
        out.varied = out.varied || c != first;
    }
    const double each = 1 / static_cast<double>(out.looked_at);
    out.mean = static_cast<Vec3>(sum * each);
    out.mean_decoded = static_cast<Vec3>(sum_decoded * each);
    return out;
}

const TexelRange& Texels::range(ImageId image, ColorSpace space) {
    const std::pair key(image, space);
    auto known = ranges_.find(key);
    if (known == ranges_.end()) known = ranges_.emplace(key, range_of(scene_.images[index(image)], space)).first;
    return known->second;
}

std::optional<Rgb> Texels::highest(TextureId id) {
    const Texture& texture = scene_.textures[index(id)];
    if (const auto* constant = std::get_if<ConstantTexture>(&texture)) return constant->value;
    if (const auto* checker = std::get_if<CheckerTexture>(&texture)) return larger(checker->even, checker->odd);
    if (const auto* image = std::get_if<ImageTexture>(&texture)) return range(image->image, image->color_space).highest;
    const auto* product = std::get_if<ProductTexture>(&texture);
    if (!product) return std::nullopt;
    const auto is_constant = [&](TextureId t) {
        return std::holds_alternative<ConstantTexture>(scene_.textures[index(t)]);
    };
    const auto first = highest(product->first), second = highest(product->second);
    if (!first || !second || !(is_constant(product->first) || is_constant(product->second))) return std::nullopt;
    return *first * *second;
}

}  // namespace steradian::lint_detail
