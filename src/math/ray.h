// What goes into the kernels and what comes out.
#pragma once

#include <cstdint>

#include "math/vector.h"

namespace steradian {

/// Coordinates beyond this bound are not accepted: the arithmetic of the kernels is proved for what lies within it.
inline constexpr float kMaxCoordinate = 1e15f;

inline bool usable_position(Vec3 p) { return is_finite(p) && max_component(abs(p)) <= kMaxCoordinate; }

inline constexpr uint32_t kNoHit = 0xffffffffu;

/// Points o + t d for t in [tmin, tmax], both ends included. A negative or NaN tmin counts as 0; a NaN tmax means an
/// empty range. d need not be unit length, but components smaller than the smallest normal float (1.2e-38) count as 0.
/// A ray whose direction is zero, or with an origin or direction that is not finite, hits nothing.
struct Ray {
    Vec3 o;
    float tmin = 0;
    Vec3 d;
    float tmax = kInfinity;
};

/// Ids only. For triangles (u, v) are the barycentric weights of the second and third vertex; for rectangles and disks
/// the coordinates in the shape's own axes, in [-1, 1]; for spheres 0.
struct Hit {
    float t = kInfinity;
    float u = 0, v = 0;
    uint32_t prim = kNoHit;
    uint32_t instance = kNoHit;

    bool found() const { return prim != kNoHit; }
    bool operator==(const Hit&) const = default;
};

/// What it takes to find the closest hit of one ray.
struct RayVisits {
    uint32_t nodes = 0;  ///< of eight children each
    uint32_t items = 0;  ///< blocks of four triangles, other shapes, and instances that are entered
    bool operator==(const RayVisits&) const = default;
};

}  // namespace steradian
