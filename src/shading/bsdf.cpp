#include "shading/bsdf.h"

#include "shading/bsdf/diffuse.h"
#include "shading/bsdf/glass.h"
#include "shading/bsdf/mirror.h"
#include "shading/bsdf/refraction.h"
#include "shading/shading_scene.h"

namespace steradian {

// A kind of material or lobe without its functions is a compile error in the visits below.

Bsdf make_bsdf(const ShadingScene& scene, const SurfacePoint& point) noexcept {
    const Instance& instance = scene.scene.instances[point.instance];
    const Material& material = scene.scene.materials[index(instance.material)];
    Bsdf out;
    out.ng = point.ng;
    out.frame = Frame::from_z(point.ns);
    std::visit([&](const auto& m) { out.lobe = make_lobe(m, scene.scene, point); }, material);
    return out;
}

bool is_specular(const Bsdf& bsdf) noexcept {
    return std::visit([](const auto& lobe) { return lobe_is_specular(lobe); }, bsdf.lobe);
}

BsdfEval eval(const Bsdf& bsdf, Vec3 wo, Vec3 wi) noexcept {
    const LobeGeometry g{bsdf.ng, bsdf.frame};
    return std::visit([&](const auto& lobe) { return eval_lobe(lobe, g, wo, wi); }, bsdf.lobe);
}

std::optional<BsdfSample> sample(const Bsdf& bsdf, Vec3 wo, float uc, Vec2 u) noexcept {
    const LobeGeometry g{bsdf.ng, bsdf.frame};
    return std::visit([&](const auto& lobe) { return sample_lobe(lobe, g, wo, uc, u); }, bsdf.lobe);
}

float fresnel_dielectric(float cos_i, float eta) noexcept {
    const double ci = clamp_to(static_cast<double>(cos_i), 0.0, 1.0), n = eta;
    const double cos2_t = 1 - (1 - ci) * (1 + ci) / (n * n);
    if (!(cos2_t > 0)) return 1;
    const double ct = std::sqrt(cos2_t);
    const double parallel = (n * ci - ct) / (n * ci + ct);
    const double perpendicular = (ci - n * ct) / (ci + n * ct);
    return static_cast<float>((parallel * parallel + perpendicular * perpendicular) / 2);
}

}  // namespace steradian
