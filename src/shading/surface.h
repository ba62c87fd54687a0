// From a hit's ids to what shading needs to know about the point, and from there to new rays.
#pragma once

#include "math/ray.h"
#include "math/vector.h"
#include "steradian/scene.h"

namespace steradian {

struct ShadingScene;

struct SurfacePoint {
    Vec3 p;            ///< world, on the surface up to rounding
    Vec3 p_error;      ///< |computed - exact| <= p_error, per coordinate; origins of new rays are offset by it
    Vec3 ng;           ///< unit geometric normal: outside by the shape's own orientation, not flipped towards the ray
    Vec3 ns;           ///< unit shading normal, on the same side as ng
    Vec2 uv;
    uint32_t instance = kNoHit;
    uint32_t prim = kNoHit;
};

SurfacePoint surface_at(const ShadingScene& scene, const Ray& ray, const Hit& hit) noexcept;

/// p moved along ±n, to the side `direction` points to, beyond the error bound, rounded outwards.
Vec3 offset_origin(Vec3 p, Vec3 p_error, Vec3 n, Vec3 direction) noexcept;

/// A ray that leaves the surface; it does not hit the surface it starts from.
Ray spawn_ray(const SurfacePoint& from, Vec3 direction) noexcept;

}  // namespace steradian
