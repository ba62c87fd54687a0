// Lights whose radiance varies over their surface.
#pragma once

#include <vector>

#include "shading/shading_scene.h"
#include "shading/texture.h"

namespace steradian {

/// At a point of the light's surface. Light samples know no footprint, so nothing else does either: however a point is
/// found, it sends the same.
inline Rgb area_radiance(const ShadingScene& scene, const AreaLight& light, const SurfacePoint& point) {
    if (!light.texture) return light.radiance;
    SurfacePoint exact = point;
    exact.footprint = 0;
    return light.radiance * eval_color(scene, *light.texture, exact);
}

/// How bright the texture makes the light, as a factor of `radiance`, mean of the channels: for choosing among lights
/// and triangles. Densities follow from what is chosen, so it need not be exact.
struct TextureMeans {
    double whole = 1;              ///< of the surface, > 0
    std::vector<float> triangles;  ///< of each, > 0; empty for shapes that are no meshes, and without a texture
};

/// By values in a grid, which may miss what is small: so no triangle counts for less than a twentieth of the mean, and
/// none that shines is never sampled. May throw std::bad_alloc.
TextureMeans texture_means(const ShadingScene& scene, const AreaLight& light);

}  // namespace steradian
