#include "shading/bsdf.h"

#include "shading/bsdf/conductor.h"
#include "shading/bsdf/diffuse.h"
#include "shading/bsdf/diffuse_transmission.h"
#include "shading/bsdf/glass.h"
#include "shading/bsdf/mirror.h"
#include "shading/bsdf/open_pbr.h"
#include "shading/bsdf/refraction.h"
#include "shading/bsdf/rough_glass.h"
#include "shading/bsdf/thin_glass.h"
#include "shading/shading_scene.h"

namespace steradian {

// A kind of material or lobe without its functions is a compile error in the visits below.

Bsdf make_bsdf(const ShadingScene& scene, const SurfacePoint& point) noexcept {
    const Instance& instance = scene.scene.instances[point.instance];
    const Material& material = scene.scene.materials[index(instance.material)];
    Bsdf out;
    out.ng = point.ng;
    out.frame = Frame::from_z(point.ns);
    const LobeContext context{scene, point, scene.materials[index(instance.material)]};
    std::visit([&](const auto& m) { out.lobe = make_lobe(m, context); }, material);
    if (std::visit([](const auto& lobe) { return lobe_has_direction(lobe); }, out.lobe))
        out.frame = Frame::from_zx(point.ns, tangent_at(scene, point));
    return out;
}

bool is_specular(const Bsdf& bsdf) noexcept {
    return std::visit([](const auto& lobe) { return lobe_is_specular(lobe); }, bsdf.lobe);
}

bool only_reflects(const Bsdf& bsdf) noexcept {
    return std::visit([](const auto& lobe) { return lobe_only_reflects(lobe); }, bsdf.lobe);
}

BsdfEval eval(const Bsdf& bsdf, Vec3 wo, Vec3 wi) noexcept {
    const LobeGeometry g{bsdf.ng, bsdf.frame};
    return std::visit([&](const auto& lobe) { return eval_lobe(lobe, g, wo, wi); }, bsdf.lobe);
}

std::optional<BsdfSample> sample(const Bsdf& bsdf, Vec3 wo, float uc, Vec2 u) noexcept {
    const LobeGeometry g{bsdf.ng, bsdf.frame};
    return std::visit([&](const auto& lobe) { return sample_lobe(lobe, g, wo, uc, u); }, bsdf.lobe);
}

}  // namespace steradian
