// What the lobes share. Each kind of lobe is one file with four functions, found by overloading:
//   Lobe make_lobe(const LobeMaterial&, const Scene&, const SurfacePoint&);
//   bool lobe_is_specular(const Lobe&);
//   BsdfEval eval_lobe(const Lobe&, const LobeGeometry&, Vec3 wo, Vec3 wi);
//   std::optional<BsdfSample> sample_lobe(const Lobe&, const LobeGeometry&, Vec3 wo, float uc, Vec2 u);
#pragma once

#include <optional>

#include "shading/bsdf.h"

namespace steradian {

struct LobeGeometry {
    Vec3 ng;
    const Frame& frame;  ///< z is the shading normal, on the side of ng
};

}  // namespace steradian
