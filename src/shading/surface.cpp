#include "shading/surface.h"

#include <bit>

#include "math/elementary.h"
#include "math/transform.h"
#include "shading/shading_scene.h"
#include "shading/surface_error.h"

namespace steradian {
namespace {

/// A hit in the space of its shape.
struct LocalSurface {
    Vec3d p;
    Vec3d n;   ///< geometric, outwards, of any length
    Vec3d ns;  ///< shading, of any length; zero where the shape has none of its own
    Vec2 uv;
    double slack = 0;  ///< see surface_error
};

Vec3d blend(const Vec3d (&v)[3], double b0, double b1, double b2) { return v[0] * b0 + v[1] * b1 + v[2] * b2; }

/// `hit`: weights of b and c.
Vec2 blend(Vec2 a, Vec2 b, Vec2 c, Vec2 hit) {
    const double b1 = hit.x, b2 = hit.y, b0 = 1 - b1 - b2;
    return {static_cast<float>(b0 * a.x + b1 * b.x + b2 * c.x), static_cast<float>(b0 * a.y + b1 * b.y + b2 * c.y)};
}

LocalSurface local_surface(const Mesh& mesh, const LocalRay&, const Hit& hit) {
    const uint32_t* i = mesh.indices.data() + size_t(3) * hit.prim;
    const Vec3d v[3] = {mesh.positions[i[0]], mesh.positions[i[1]], mesh.positions[i[2]]};
    const double b1 = hit.u, b2 = hit.v, b0 = 1 - b1 - b2;
    LocalSurface out;
    out.p = blend(v, b0, b1, b2);
    const Vec3d e1 = v[1] - v[0], e2 = v[2] - v[0], e3 = v[2] - v[1];
    out.n = cross(e1, e2);
    const double size = std::sqrt(max_of(dot(e1, e1), max_of(dot(e2, e2), dot(e3, e3))));
    const double reach = max_of(max_component(abs(v[0])), max_of(max_component(abs(v[1])), max_component(abs(v[2]))));
    out.slack = flat_slack(size, reach, length(out.n));
    if (!mesh.normals.empty()) {
        // Each vertex normal counts as a direction, whatever its length.
        const Vec3d n[3] = {normalize(Vec3d(mesh.normals[i[0]])), normalize(Vec3d(mesh.normals[i[1]])),
                            normalize(Vec3d(mesh.normals[i[2]]))};
        out.ns = blend(n, b0, b1, b2);
    }
    out.uv = {hit.u, hit.v};
    if (!mesh.uvs.empty()) {
        out.uv = blend(mesh.uvs[i[0]], mesh.uvs[i[1]], mesh.uvs[i[2]], {hit.u, hit.v});
    }
    return out;
}

LocalSurface local_surface(const Sphere& sphere, const LocalRay& ray, const Hit& hit) {
    // hit.t is rounded to float, which far from a small sphere is worth more than its radius: the root is found again,
    // in double, from the foot of the perpendicular (Haines et al., Ray Tracing Gems, chapter 7), and the point put
    // onto the sphere.
    const Vec3d center = sphere.center;
    const double r = sphere.radius;
    const Vec3d oc = ray.o - center;
    const double dd = dot(ray.d, ray.d);
    const double foot = -dot(oc, ray.d) / dd;
    const Vec3d nearest = oc + ray.d * foot;
    const double half = std::sqrt(max_of(r * r - dot(nearest, nearest), 0.0) / dd);
    const double near = foot - half, far = foot + half, t_hit = hit.t;
    const bool is_near = static_cast<float>(near) == hit.t || std::fabs(t_hit - near) < std::fabs(t_hit - far);
    const double t = is_near ? -half : half;
    const Vec3d n = normalize(nearest + ray.d * t);
    LocalSurface out;
    out.n = n;
    out.p = center + n * r;
    out.slack = sphere_slack(r, max_component(abs(center)) + r);
    double turn = math::atan2(-n.z, n.x) / (2 * std::numbers::pi);
    if (turn < 0) turn += 1;
    const double fall = math::atan2(std::sqrt(n.x * n.x + n.z * n.z), n.y) / std::numbers::pi;
    out.uv = {static_cast<float>(turn), static_cast<float>(fall)};
    return out;
}

LocalSurface parallelogram(Vec3d center, Vec3d half_u, Vec3d half_v, const Hit& hit) {
    LocalSurface out;
    out.p = center + half_u * hit.u + half_v * hit.v;
    out.n = cross(half_u, half_v);
    const double lu = length(half_u), lv = length(half_v);
    out.slack = flat_slack(2 * (lu + lv), max_component(abs(center)) + lu + lv, 4 * length(out.n));
    out.uv = {static_cast<float>((hit.u + 1.0) / 2), static_cast<float>((1.0 - hit.v) / 2)};
    return out;
}

LocalSurface local_surface(const Rectangle& r, const LocalRay&, const Hit& hit) {
    return parallelogram(r.center, r.half_u, r.half_v, hit);
}

LocalSurface local_surface(const Disk& disk, const LocalRay&, const Hit& hit) {
    const DiskAxes axes = disk_axes(disk);
    return parallelogram(disk.center, axes.u, axes.v, hit);
}

/// Null where there is no such set.
const std::vector<Vec2>* further_uvs(const Mesh& mesh, uint32_t uv_set) {
    if (uv_set == 0 || uv_set > mesh.more_uvs.size() || mesh.more_uvs[uv_set - 1].empty()) return nullptr;
    return &mesh.more_uvs[uv_set - 1];
}
const Mesh* mesh_of(const Scene& scene, const SurfacePoint& point) {
    const auto* id = std::get_if<MeshId>(&scene.shapes[index(scene.instances[point.instance].shape)]);
    return id ? &scene.meshes[index(*id)] : nullptr;
}

SurfaceDerivatives local_derivatives(const Mesh& mesh, const SurfacePoint& point, uint32_t uv_set, Vec3d) {
    const uint32_t* i = mesh.indices.data() + size_t(3) * point.prim;
    const Vec3d p0 = mesh.positions[i[0]], e1 = Vec3d(mesh.positions[i[1]]) - p0, e2 = Vec3d(mesh.positions[i[2]]) - p0;
    const std::vector<Vec2>* further = further_uvs(mesh, uv_set);
    const std::vector<Vec2>& uvs = further ? *further : mesh.uvs;
    if (uvs.empty()) return {e1, e2, 1};
    const Vec2 a = uvs[i[0]], b = uvs[i[1]], c = uvs[i[2]];
    const double du1 = static_cast<double>(b.x) - a.x, dv1 = static_cast<double>(b.y) - a.y;
    const double du2 = static_cast<double>(c.x) - a.x, dv2 = static_cast<double>(c.y) - a.y;
    return {e1 * dv2 - e2 * dv1, e2 * du1 - e1 * du2, du1 * dv2 - du2 * dv1};
}
/// `n` is the normal of any length. At the poles v has no direction.
SurfaceDerivatives local_derivatives(const Sphere& sphere, const SurfacePoint&, uint32_t, Vec3d n) {
    const double around = std::sqrt(n.x * n.x + n.z * n.z), size = length(n) / (std::numbers::pi * sphere.radius);
    const Vec3d du{n.z, 0, -n.x};
    if (!(around > 0)) return {{}, {}, 0};
    const Vec3d dv = Vec3d{n.y * n.x / around, -around, n.y * n.z / around} * 0.5;
    return {du, dv, size / 2};
}
SurfaceDerivatives local_derivatives(const Rectangle& r, const SurfacePoint&, uint32_t, Vec3d) {
    return {r.half_u, -Vec3d(r.half_v), 0.5};
}
SurfaceDerivatives local_derivatives(const Disk& disk, const SurfacePoint&, uint32_t, Vec3d) {
    const DiskAxes axes = disk_axes(disk);
    return {axes.u, -Vec3d(axes.v), 0.5};
}

/// The next float up or down from a finite one.
float next_after(float x, bool up) {
    if (x == 0) return up ? 0x1p-149f : -0x1p-149f;
    const auto bits = std::bit_cast<uint32_t>(x);
    return std::bit_cast<float>((x > 0) == up ? bits + 1 : bits - 1);
}

}  // namespace

SurfacePoint surface_at(const ShadingScene& scene, const Ray& ray, const Hit& hit) noexcept {
    const Instance& placed = scene.scene.instances[hit.instance];
    const ShadingScene::TransformData& instance = scene.transform_of(hit.instance);
    const LocalRay local = local_ray(instance, ray);
    const LocalSurface s = std::visit(
        [&](const auto& shape) {
            if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, MeshId>)
                return local_surface(scene.scene.meshes[index(shape)], local, hit);
            else
                return local_surface(shape, local, hit);
        },
        scene.scene.shapes[index(placed.shape)]);

