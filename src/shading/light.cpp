#include "shading/light.h"

#include "shading/environment.h"
#include "shading/light/area.h"
#include "shading/light/directional.h"
#include "shading/light/goniometric.h"
#include "shading/light/infinite.h"
#include "shading/light/point.h"
#include "shading/light/spot.h"
#include "shading/shading_scene.h"

namespace steradian {

// A kind of light or emitter without its functions is a compile error in the visits below and in light/area.h.

uint32_t light_sample_count(const ShadingScene& scene, uint32_t light) noexcept {
    return std::visit([](const auto& kind) { return samples_wanted(kind); }, scene.scene.lights[light]);
}

namespace {

/// Null where the light is none, or has no parts.
const MeshEmitter* mesh_emitter(const ShadingScene& scene, uint32_t light) {
    return std::get_if<MeshEmitter>(&scene.lights[light].emitter);
}

}  // namespace

LightQuery part_query(const ShadingScene& scene, uint32_t light, const SurfacePoint& from, uint32_t choice) noexcept {
    LightQuery out;
    if (const MeshEmitter* emitter = mesh_emitter(scene, light))
        out = {&emitter->triangles, receiver_at(from), choice, kLightValues, {}};
    return out;
}

void prefetch_part(const ShadingScene& scene, uint32_t light, const LightQuery& part, PartMemory what) noexcept {
    if (!part.chosen) return;
    const Mesh& mesh = scene.scene.meshes[index(mesh_emitter(scene, light)->mesh)];
    const uint32_t* corner = mesh.indices.data() + size_t(3) * part.chosen->light;
    if (what == PartMemory::indices) {
        __builtin_prefetch(corner);
        __builtin_prefetch(corner + 2);
        return;
    }
    for (int k = 0; k < 3; ++k) __builtin_prefetch(&mesh.positions[corner[k]]);
}

std::optional<LightSample> sample_light(const ShadingScene& scene, uint32_t light, const SurfacePoint& from,
                                        uint32_t choice, Vec2 u, EnvironmentDensity density,
                                        const LightQuery* part) noexcept {
    const LightContext context{scene, light, density, part};
    return std::visit([&](const auto& kind) { return sample_kind(kind, context, from, choice, u); },
                      scene.scene.lights[light]);
}

float pdf_light(const ShadingScene& scene, uint32_t light, const SurfacePoint& from, Vec3 wi, const SurfacePoint* hit,
                EnvironmentDensity density) noexcept {
    const LightContext context{scene, light, density};
    return static_cast<float>(std::visit([&](const auto& kind) { return pdf_kind(kind, context, from, wi, hit); },
                                         scene.scene.lights[light]));
}

Rgb emitted_radiance(const ShadingScene& scene, const SurfacePoint& point, Vec3 wo) noexcept {
    const uint32_t light = scene.instances[point.instance].area_light;
    if (light == kNoLight) return {};
    if (scene.lights[light].of_material) return material_emission(scene, point, wo);
    const AreaLight& area = std::get<AreaLight>(scene.scene.lights[light]);
    const float side = dot(wo, point.ng);
    return side > 0 || (side < 0 && area.two_sided) ? area_radiance(scene, area, point) : Rgb{};
}

uint32_t distant_sources(const ShadingScene& scene) noexcept { return static_cast<uint32_t>(1 + scene.suns.size()); }

DistantRadiance distant_radiance(const ShadingScene& scene, uint32_t source, Vec3 d, bool from_camera,
                                 const SurfacePoint* from, EnvironmentDensity density) noexcept {
    const auto sees = [&](const auto& light) { return !from_camera || light.visible_to_camera; };
    DistantRadiance out;
    out.light = source == kEnvironmentSource ? scene.environment_light : scene.suns[source - 1];
    if (out.light == kNoLight) return out;
    if (const auto* sun = std::get_if<DirectionalLight>(&scene.scene.lights[out.light])) {
        if (sees(*sun)) out.radiance = disc_radiance(scene.lights[out.light], d);
    } else if (sees(std::get<EnvironmentLight>(scene.scene.lights[out.light]))) {
        const EnvironmentTable& table = *scene.environment;
        if (!table.is_constant()) {
            const MapPoint at = table.map_point(d);
            out.radiance = table.radiance_at(scene.scene, at);
            if (from && !table.empty())
                out.pdf = static_cast<float>(table.pdf_at(at, density_at(table, density, *from)));
            return out;
        }
        out.radiance = table.radiance(scene.scene, d);
    }
    if (from && !is_black(out.radiance)) out.pdf = pdf_light(scene, out.light, *from, d, nullptr, density);
    return out;
}

Rgb sky_radiance(const ShadingScene& scene, Vec3 d, bool from_camera) noexcept {
    Rgb sum = distant_radiance(scene, kEnvironmentSource, d, from_camera).radiance;
    for (uint32_t i = 1; i < distant_sources(scene); ++i)
        sum = sum + distant_radiance(scene, i, d, from_camera).radiance;
    return sum;
}

}  // namespace steradian
