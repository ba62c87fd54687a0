// One wavelength for a path, and the colour it stands for.
#pragma once

#include <array>
#include <cstdint>

#include "math/vector.h"

namespace steradian {

/// Micrometres. Beyond lies less than a hundredth of each curve, and the tails of their fits have wrong hues.
inline constexpr double kShortestSample = 0.39, kLongestSample = 0.68;

struct WavelengthSample {
    float wavelength = 0;  ///< micrometres
    Rgb weight;            ///< w / p: of light of all wavelengths this one stands for; not negative, at most 3
};

/// What red, green and blue get of light of one wavelength: curves w(λ) ≥ 0, each of which integrates to 1, so that
/// white light that is taken apart and put together is white. They are what the responses of linear Rec. 709
/// (spectrum.h) have above 0, over their integrals. The density of the wavelengths is the mean of the three, p = (w_r +
/// w_g + w_b) / 3: the three channels of every weight sum to 3. docs/decisions/0018 has the reasons.
///
/// Everything is linear between nodes one nanometre apart, sampled by inverting the integral.
class WavelengthSampler {
public:
    WavelengthSampler();
    /// `bits` are 32 uniform ones. Ascending bits are ascending wavelengths.
    WavelengthSample sample(uint32_t bits) const noexcept;
    /// w and p at a wavelength in micrometres, per micrometre; 0 beyond the spectrum.
    Vec3d response(double wavelength) const noexcept;
    double pdf(double wavelength) const noexcept;

private:
    static constexpr size_t kCells = 290;
    std::array<Vec3d, kCells + 1> response_;
    std::array<double, kCells + 1> pdf_, below_;  ///< below_: the integral of p up to a node
};

}  // namespace steradian
