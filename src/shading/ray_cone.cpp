#include "shading/ray_cone.h"

#include "math/elementary.h"
#include "math/transform.h"
#include "shading/bsdf.h"
#include "shading/shading_scene.h"
#include "shading/surface.h"

namespace steradian {
namespace {

constexpr double kLeastCosine = 0.01;  ///< at grazing incidence footprints have an end
constexpr double kMostSpread = 0.5;    ///< radians

double cosine_of(const SurfacePoint& point) {
    return max_of(std::fabs(dot(Vec3d(point.wo), Vec3d(point.ng))), kLeastCosine);
}

/// The mean over the three edges of what the normal turns along them, over their length.
double local_curvature(const Mesh& mesh, const SurfacePoint& point) {
    if (mesh.normals.empty()) return 0;
    const uint32_t* i = mesh.indices.data() + size_t(3) * point.prim;
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
        const uint32_t a = i[k], b = i[(k + 1) % 3];
        const Vec3d edge = Vec3d(mesh.positions[b]) - Vec3d(mesh.positions[a]);
        const Vec3d turned = normalize(Vec3d(mesh.normals[b])) - normalize(Vec3d(mesh.normals[a]));
        const double length2 = dot(edge, edge);
        if (length2 > 0) sum += std::fabs(dot(turned, edge)) / length2;
    }
    return sum / 3;
}
double local_curvature(const Sphere& sphere, const SurfacePoint&) { return 1 / static_cast<double>(sphere.radius); }
double local_curvature(const Rectangle&, const SurfacePoint&) { return 0; }
double local_curvature(const Disk&, const SurfacePoint&) { return 0; }

}  // namespace

double curvature_at(const ShadingScene& scene, const SurfacePoint& point) noexcept {
    const Instance& placed = scene.scene.instances[point.instance];
    const double local = std::visit(
        [&](const auto& shape) {
            if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, MeshId>)
                return local_curvature(scene.scene.meshes[index(shape)], point);
            else
                return local_curvature(shape, point);
        },
        scene.scene.shapes[index(placed.shape)]);
    // Of a shape that is scaled: by the mean of what happens to lengths.
    if (scene.transform_of(point.instance).identity || local == 0) return local;
    const double scale = math::pow(std::fabs(determinant(placed.world_from_object)), 1.0 / 3);
    return scale > 0 ? local / scale : 0;
}

float footprint_of(const RayCone& cone, const SurfacePoint& point) noexcept {
    return static_cast<float>(cone.width / cosine_of(point));
}

RayCone bounced(const RayCone& cone, const ShadingScene& scene, const SurfacePoint& point,
                const BsdfSample& sample) noexcept {
    // Over its footprint the normal turns by curvature times footprint, and a mirrored ray twice as much.
    double spread = cone.spread + 2 * curvature_at(scene, point) * footprint_of(cone, point);
    if (!sample.specular && sample.pdf > 0) spread += std::sqrt(1 / static_cast<double>(sample.pdf)) / 8;
    return {cone.width, static_cast<float>(min_of(spread, kMostSpread))};
}

}  // namespace steradian
