#pragma once

#include "shading/light/disk_emitter.h"
#include "shading/light/light_kind.h"
#include "shading/light/mesh_emitter.h"
#include "shading/light/rectangle_emitter.h"
#include "shading/light/sphere_emitter.h"

namespace steradian {

inline uint32_t samples_wanted(const AreaLight& light) { return light.samples; }

/// Lights of which there is nothing to sample (degenerate shapes).
inline std::optional<EmitterSample> sample_emitter(const std::monostate&, const EmitterContext&, Vec3d, uint32_t,
                                                   Vec2) {
    return std::nullopt;
}
inline double emitter_pdf(const std::monostate&, const EmitterContext&, Vec3d, Vec3d, Vec3d) { return 0; }

inline std::optional<LightSample> sample_kind(const AreaLight& light, const LightContext& context,
                                              const SurfacePoint& from, uint32_t choice, Vec2 u) {
    if (is_black(light.radiance)) return std::nullopt;
    const EmitterContext emitter_context{context.scene, receiver_at(from), light.two_sided};
    const std::optional<EmitterSample> at =
        std::visit([&](const auto& emitter) { return sample_emitter(emitter, emitter_context, from.p, choice, u); },
                   context.data().emitter);
    if (!at) return std::nullopt;
    const auto pdf = static_cast<float>(at->pdf);
    const auto towards = Towards::from_to(from.p, at->p);
    if (!towards || !(pdf > 0) || !is_finite(pdf)) return std::nullopt;
    const std::optional<Ray> ray = shadow_ray_to_surface(from, context, light.instance, *at, towards->wi);
    if (!ray) return std::nullopt;
    return LightSample{towards->wi, light.radiance, pdf, *ray};
}

inline double pdf_kind(const AreaLight& light, const LightContext& context, const SurfacePoint& from, Vec3 wi,
                       const SurfacePoint* hit) {
    if (!hit || hit->instance != index(light.instance) || is_black(light.radiance)) return 0;
    if (!(dot(hit->ng, wi) < 0) && !light.two_sided) return 0;
    const EmitterContext emitter_context{context.scene, receiver_at(from), light.two_sided, hit->prim};
    return std::visit(
        [&](const auto& emitter) { return emitter_pdf(emitter, emitter_context, from.p, hit->p, hit->ng); },
        context.data().emitter);
}

}  // namespace steradian
