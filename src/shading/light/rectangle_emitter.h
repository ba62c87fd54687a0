// Rectangles are sampled uniformly over the solid angle they fill: Ureña, Fajardo & King 2013, "An Area-Preserving
// Parametrization for Spherical Rectangles".
#pragma once

#include <optional>

#include "math/warp.h"
#include "shading/light/emitter.h"

namespace steradian {

/// Below this the solid angle, a difference of angles in double, has fewer than about 9 digits left; area sampling,
/// which is good for small solid angles, takes over. Steradians.
inline constexpr double kSmallestSphericalRectangle = 1e-6;

/// The rectangle seen from a point, in a frame whose axes are its sides and whose z points away from it.
struct SphericalRectangle {
    double x0, y0, z0, x1, y1;  ///< z0 <= 0
    double f00, f01, f10, f11;  ///< signed solid angles of the quarter planes up to a corner, minus constants
    double solid_angle;

    SphericalRectangle(const RectangleEmitter& r, Vec3d from) {
        const double length_u = length(r.half_u), length_v = length(r.half_v);
        const Vec3d d = r.center - from;
        const double x = dot(d, r.half_u) / length_u, y = dot(d, r.half_v) / length_v;
        x0 = x - length_u, x1 = x + length_u;
        y0 = y - length_v, y1 = y + length_v;
        z0 = -std::fabs(dot(d, r.normal));
        f00 = corner(x0, y0), f01 = corner(x0, y1), f10 = corner(x1, y0), f11 = corner(x1, y1);
        solid_angle = (f11 - f01) - (f10 - f00);
    }

    /// The angle asin(x y / (√(x²+z²) √(y²+z²))), in a form that keeps its digits everywhere. The inner angles of the
    /// spherical rectangle (the paper's γ) are π/2 plus or minus this at its corners.
    double corner(double x, double y) const { return math::atan2(x * y, -z0 * std::sqrt(x * x + y * y + z0 * z0)); }

    /// Position on the rectangle, each coordinate in [-1, 1].
    warp::DiskPoint position(Vec2 u) const {
        // Equations (6) to (9) of the paper.
        const double b0 = -y0 / std::sqrt(y0 * y0 + z0 * z0), b1 = y1 / std::sqrt(y1 * y1 + z0 * z0);
        const double k = std::numbers::pi + f01 - f00;
        const double angle = warp::cell_middle(u.x) * solid_angle + k;
        const math::SinCos at = math::sin_cos(angle);
        const double fu = (at.cos * b0 - b1) / at.sin;
        const double cu = clamp_to(std::copysign(1 / std::sqrt(fu * fu + b0 * b0), fu), -1.0, 1.0);
        const double xu = clamp_to(-(cu * z0) / std::sqrt(max_of((1 - cu) * (1 + cu), 1e-300)), x0, x1);
        // And (10) for the other coordinate.
        const double d2 = xu * xu + z0 * z0;
        const double h0 = y0 / std::sqrt(d2 + y0 * y0), h1 = y1 / std::sqrt(d2 + y1 * y1);
        const double h = h0 + warp::cell_middle(u.y) * (h1 - h0);
        const double yv = clamp_to(h * std::sqrt(d2 / max_of((1 - h) * (1 + h), 1e-300)), y0, y1);
        return {2 * (xu - x0) / (x1 - x0) - 1, 2 * (yv - y0) / (y1 - y0) - 1, 0};
    }
};

inline double emitter_pdf(const RectangleEmitter& r, const EmitterContext&, Vec3d from, Vec3d p, Vec3d) {
    if (r.right_angled) {
        const SphericalRectangle seen(r, from);
        if (seen.solid_angle >= kSmallestSphericalRectangle) return 1 / seen.solid_angle;
    }
    return solid_angle_pdf(1 / r.area, p - from, r.normal);
}

inline std::optional<EmitterSample> sample_emitter(const RectangleEmitter& r, const EmitterContext& context, Vec3d from,
                                                   uint32_t, Vec2 u) {
    if (!emits_towards(r.center, r.normal, from, context.two_sided)) return std::nullopt;
    EmitterSample out;
    out.n = r.normal;
    out.p_error = r.p_error;
    if (r.right_angled) {
        const SphericalRectangle seen(r, from);
        if (seen.solid_angle >= kSmallestSphericalRectangle) {
            const warp::DiskPoint at = seen.position(u);
            out.p = r.center + r.half_u * at.x + r.half_v * at.y;
            out.u = static_cast<float>(at.x), out.v = static_cast<float>(at.y);
            out.pdf = 1 / seen.solid_angle;
            return out;
        }
    }
    const double a = 2 * warp::cell_middle(u.x) - 1, b = 2 * warp::cell_middle(u.y) - 1;
    out.p = r.center + r.half_u * a + r.half_v * b;
    out.u = static_cast<float>(a), out.v = static_cast<float>(b);
    out.pdf = solid_angle_pdf(1 / r.area, out.p - from, r.normal);
    return out;
}

}  // namespace steradian
