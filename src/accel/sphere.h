// Ray against sphere, in double.
#pragma once

#include <cmath>

#include "accel/accel.h"
#include "accel/box.h"

namespace steradian {

struct SphereCandidates {
    int count = 0;
    float t[2];  ///< ascending, rounded once; may be infinite
};

/// Both points where the line through the ray meets the sphere; once where they are the same float. Never for radius 0.
///
/// The discriminant is r² - |l|² with l the vector from the centre to the line's nearest point, which keeps its digits
/// for small spheres far away (Haines et al. 2019, "Precision Improvements for Ray/Sphere Intersection"); the two roots
/// come from one without cancellation.
inline SphereCandidates intersect_sphere(const Ray& ray, const SphereGeometry& sphere) {
    SphereCandidates out;
    const double r = sphere.radius;
    if (!(r > 0)) return out;
    const Vec3d d = ray.d, f = Vec3d(ray.o) - Vec3d(sphere.center);
    const double a = dot(d, d), b = -dot(f, d);
    const Vec3d l = f + d * (b / a);
    const double discriminant = r * r - dot(l, l);
    if (!(discriminant >= 0)) return out;
    const double root = std::sqrt(a * discriminant);
    const double q = b < 0 ? b - root : b + root;
    const double far = q / a;
    const double near = q == 0 ? 0 : (dot(f, f) - r * r) / q;
    out.t[0] = static_cast<float>(near < far ? near : far);
    out.t[1] = static_cast<float>(near < far ? far : near);
    out.count = out.t[0] == out.t[1] ? 1 : 2;
    return out;
}

/// Contains every point of the exact sphere.
inline Box sphere_bounds(const SphereGeometry& sphere) {
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
        const double c = sphere.center[axis], r = sphere.radius;
        box.lo[axis] = r > 0 ? below(c - r) : sphere.center[axis];
        box.hi[axis] = r > 0 ? above(c + r) : sphere.center[axis];
    }
    return box;
}

}  // namespace steradian
