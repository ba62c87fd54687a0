// How much a smooth boundary reflects, unpolarised. Cosines are of the angle to the normal, in [0, 1].
#pragma once

#include "math/vector.h"
#include "steradian/scene.h"

namespace steradian {

inline constexpr float kLeastVisibleIndex = 1.001f;
/// Nearer to 1 refraction is lost in the rounding to float: such a boundary is smooth whatever its roughness.
inline bool refracts_visibly(float eta) { return std::fabs(eta - 1) >= 1e-3f; }

/// Of a dielectric; cos_i on the incident side, eta = transmitted over incident index. 1 for total internal reflection.
double fresnel_dielectric(double cos_i, double eta) noexcept;
inline float fresnel_dielectric(float cos_i, float eta) noexcept {
    return static_cast<float>(fresnel_dielectric(static_cast<double>(cos_i), static_cast<double>(eta)));
}

/// Of a metal with the index n + ik over that of the incident medium.
double fresnel_conductor(double cos_i, double n, double k) noexcept;
Rgb fresnel_conductor(double cos_i, const ComplexIndex& index) noexcept;

/// Schlick 1994, "An Inexpensive BRDF Model for Physically-Based Rendering", equation 24: from `normal` at normal
/// incidence to `grazing` at 90 degrees.
Rgb fresnel_schlick(double cos_i, Rgb normal, Rgb grazing) noexcept;

/// The cosine-weighted mean over the hemisphere, 2 ∫ F(μ) μ dμ.
Rgb mean_fresnel_conductor(const ComplexIndex& index) noexcept;
Rgb mean_fresnel_schlick(Rgb normal, Rgb grazing) noexcept;

}  // namespace steradian
