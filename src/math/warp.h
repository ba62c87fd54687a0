// From uniform numbers to points on disks, spheres and triangles; each with its density. Inputs are in [0, 1) on the
// samplers' grid of 2^-24; each stands for the middle of its cell, so that no warp ever sees 0 or 1 and all are
// symmetric. The warps preserve areas and are continuous: well spread numbers give well spread points.
#pragma once

#include "math/elementary.h"
#include "math/vector.h"

namespace steradian::warp {

constexpr double cell_middle(float u) { return static_cast<double>(u) + 0x1p-25; }

struct DiskPoint {
    double x = 0, y = 0;
    double radius = 0;  ///< √(x² + y²), not computed from them
};

/// Uniform on the unit disk: squares become rings (Shirley & Chiu 1997, in the form without case distinction by Cline).
inline DiskPoint disk(Vec2 u) {
    const double a = 2 * cell_middle(u.x) - 1;
    const double b = 2 * cell_middle(u.y) - 1;
    const bool wide = std::fabs(a) > std::fabs(b);
    const double r = wide ? a : b;
    const double angle = wide ? std::numbers::pi / 4 * (b / a) : std::numbers::pi / 2 - std::numbers::pi / 4 * (a / b);
    const math::SinCos at = math::sin_cos(angle);
    return {r * at.cos, r * at.sin, std::fabs(r)};
}
/// Uniform on the regular polygon with its corners on the unit circle, the first one at (1, 0): the disk, with its
/// circles pushed to polygons. The angle becomes a place on the outline, so areas keep their ratio and all is
/// continuous. The density is 2 / (n sin(2π / n)) per area.
inline DiskPoint polygon(Vec2 u, uint32_t corners) {
    const double a = 2 * cell_middle(u.x) - 1;
    const double b = 2 * cell_middle(u.y) - 1;
    const bool wide = std::fabs(a) > std::fabs(b);
    const double eighth = wide ? b / a : 2 - a / b;  // of a turn, from (1, 0) or from (-1, 0)
    const bool opposite = (wide ? a : b) < 0;
    double turn = eighth / 8 + (opposite ? 0.5 : 0);
    if (turn < 0) turn += 1;
    const double along = turn * corners, first = std::floor(along), t = along - first;
    const double step = 2 * std::numbers::pi / corners;
    const double r = std::fabs(wide ? a : b);
    const double x = (1 - t) * math::cos(first * step) + t * math::cos((first + 1) * step);
    const double y = (1 - t) * math::sin(first * step) + t * math::sin((first + 1) * step);
    return {r * x, r * y, r * std::sqrt(x * x + y * y)};
}
/// Per area.
inline constexpr double kDiskPdf = 1 / std::numbers::pi;

/// About +z with density cos θ / π per solid angle: the disk lifted onto the hemisphere (Malley).
inline Vec3d cosine_hemisphere(Vec2 u) {
    const DiskPoint d = disk(u);
    return {d.x, d.y, std::sqrt((1 - d.radius) * (1 + d.radius))};
}
constexpr double cosine_hemisphere_pdf(double cos_theta) { return cos_theta > 0 ? cos_theta / std::numbers::pi : 0; }

/// 1 - cos of an angle of at most 90 degrees from its squared sine in [0, 1], without cancellation.
inline double one_minus_cos(double squared_sine) { return squared_sine / (1 + std::sqrt(1 - squared_sine)); }

/// Uniform within the cone about +z whose half angle θ is given by 1 - cos θ in (0, 2]: exact for the narrowest cones,
/// where cos θ itself would round to 1. The area of a cap about the pole is proportional to 1 - z (Archimedes), so the
/// disk is lifted by 1 - z = r² (1 - cos θ).
inline Vec3d cone(Vec2 u, double one_minus_cos_theta) {
    const DiskPoint d = disk(u);
    const double below_pole = d.radius * d.radius * one_minus_cos_theta;
    const double spread = std::sqrt(one_minus_cos_theta * (2 - below_pole));
    return {d.x * spread, d.y * spread, 1 - below_pole};
}
constexpr double cone_pdf(double one_minus_cos_theta) { return 1 / (2 * std::numbers::pi * one_minus_cos_theta); }

/// Uniform on the hemisphere about +z.
inline Vec3d hemisphere(Vec2 u) { return cone(u, 1); }
inline constexpr double kHemispherePdf = 1 / (2 * std::numbers::pi);

/// Uniform on the unit sphere.
inline Vec3d sphere(Vec2 u) { return cone(u, 2); }
inline constexpr double kSpherePdf = 1 / (4 * std::numbers::pi);

/// The weights of a triangle's second and third vertex; the first has 1 - b1 - b2.
struct TrianglePoint {
    double b1 = 0, b2 = 0;
};

/// Uniform on the triangle (Heitz 2019, "A Low-Distortion Map Between Triangle and Square"): each half of the square on
/// either side of its diagonal is pushed to one half of the triangle. The density is 1 / area.
inline TrianglePoint triangle(Vec2 u) {
    const double x = cell_middle(u.x), y = cell_middle(u.y);
    return y > x ? TrianglePoint{x / 2, y - x / 2} : TrianglePoint{x - y / 2, y / 2};
}

}  // namespace steradian::warp
