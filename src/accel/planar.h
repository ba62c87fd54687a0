// Ray against rectangle (any parallelogram) and disk (any ellipse), in double.
#pragma once

#include <cmath>

#include "accel/accel.h"
#include "accel/box.h"

namespace steradian {

struct PlanarCandidate {
    float t;     ///< rounded once; may be infinite
    float a, b;  ///< in [-1, 1]
};

namespace detail {

struct PlanarPoint {
    double t, a, b;
};

/// Solves o + t d = center + a u + b v by Cramer's rule. False when the ray runs along the plane or u and v span none:
/// products of floats are exact in double, so u × v of parallel axes is 0 exactly.
inline bool intersect_plane(const Ray& ray, Vec3 center, Vec3 u_axis, Vec3 v_axis, PlanarPoint& out) {
    const Vec3d d = ray.d, u = u_axis, v = v_axis, s = Vec3d(ray.o) - Vec3d(center);
    const Vec3d n = cross(u, v);
    const double denominator = dot(d, n);
    if (denominator == 0) return false;
    out.t = -dot(s, n) / denominator;
    out.a = dot(d, cross(s, v)) / denominator;
    out.b = dot(d, cross(u, s)) / denominator;
    return true;
}

/// Contains center ± extent; exactly flat where the extent is 0.
inline Box planar_bounds(Vec3 center, const double extent[3]) {
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
        const double c = center[axis], e = extent[axis];
        box.lo[axis] = e > 0 ? below(c - e) : center[axis];
        box.hi[axis] = e > 0 ? above(c + e) : center[axis];
    }
    return box;
}

}  // namespace detail

/// The edge counts; both sides do. Never for a rectangle without area.
inline bool intersect_rectangle(const Ray& ray, const RectangleGeometry& r, PlanarCandidate& out) {
    detail::PlanarPoint p;
    if (!detail::intersect_plane(ray, r.center, r.half_u, r.half_v, p)) return false;
    if (!(std::fabs(p.a) <= 1 && std::fabs(p.b) <= 1)) return false;
    out = {static_cast<float>(p.t), static_cast<float>(p.a), static_cast<float>(p.b)};
    return true;
}

/// The edge counts; both sides do. Never for a disk without area.
inline bool intersect_disk(const Ray& ray, const DiskGeometry& disk, PlanarCandidate& out) {
    detail::PlanarPoint p;
    if (!detail::intersect_plane(ray, disk.center, disk.axis_u, disk.axis_v, p)) return false;
    if (!(p.a * p.a + p.b * p.b <= 1)) return false;
    out = {static_cast<float>(p.t), static_cast<float>(p.a), static_cast<float>(p.b)};
    return true;
}

inline Box rectangle_bounds(const RectangleGeometry& r) {
    double extent[3];
    for (int axis = 0; axis < 3; ++axis)
        extent[axis] = std::fabs(double(r.half_u[axis])) + std::fabs(double(r.half_v[axis]));
    return detail::planar_bounds(r.center, extent);
}

inline Box disk_bounds(const DiskGeometry& disk) {
    double extent[3];
    for (int axis = 0; axis < 3; ++axis) {
        const double u = disk.axis_u[axis], v = disk.axis_v[axis];
        extent[axis] = std::sqrt(u * u + v * v);
    }
    return detail::planar_bounds(disk.center, extent);
}

}  // namespace steradian
