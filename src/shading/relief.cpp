#include "shading/relief.h"

#include "math/elementary.h"
#include "shading/texture.h"

namespace steradian {
namespace {

/// The part of v that is perpendicular to n, of unit length; zero where there is none.
Vec3d along_surface(Vec3d v, Vec3d n) { return normalize(v - n * dot(v, n)); }

/// u, and what is perpendicular to it; texture coordinates may be mirrored on the surface: -v is on either side of u.
struct TangentAxes {
    Vec3d x, up;
    bool mirrored = false;  ///< -v is on the side of -up
    TangentAxes(const SurfaceDerivatives& d, Vec3d n) {
        const double sign = d.determinant > 0 ? 1 : -1;
        x = along_surface(d.du * sign, n);
        up = cross(n, x);
        mirrored = dot(up, d.dv * sign) > 0;
    }
};

Vec3d by_map(const NormalMap& map, Rgb texel, const SurfaceDerivatives& d, Vec3d n) {
    const auto [x, up, mirrored] = TangentAxes(d, n);
    const double strength = map.strength, r = (2.0 * texel.r - 1) * strength, g = (2.0 * texel.g - 1) * strength;
    return x * r + up * (mirrored != map.flip_y ? -g : g) + n * (2.0 * texel.b - 1);
}

/// n - ∇h, with the gradient on the surface by the dual of dp/du and dp/dv (Mikkelsen 2010, "Bump Mapping
/// Unparametrized Surfaces on the GPU", equation 7, for derivatives that are known).
Vec3d by_heights(Vec2 slope, double scale, const SurfaceDerivatives& d, Vec3d n) {
    const double across = dot(n, cross(d.du, d.dv));
    const Vec3d gradient = cross(d.dv, n) * slope.x + cross(n, d.du) * slope.y;
    return n - gradient * (scale * d.determinant / across);
}

}  // namespace

Vec3d visible_normal(Vec3d n, Vec3d ng, Vec3d wo) noexcept {
    // In the plane of both normals: z along ng, x on the side to which n leans.
    const Vec3d x = along_surface(n, ng);
    double nx = dot(n, x), nz = dot(n, ng);
    if (!(nx > 0)) return n;
    const double side = dot(wo, ng) < 0 ? -1 : 1, wx = dot(wo, x) * side, wz = dot(wo, ng) * side;
    const double seen = kLeastSeen * wz;
    if (nz >= kLeastUpright && wx * nx + wz * nz >= seen) return n;
    if (nz < kLeastUpright) {
        nz = kLeastUpright;
        nx = std::sqrt(1 - nz * nz);
    }
    if (wx * nx + wz * nz < seen) {
        // The two unit vectors whose dot product with (wx, wz) is `seen`; this one leans to x.
        const double length2 = wx * wx + wz * wz, root = std::sqrt(max_of(length2 - seen * seen, 0.0));
        nx = (seen * wx + root * wz) / length2;
        nz = (seen * wz - root * wx) / length2;
    }
    return normalize(x * nx + ng * nz);
}

ReliefNormal relief_normal(const ShadingScene& scene, const SurfacePoint& point, const Relief& relief) noexcept {
    const ReliefNormal flat{point.ns, false};
    SurfaceDerivatives d;
    const Vec3d own = point.ns;
    Vec3d n;
    if (const auto* map = std::get_if<NormalMap>(&relief.map)) {
        const Rgb texel = eval_texture(scene, map->texture, point);
        d = tangents_at(scene, point, uv_set_of(scene.scene, map->texture));
        if (map->strength == 0 || (texel.r == 0.5f && texel.g == 0.5f)) return flat;
        n = by_map(*map, texel, d, own);
    } else {
        const auto& bump = std::get<BumpMap>(relief.map);
        d = derivatives_at(scene, point, uv_set_of(scene.scene, bump.texture));
        const Vec2 slope = texture_slope(scene, bump.texture, point);
        if (bump.scale == 0 || slope == Vec2{0, 0}) return flat;
        n = by_heights(slope, bump.scale, d, own);
    }
    const double size = length(n);
    if (!(size > 0) || !std::isfinite(size) || d.determinant == 0) return flat;
    return {static_cast<Vec3>(visible_normal(n * (1 / size), point.ng, point.wo)), true};
}

Vec3 grain_at(const ShadingScene& scene, const SurfacePoint& point, const GrainDirection& grain) noexcept {
    if (grain.rotation == 0 && !grain.texture) return tangent_at(scene, point);
    double x = 1, y = 0;
    uint32_t uv_set = 0;
    if (grain.texture) {
        const Rgb texel = eval_texture(scene, *grain.texture, point);
        uv_set = uv_set_of(scene.scene, *grain.texture);
        x = 2.0 * texel.r - 1, y = 2.0 * texel.g - 1;
        if (!(x * x + y * y > 0)) x = 1, y = 0;
    }
    const double angle = grain.rotation * (std::numbers::pi / 180), c = math::cos(angle), s = math::sin(angle);
    const SurfaceDerivatives d = tangents_at(scene, point, uv_set);
    if (d.determinant == 0) return {};
    const TangentAxes axes(d, point.ns);
    const double across = (s * x + c * y) * (axes.mirrored ? -1 : 1);
    return static_cast<Vec3>(normalize(axes.x * (c * x - s * y) + axes.up * across));
}

}  // namespace steradian
