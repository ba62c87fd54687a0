#include "lint/texels.h"

#include "base/parallel.h"
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
