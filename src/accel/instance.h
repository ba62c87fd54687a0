// Geometry placed in the world, and what the t of a hit is by definition.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "accel/box.h"
#include "math/transform.h"

namespace steradian {

/// The t of a candidate that a primitive's test accepted, or false when it is rejected after all.
///
/// A computed t may lie outside the primitive's box, and a hit in an instance outside the instance's world box, because
/// rays are rounded on their way into its space. Traversal knows boxes only, so the definition of a hit takes them in:
/// t is clamped into the interval of the primitive's own box (in the space of the geometry), then into that of the
/// instance's world box (along the world ray), and a candidate whose box the ray misses is none. Since an inner box's
/// interval lies within an outer one's (box.h), every node of the upper level on the way to the primitive has t_in <= t
/// <= t_out, and no traversal that skips nodes for t_in > best t or t_out < tmin can lose it. Within an instance the
/// same holds for t before the second clamp, which is monotone: there nodes may be skipped for t_in > best t only while
/// best t < world.out, and for t_out < tmin only while tmin > world.in (set_range in the kernels).
inline bool settle(float t, Interval own, Interval world, float& out) {
    if (own.empty() || world.empty()) return false;
    // + 0 turns -0 into 0: two ways to write one time.
    out = world.clamp(own.clamp(t)) + 0.0f;
    return out < kInfinity;
}

/// An instance as the kernels need it.
struct PlacedGeometry {
    uint32_t geometry = 0;
    bool identity = true;
    Affine object_from_world;
    Box world;  ///< contains every exact world point of the geometry

    /// The ray in the geometry's space, canonical. False when it can hit nothing there, which happens when the
    /// direction leaves the range of float.
    bool to_object(const Ray& world_ray, Ray& object_ray) const {
        const Vec3d o = transform_point(object_from_world, world_ray.o);
        const Vec3d d = transform_vector(object_from_world, world_ray.d);
        return canonical({Vec3(o), world_ray.tmin, Vec3(d), world_ray.tmax}, object_ray);
    }
};

/// Bounds of the transformed box. The double arithmetic is off by at most 4 * 2^-53 of the sum of the magnitudes; below
/// and above add a float, which is far more unless the sum cancels.
inline Box transformed_bounds(const Affine& world_from_object, const Box& box) {
    Box out;
    for (int row = 0; row < 3; ++row) {
        const auto& m = world_from_object.m[row];
        double lo = m[3], hi = m[3], magnitude = std::fabs(m[3]);
        for (int axis = 0; axis < 3; ++axis) {
            const double a = m[axis] * box.lo[axis], b = m[axis] * box.hi[axis];
            lo += a < b ? a : b;
            hi += a < b ? b : a;
            magnitude += std::max(std::fabs(a), std::fabs(b));
        }
        const double error = magnitude * 0x1p-50;
        out.lo[row] = below(lo - error);
        out.hi[row] = above(hi + error);
    }
    return out;
}

/// Nothing when the transform is singular, not finite or scales by more than 1e30 or less than 1e-30, where rays in the
/// geometry's space would leave the range of float.
inline std::optional<PlacedGeometry> place(uint32_t geometry, const Affine& world_from_object, const Box& bounds) {
    PlacedGeometry placed;
    placed.geometry = geometry;
    placed.identity = is_identity(world_from_object);
    placed.world = bounds;
    if (placed.identity) return placed;
    const std::optional<Affine> inverted = usable_inverse(world_from_object);
    if (!inverted) return std::nullopt;
    placed.object_from_world = *inverted;
    if (!bounds.empty()) placed.world = transformed_bounds(world_from_object, bounds);
    return placed;
}

}  // namespace steradian
