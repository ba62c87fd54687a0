// How a medium scatters: the phase function of Henyey and Greenstein 1941, "Diffuse Radiation in the Galaxy". It stands
// for a Bsdf at points where there is no surface: f · |cos| is the phase function, and its directions have its density.
#pragma once

#include "math/elementary.h"
#include "math/warp.h"
#include "shading/bsdf/lobe.h"

namespace steradian {

/// Per solid angle, at the cosine between the directions of travel before and after.
inline double henyey_greenstein(double g, double cosine) {
    const double d = 1 + g * g - 2 * g * cosine;
    return (1 - g * g) / (4 * std::numbers::pi * d * std::sqrt(d));
}

/// The cosine below which lies the part 1 - u of the function's integral.
inline double sample_henyey_greenstein(double g, double u) {
    const double s = 1 - 2 * u;
    if (std::fabs(g) < 1e-4) return s + 1.5 * g * (1 - s) * (1 + s);  // and g², which is nothing
    const double q = (1 - g * g) / (1 + g * s);
    return clamp_to((1 + g * g - q * q) / (2 * g), -1.0, 1.0);
}

inline bool lobe_is_specular(const PhaseBsdf&) { return false; }

inline BsdfEval eval_lobe(const PhaseBsdf& lobe, const LobeGeometry&, Vec3 wo, Vec3 wi) {
    const auto p = static_cast<float>(henyey_greenstein(lobe.anisotropy, -dot(Vec3d(wo), Vec3d(wi))));
    return {{p, p, p}, p, {p, p, p}};
}

inline std::optional<BsdfSample> sample_lobe(const PhaseBsdf& lobe, const LobeGeometry& g, Vec3 wo, float, Vec2 u) {
    const warp::DiskPoint d = warp::disk(u);
    const double cosine = sample_henyey_greenstein(lobe.anisotropy, d.radius * d.radius);
    const double sine = std::sqrt((1 - cosine) * (1 + cosine)), spread = d.radius > 0 ? sine / d.radius : 0;
    const Frame3d onward = Frame3d::from_z(-Vec3d(wo));
    const Vec3 wi = static_cast<Vec3>(normalize(onward.to_world({d.x * spread, d.y * spread, cosine})));
    return BsdfSample{wi, {1, 1, 1}, eval_lobe(lobe, g, wo, wi).pdf};
}

}  // namespace steradian
