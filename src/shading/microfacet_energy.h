// What a rough surface keeps of the light after one bounce between its microfacets, as tables that are computed when a
// scene is made. What is missing is what bounced more than once; the lobes add it again (Kulla & Conty 2017,
// "Revisiting Physically Based Shading at Imageworks").
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
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
    /// Where tables are over the grain as well: α across over α along, at most 1; `level` is then the root of α along.
    float across = 1;

    bool smooth() const { return alpha_x == 0 && alpha_y == 0; }
    Ggx ggx() const { return {alpha_x, alpha_y}; }
};

/// The roughness where its texture, if it has one, is `texture`.
Microfacets microfacets(const Roughness& roughness, float texture) noexcept;

/// Of a dielectric, inside over outside; both ends are the same where the index does not depend on the wavelength.
struct IndexRange {
    double first = 1.5, last = 1.5;
    /// Where an index lies: 0 … 1.
    float place(double eta) const {
        return first == last ? 0.0f : static_cast<float>(clamp_to((eta - first) / (last - first), 0.0, 1.0));
    }
};

enum class Side : uint8_t { outside, inside };  ///< of a dielectric; metals have the first only

/// What roughnesses tables are made for: one, all that a texture makes of it, or any along and across.
struct TabulatedRoughness : Roughness {
    TabulatedRoughness(const Roughness& of) : Roughness(of) {}
    static TabulatedRoughness every_grain() {
        TabulatedRoughness out{Roughness{{1, 1}, true, TextureId{}}};
        out.grains = true;
        return out;
    }
    bool grains = false;
};

/// Unit vectors in the surface along the middles of `parts` equal parts of the azimuths 0 … range, for sums over
/// directions.
std::vector<Vec3d> middle_azimuths(double range, size_t parts);

/// For one material: over the direction, and where the roughness is a texture, over its values.
class MicrofacetEnergy {
public:
    /// Facets that reflect everything.
    static std::shared_ptr<const MicrofacetEnergy> reflecting(const TabulatedRoughness& roughness);
    /// Facets of a dielectric that reflect; what refracts is lost. eta: far over near side, > 1.
    static std::shared_ptr<const MicrofacetEnergy> coating(const TabulatedRoughness& roughness, double eta);
    /// The same by each channel of several tables of reflectances, one after the other: at the cosines (i / (entries -
    /// 1))² to the facet, linear in their roots between them. Has losses() only.
    static std::shared_ptr<const MicrofacetEnergy> coating(const TabulatedRoughness& roughness,
                                                           std::span<const Rgb> tables, size_t entries);
    /// Facets of a dielectric that reflect and refract.
    static std::shared_ptr<const MicrofacetEnergy> transmitting(const TabulatedRoughness& roughness, IndexRange eta);

    /// The part of the light from w (unit, w.z >= 0) that does not leave after one bounce. Within about 1e-4, of
    /// dielectrics from the dense side 4e-3; with a grain of 1 to 16 within 1e-2, and 3e-2 less than 3 degrees above
    /// the surface. `index`: where the index lies in its range, IndexRange::place.
    double loss(const Microfacets& m, Vec3d w, Side side = Side::outside, float index = 0) const noexcept;
    /// Of tables of reflectances from number `first` on, as many as there is room for in `out`.
    void losses(const Microfacets& m, Vec3d w, size_t first, std::span<Vec3d> out) const noexcept;
    /// The mean of loss() over the hemisphere, weighted by the cosine.
    double mean_loss(const Microfacets& m, Side side = Side::outside, float index = 0) const noexcept;

private:
    MicrofacetEnergy(const TabulatedRoughness& roughness, int sides, int indices = 1);
    template <class Albedo>
    void fill(const TabulatedRoughness& roughness, Side side, const Albedo& albedo);
    template <class Albedo>
    void fill_losses(const TabulatedRoughness& roughness, Side side, const Albedo& albedo);
    void fill_losses(const TabulatedRoughness& roughness, std::span<const Rgb> tables, size_t entries);
    template <class Visit>
    void for_each_direction(const TabulatedRoughness& roughness, Side side, const Visit& visit) const;
    void fill_means(const TabulatedRoughness& roughness, Side side, float index);
    /// Of the space that the table of a side is over: along x and y.
    Vec2 stretch(const Microfacets& m, Side side) const;
    struct Stencil;
    Stencil stencil(const Microfacets& m, Vec3d w, Side side) const;
    void add_loss(double& sum, double weight, size_t index, Side side, const Stencil& s) const;
    /// Row of the axes level and grain together.
    Microfacets at_row(const TabulatedRoughness& roughness, int row) const;
    int rows() const { return levels_ * grains_; }
    size_t directions() const { return size_t(rows()) * size_t(azimuths_) * size_t(polar_); }  ///< of a table

    // Axes: index (or channel of a table of reflectances), side, level, grain, azimuth, polar angle. An axis with a
    // single entry is constant.
    int indices_ = 1, sides_ = 1, levels_ = 1, grains_ = 1, azimuths_ = 1, polar_ = 32;
    /// The side that is tabulated over directions as they are: of a dielectric where total reflection begins at one
    /// angle, whatever the roughness. Other sides are in the space in which the roughness is 1 (ggx.h), where the loss
    /// changes at the same place whatever the roughness.
    std::optional<Side> as_they_are_;
    std::vector<float> loss_;  ///< [index][side][level][grain][azimuth][polar]
    std::vector<float> mean_;  ///< [index][side][level][grain]
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
