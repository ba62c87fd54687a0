// A coat about a normal of its own. It lets pass what it does not reflect of the light from wo, as it is seen from
// there, to all that lies below it; both are folded at the surface where their normals come from maps (fold.h), so that
// as much as about one normal is kept, and nothing leaks. Fuzz has the normal of the base.
#pragma once

#include "shading/bsdf/fold.h"
#include "shading/bsdf/open_pbr.h"

namespace steradian {

struct OpenPbrCoatAlone {
    const OpenPbrBsdf& lobe;
    double share = 0;
};
inline LocalEval eval_local(const OpenPbrCoatAlone& coat, Vec3d wo, Vec3d wi, bool) {
    if (!(wi.z > 0)) return {};
    LocalEval out = eval_dielectric(coat.lobe.coat, coat.lobe.tables->coat_eta, wo, wi);
    out.f_cos = out.f_cos * static_cast<float>(coat.share);
    return out;
}
inline std::optional<Vec3d> sample_local(const OpenPbrCoatAlone& coat, Vec3d wo, bool, float, Vec2 u) {
    const std::optional<Vec3d> wi = reflect(wo, coat.lobe.coat.ggx().sample_visible(wo, u));
    return wi && wi->z > 0 ? wi : std::nullopt;
}

/// All but the coat. The probabilities of `shares` are those of the whole lobe.
struct OpenPbrBelowCoat {
    const OpenPbrBsdf& lobe;
    OpenPbrShares shares;
    double probability = 1;  ///< their sum, without the coat's
};
inline LocalEval eval_local(const OpenPbrBelowCoat& below, Vec3d wo, Vec3d wi, bool outside) {
    return eval_shares(below.lobe, below.shares, wo, wi, outside);
}
inline std::optional<Vec3d> sample_local(const OpenPbrBelowCoat& below, Vec3d wo, bool outside, float uc, Vec2 u) {
    return sample_shares(below.lobe, below.shares, wo, outside, uc * below.probability, u);
}

template <class Part>
requires std::is_same_v<Part, OpenPbrCoatAlone> || std::is_same_v<Part, OpenPbrBelowCoat> BsdfEval
eval_lobe(const Part& part, const LobeGeometry& g, Vec3 wo, Vec3 wi) {
    return eval_by_frame(part, g, wo, wi);
}
template <class Part>
requires std::is_same_v<Part, OpenPbrCoatAlone> || std::is_same_v<Part, OpenPbrBelowCoat> std::optional<BsdfSample>
sample_lobe(const Part& part, const LobeGeometry& g, Vec3 wo, float uc, Vec2 u) {
    return sample_by_frame(part, g, wo, uc, u);
}

/// The two of them as seen from wo; nothing where wo lies in the surface.
struct OpenPbrApart {
    OpenPbrCoatAlone coat;
    OpenPbrBelowCoat below;
    double p_coat = 0;

    static std::optional<OpenPbrApart> seen_from(const OpenPbrBsdf& lobe, const LobeGeometry& g, Vec3 wo) {
        const auto local = [&](const Frame& frame, bool folded) -> std::optional<Vec3d> {
            const auto seen = LocalFrame::seen_from({folded ? frame.z : g.ng, frame}, wo);
            return seen ? std::optional(seen->to_local(wo)) : std::nullopt;
        };
        const auto base = local(g.frame, lobe.base_folded), coat = local(lobe.coat_frame, lobe.coat_folded);
        if (!base || !coat || !(base->z > 0) || !(coat->z > 0)) return std::nullopt;
        OpenPbrShares shares(lobe, *base, *coat);
        const double p_coat = shares.p_coat;
        shares.p_coat = 0;
        return OpenPbrApart{{lobe, shares.coat}, {lobe, shares, 1 - p_coat}, p_coat};
    }

    BsdfEval eval(const LobeGeometry& g, Vec3 wo, Vec3 wi) const {
        const OpenPbrBsdf& lobe = coat.lobe;
        const BsdfEval c = eval_any(coat, {g.ng, lobe.coat_frame}, lobe.coat_folded, wo, wi);
        const BsdfEval b = eval_any(below, g, lobe.base_folded, wo, wi);
        return {c.f_cos + b.f_cos, static_cast<float>(c.pdf * p_coat + b.pdf), b.diffuse};
    }

    std::optional<BsdfSample> sample(const LobeGeometry& g, Vec3 wo, float uc, Vec2 u) const {
        const OpenPbrBsdf& lobe = coat.lobe;
        const auto again = [](double x) { return static_cast<float>(clamp_to(x, 0.0, double{kOneMinusEpsilon})); };
        std::optional<BsdfSample> out;
        if (uc < p_coat)
            out = sample_any(coat, {g.ng, lobe.coat_frame}, lobe.coat_folded, wo, again(uc / p_coat), u);
        else if (p_coat < 1)
            out = sample_any(below, g, lobe.base_folded, wo, again((uc - p_coat) / (1 - p_coat)), u);
        if (!out) return out;
        const BsdfEval e = eval(g, wo, out->wi);
        if (!(e.pdf > 0) || !is_finite(e.pdf)) return std::nullopt;
        out->weight = e.f_cos / e.pdf;
        out->pdf = e.pdf;
        return out;
    }
};

inline BsdfEval eval_lobe(const OpenPbrBsdf& lobe, const LobeGeometry& g, Vec3 wo, Vec3 wi) {
    if (!lobe.coat_apart) return eval_by_frame(lobe, g, wo, wi);
    const auto apart = OpenPbrApart::seen_from(lobe, g, wo);
    return apart ? apart->eval(g, wo, wi) : BsdfEval{};
}

inline std::optional<BsdfSample> sample_lobe(const OpenPbrBsdf& lobe, const LobeGeometry& g, Vec3 wo, float uc,
                                             Vec2 u) {
    if (!lobe.coat_apart) return sample_by_frame(lobe, g, wo, uc, u);
    const auto apart = OpenPbrApart::seen_from(lobe, g, wo);
    return apart ? apart->sample(g, wo, uc, u) : std::nullopt;
}

}  // namespace steradian
