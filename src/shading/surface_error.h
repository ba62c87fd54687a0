// What the ray kernels see: rays in the space of an instance, and how far a computed surface point may be from the
// surface that they resolve.
#pragma once

#include "math/ray.h"
#include "math/transform.h"
#include "math/vector.h"
#include "shading/shading_scene.h"

namespace steradian {

/// Rounded up to float; the addend covers results that are rounded to a subnormal number.
inline float round_up(double x) { return static_cast<float>(x * (1 + 0x1p-22)) + 0x1p-149f; }

inline Vec3d abs(Vec3d v) { return {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}; }
inline double max_component(Vec3d v) { return max_of(v.x, max_of(v.y, v.z)); }

/// The bound SurfacePoint::p_error for a point that is p_object in the shape's own space, p_world in the world (both in
/// double), where p_world is then rounded to float. `slack` bounds, in the object's space and per coordinate, the
/// distance between p_object and the surface as the kernel resolves it in double.
///
/// Without a transform that leaves the rounding of p (2^-24 |p|) and the slack. With one, the kernel sees a ray whose
/// origin was brought into the object's space in double and rounded to float there: 2^-24 |p_object|, which is
/// |M| 2^-24 |p_object| in the world. What is done in double (both transforms, and inverse and transform being inverse
/// to each other only up to rounding) is below 2^-45 (|M| |M⁻¹|)² (|p| + |translation|), and that term also holds the
/// errors of second order of the float roundings.
inline Vec3 surface_error(const Affine& world_from_object, const ShadingScene::TransformData& instance, Vec3d p_object,
                          Vec3d p_world, double slack) {
    const Vec3d world = abs(p_world), object = abs(p_object);
    if (instance.identity)
        return {round_up(0x1p-24 * world.x + slack), round_up(0x1p-24 * world.y + slack),
                round_up(0x1p-24 * world.z + slack)};
    const auto& m = world_from_object.m;
    const Vec3d base{world.x + std::fabs(m[0][3]), world.y + std::fabs(m[1][3]), world.z + std::fabs(m[2][3])};
    Vec3 out;
    for (int i = 0; i < 3; ++i) {
        const double* row = &instance.round_trip[static_cast<size_t>(3 * i)];
        double e = 0x1p-24 * world[i] + 0x1p-45 * (row[0] * base.x + row[1] * base.y + row[2] * base.z);
        for (int j = 0; j < 3; ++j)
            e += std::fabs(m[static_cast<size_t>(i)][static_cast<size_t>(j)]) * (0x1p-24 * object[j] + slack);
        out[i] = round_up(e);
    }
    return out;
}

/// The slack of a flat shape of diameter `size`, of which the vertices are as far from the origin as `reach`, and whose
/// cross product of spanning vectors (each at most `size` long) has the given length: double rounding of the point
/// itself, and of the kernel's distance along the normal, which thin shapes magnify by size² / cross.
inline double flat_slack(double size, double reach, double cross) {
    const double magnified = size * (size * size / cross);
    return 0x1p-50 * reach + 0x1p-47 * min_of(magnified, size * 0x1p40);
}

/// A ray in an instance's space: transformed in double and rounded to float once, unless the transform is the identity.
struct LocalRay {
    Vec3d o, d;
};
inline LocalRay local_ray(const ShadingScene::TransformData& instance, const Ray& ray) {
    if (instance.identity) return {ray.o, ray.d};
    return {static_cast<Vec3>(transform_point(instance.object_from_world, ray.o)),
            static_cast<Vec3>(transform_vector(instance.object_from_world, ray.d))};
}

/// The slack of a sphere.
inline double sphere_slack(double radius, double reach) { return 0x1p-50 * reach + 0x1p-47 * radius; }

}  // namespace steradian
