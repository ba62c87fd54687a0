#include "math/elementary.h"
#include "math/vector.h"
#include "steradian/scene.h"

namespace steradian {

/// Section "Translucent base" of the specification: with μ_t = -ln(color) / depth and μ_s = scatter / depth,
/// μ_a = μ_t - μ_s, less its smallest component where that is negative.
Medium open_pbr_interior(Rgb color, float depth, Rgb scatter, float anisotropy) {
    const auto limited = [](double coefficient) { return min_of(coefficient, kMaxMediumCoefficient); };
    double absorption[3], least = 0;
    Medium out;
    for (int c = 0; c < 3; ++c) {
        const double passes = clamp_to(static_cast<double>(color[c]), 1e-30, 1.0);
        const double scattering = limited(static_cast<double>(scatter[c]) / depth);
        absorption[c] = limited(math::log(1 / passes) / depth) - scattering;
        least = min_of(least, absorption[c]);
        out.scattering[c] = static_cast<float>(scattering);
    }
    for (int c = 0; c < 3; ++c) out.absorption[c] = static_cast<float>(limited(absorption[c] - least));
    out.anisotropy = clamp_to(anisotropy, -kMaxAnisotropy, kMaxAnisotropy);
    return out;
}

}  // namespace steradian