    const auto to_world = [&](Vec3d n) {
        return normalize(instance.identity ? n : transform_normal_by_inverse(instance.object_from_world, n));
    };
    const Vec3d p = instance.identity ? s.p : transform_point(placed.world_from_object, s.p);
    const Vec3d ng = to_world(s.n);
    const Vec3d ns = to_world(s.ns);
    const double side = dot(ns, ng);

    SurfacePoint out;
    out.p = static_cast<Vec3>(p);
    out.p_error = surface_error(placed.world_from_object, instance, s.p, p, s.slack);
    out.ng = static_cast<Vec3>(ng);
    out.ns = static_cast<Vec3>(side > 0 ? ns : side < 0 ? -ns : ng);
    out.uv = s.uv;
    out.wo = -ray.d;
    out.hit_uv = {hit.u, hit.v};
    out.instance = hit.instance;
    out.prim = hit.prim;
    return out;
}

SurfaceDerivatives derivatives_at(const ShadingScene& scene, const SurfacePoint& point, uint32_t uv_set) noexcept {
    const Instance& placed = scene.scene.instances[point.instance];
    const Affine& world_from_object = placed.world_from_object;
    // n_world = M⁻ᵀ n_object up to its length, so n_object = Mᵀ n_world.
    const Vec3d ng = transform_normal_by_inverse(world_from_object, Vec3d(point.ng));
    SurfaceDerivatives out = std::visit(
        [&](const auto& shape) {
            if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, MeshId>)
                return local_derivatives(scene.scene.meshes[index(shape)], point, uv_set, ng);
            else
                return local_derivatives(shape, point, uv_set, ng);
        },
        scene.scene.shapes[index(placed.shape)]);
    out.du = transform_vector(world_from_object, out.du);
    out.dv = transform_vector(world_from_object, out.dv);
    return out;
}

