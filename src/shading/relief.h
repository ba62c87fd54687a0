// Shading normals turned by normal and bump maps, and what keeps them consistent with the surface itself.
#pragma once

#include "math/vector.h"
#include "shading/shading_scene.h"
#include "shading/surface.h"

namespace steradian {

/// A facet is seen at no less than this part of the cosine at which the surface itself is.
inline constexpr double kLeastSeen = 0.25;
/// The least cosine between a facet and the surface.
inline constexpr double kLeastUpright = 0.05;

/// The shading normal of a facet, turned towards the geometric one as little as it takes to be seen from wo: whichever
/// side wo is on, dot(n, wo) is at least kLeastSeen dot(ng, wo). Neither has to be turned where that holds already.
Vec3d visible_normal(Vec3d n, Vec3d ng, Vec3d wo) noexcept;

struct ReliefNormal {
    Vec3 n;
    bool turned = false;  ///< false: n is the point's own ns, to the bit
};
/// Seen from point.wo, where that is given.
ReliefNormal relief_normal(const ShadingScene& scene, const SurfacePoint& point, const Relief& relief) noexcept;

/// The direction of a grain on the surface, in world space; as tangent_at() where it is not turned.
Vec3 grain_at(const ShadingScene& scene, const SurfacePoint& point, const GrainDirection& grain) noexcept;

}  // namespace steradian
