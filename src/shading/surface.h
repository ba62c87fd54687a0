// From a hit's ids to what shading needs to know about the point, and from there to new rays.
#pragma once

#include "math/ray.h"
#include "math/vector.h"
#include "shading/light_bounds.h"
#include "steradian/scene.h"

namespace steradian {

struct ShadingScene;

struct SurfacePoint {
    Vec3 p;        ///< world, on the surface up to rounding
    Vec3 p_error;  ///< |computed - exact| <= p_error, per coordinate; origins of new rays are offset by it
    Vec3 ng;       ///< unit geometric normal: outside by the shape's own orientation, not flipped towards the ray
    Vec3 ns;       ///< unit shading normal, on the same side as ng
    Vec2 uv;
    Vec3 wo;                ///< unit, to where the ray came from; zero where nobody said
    Vec2 hit_uv;            ///< u and v of the hit
    float footprint = 0;    ///< metres of the surface that a ray stands for (ray_cone.h); 0: a point
    float outer_index = 1;  ///< over vacuum, of what is around a body with a priority (interior.h)
    uint32_t instance = kNoHit;
    uint32_t prim = kNoHit;
    bool both_sides = false;  ///< light from behind ns counts as well, for choosing lights and directions towards them
};

/// `hit` must be of `ray`. uv of meshes without any are (hit.u, hit.v); of disks as of the rectangle around them.
/// A mirroring transform does not turn a shape inside out: what was outside stays outside.
SurfacePoint surface_at(const ShadingScene& scene, const Ray& ray, const Hit& hit) noexcept;

/// The same point with ng and ns turned to the side that wo points to: what is lit when it is seen from there.
/// sample_light and pdf_light take it so (a constant environment is sampled about ns).
SurfacePoint facing(SurfacePoint point, Vec3 wo) noexcept;

/// What choosing a light needs to know of a point that is turned so.
inline LightReceiver receiver_at(const SurfacePoint& from) noexcept { return {from.p, from.ns, from.both_sides}; }

/// How the point moves with its texture coordinates, in world space, up to a common factor: `determinant` of what they
/// are, so that dp/du = du / determinant. Zero where the coordinates do not say.
struct SurfaceDerivatives {
    Vec3d du, dv;
    double determinant = 1;
};
SurfaceDerivatives derivatives_at(const ShadingScene& scene, const SurfacePoint& point, uint32_t uv_set = 0) noexcept;

/// The point's coordinates of a set (ImageTexture::uv_set); those of the first where it has no other.
Vec2 uv_at(const ShadingScene& scene, const SurfacePoint& point, uint32_t uv_set) noexcept;

/// Directions of u and v for normal maps, as derivatives: by the tangents of the mesh where it has some (their lengths
/// mean nothing then), by the texture coordinates otherwise.
SurfaceDerivatives tangents_at(const ShadingScene& scene, const SurfacePoint& point, uint32_t uv_set = 0) noexcept;

/// In which direction u of `point` grows on the surface, in world space, of any length: what rough surfaces with a
/// grain are turned by. Zero where nothing says. Of meshes without texture coordinates: along the first edge.
Vec3 tangent_at(const ShadingScene& scene, const SurfacePoint& point) noexcept;

/// The two axes of a disk, perpendicular to its normal and `radius` long: what (u, v) of a hit refers to. Rounded to
/// float, they define the plane of the disk; whoever gives disks to the ray kernels must use these.
struct DiskAxes {
    Vec3 u, v;
};
DiskAxes disk_axes(const Disk& disk) noexcept;

/// p moved along ±n, to the side `direction` points to, beyond the error bound, rounded outwards: strictly on that side
/// of every plane with normal n through the box p ± p_error.
Vec3 offset_origin(Vec3 p, Vec3 p_error, Vec3 n, Vec3 direction) noexcept;

/// A ray that leaves the surface; it does not hit the surface it starts from. (ng is rounded to float, and so is the
/// direction in the space of an instance: one within about 1e-6 of the tangent plane, times the anisotropy of the
/// instance's transform, may still be one that enters the exact surface.)
Ray spawn_ray(const SurfacePoint& from, Vec3 direction) noexcept;

}  // namespace steradian
