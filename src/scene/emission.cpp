#include "scene/emission.h"

namespace steradian {

Emission emission_of(const Scene& scene, MaterialId material) {
    if (const auto* mix = std::get_if<MixMaterial>(&scene.materials[index(material)])) {
        const Emission a = emission_of(scene, mix->first), b = emission_of(scene, mix->second);
        const float second = mix->weight.value, first = mix->weight.texture ? 1 : 1 - second;
        return {a.radiance * first + b.radiance * second, a.two_sided || b.two_sided,
                a.textured || b.textured || mix->weight.texture.has_value()};
    }
    const auto* m = std::get_if<OpenPbrMaterial>(&scene.materials[index(material)]);
    if (!m || m->emission_luminance == 0) return {};
    return {m->emission_color.value * m->emission_luminance, m->geometry_thin_walled,
            m->emission_color.texture.has_value()};
}

void add_emission(Scene& scene) {
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
        const Emission emission = emission_of(scene, scene.instances[i].material);
        if (is_black(emission.radiance)) continue;
        AreaLight light;
        light.instance = InstanceId{i};
        light.radiance = emission.radiance;
        light.two_sided = emission.two_sided;
        scene.lights.push_back(light);
    }
}

}  // namespace steradian
