// What a rough surface keeps of the light after one bounce between its microfacets, as tables that are computed when a
// scene is made. What is missing is what bounced more than once; the lobes add it again (Kulla & Conty 2017,
// "Revisiting Physically Based Shading at Imageworks").
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "shading/ggx.h"
#include "steradian/scene.h"

namespace steradian {

/// A roughness below this, other than 0 on both axes, counts as this: narrower highlights are lost in the rounding of
/// directions to float.
inline constexpr float kMinAlpha = 1e-4f;

/// A surface's microfacets at one point. Perfectly smooth when both are 0.
struct Microfacets {
    float alpha_x = 0, alpha_y = 0;
    float level = 1;  ///< in [0, 1]: the square root of α over the material's own, which the texture multiplies

    bool smooth() const { return alpha_x == 0 && alpha_y == 0; }
    Ggx ggx() const { return {alpha_x, alpha_y}; }
};

/// The roughness where its texture, if it has one, is `texture`.
Microfacets microfacets(const Roughness& roughness, float texture) noexcept;

/// For one material: over the direction, and where the roughness is a texture, over its values.
class MicrofacetEnergy {
public:
    /// Facets that reflect everything.
    static std::shared_ptr<const MicrofacetEnergy> reflecting(const Roughness& roughness);

    /// The part of the light from w (unit, w.z >= 0) that does not leave after one bounce. Within about 1e-4.
    double loss(const Microfacets& m, Vec3d w) const noexcept;
    /// Its mean over the hemisphere, weighted by the cosine.
    double mean_loss(const Microfacets& m) const noexcept;

private:
    explicit MicrofacetEnergy(const Roughness& roughness);
    template <class Albedo>
    void fill(const Roughness& roughness, const Albedo& albedo);
    Microfacets at_level(const Roughness& roughness, int level) const;

    // Axes: level, azimuth, polar angle. An axis with a single entry is constant.
    int levels_ = 1, azimuths_ = 1;
    std::vector<float> loss_;  ///< [level][azimuth][polar]
    std::vector<float> mean_;  ///< [level]
};

/// How the light that bounces between facets is sampled: uniform in azimuth, and in the cosine μ like μ / (μ² + α²),
/// which is how the loss behaves times μ: near grazing incidence it is large, from there it falls like 1 / μ².
struct WideLobe {
    double alpha2, log_range;
    explicit WideLobe(const Microfacets& m);
    Vec3d sample(Vec2 u) const;
    /// Per solid angle, over the upper hemisphere.
    double pdf(double cosine) const;
};

}  // namespace steradian
