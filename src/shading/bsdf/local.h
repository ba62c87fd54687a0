// Lobes that scatter around a normal, in a frame of their own: z is the normal, on the side of wo, and x the direction
// of u. Such a lobe is two functions:
//   LocalEval eval_local(const Lobe&, Vec3d wo, Vec3d wi, bool outside);      wo.z > 0; wi on either side
//   std::optional<Vec3d> sample_local(const Lobe&, Vec3d wo, bool outside, float uc, Vec2 u);
// `outside` says which side of the geometric surface wo is on. The functions here make a lobe of the renderer of them.
#pragma once

#include "shading/bsdf/lobe.h"

namespace steradian {

struct LocalEval {
    Rgb f_cos;
    double pdf = 0;             ///< of sample_local choosing wi
    double radiance_scale = 1;  ///< the (η_i/η_t)² that is part of f_cos
    Rgb diffuse{};              ///< as in BsdfEval
};

/// The frame as seen from wo, and where the surface itself lies in it.
struct LocalFrame {
    Frame3d axes;
    Vec3d ng;  ///< on the side of wo
    bool outside = true;

    /// About the shading normal, or about the geometric one where wo is behind the other: what is seen is never black
    /// because its shading normal faces away. Nothing when wo lies in the surface.
    static std::optional<LocalFrame> seen_from(const LobeGeometry& g, Vec3 wo) {
        const Vec3d w = wo, n = g.ng, s = g.frame.z;
        const double side = dot(w, n);
        if (side == 0) return std::nullopt;
        const double sign = side > 0 ? 1 : -1;
        const bool agree = dot(w, s) * sign > 0;
        const Vec3d z = (agree ? s : n) * sign, along = g.frame.x;
        const Vec3d x = agree ? along : normalize(along - z * dot(along, z));
        return LocalFrame{{x, cross(z, x), z}, n * sign, side > 0};
    }
    Vec3d to_local(Vec3 w) const { return normalize(axes.to_local(w)); }
    /// A direction that is above by one normal and below by the other neither gives nor gets light: nothing leaks.
    bool agree_on(Vec3 w, Vec3d local) const {
        const double by_geometry = dot(Vec3d(w), ng);
        return (by_geometry > 0 && local.z > 0) || (by_geometry < 0 && local.z < 0);
    }
};

template <class Lobe>
LocalEval eval_in_frame(const Lobe& lobe, const LocalFrame& frame, Vec3 wo, Vec3 wi) {
    const Vec3d o = frame.to_local(wo), i = frame.to_local(wi);
    return o.z > 0 && frame.agree_on(wi, i) ? eval_local(lobe, o, i, frame.outside) : LocalEval{};
}

template <class Lobe>
BsdfEval eval_by_frame(const Lobe& lobe, const LobeGeometry& g, Vec3 wo, Vec3 wi) {
    const auto frame = LocalFrame::seen_from(g, wo);
    if (!frame) return {};
    const LocalEval e = eval_in_frame(lobe, *frame, wo, wi);
    return {e.f_cos, static_cast<float>(e.pdf), e.diffuse};
}

/// The direction is rounded to float first: weight and density are those of what is returned, to the bit those of eval.
/// Directions that the normals disagree about are given up, not redrawn.
template <class Lobe>
std::optional<BsdfSample> sample_by_frame(const Lobe& lobe, const LobeGeometry& g, Vec3 wo, float uc, Vec2 u) {
    const auto frame = LocalFrame::seen_from(g, wo);
    if (!frame) return std::nullopt;
    const Vec3d o = frame->to_local(wo);
    if (!(o.z > 0)) return std::nullopt;
    const std::optional<Vec3d> local = sample_local(lobe, o, frame->outside, uc, u);
    if (!local) return std::nullopt;
    const Vec3 wi = static_cast<Vec3>(normalize(frame->axes.to_world(*local)));
    const LocalEval e = eval_in_frame(lobe, *frame, wo, wi);
    const auto pdf = static_cast<float>(e.pdf);
    if (!(pdf > 0) || !is_finite(pdf)) return std::nullopt;
    const bool transmitted = dot(Vec3d(wi), frame->ng) < 0;
    return BsdfSample{wi, e.f_cos / pdf, pdf, false, transmitted, static_cast<float>(e.radiance_scale)};
}

}  // namespace steradian
