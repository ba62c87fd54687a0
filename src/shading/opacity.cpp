#include "shading/opacity.h"

#include "shading/mixture.h"
#include "shading/shading_scene.h"
#include "shading/texture.h"

namespace steradian {

float opacity_at(const ShadingScene& scene, const SurfacePoint& point, MaterialId material) noexcept {
    if (!scene.materials[index(material)].cut_out) return 1;
    const auto& m = std::get<OpenPbrMaterial>(scene.scene.materials[index(material)]);
    // Rays that pass do not know how wide they are, so nobody looks at more than a point: all must agree.
    SurfacePoint exact = point;
    exact.footprint = 0;
    const float opacity = eval_input(scene, m.geometry_opacity, exact);
    if (m.geometry_opacity_cutoff > 0) return opacity >= m.geometry_opacity_cutoff ? 1.0f : 0.0f;
    return opacity;
}

float opacity_at(const ShadingScene& scene, const SurfacePoint& point) noexcept {
    const MaterialId material = scene.scene.instances[point.instance].material;
    if (!scene.materials[index(material)].cut_out) return 1;
    const Mixture mixture(scene, point, material);
    float sum = 0;
    for (const Mixture::Share& share : mixture.parts()) sum += share.weight * opacity_at(scene, point, share.material);
    return sum;
}

}  // namespace steradian
