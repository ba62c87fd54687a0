// Several materials on one surface, each with its share of it: f = Σ w f, evaluated as a whole. Each part has a normal
// and a frame of its own.
#pragma once

#include <algorithm>

// All kinds that a part may be: they are visited here.
#include "shading/bsdf/conductor.h"
#include "shading/bsdf/diffuse.h"
#include "shading/bsdf/diffuse_transmission.h"
#include "shading/bsdf/fold.h"
#include "shading/bsdf/glass.h"
#include "shading/bsdf/mirror.h"
#include "shading/bsdf/open_pbr_coat.h"
#include "shading/bsdf/refraction.h"
#include "shading/bsdf/rough_glass.h"
#include "shading/bsdf/thin_glass.h"

namespace steradian {

inline bool lobe_is_specular(const MixBsdf& mix) {
    return std::all_of(mix.parts.begin(), mix.parts.begin() + mix.count, [](const MixBsdf::Part& part) {
        return std::visit([](const auto& lobe) { return lobe_is_specular(lobe); }, part.lobe);
    });
}

/// Light from behind one normal may come from before another one.
inline bool lobe_only_reflects(const MixBsdf& mix) {
    return std::all_of(mix.parts.begin(), mix.parts.begin() + mix.count, [&](const MixBsdf::Part& part) {
        return part.frame.z == mix.parts[0].frame.z &&
               std::visit([](const auto& lobe) { return lobe_only_reflects(lobe); }, part.lobe);
    });
}

inline BsdfEval eval_lobe(const MixBsdf& mix, const LobeGeometry& g, Vec3 wo, Vec3 wi) {
    BsdfEval out;
    for (uint32_t i = 0; i < mix.count; ++i) {
        const MixBsdf::Part& part = mix.parts[i];
        const BsdfEval e = eval_any(part.lobe, {g.ng, part.frame}, part.folded, wo, wi);
        out.f_cos = out.f_cos + e.f_cos * part.weight;
        out.pdf += e.pdf * part.weight;
        out.diffuse = out.diffuse + e.diffuse * part.weight;
    }
    return out;
}

/// A part is chosen by its weight. What is left of the number chooses within it.
inline std::optional<BsdfSample> sample_lobe(const MixBsdf& mix, const LobeGeometry& g, Vec3 wo, float uc, Vec2 u) {
    if (mix.count == 0) return std::nullopt;
    double left = uc;
    uint32_t chosen = 0;
    while (chosen + 1 < mix.count && left >= mix.parts[chosen].weight) left -= mix.parts[chosen++].weight;
    const MixBsdf::Part& part = mix.parts[chosen];
    const auto again = static_cast<float>(clamp_to(left / part.weight, 0.0, double{kOneMinusEpsilon}));
    std::optional<BsdfSample> out = sample_any(part.lobe, {g.ng, part.frame}, part.folded, wo, again, u);
    // A perfectly specular part keeps its weight: its share is the probability of having chosen it.
    if (!out || out->specular) return out;
    const BsdfEval e = eval_lobe(mix, g, wo, out->wi);
    if (!(e.pdf > 0) || !is_finite(e.pdf)) return std::nullopt;
    out->weight = e.f_cos / e.pdf;
    out->pdf = e.pdf;
    return out;
}

}  // namespace steradian
