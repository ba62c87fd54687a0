// What goes into the kernels and what comes out.
#pragma once

#include <cstdint>

#include "math/vector.h"

namespace steradian {

/// Coordinates beyond this bound are not accepted: the arithmetic of the kernels is proved for what lies within it.
inline constexpr float kMaxCoordinate = 1e15f;

inline constexpr uint32_t kNoHit = 0xffffffffu;

/// Points o + t d for t in [tmin, tmax]. A negative or NaN tmin counts as 0. d need not be unit length; a ray whose
/// direction is zero, or with anything that is not finite (tmax may be infinite), hits nothing.
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

}  // namespace steradian
