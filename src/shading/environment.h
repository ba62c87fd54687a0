// The environment's radiance, and a distribution of directions that follows it.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "math/vector.h"
#include "shading/irradiance_share.h"
#include "steradian/result.h"
#include "steradian/scene.h"

namespace steradian {

struct EnvironmentSample {
    Vec3 direction;  ///< unit, world
    double pdf = 0;  ///< per solid angle
};

/// Which density directions are drawn with. `compensated` leaves out what lies below the mean, in favour of what lies
/// above: for multiple importance sampling, where the BSDF finds the rest (Karlík, Šik, Vévoda, Skřivan & Křivánek
/// 2019, "MIS Compensation: Optimizing Sampling Techniques in Multiple Importance Sampling"). It is 0 where there may
/// be light. EnvironmentTable::at_surface() says where that pays.
enum class EnvironmentDensity : uint8_t { complete, compensated };

/// Where a direction lies in the image, from its top left corner, both in [0, 1]; (0, 0) for directions that are not
/// numbers.
struct MapPoint {
    double s = 0, t = 0;
};

/// A latitude-longitude image is interpolated bilinearly between texel centres, wraps around at the sides and is
/// continued at the poles. Directions are drawn by texel, with the probability of the texel's mean luminance times its
/// solid angle, and uniformly within one: so wherever there is radiance there is density, but for the compensated one.
/// Without an image the radiance is constant, and nothing is tabulated.
class EnvironmentTable {
public:
    /// Refers to `light.image` by its id only; the functions below must be given the same scene data.
    /// May throw std::bad_alloc.
    static std::shared_ptr<const EnvironmentTable> make(const Scene& scene, const EnvironmentLight& light,
                                                        Diagnostics& diagnostics);

    bool is_constant() const noexcept { return !image_; }
    /// There is nothing to sample: black everywhere, or not summable.
    bool empty() const noexcept { return empty_; }

    /// Along a ray of direction d (unit).
    Rgb radiance(const Scene& scene, Vec3 d) const noexcept {
        return image_ ? radiance_at(scene, map_point(d)) : scale_;
    }

    // For images that are not empty() only.

    /// The density that suits a surface of normal n (unit; zero: a point in space): `wanted`, but the complete one
    /// where what is above the mean is below the horizon, or nearly, and samples of it would find nothing.
    EnvironmentDensity at_surface(EnvironmentDensity wanted, Vec3 n, bool both_sides) const noexcept;

    /// `choice` refines u below its 24 bits.
    EnvironmentSample sample(uint32_t choice, Vec2 u, EnvironmentDensity density) const noexcept;
    double pdf(Vec3 d, EnvironmentDensity density) const noexcept { return pdf_at(map_point(d), density); }

    // The same for those who ask for both of one direction.
    MapPoint map_point(Vec3 d) const noexcept;
    Rgb radiance_at(const Scene& scene, MapPoint at) const noexcept;
    double pdf_at(MapPoint at, EnvironmentDensity density) const noexcept;

    static constexpr uint64_t kBytesPerTexel = 2 * sizeof(double);

private:
    /// Cumulative masses of the texels.
    struct CellMasses {
        std::vector<double> rows;   ///< over rows, of the last element of each row of cells
        std::vector<double> cells;  ///< within each row

        /// Sums up the rows of `width` cells each; the total.
        double finish(size_t width);
        double row(uint32_t y) const noexcept { return rows[y] - (y > 0 ? rows[y - 1] : 0.0); }
        double cell(uint32_t width, uint32_t x, uint32_t y) const noexcept { return run(width, y, x, x + size_t{1}); }
        /// Of the cells from x0 to before x1 of a row.
        double run(uint32_t width, size_t y, size_t x0, size_t x1) const noexcept {
            const double* at = cells.data() + y * width;
            return at[x1 - 1] - (x0 > 0 ? at[x0 - 1] : 0.0);
        }
    };

    /// Directions of the image turned into the world.
    Vec3d from_map(Vec3d m) const noexcept {
        return {cos_rotation_ * m.x + sin_rotation_ * m.z, m.y, cos_rotation_ * m.z - sin_rotation_ * m.x};
    }
    void tabulate(const RawImage& image);
    void compensate();
    IrradianceShare share_above() const;
    /// Both are the complete ones where nothing is compensated.
    const CellMasses& masses(EnvironmentDensity density) const noexcept {
        return density == EnvironmentDensity::compensated && !compensated_.rows.empty() ? compensated_ : complete_;
    }
    double cell_pdf(const CellMasses& of, uint32_t x, uint32_t y) const noexcept;

    Rgb scale_;
    std::optional<ImageId> image_;
    ColorSpace color_space_ = ColorSpace::linear;
    double cos_rotation_ = 1, sin_rotation_ = 0;
    bool empty_ = false;
    uint32_t width_ = 0, height_ = 0;
    CellMasses complete_, compensated_;
    IrradianceShare above_;          ///< where something is compensated
    std::vector<double> cos_theta_;  ///< at the height_ + 1 borders between rows
};

}  // namespace steradian
