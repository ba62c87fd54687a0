// From uniform numbers to points on disks, hemispheres, spheres and triangles. Inputs are in [0, 1) on the samplers'
// grid of 2^-24; each stands for the middle of its cell, so no warp ever sees 0 or 1.
#pragma once

#include "math/elementary.h"
#include "math/vector.h"

namespace steradian {

inline double cell_middle(float u) { return static_cast<double>(u) + 0x1p-25; }

/// An orthonormal basis in double, as Frame is in float (Duff et al. 2017).
struct Frame3d {
    Vec3d x, y, z;

    static Frame3d from_z(Vec3d n) {
        const double sign = std::copysign(1.0, n.z);
        const double a = -1 / (sign + n.z);
        const double b = n.x * n.y * a;
        return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
    }
    Vec3d to_world(Vec3d v) const { return x * v.x + y * v.y + z * v.z; }
};

struct DiskPoint {
    double x = 0, y = 0;
    double radius = 0;
};

/// Uniform on the unit disk, keeping neighbours together (Shirley & Chiu 1997).
inline DiskPoint warp_disk(Vec2 u) {
    const double a = 2 * cell_middle(u.x) - 1;
    const double b = 2 * cell_middle(u.y) - 1;
    const bool wide = std::fabs(a) > std::fabs(b);
    const double r = wide ? a : b;
    const double quarter = std::numbers::pi / 4;
    const double angle = wide ? quarter * (b / a) : 2 * quarter - quarter * (a / b);
    return {r * math::cos(angle), r * math::sin(angle), std::fabs(r)};
}

/// Density cos θ / π about +z.
inline Vec3d warp_cosine_hemisphere(Vec2 u) {
    const DiskPoint d = warp_disk(u);
    return {d.x, d.y, std::sqrt((1 - d.radius) * (1 + d.radius))};
}

/// Density 1 / 4π.
inline Vec3d warp_sphere(Vec2 u) {
    const double z = 1 - 2 * cell_middle(u.x);
    const double r = std::sqrt((1 - z) * (1 + z));
    const double phi = 2 * std::numbers::pi * cell_middle(u.y);
    return {r * math::cos(phi), r * math::sin(phi), z};
}

/// Uniform on a triangle: the weights of the second and third vertex.
struct TrianglePoint {
    double b1 = 0, b2 = 0;
};
inline TrianglePoint warp_triangle(Vec2 u) {
    const double s = std::sqrt(cell_middle(u.x));
    return {s * (1 - cell_middle(u.y)), s * cell_middle(u.y)};
}

}  // namespace steradian
