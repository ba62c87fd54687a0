// What lights send, and how to choose directions towards them.
#pragma once

#include <optional>

#include "math/ray.h"
#include "math/vector.h"
#include "shading/environment.h"
#include "shading/light_tree.h"
#include "shading/surface.h"
#include "steradian/scene.h"

namespace steradian {

/// How much of the way to its target a shadow ray goes: the last 2^-17 is more than the rounding of its direction, and
/// less than the distance at which an occluder in front of a light is worth seeing.
inline constexpr float kShadowRayEnd = 1 - 0x1p-17f;

struct LightSample {
    Vec3 wi;         ///< unit, from the point towards the light
    Rgb radiance;    ///< incident radiance; for delta lights the irradiance on a surface that faces them
    float pdf = 0;   ///< per solid angle; 0 marks a delta light, whose "pdf" is 1
    Ray shadow_ray;  ///< unobstructed when occluded() says no
    /// From where the shadow ray starts to the light, in metres; may be infinite.
    double distance() const { return length(Vec3d(shadow_ray.d)) * (shadow_ray.tmax / double{kShadowRayEnd}); }
};

/// Number of shadow rays that light `light` wants per camera sample.
uint32_t light_sample_count(const ShadingScene& scene, uint32_t light) noexcept;

/// The choice among the parts of a light that sample_light() would make, as a question that LightTree::answer() can
/// answer together with others; one without a tree where there is nothing to choose.
LightQuery part_query(const ShadingScene& scene, uint32_t light, const SurfacePoint& from, uint32_t choice) noexcept;
/// Has the memory fetched that sampling a chosen part reads: first what says where the rest is, then the rest.
enum class PartMemory : uint8_t { indices, corners };
void prefetch_part(const ShadingScene& scene, uint32_t light, const LightQuery& part, PartMemory what) noexcept;

/// One direction towards one light of scene.lights. `choice`: 32 uniform bits for choosing among its parts, used where
/// it has several. Nothing when no light can arrive from it. The density may depend on the point: a constant
/// environment is sampled by the cosine about the shading normal, a rectangle by its solid angle, a sphere by its cone.
///
/// `from` must be turned to the side that is to be lit, see facing(): unless from.both_sides says otherwise, a constant
/// environment is sampled on the side of from.ns only, and a surface that is seen from behind would get nothing from
/// it. A point in space has no normals: ng and ns are zero.
///
/// `part`: the light's part_query(), answered; null where it was not asked.
std::optional<LightSample> sample_light(const ShadingScene& scene, uint32_t light, const SurfacePoint& from,
                                        uint32_t choice, Vec2 u,
                                        EnvironmentDensity density = EnvironmentDensity::complete,
                                        const LightQuery* part = nullptr) noexcept;

/// The density with which sample_light chooses wi, given that a ray from `from` along wi sees the light at `hit` (for
/// the environment `hit` is null). 0 for delta lights.
float pdf_light(const ShadingScene& scene, uint32_t light, const SurfacePoint& from, Vec3 wi, const SurfacePoint* hit,
                EnvironmentDensity density = EnvironmentDensity::complete) noexcept;

/// Radiance that an area light on this surface sends towards wo; black where there is none.
Rgb emitted_radiance(const ShadingScene& scene, const SurfacePoint& point, Vec3 wo) noexcept;

/// Radiance that arrives from infinity along a ray of direction d (unit), from the environment (0) and from each of
/// scene.suns (1, 2, …): what `distant` of them sends. Black where there is none. A ray from the camera does not see
/// the hidden ones.
struct DistantRadiance {
    uint32_t light = 0;  ///< index into scene.lights, kNoLight where there is none
    Rgb radiance;
    float pdf = 0;  ///< pdf_light() of d, where it was asked for and there is radiance
};
inline constexpr uint32_t kEnvironmentSource = 0;
uint32_t distant_sources(const ShadingScene& scene) noexcept;
/// `from`: the point that lights were sampled from, if the density is wanted.
DistantRadiance distant_radiance(const ShadingScene& scene, uint32_t source, Vec3 d, bool from_camera,
                                 const SurfacePoint* from = nullptr,
                                 EnvironmentDensity density = EnvironmentDensity::complete) noexcept;
/// Of all of them together.
Rgb sky_radiance(const ShadingScene& scene, Vec3 d, bool from_camera) noexcept;

}  // namespace steradian
