// How the index of refraction of glass depends on the wavelength.
#pragma once

#include "shading/microfacet_energy.h"
#include "shading/wavelength_sampler.h"

namespace steradian {

/// Fraunhofer's lines F, d and C in micrometres, as OpenPBR Surface 1.1 has them.
inline constexpr double kLineF = 0.48613, kLineD = 0.58756, kLineC = 0.65627;

/// Cauchy's formula with two terms, n(λ) = A + B / λ², by the index at line d and the Abbe number V = (n_d - 1) / (n_F
/// - n_C), at least 1 (OpenPBR Surface 1.1, section "Dispersion"). An index below 1 is that of a bubble in such a
/// glass: the glass disperses, and the index is 1 / n(λ). What is within 3e-3 of 1 does not disperse.
class GlassIndex {
public:
    GlassIndex() = default;
    /// `abbe` 0 or infinite: the index is eta everywhere.
    GlassIndex(float eta, double abbe) : eta_(eta) {
        const double n = eta < 1 ? 1 / static_cast<double>(eta) : static_cast<double>(eta);
        if (!(abbe > 0) || n - 1 < 3e-3) return;
        constexpr double kSpan = 1 / (kLineF * kLineF) - 1 / (kLineC * kLineC);
        excess_ = n - 1;
        b_ = excess_ / (abbe * kSpan);
    }

    bool disperses() const { return b_ > 0; }
    /// Of all wavelengths that are sampled.
    IndexRange range() const {
        if (!disperses()) return {static_cast<double>(eta_), static_cast<double>(eta_)};
        return {static_cast<double>(at(kLongestSample)), static_cast<double>(at(kShortestSample))};
    }
    /// Inside over outside, at a wavelength in micrometres; at line d where that is 0.
    float at(double wavelength) const {
        if (!disperses() || wavelength == 0) return eta_;
        constexpr double kAtD = 1 / (kLineD * kLineD);
        const double n = 1 + excess_ + b_ * (1 / (wavelength * wavelength) - kAtD);
        return static_cast<float>(eta_ < 1 ? 1 / n : n);
    }

private:
    float eta_ = 1.5f;
    double excess_ = 0, b_ = 0;  ///< n_d - 1 and B, in square micrometres, of the denser side
};

}  // namespace steradian
