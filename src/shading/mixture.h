// What the material of a surface is made of at a point.
#pragma once

#include <array>
#include <span>

#include "shading/shading_scene.h"
#include "shading/texture.h"

namespace steradian {

inline float eval_input(const ShadingScene& scene, const FloatInput& in, const SurfacePoint& point) {
    if (!in.texture) return in.value;
    return in.value * clamp_to(eval_texture(scene, *in.texture, point).r, 0.0f, 1.0f);
}
inline Rgb eval_input(const ShadingScene& scene, const ColorInput& in, const SurfacePoint& point) {
    return in.texture ? in.value * eval_color(scene, *in.texture, point) : in.value;
}

/// Materials that are no mixes, whose weights sum to 1; mixes within mixes are taken apart, and what has no weight is
/// left out.
class Mixture {
public:
    struct Share {
        MaterialId material;
        float weight;
    };

    Mixture(const ShadingScene& scene, const SurfacePoint& point, MaterialId id) { add(scene, point, id, 1); }
    std::span<const Share> parts() const { return {shares_.data(), count_}; }

private:
    void add(const ShadingScene& scene, const SurfacePoint& point, MaterialId id, float weight) {
        if (!(weight > 0)) return;
        const auto* mix = std::get_if<MixMaterial>(&scene.scene.materials[index(id)]);
        if (!mix) {
            shares_[count_++] = {id, weight};
            return;
        }
        const float second = eval_input(scene, mix->weight, point);
        add(scene, point, mix->first, weight * (1 - second));
        add(scene, point, mix->second, weight * second);
    }

    std::array<Share, kMaxMixed> shares_;
    uint32_t count_ = 0;
};

}  // namespace steradian
