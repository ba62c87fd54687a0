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

/// What the texels of an image, or some of many, are as normals: 2 rgb - 1.
struct NormalTexels {
    uint64_t looked_at = 0;
    uint64_t roughly_unit = 0;  ///< of length 1 within 25 %
    uint64_t unit = 0;          ///< of length 1 within 6 %, and not into the surface
    uint64_t unit_decoded = 0;  ///< likewise, if the numbers were sRGB
    uint64_t inwards = 0;
    bool varied = false;  ///< not all the same
    Vec3 mean, mean_decoded;

    /// Nothing else has only unit vectors, which are about +z in the mean.
    bool normal_map() const { return varied && almost_all(unit) && upright(mean); }
    bool decoded() const { return almost_all(unit_decoded) && upright(mean_decoded); }

private:
    bool almost_all(uint64_t n) const { return 100 * n >= 95 * looked_at; }
    static bool upright(Vec3 n) { return n.z > 0.7f && flat(n.x) && flat(n.y); }
    static bool flat(float x) { return x > -0.25f && x < 0.25f; }
};
/// Of the numbers as they are stored, whatever is said of their colour space.
NormalTexels normal_texels(const RawImage& image);

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
