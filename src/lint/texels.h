// What the texels of an image come to.
#pragma once

#include <map>
#include <optional>
#include <utility>

#include "steradian/scene.h"

namespace steradian::lint_detail {

struct TexelRange {
    Rgb lowest, highest;
    /// Nothing between 0 and 1 in any colour channel of any texel: it does not matter whether they are read as sRGB.
    bool black_and_white = true;
    uint64_t not_finite = 0;
};

/// Linear values of a whole image, computed when first asked for.
class Texels {
public:
    explicit Texels(const Scene& scene) : scene_(scene) {}
    const TexelRange& range(ImageId image, ColorSpace space);
    /// The largest value of each channel, where it is known for sure: not of vertices' colours, and of a product where
    /// one of the two is constant.
    std::optional<Rgb> highest(TextureId texture);

private:
    const Scene& scene_;
    std::map<std::pair<ImageId, ColorSpace>, TexelRange> ranges_;
};

}  // namespace steradian::lint_detail
