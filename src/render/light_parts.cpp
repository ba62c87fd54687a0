#include "render/light_parts.h"

namespace steradian {
namespace {

Rgb diffuse_share(const BsdfEval& e) {
    Rgb out;
    for (int c = 0; c < 3; ++c) out[c] = e.f_cos[c] > 0 ? clamp_to(e.diffuse[c] / e.f_cos[c], 0.0f, 1.0f) : 0.0f;
    return out;
}

}  // namespace

LightParts::LightParts(const RenderContext& context, uint32_t paths) {
    if (SumKinds(context.settings.aovs).light) states_.resize(paths);
}

uint64_t LightParts::bytes_per_path(AovSet aovs) noexcept { return SumKinds(aovs).light ? sizeof(State) : 0; }

void LightParts::found(uint32_t path, Rgb contribution, bool background) noexcept {
    State& state = states_[path];
    if (state.stage == Stage::camera) {
        Rgb& seen = part(state, background ? Aov::background : Aov::emission);
        seen = seen + contribution;
        return;
    }
    LightSplit split = state.split;
    split.direct = state.stage == Stage::first_surface;
    add(path, split, contribution);
}

LightSplit LightParts::split(uint32_t path, const Bsdf& bsdf, Vec3 wo, Vec3 wi,
                             const BsdfEval& scattered) const noexcept {
    const State& state = states_[path];
    if (state.stage != Stage::camera) return state.split;
    return {diffuse_share(scattered), on_two_sides(bsdf, wo, wi), true};
}

/// The two shares of a contribution c are c s and c - c s: together c, up to the rounding of the first.
void LightParts::add(uint32_t path, const LightSplit& split, Rgb contribution) noexcept {
    State& state = states_[path];
    if (split.transmitted) {
        Rgb& sum = part(state, split.direct ? Aov::transmission_direct : Aov::transmission_indirect);
        sum = sum + contribution;
        return;
    }
    Rgb& diffuse = part(state, split.direct ? Aov::diffuse_direct : Aov::diffuse_indirect);
    Rgb& specular = part(state, split.direct ? Aov::specular_direct : Aov::specular_indirect);
    const Rgb share = contribution * split.diffuse;
    diffuse = diffuse + share;
    specular = specular + Rgb{contribution.r - share.r, contribution.g - share.g, contribution.b - share.b};
}

void LightParts::turn(uint32_t path, const Bsdf& bsdf, Vec3 wo, const BsdfSample& next) noexcept {
    State& state = states_[path];
    if (state.stage != Stage::camera) {
        state.stage = Stage::later;
        return;
    }
    state.stage = Stage::first_surface;
    state.split = {next.specular ? Rgb{} : diffuse_share(eval(bsdf, wo, next.wi)), next.transmitted, false};
}

void LightParts::add_to(LightSum& sum, uint32_t path, float filter_weight) const noexcept {
    for (size_t i = 0; i < kLightParts; ++i) sum.parts[i].add(states_[path].parts[i], filter_weight);
}

}  // namespace steradian
