#include "lint/pieces.h"

#include <cmath>
#include <numbers>

#include "math/elementary.h"
#include "math/ray.h"
#include "math/transform.h"

namespace steradian::lint_detail {
namespace {

constexpr uint32_t kDiskPieces = 32;

Vec3d on_disk(const Disk& disk, uint32_t k) {
    const Frame3d frame = Frame3d::from_z(normalize(Vec3d(disk.normal)));
    const double phi = 2 * std::numbers::pi * k / kDiskPieces, r = disk.radius;
    return Vec3d(disk.center) + frame.x * (r * math::cos(phi)) + frame.y * (r * math::sin(phi));
}

std::optional<Corners> local_piece(const Scene& scene, const Shape& shape, uint32_t number) {
    if (const auto* id = std::get_if<MeshId>(&shape)) {
        const Mesh& mesh = scene.meshes[index(*id)];
        Corners out;
        for (size_t k = 0; k < 3; ++k) {
            const Vec3 p = mesh.positions[mesh.indices[3 * size_t(number) + k]];
            if (!usable_position(p)) return std::nullopt;
            out[k] = p;
        }
        return out;
    }
    if (const auto* r = std::get_if<Rectangle>(&shape)) {
        const Vec3d c = r->center, u = r->half_u, v = r->half_v;
        return number == 0 ? Corners{c - u - v, c + u - v, c + u + v} : Corners{c - u - v, c + u + v, c - u + v};
    }
    const auto& disk = std::get<Disk>(shape);
    return Corners{Vec3d(disk.center), on_disk(disk, number), on_disk(disk, number + 1)};
}

/// The distance along d to the triangle (Möller and Trumbore 1997).
std::optional<double> distance_to(const Corners& c, Vec3d o, Vec3d d) {
    const Vec3d e1 = c[1] - c[0], e2 = c[2] - c[0], p = cross(d, e2);
    const double det = dot(e1, p);
    if (det == 0) return std::nullopt;
    const Vec3d s = o - c[0], q = cross(s, e1);
    const double u = dot(s, p) / det, v = dot(d, q) / det;
    if (!(u >= 0 && v >= 0 && u + v <= 1)) return std::nullopt;
    return dot(e2, q) / det;
}

/// Whether the part of the ray comes near the box; `slack` for flat ones.
bool near_box(const Box& box, Vec3d o, Vec3d d, double from, double to, double slack) {
    for (int axis = 0; axis < 3; ++axis) {
        const double lo = box.lo[axis] - slack - o[axis], hi = box.hi[axis] + slack - o[axis];
        if (d[axis] == 0) {
            if (!(lo <= 0 && hi >= 0)) return false;
            continue;
        }
        const double a = lo / d[axis], b = hi / d[axis];
        from = max_of(from, min_of(a, b)), to = min_of(to, max_of(a, b));
    }
    return from <= to;
}

/// The two distances along d to a sphere that is transformed.
std::optional<std::array<double, 2>> distances_to(const Sphere& sphere, const Affine& place, Vec3d o, Vec3d d) {
    const auto inverse = usable_inverse(place);
    if (!inverse) return std::nullopt;
    const Vec3d p = transform_point(*inverse, o) - Vec3d(sphere.center), w = transform_vector(*inverse, d);
    const double a = dot(w, w), b = dot(p, w), c = dot(p, p) - double(sphere.radius) * sphere.radius,
                 root = b * b - a * c;
    if (!(root >= 0 && a > 0)) return std::nullopt;
    return std::array<double, 2>{(-b - std::sqrt(root)) / a, (-b + std::sqrt(root)) / a};
}

}  // namespace

uint64_t count_pieces(const Scene& scene, uint32_t instance) {
    const Shape& shape = scene.shapes[index(scene.instances[instance].shape)];
    if (const auto* id = std::get_if<MeshId>(&shape)) return scene.meshes[index(*id)].indices.size() / 3;
    if (std::holds_alternative<Rectangle>(shape)) return 2;
    return std::holds_alternative<Disk>(shape) ? kDiskPieces : 0;
}

std::optional<Corners> piece(const Scene& scene, uint32_t instance, uint32_t number) {
    const Instance& placed = scene.instances[instance];
    auto out = local_piece(scene, scene.shapes[index(placed.shape)], number);
    if (out)
        for (Vec3d& p : *out) p = transform_point(placed.world_from_object, p);
    return out;
}

bool Rays::meets(uint32_t instance, Vec3d o, Vec3d d, double from, double to) {
    const double slack = 1e-6 * (world_.all().size() + reach(o));
    if (!near_box(world_.box(instance), o, d, from, to, slack)) return false;
    const auto within = [&](double t) { return t >= from && t <= to; };
    const Instance& placed = scene_.instances[instance];
    if (const auto* sphere = std::get_if<Sphere>(&scene_.shapes[index(placed.shape)])) {
        const auto t = distances_to(*sphere, placed.world_from_object, o, d);
        return t && (within((*t)[0]) || within((*t)[1]));
    }
    const uint64_t count = count_pieces(scene_, instance);
    spent_ += count;
    for (uint32_t k = 0; k < count && spent_ <= kBudget; ++k) {
        const auto corners = piece(scene_, instance, k);
        const auto t = corners ? distance_to(*corners, o, d) : std::nullopt;
        if (t && within(*t)) return true;
    }
    return false;
}

std::optional<bool> Rays::blocked(Vec3d o, Vec3d d, double from, double to) {
    for (uint32_t i = 0; i < scene_.instances.size(); ++i) {
        if (++spent_ > kBudget) return std::nullopt;
        if (world_.visible_to_camera(i) && meets(i, o, d, from, to) && opaque(i)) return true;
    }
    return spent_ > kBudget ? std::nullopt : std::optional(false);
}

std::optional<uint32_t> Rays::cover(Vec3d o, Vec3d d, double from, double to, uint32_t but) {
    for (uint32_t i = 0; i < scene_.instances.size() && ++spent_ <= kBudget; ++i)
        if (i != but && meets(i, o, d, from, to) && opaque(i)) return i;
    return std::nullopt;
}

}  // namespace steradian::lint_detail
