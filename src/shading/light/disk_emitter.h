#pragma once

#include <optional>

#include "math/warp.h"
#include "shading/light/emitter.h"

namespace steradian {

inline double emitter_pdf(const DiskEmitter& disk, const EmitterContext&, Vec3d from, Vec3d p, Vec3d) {
    return solid_angle_pdf(1 / disk.area, p - from, disk.normal);
}

inline std::optional<EmitterSample> sample_emitter(const DiskEmitter& disk, const EmitterContext& context, Vec3d from,
                                                   uint32_t, Vec2 u) {
    if (!emits_towards(disk.center, disk.normal, from, context.two_sided)) return std::nullopt;
    const warp::DiskPoint at = warp::disk(u);
    EmitterSample out;
    out.p = disk.center + disk.axis_u * at.x + disk.axis_v * at.y;
    out.u = static_cast<float>(at.x), out.v = static_cast<float>(at.y);
    out.n = disk.normal;
    out.p_error = disk.p_error;
    out.pdf = emitter_pdf(disk, context, from, out.p, out.n);
    return out;
}

}  // namespace steradian
