// Microfacets with the distribution of Trowbridge and Reitz (GGX), elongated along x and y, and Smith's masking with
// correlated heights. Directions are in the frame of the surface: z is its normal, x and y are the axes of the
// roughness.
//
// All formulas come from one observation (Heitz 2014, section 5; Dupuy & Benyoub 2023): scaled by (αx, αy, 1), the
// surface is one of hemispheres, α = 1. With t(w) = |(αx x, αy y, z)| and the cosine in that space, c = z / t:
//   masking of one direction      G1(w) = 2c / (1 + c)
//   of two, correlated heights    G2(o, i) = 2 c_o c_i / (c_o + c_i)
#pragma once

#include "math/warp.h"

namespace steradian {

struct Ggx {
    double ax = 1, ay = 1;  ///< α along x and y, both > 0

    /// |(αx x, αy y, z)|
    double stretched_length(Vec3d w) const {
        const double x = ax * w.x, y = ay * w.y;
        return std::sqrt(x * x + y * y + w.z * w.z);
    }

    /// The density D of microfacet normals h per solid angle and projected area, ∫ D(h) h.z dh = 1.
    double density(Vec3d h) const {
        const double x = h.x / ax, y = h.y / ay, s = x * x + y * y + h.z * h.z;
        return 1 / (std::numbers::pi * ax * ay * s * s);
    }

    /// G2 / |o.z|, finite at grazing incidence; signs of z do not matter.
    double masking_over_cosine(Vec3d o, Vec3d i) const {
        const double to = stretched_length(o), ci = std::fabs(i.z) / stretched_length(i);
        return 2 * ci / (std::fabs(o.z) + to * ci);
    }

    /// The density of the normals that are seen from o (o.z >= 0) over (o · h) D(h): G1(o) / o.z.
    double visible_over_projected(Vec3d o) const { return 2 / (stretched_length(o) + o.z); }

    /// A normal with the density visible_over_projected(o) (o · h) D(h) per solid angle, by the cap of directions that
    /// a mirroring sphere reflects into o (Dupuy & Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps",
    /// listing 1).
    Vec3d sample_visible(Vec3d o, Vec2 u) const {
        const Vec3d stretched = normalize(Vec3d{ax * o.x, ay * o.y, o.z});
        const Vec3d cap = warp::cone(u, 1 + stretched.z);
        const Vec3d h = cap + stretched;
        return normalize(Vec3d{ax * h.x, ay * h.y, h.z});
    }
};

}  // namespace steradian
