// How wide the bundle of light is that a ray stands for: a cone along the path, started by the camera's pixel
// (Amanatides 1984; Akenine-Möller et al. 2021, "Improved Shader and Texture Level of Detail Using Ray Cones"). Only
// textures that are filtered by their footprint look at it.
#pragma once

#include "math/vector.h"

namespace steradian {

struct ShadingScene;
struct SurfacePoint;
struct BsdfSample;

struct RayCone {
    float width = 0;   ///< metres, across
    float spread = 0;  ///< radians, by which it grows with distance

    /// After so many metres.
    RayCone after(float distance) const { return {width + spread * distance, spread}; }
};

/// How far the cone reaches on the surface, along the way it is seen from: metres.
float footprint_of(const RayCone& cone, const SurfacePoint& point) noexcept;

/// The cone that leaves `point`, where `cone` arrives: wider where the surface is curved, as a mirror's would be, and
/// by an eighth of the lobe, √(1 / pdf) wide, where the bounce is rough. It never becomes narrower.
RayCone bounced(const RayCone& cone, const ShadingScene& scene, const SurfacePoint& point,
                const BsdfSample& sample) noexcept;

/// The mean curvature of the surface as its normals have it, without a sign: 1/m. 0 for what is flat.
double curvature_at(const ShadingScene& scene, const SurfacePoint& point) noexcept;

}  // namespace steradian
