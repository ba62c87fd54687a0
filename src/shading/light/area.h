#pragma once

#include "shading/emission.h"
#include "shading/light/disk_emitter.h"
#include "shading/light/emitter_texture.h"
#include "shading/light/light_kind.h"
#include "shading/light/mesh_emitter.h"
#include "shading/light/rectangle_emitter.h"
#include "shading/light/sphere_emitter.h"
#include "shading/opacity.h"

namespace steradian {

inline uint32_t samples_wanted(const AreaLight& light) { return light.samples; }

/// Lights of which there is nothing to sample (degenerate shapes).
inline std::optional<EmitterSample> sample_emitter(const std::monostate&, const EmitterContext&, Vec3d, uint32_t,
                                                   Vec2) {
    return std::nullopt;
}
inline double emitter_pdf(const std::monostate&, const EmitterContext&, Vec3d, Vec3d, Vec3d) { return 0; }

/// The point of the instance's surface that was sampled, as a ray from `from` would find it.
inline SurfacePoint point_of(const LightContext& context, InstanceId instance, const SurfacePoint& from,
                             const EmitterSample& at) {
    const Ray ray{from.p, 0, static_cast<Vec3>(at.p - Vec3d(from.p)), kInfinity};
    return surface_at(context.scene, ray, {1, at.u, at.v, at.prim, index(instance)});
}

/// A flat light sends nothing to its own points. Rounding has them just before or behind it, where a rectangle fills
/// half of all directions.
inline bool is_on_flat(const AreaLight& light, const LightContext& context, const SurfacePoint& from) {
    const Emitter& emitter = context.data().emitter;
    return from.instance == index(light.instance) &&
           (std::holds_alternative<RectangleEmitter>(emitter) || std::holds_alternative<DiskEmitter>(emitter));
}

inline std::optional<LightSample> sample_kind(const AreaLight& light, const LightContext& context,
                                              const SurfacePoint& from, uint32_t choice, Vec2 u) {
    if (is_black(light.radiance) || is_on_flat(light, context, from)) return std::nullopt;
    const EmitterContext emitter_context{context.scene, receiver_at(from), light.two_sided, 0, context.part};
    const std::optional<EmitterSample> at =
        std::visit([&](const auto& emitter) { return sample_emitter(emitter, emitter_context, from.p, choice, u); },
                   context.data().emitter);
    if (!at) return std::nullopt;
    const auto pdf = static_cast<float>(at->pdf);
    const auto towards = Towards::from_to(from.p, at->p);
    if (!towards || !(pdf > 0) || !is_finite(pdf)) return std::nullopt;
    const std::optional<Ray> ray = shadow_ray_to_surface(from, context, light.instance, *at, towards->wi);
    if (!ray) return std::nullopt;
    const bool cut_out = context.scene.has_cut_outs && context.scene.is_cut_out(index(light.instance));
    Rgb radiance = light.radiance;
    if (light.texture || cut_out || context.data().of_material) {
        const SurfacePoint point = point_of(context, light.instance, from, *at);
        radiance = context.data().of_material ? material_emission(context.scene, point, -towards->wi)
                                              : area_radiance(context.scene, light, point);
        if (cut_out) radiance = radiance * opacity_at(context.scene, point);
        if (is_black(radiance)) return std::nullopt;
    }
    return LightSample{towards->wi, radiance, pdf, *ray};
}

inline double pdf_kind(const AreaLight& light, const LightContext& context, const SurfacePoint& from, Vec3 wi,
                       const SurfacePoint* hit) {
    if (!hit || hit->instance != index(light.instance) || is_black(light.radiance)) return 0;
    if (is_on_flat(light, context, from)) return 0;
    if (!(dot(hit->ng, wi) < 0) && !light.two_sided) return 0;
    const EmitterContext emitter_context{context.scene, receiver_at(from), light.two_sided, hit->prim};
    return std::visit(
        [&](const auto& emitter) { return emitter_pdf(emitter, emitter_context, from.p, hit->p, hit->ng); },
        context.data().emitter);
}

}  // namespace steradian
