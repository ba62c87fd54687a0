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
#include "shading/relief.h"
#include "shading/shading_scene.h"

namespace steradian {
namespace {

BsdfEval eval_lobe_of(const Bsdf& bsdf, Vec3 ng, Vec3 wo, Vec3 wi) {
    const LobeGeometry g{ng, bsdf.frame};
    return std::visit([&](const auto& lobe) { return eval_lobe(lobe, g, wo, wi); }, bsdf.lobe);
}

std::optional<BsdfSample> sample_lobe_of(const Bsdf& bsdf, Vec3 ng, Vec3 wo, float uc, Vec2 u) {
    const LobeGeometry g{ng, bsdf.frame};
    return std::visit([&](const auto& lobe) { return sample_lobe(lobe, g, wo, uc, u); }, bsdf.lobe);
}

// Where a map has turned the normal n, a lobe about n leans over: part of what it reflects would go into the surface,
// part of what it transmits would come out. Between the facets of real relief such light meets the surface again; as in
// microfacet-based normal mapping (Schüssler et al. 2017) it is reflected there, but by a mirror that lies in the
// surface itself: the lobe is folded at it. All of its energy stays, on the side where it belongs, and values,
// densities and samples follow from the lobe's own without anything new to integrate.

int side_of(Vec3 w, Vec3 n) {
    const double cosine = dot(Vec3d(w), Vec3d(n));
    return cosine > 0 ? 1 : cosine < 0 ? -1 : 0;
}

Vec3 mirrored_at(Vec3 n, Vec3 w) {
    return static_cast<Vec3>(normalize(Vec3d(w) - Vec3d(n) * (2 * dot(Vec3d(w), Vec3d(n)))));
}

/// What the lobe about the turned normal sends to wi, and what would go to wi's image behind the surface.
BsdfEval eval_folded(const Bsdf& bsdf, Vec3 wo, Vec3 wi) {
    const Vec3 n = bsdf.frame.z, image = mirrored_at(bsdf.ng, wi);
    const int side = side_of(wi, bsdf.ng);
    if (side == 0 || side_of(wo, bsdf.ng) != side_of(wo, n)) return {};
    BsdfEval out;
    if (side_of(wi, n) == side) out = eval_lobe_of(bsdf, n, wo, wi);
    if (side_of(image, n) != side) return out;
    const BsdfEval from_image = eval_lobe_of(bsdf, n, wo, image);
    return {out.f_cos + from_image.f_cos, out.pdf + from_image.pdf};
}

std::optional<BsdfSample> sample_folded(const Bsdf& bsdf, Vec3 wo, float uc, Vec2 u) {
    const Vec3 n = bsdf.frame.z;
    if (side_of(wo, bsdf.ng) != side_of(wo, n)) return std::nullopt;
    std::optional<BsdfSample> out = sample_lobe_of(bsdf, n, wo, uc, u);
    if (!out) return out;
    const int side = side_of(out->wi, n);
    if (side_of(out->wi, bsdf.ng) != side) out->wi = mirrored_at(bsdf.ng, out->wi);
    if (side == 0 || side_of(out->wi, bsdf.ng) != side) return std::nullopt;
    if (out->specular) return out;
    const BsdfEval e = eval_folded(bsdf, wo, out->wi);
    if (!(e.pdf > 0) || !is_finite(e.pdf)) return std::nullopt;
    out->weight = e.f_cos / e.pdf;
    out->pdf = e.pdf;
    return out;
}

}  // namespace

// A kind of material or lobe without its functions is a compile error in the visits below.

Bsdf make_bsdf(const ShadingScene& scene, const SurfacePoint& point) noexcept {
    const Instance& instance = scene.scene.instances[point.instance];
    const Material& material = scene.scene.materials[index(instance.material)];
    Bsdf out;
    out.ng = point.ng;
    const LobeContext context{scene, point, scene.materials[index(instance.material)]};
    Vec3 n = point.ns;
    if (context.material.relief != kNoRelief) {
        const ReliefNormal facet = relief_normal(scene, point, scene.scene.reliefs[context.material.relief]);
        n = facet.n;
        out.folded = facet.turned;
    }
    out.frame = Frame::from_z(n);
    std::visit([&](const auto& m) { out.lobe = make_lobe(m, context); }, material);
    if (std::visit([](const auto& lobe) { return lobe_has_direction(lobe); }, out.lobe))
        out.frame = Frame::from_zx(n, tangent_at(scene, point));
    return out;
}

bool is_specular(const Bsdf& bsdf) noexcept {
    return std::visit([](const auto& lobe) { return lobe_is_specular(lobe); }, bsdf.lobe);
}

bool only_reflects(const Bsdf& bsdf) noexcept {
    return std::visit([](const auto& lobe) { return lobe_only_reflects(lobe); }, bsdf.lobe);
}

BsdfEval eval(const Bsdf& bsdf, Vec3 wo, Vec3 wi) noexcept {
    return bsdf.folded ? eval_folded(bsdf, wo, wi) : eval_lobe_of(bsdf, bsdf.ng, wo, wi);
}

std::optional<BsdfSample> sample(const Bsdf& bsdf, Vec3 wo, float uc, Vec2 u) noexcept {
    return bsdf.folded ? sample_folded(bsdf, wo, uc, u) : sample_lobe_of(bsdf, bsdf.ng, wo, uc, u);
}

}  // namespace steradian
