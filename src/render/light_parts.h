// Light in parts, by what becomes of it at the first surface that a path meets: for each path of a batch.
#pragma once

#include <array>
#include <vector>

#include "render/integrator.h"
#include "shading/bsdf.h"

namespace steradian {

/// How the first surface divides what comes from one direction.
struct LightSplit {
    Rgb diffuse;  ///< the share of matte and fuzzy layers, 0 … 1 per channel; what is left is specular
    bool transmitted = false;
    bool direct = false;  ///< nothing but the first surface lies between the light and the camera
};

class LightParts {
public:
    /// For `paths` paths at a time; for none where no AOV asks.
    LightParts(const RenderContext& context, uint32_t paths);
    static uint64_t bytes_per_path(AovSet aovs) noexcept;

    bool wanted() const noexcept { return !states_.empty(); }
    void begin(uint32_t path) noexcept { states_[path] = {}; }
    /// Emission that the path's ray has found, of a surface or of the background.
    void found(uint32_t path, Rgb contribution, bool background) noexcept;
    /// How a light sample from the path's vertex will be divided, `scattered` being the vertex's BSDF for it.
    LightSplit split(uint32_t path, const Bsdf& bsdf, Vec3 wo, Vec3 wi, const BsdfEval& scattered) const noexcept;
    void add(uint32_t path, const LightSplit& split, Rgb contribution) noexcept;
    /// The path goes on from its vertex along `next`.
    void turn(uint32_t path, const Bsdf& bsdf, Vec3 wo, const BsdfSample& next) noexcept;
    void add_to(LightSum& sum, uint32_t path, float filter_weight) const noexcept;

private:
    /// What lies behind the ray under way: no vertex, one, or more.
    enum class Stage : uint8_t { camera, first_surface, later };
    struct State {
        Stage stage = Stage::camera;
        LightSplit split;  ///< of the first surface, for the direction in which the path has gone on
        std::array<Rgb, kLightParts> parts{};
    };
    Rgb& part(State& state, Aov part) noexcept { return state.parts[light_part(part)]; }

    std::vector<State> states_;
};

}  // namespace steradian