Vec2 uv_at(const ShadingScene& scene, const SurfacePoint& point, uint32_t uv_set) noexcept {
    const Mesh* mesh = uv_set == 0 ? nullptr : mesh_of(scene.scene, point);
    const std::vector<Vec2>* uvs = mesh ? further_uvs(*mesh, uv_set) : nullptr;
    if (!uvs) return point.uv;
    const uint32_t* i = mesh->indices.data() + size_t(3) * point.prim;
    return blend((*uvs)[i[0]], (*uvs)[i[1]], (*uvs)[i[2]], point.hit_uv);
}

SurfaceDerivatives tangents_at(const ShadingScene& scene, const SurfacePoint& point, uint32_t uv_set) noexcept {
    const Mesh* mesh = mesh_of(scene.scene, point);
    if (!mesh || mesh->tangents.empty()) return derivatives_at(scene, point, uv_set);
    const uint32_t* i = mesh->indices.data() + size_t(3) * point.prim;
    const double b1 = point.hit_uv.x, b2 = point.hit_uv.y, weights[3] = {1 - b1 - b2, b1, b2};
    Vec3d along, n;
    double side = 0;
    for (size_t k = 0; k < 3; ++k) {
        const Tangent& t = mesh->tangents[i[k]];
        along = along + Vec3d(t.direction) * weights[k];
        side += t.side * weights[k];
        if (!mesh->normals.empty()) n = n + normalize(Vec3d(mesh->normals[i[k]])) * weights[k];
    }
    if (!(length(n) > 0)) {
        const Vec3d p0 = mesh->positions[i[0]];
        n = cross(Vec3d(mesh->positions[i[1]]) - p0, Vec3d(mesh->positions[i[2]]) - p0);
    }
    const Vec3d down = cross(along, n) * (side < 0 ? -1.0 : 1.0);
    if (!(length(down) > 0)) return derivatives_at(scene, point, uv_set);
    const Affine& world_from_object = scene.scene.instances[point.instance].world_from_object;
    return {transform_vector(world_from_object, along), transform_vector(world_from_object, down), 1};
}

Vec3 tangent_at(const ShadingScene& scene, const SurfacePoint& point) noexcept {
    const SurfaceDerivatives d = tangents_at(scene, point);
    const double sign = d.determinant > 0 ? 1 : d.determinant < 0 ? -1 : 0;
    return static_cast<Vec3>(normalize(d.du * sign));
}

SurfacePoint facing(SurfacePoint point, Vec3 wo) noexcept {
    if (dot(point.ng, wo) < 0) {
        point.ng = -point.ng;
        point.ns = -point.ns;
    }
    return point;
}

DiskAxes disk_axes(const Disk& disk) noexcept {
    const Frame frame = Frame::from_z(normalize(disk.normal));
    return {frame.x * disk.radius, frame.y * disk.radius};
}

Vec3 offset_origin(Vec3 p, Vec3 p_error, Vec3 n, Vec3 direction) noexcept {
    // The support of the box p ± p_error in the direction of n. The factor covers that n is rounded to float.
    const Vec3d m = abs(Vec3d(n));
    const double support = dot(m, Vec3d(p_error)) * (1 + 0x1p-20);
    const double sign = dot(Vec3d(n), Vec3d(direction)) < 0 ? -1 : 1;
    const Vec3d move = Vec3d(n) * (support * sign);
    Vec3 out;
    for (int i = 0; i < 3; ++i) {
        out[i] = static_cast<float>(static_cast<double>(p[i]) + move[i]);
        if (n[i] != 0) out[i] = next_after(out[i], n[i] * sign > 0);
    }
    return out;
}

Ray spawn_ray(const SurfacePoint& from, Vec3 direction) noexcept {
    return {offset_origin(from.p, from.p_error, from.ng, direction), 0, direction, kInfinity};
}

}  // namespace steradian
