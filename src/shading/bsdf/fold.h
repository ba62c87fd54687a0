// Lobes about a normal that a map has turned (relief.h).
//
// Such a lobe leans over: part of what it reflects would go into the surface, part of what it transmits would come out.
// Between the facets of real relief such light meets the surface again; as in microfacet-based normal mapping
// (Schüssler et al. 2017) it is reflected there, but by a mirror that lies in the surface itself: the lobe is folded at
// it. All of its energy stays, on the side where it belongs, and values, densities and samples follow from the lobe's
// own without anything new to integrate.
#pragma once

#include "shading/bsdf/lobe.h"

namespace steradian {

template <class OneLobe>
BsdfEval eval_flat(const OneLobe& lobe, const LobeGeometry& g, Vec3 wo, Vec3 wi) {
    return eval_lobe(lobe, g, wo, wi);
}
template <class... Kinds>
BsdfEval eval_flat(const std::variant<Kinds...>& any, const LobeGeometry& g, Vec3 wo, Vec3 wi) {
    return std::visit([&](const auto& lobe) { return eval_lobe(lobe, g, wo, wi); }, any);
}

template <class OneLobe>
std::optional<BsdfSample> sample_flat(const OneLobe& lobe, const LobeGeometry& g, Vec3 wo, float uc, Vec2 u) {
    return sample_lobe(lobe, g, wo, uc, u);
}
template <class... Kinds>
std::optional<BsdfSample> sample_flat(const std::variant<Kinds...>& any, const LobeGeometry& g, Vec3 wo, float uc,
                                      Vec2 u) {
    return std::visit([&](const auto& lobe) { return sample_lobe(lobe, g, wo, uc, u); }, any);
}

/// 1: the side that n points to, -1: the other one.
inline int side_of(Vec3 w, Vec3 n) {
    const double cosine = dot(Vec3d(w), Vec3d(n));
    return cosine > 0 ? 1 : cosine < 0 ? -1 : 0;
}

inline Vec3 mirrored_at(Vec3 n, Vec3 w) {
    return static_cast<Vec3>(normalize(Vec3d(w) - Vec3d(n) * (2 * dot(Vec3d(w), Vec3d(n)))));
}

/// What the lobe sends to wi, and what it would send to wi's image behind the surface; g as for the lobe without a
/// surface around it: g.ng is the surface's own, g.frame.z the turned normal.
template <class AnyLobe>
BsdfEval eval_folded(const AnyLobe& lobe, const LobeGeometry& g, Vec3 wo, Vec3 wi) {
    const Vec3 n = g.frame.z, image = mirrored_at(g.ng, wi);
    const int side = side_of(wi, g.ng);
    if (side == 0 || side_of(wo, g.ng) != side_of(wo, n)) return {};
    const LobeGeometry alone{n, g.frame};
    BsdfEval out;
    if (side_of(wi, n) == side) out = eval_flat(lobe, alone, wo, wi);
    if (side_of(image, n) != side) return out;
    const BsdfEval from_image = eval_flat(lobe, alone, wo, image);
    return {out.f_cos + from_image.f_cos, out.pdf + from_image.pdf, out.diffuse + from_image.diffuse};
}

template <class AnyLobe>
std::optional<BsdfSample> sample_folded(const AnyLobe& lobe, const LobeGeometry& g, Vec3 wo, float uc, Vec2 u) {
    const Vec3 n = g.frame.z;
    if (side_of(wo, g.ng) != side_of(wo, n)) return std::nullopt;
    std::optional<BsdfSample> out = sample_flat(lobe, {n, g.frame}, wo, uc, u);
    if (!out) return out;
    const int side = side_of(out->wi, n);
    if (side_of(out->wi, g.ng) != side) out->wi = mirrored_at(g.ng, out->wi);
    if (side == 0 || side_of(out->wi, g.ng) != side) return std::nullopt;
    if (out->specular) return out;
    const BsdfEval e = eval_folded(lobe, g, wo, out->wi);
    if (!(e.pdf > 0) || !is_finite(e.pdf)) return std::nullopt;
    out->weight = e.f_cos / e.pdf;
    out->pdf = e.pdf;
    return out;
}

template <class AnyLobe>
BsdfEval eval_any(const AnyLobe& lobe, const LobeGeometry& g, bool folded, Vec3 wo, Vec3 wi) {
    return folded ? eval_folded(lobe, g, wo, wi) : eval_flat(lobe, g, wo, wi);
}

template <class AnyLobe>
std::optional<BsdfSample> sample_any(const AnyLobe& lobe, const LobeGeometry& g, bool folded, Vec3 wo, float uc,
                                     Vec2 u) {
    return folded ? sample_folded(lobe, g, wo, uc, u) : sample_flat(lobe, g, wo, uc, u);
}

}  // namespace steradian
