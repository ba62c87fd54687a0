// The surfaces that area lights sit on, in world space and ready to be sampled: a closed set, one file per kind.
//
// Every kind has
//   std::optional<EmitterSample> sample_emitter(const Kind&, const EmitterContext&, Vec3d from, uint32_t choice, Vec2
//   u); double emitter_pdf(const Kind&, const EmitterContext&, Vec3d from, Vec3d p, Vec3d n);
// where `from` is the receiving point, p and n a point of the surface that is seen from there and its outward normal.
// Densities are per solid angle at `from`, over the visible emitting side.
#pragma once

#include <variant>
#include <vector>

#include "math/vector.h"
#include "shading/light_tree.h"
#include "steradian/scene.h"

namespace steradian {

struct ShadingScene;

/// Chooses a triangle by what it may contribute, then a point on it uniformly.
struct MeshEmitter {
    InstanceId instance{};
    MeshId mesh{};
    LightTree triangles;  ///< in world space
};

/// A sphere that is one in world space as well: sampled uniformly over the cone it fills, from inside over all
/// directions, from the surface itself over the area.
struct SphereEmitter {
    Vec3d center;
    double radius = 0;
    Vec3 p_error;  ///< see SurfacePoint::p_error; holds for every point of the surface
};

/// A sphere under a transform that is not a similarity: sampled uniformly over the object's sphere.
struct EllipsoidEmitter {
    InstanceId instance{};
    Vec3d center;  ///< in the object's space, like the radius
    double radius = 0;
    double abs_determinant = 0;
    Vec3 p_error;
};

/// center + a half_u + b half_v, a and b in [-1, 1]. Real rectangles are sampled by solid angle, others by area.
struct RectangleEmitter {
    Vec3d center, half_u, half_v;
    Vec3d normal;  ///< unit, of the emitting side
    double area = 0;
    bool right_angled = false;
    Vec3 p_error;
};

/// The ellipse center + a axis_u + b axis_v, a² + b² <= 1; sampled by area.
struct DiskEmitter {
    Vec3d center, axis_u, axis_v;
    Vec3d normal;
    double area = 0;
    Vec3 p_error;
};

/// The first alternative stands for lights without a surface.
using Emitter =
    std::variant<std::monostate, MeshEmitter, SphereEmitter, EllipsoidEmitter, RectangleEmitter, DiskEmitter>;

struct EmitterSample {
    Vec3d p;
    Vec3d n;  ///< unit, outside by the shape's own orientation
    Vec3 p_error;
    double pdf = 0;
    float u = 0, v = 0;  ///< with prim as in the Hit of a ray that arrives there
    uint32_t prim = 0;
};

/// What a kind may need besides its own values.
struct EmitterContext {
    const ShadingScene& scene;
    LightReceiver receiver;
    bool two_sided = false;
    uint32_t prim = 0;                 ///< for densities: the primitive that is seen
    const LightQuery* part = nullptr;  ///< for samples: see sample_light()
};

/// Per solid angle at a distance, from per area; 0 where the surface is seen edge-on.
inline double solid_angle_pdf(double pdf_area, Vec3d to_surface, Vec3d n) {
    const double d2 = dot(to_surface, to_surface);
    const double projected = std::fabs(dot(n, to_surface));
    return projected > 0 ? pdf_area * d2 * std::sqrt(d2) / projected : 0;
}

/// Whether the emitting side of a surface element faces `from`.
inline bool emits_towards(Vec3d p, Vec3d n, Vec3d from, bool two_sided) {
    const double side = dot(n, from - p);
    return two_sided ? side != 0 : side > 0;
}

}  // namespace steradian
