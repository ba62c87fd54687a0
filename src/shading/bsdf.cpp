#include "shading/bsdf.h"

#include <algorithm>
#include <utility>

#include "shading/bsdf/conductor.h"
#include "shading/bsdf/diffuse.h"
#include "shading/bsdf/diffuse_transmission.h"
#include "shading/bsdf/fold.h"
#include "shading/bsdf/glass.h"
#include "shading/bsdf/mirror.h"
#include "shading/bsdf/mix.h"
#include "shading/bsdf/open_pbr_coat.h"
#include "shading/bsdf/phase.h"
#include "shading/bsdf/refraction.h"
#include "shading/bsdf/rough_glass.h"
#include "shading/bsdf/thin_glass.h"
#include "shading/mixture.h"
#include "shading/opacity.h"
#include "shading/relief.h"
#include "shading/shading_scene.h"

namespace steradian {
namespace {

// A kind of material or lobe without its functions is a compile error in the visits below.

Frame frame_about(Vec3 n, const Microfacets& facets, Vec3 along) {
    return facets.alpha_x == facets.alpha_y ? Frame::from_z(n) : Frame::from_zx(n, along);
}

/// Turns the frames of base and coat by their grain. The coat gets one of its own where that of the base would not do:
/// it has its own normal, which without a map is that of the surface.
template <class Out>
void place_layers(const LobeContext& context, const OpenPbrMaterial& m, MaterialId id, OpenPbrBsdf& lobe, Out& out) {
    const ShadingScene& scene = context.scene;
    const SurfacePoint& point = context.point;
    const Microfacets& base = lobe.metal.facets;
    const Vec3 n = out.frame.z;
    const bool coat_has_grain = lobe.coat.alpha_x != lobe.coat.alpha_y;
    const bool turned = m.geometry_tangent.rotation != 0 || m.geometry_tangent.texture;
    ReliefNormal coat{point.ns, false};
    if (lobe.tables->coat && m.geometry_coat_normal) coat = relief_normal(scene, point, {id, *m.geometry_coat_normal});
    lobe.coat_apart = lobe.tables->coat && (coat.n != n || (coat_has_grain && turned));
    const Vec3 along = lobe_has_direction(lobe) ? grain_at(scene, point, m.geometry_tangent) : Vec3{};
    if (!lobe.coat_apart) {
        if (lobe_has_direction(lobe)) out.frame = Frame::from_zx(n, along);
        return;
    }
    out.frame = frame_about(n, base, along);
    lobe.coat_frame = frame_about(coat.n, lobe.coat, tangent_at(scene, point));
    lobe.coat_folded = coat.turned;
    lobe.base_folded = std::exchange(out.folded, false);
}

/// The lobe of one material that is no mix, about the normal that its relief gives it. `out` is a Bsdf or a part of
/// one.
template <class Out>
void make_plain(const ShadingScene& scene, const SurfacePoint& point, MaterialId id, float wavelength, Out& out) {
    const LobeContext context{scene, point, scene.materials[index(id)], wavelength};
    Vec3 n = point.ns;
    if (context.material.relief != kNoRelief) {
        const ReliefNormal facet = relief_normal(scene, point, scene.scene.reliefs[context.material.relief]);
        n = facet.n;
        out.folded = facet.turned;
    }
    out.frame = Frame::from_z(n);
    const auto set = [&](auto&& lobe) {
        if constexpr (std::is_same_v<std::decay_t<decltype(lobe)>, OpenPbrBsdf>)
            place_layers(context, std::get<OpenPbrMaterial>(scene.scene.materials[index(id)]), id, lobe, out);
        else if (lobe_has_direction(lobe))
            out.frame = Frame::from_zx(n, tangent_at(scene, point));
        out.lobe = std::move(lobe);
    };
    const auto make = [&](const auto& material) {
        using Kind = std::decay_t<decltype(material)>;
        if constexpr (std::is_same_v<Kind, GlassMaterial>)
            std::visit(set, make_lobe(material, context));
        else if constexpr (!std::is_same_v<Kind, MixMaterial>)
            set(make_lobe(material, context));
    };
    std::visit(make, scene.scene.materials[index(id)]);
}

/// Of a material that is no mix: glass, and what a texture does not keep from being so.
bool plain_disperses(const ShadingScene& scene, const SurfacePoint& point, MaterialId id) {
    if (!scene.materials[index(id)].disperses) return false;
    const auto* layered = std::get_if<OpenPbrMaterial>(&scene.scene.materials[index(id)]);
    return !layered || eval_input(scene, layered->transmission_weight, point) > 0;
}

/// Where parts of a mix let rays pass, what is left of the others makes a whole: a ray that has not passed has met
/// them.
void make_mix(const ShadingScene& scene, const SurfacePoint& point, MaterialId id, const Mixture& mixture,
              float wavelength, Bsdf& out) {
    MixBsdf& mix = out.lobe.emplace<MixBsdf>();
    const float all = scene.materials[index(id)].cut_out ? opacity_at(scene, point) : 1;
    Vec3 sum;
    for (const Mixture::Share& share : mixture.parts()) {
        float weight = share.weight;
        if (all > 0 && all < 1) weight *= opacity_at(scene, point, share.material) / all;
        if (!(weight > 0)) continue;
        MixBsdf::Part& part = mix.parts[mix.count++];
        part.weight = weight;
        make_plain(scene, point, share.material, wavelength, part);
        sum = sum + part.frame.z * part.weight;
    }
    const bool same = std::all_of(mix.parts.begin(), mix.parts.begin() + mix.count,
                                  [&](const auto& part) { return part.frame.z == mix.parts[0].frame.z; });
    out.frame = Frame::from_z(same ? mix.parts[0].frame.z : normalize(sum));
}

}  // namespace

bool disperses(const ShadingScene& scene, const SurfacePoint& point) noexcept {
    const MaterialId id = scene.scene.instances[point.instance].material;
    if (!scene.materials[index(id)].disperses) return false;
    if (!std::holds_alternative<MixMaterial>(scene.scene.materials[index(id)]))
        return plain_disperses(scene, point, id);
    const Mixture mixture(scene, point, id);
    return std::any_of(mixture.parts().begin(), mixture.parts().end(),
                       [&](const auto& share) { return plain_disperses(scene, point, share.material); });
}

Bsdf make_bsdf(const ShadingScene& scene, const SurfacePoint& point, float wavelength) noexcept {
    const MaterialId id = scene.scene.instances[point.instance].material;
    Bsdf out;
    out.ng = point.ng;
    if (!std::holds_alternative<MixMaterial>(scene.scene.materials[index(id)])) {
        make_plain(scene, point, id, wavelength, out);
        return out;
    }
    const Mixture mixture(scene, point, id);
    if (mixture.parts().size() == 1)
        make_plain(scene, point, mixture.parts()[0].material, wavelength, out);
    else
        make_mix(scene, point, id, mixture, wavelength, out);
    return out;
}

bool is_specular(const Bsdf& bsdf) noexcept {
    return std::visit([](const auto& lobe) { return lobe_is_specular(lobe); }, bsdf.lobe);
}

bool only_reflects(const Bsdf& bsdf) noexcept {
    return std::visit([](const auto& lobe) { return lobe_only_reflects(lobe); }, bsdf.lobe);
}

BsdfEval eval(const Bsdf& bsdf, Vec3 wo, Vec3 wi) noexcept {
    return eval_any(bsdf.lobe, {bsdf.ng, bsdf.frame}, bsdf.folded, wo, wi);
}

std::optional<BsdfSample> sample(const Bsdf& bsdf, Vec3 wo, float uc, Vec2 u) noexcept {
    return sample_any(bsdf.lobe, {bsdf.ng, bsdf.frame}, bsdf.folded, wo, uc, u);
}

}  // namespace steradian
