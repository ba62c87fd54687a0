// What the lobes share. Each kind of lobe is one file with these functions, found by overloading:
//   Lobe make_lobe(const SomeMaterial&, const LobeContext&);   (or one kind of lobe)
// and for its kind of lobe
//   bool lobe_is_specular(const Lobe&);
//   BsdfEval eval_lobe(const Lobe&, const LobeGeometry&, Vec3 wo, Vec3 wi);
//   std::optional<BsdfSample> sample_lobe(const Lobe&, const LobeGeometry&, Vec3 wo, float uc, Vec2 u);
#pragma once

#include <optional>

#include "shading/bsdf.h"
#include "shading/shading_scene.h"

namespace steradian {

/// What a lobe is made from, besides its material.
struct LobeContext {
    const ShadingScene& scene;
    const SurfacePoint& point;
    const ShadingScene::MaterialData& material;
    float wavelength = 0;  ///< as in make_bsdf
};

/// Of a dielectric with the index `eta`, over that of what is around it.
inline float relative_index(float eta, const LobeContext& context) { return eta / context.point.outer_index; }

/// What a rough boundary to what is around it loses; null where nobody has computed that.
inline const MicrofacetEnergy* energy_of_boundary(const LobeContext& context,
                                                  const std::shared_ptr<const MicrofacetEnergy>& in_vacuum) {
    if (context.point.outer_index == 1) return in_vacuum.get();
    for (const ShadingScene::NestedEnergy& nested : context.material.nested)
        if (nested.outer_index == context.point.outer_index) return nested.energy.get();
    return nullptr;
}

/// Whether it matters how the lobe is turned about the normal.
template <class Lobe>
bool lobe_has_direction(const Lobe&) {
    return false;
}

/// Whether all light that leaves towards wo has come from the side of the shading normal on which wo is.
template <class Lobe>
bool lobe_only_reflects(const Lobe&) {
    return false;
}

struct LobeGeometry {
    Vec3 ng;
    const Frame& frame;  ///< z is the shading normal, on the side of ng
};

}  // namespace steradian
