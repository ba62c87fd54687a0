#include "lint/bodies.h"

#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "math/elementary.h"
#include "math/ray.h"
#include "math/transform.h"

namespace steradian::lint_detail {
namespace {

/// Signed, of a triangle seen from the origin.
double solid_angle(Vec3d a, Vec3d b, Vec3d c) {
    const double la = length(a), lb = length(b), lc = length(c);
    const double up = dot(a, cross(b, c)), down = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    return up == 0 ? 0 : 2 * math::atan2(up, down);
}

}  // namespace

double winding_number(const Mesh& mesh, Vec3d p, const Components* components, uint32_t without) {
    constexpr size_t kChunk = 1 << 14;
    const size_t triangles = mesh.indices.size() / 3;
    std::vector<double> sums((triangles + kChunk - 1) / kChunk);
    parallel_for(triangles, kChunk, [&](size_t begin, size_t end) {
        double sum = 0;
        for (size_t t = begin; t < end; ++t) {
            if (components && components->of_triangle[t] == without) continue;
            Vec3d corner[3];
            bool usable = true;
            for (size_t k = 0; k < 3; ++k) {
                const Vec3 position = mesh.positions[mesh.indices[3 * t + k]];
                usable = usable && usable_position(position);
                corner[k] = Vec3d(position) - p;
            }
            if (usable) sum += solid_angle(corner[0], corner[1], corner[2]);
        }
        sums[begin / kChunk] = sum;
    });
    double total = 0;
    for (const double sum : sums) total += sum;
    return total * (1 / (4 * std::numbers::pi));
}

std::shared_ptr<const Topology> Bodies::topology(MeshId id) {
    if (!last_ || last_mesh_ != id) {
        last_.reset();  // before the next one takes its memory
        last_ = std::make_shared<const Topology>(topology_of(scene_.meshes[index(id)]));
        last_mesh_ = id;
    }
    return last_;
}

bool Bodies::closed(uint32_t instance) {
    const Shape& shape = scene_.shapes[index(scene_.instances[instance].shape)];
    const auto* id = std::get_if<MeshId>(&shape);
    if (!id) return std::holds_alternative<Sphere>(shape);
    auto known = closed_.find(*id);
    if (known == closed_.end()) {
        const Mesh& mesh = scene_.meshes[index(*id)];
        known = closed_.emplace(*id, mesh.indices.size() >= 12 && topology(*id)->closed()).first;
    }
    return known->second;
}

std::optional<bool> Bodies::inside(uint32_t instance, Vec3d point) {
    const auto object_from_world = usable_inverse(scene_.instances[instance].world_from_object);
    if (!object_from_world) return std::nullopt;
    const Vec3d p = transform_point(*object_from_world, point);
    const Shape& shape = scene_.shapes[index(scene_.instances[instance].shape)];
    if (const auto* sphere = std::get_if<Sphere>(&shape)) {
        constexpr double kNear = 1e-4;
        const double d = length(p - Vec3d(sphere->center)) / double(sphere->radius);
        if (std::fabs(d - 1) < kNear) return std::nullopt;
        return d < 1;
    }
    const auto* id = std::get_if<MeshId>(&shape);
    if (!id) return std::nullopt;
    const Box& box = world_.mesh_box(*id);
    if (box.empty() || !box.contains(p)) return false;
    const Mesh& mesh = scene_.meshes[index(*id)];
    spent_ += mesh.indices.size() / 3;
    if (spent_ > kBudget) return std::nullopt;
    constexpr double kUnsure = 0.01;
    const double w = winding_number(mesh, p), whole = std::floor(w + 0.5);
    if (!(std::fabs(w - whole) < kUnsure)) return std::nullopt;
    return whole != 0;
}

}  // namespace steradian::lint_detail
