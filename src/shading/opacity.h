// How much of a surface is there. What is not there lets rays pass as if it were a hole: it is neither a bounce of a
// path nor a vertex of it, and light samples go through it.
#pragma once

#include "shading/surface.h"
#include "steradian/scene.h"

namespace steradian {

struct ShadingScene;

/// Whether surfaces of the material may let rays pass somewhere. `earlier` says it of the materials before it.
template <class Earlier>
bool may_let_pass(const Material& material, const Earlier& earlier) {
    if (const auto* mix = std::get_if<MixMaterial>(&material)) return earlier(mix->first) || earlier(mix->second);
    const auto* m = std::get_if<OpenPbrMaterial>(&material);
    if (!m) return false;
    if (m->geometry_opacity.texture) return true;
    const float opacity = m->geometry_opacity.value;
    return m->geometry_opacity_cutoff > 0 ? opacity < m->geometry_opacity_cutoff : opacity < 1;
}

/// In [0, 1]: the probability that a ray which meets `point` does not pass. Of a mix the weighted mean.
float opacity_at(const ShadingScene& scene, const SurfacePoint& point) noexcept;
/// Of one material that is no mix.
float opacity_at(const ShadingScene& scene, const SurfacePoint& point, MaterialId material) noexcept;

}  // namespace steradian
