// Solid transparent bodies whose surface does not enclose them: what goes in never comes out as it should.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "lint/check.h"
#include "math/transform.h"

namespace steradian::lint_detail {
namespace {

/// Perfect refraction is made for single sheets (docs/conventions.md).
bool needs_a_body(const Scene& scene, MaterialId id) {
    const Material& material = scene.materials[index(id)];
    if (std::holds_alternative<RefractionMaterial>(material)) return false;
    if (const auto* mix = std::get_if<MixMaterial>(&material))
        return needs_a_body(scene, mix->first) || needs_a_body(scene, mix->second);
    return optics_of(scene, id).solid;
}

/// Seen from above, water fills what is below: its surface needs no bottom. By the share of its area that faces up.
constexpr double kLevel = 0.8;

bool is_level(const Scene& scene, uint32_t instance, const Mesh& mesh) {
    const Affine& world_from_object = scene.instances[instance].world_from_object;
    Vec3d sum;
    double total = 0;
    for (size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
        const auto p = [&](size_t k) {
            return transform_point(world_from_object, mesh.positions[mesh.indices[t + k]]);
        };
        const Vec3d n = cross(p(1) - p(0), p(2) - p(0));
        if (!std::isfinite(length(n))) continue;
        sum = sum + n;
        total += length(n);
    }
    return std::fabs(sum.y) > kLevel * total;
}
bool is_level(const Scene& scene, uint32_t instance, Vec3d u, Vec3d v) {
    const Affine& world_from_object = scene.instances[instance].world_from_object;
    const Vec3d n = normalize(cross(transform_vector(world_from_object, u), transform_vector(world_from_object, v)));
    return std::fabs(n.y) > kLevel;
}

/// Loose edges of a mesh as pairs of points.
struct Rim {
    Vec3 a, b;
    bool operator<(const Rim& o) const {
        return std::tuple(a.x, a.y, a.z, b.x, b.y, b.z) < std::tuple(o.a.x, o.a.y, o.a.z, o.b.x, o.b.y, o.b.z);
    }
};

class OpenGlass {
public:
    explicit OpenGlass(Check& check) : check_(check), scene_(check.scene) {}

    void run() {
        for (uint32_t i = 0; i < scene_.instances.size(); ++i)
            if (needs_a_body(scene_, scene_.instances[i].material))
                std::visit([&](const auto& shape) { look_at(i, shape); },
                           scene_.shapes[index(scene_.instances[i].shape)]);
    }

private:
    void look_at(uint32_t, const Sphere&) {}
    void look_at(uint32_t i, const Rectangle& r) {
        if (!is_level(scene_, i, r.half_u, r.half_v)) sheet(i, "a rectangle");
    }
    void look_at(uint32_t i, const Disk& d) {
        const Frame3d frame = Frame3d::from_z(normalize(Vec3d(d.normal)));
        if (!is_level(scene_, i, frame.x, frame.y)) sheet(i, "a disk");
    }
    void sheet(uint32_t i, const char* kind) {
        add(i, fmt::format("{} is {} of solid glass ({}): what passes stays inside for ever", check_.object(i), kind,
                           check_.material(scene_.instances[i].material)));
    }

    void look_at(uint32_t i, MeshId id) {
        // The first instance stands for all of a mesh.
        const Mesh& mesh = scene_.meshes[index(id)];
        if (mesh.indices.empty() || !seen_.insert(id).second) return;
        std::vector<LooseEdge> loose = check_.bodies.topology(id)->loose;
        if (!loose.empty() && !close_by_neighbours(i, id, loose)) return;
        const std::vector<Hole> holes = holes_of(mesh, loose);
        if (holes.empty() || is_level(scene_, i, mesh)) return;
        uint64_t edges = 0;
        for (const Hole& hole : holes) edges += hole.edges;
        const Affine& place = scene_.instances[i].world_from_object;
        const Vec3d a = transform_point(place, holes[0].from), b = transform_point(place, holes[0].to);
        add(i, fmt::format("{} of solid glass ({}) is open: {} with {} edges, the first from ({:.5g}, {:.5g}, {:.5g}) "
                           "to ({:.5g}, {:.5g}, {:.5g})",
                           check_.object(i), check_.material(scene_.instances[i].material),
                           holes.size() == 1 ? "1 hole" : fmt::format("{} holes", holes.size()), edges, a.x, a.y, a.z,
                           b.x, b.y, b.z));
    }

    /// What another mesh in the same place has on its edges: a body of several materials is closed by all of them.
    /// False where it would take too long to find out.
    bool close_by_neighbours(uint32_t i, MeshId id, std::vector<LooseEdge>& loose) {
        const Mesh& mesh = scene_.meshes[index(id)];
        std::vector<Rim> others;
        for (uint32_t k = 0; k < scene_.instances.size(); ++k) {
            const auto* other = std::get_if<MeshId>(&scene_.shapes[index(scene_.instances[k].shape)]);
            if (!other || *other == id ||
                scene_.instances[k].world_from_object != scene_.instances[i].world_from_object)
                continue;
            if (!check_.world.mesh_box(*other).touches(check_.world.mesh_box(id))) continue;
            const Mesh& neighbour = scene_.meshes[index(*other)];
            spent_ += neighbour.indices.size() / 3;
            if (spent_ > kBudget) return false;
            const std::shared_ptr<const Topology> topology = check_.bodies.topology(*other);
            for (const LooseEdge& edge : topology->loose)
                for (const bool turned : {false, true})  // whichever way its triangles run
                    others.push_back(
                        {neighbour.positions[turned ? edge.b : edge.a], neighbour.positions[turned ? edge.a : edge.b]});
        }
        std::sort(others.begin(), others.end());
        std::erase_if(loose, [&](const LooseEdge& edge) {
            return std::binary_search(others.begin(), others.end(),
                                      Rim{mesh.positions[edge.a], mesh.positions[edge.b]});
        });
        return true;
    }

    void add(uint32_t i, std::string message) {
        check_.out.add(Rule::open_glass, Element{ElementKind::instance, i}, std::move(message),
                       "close it, or make the sheet 'thin_glass' (open_pbr: geometry_thin_walled)");
    }

    /// Triangles of neighbours in all: some seconds.
    static constexpr uint64_t kBudget = uint64_t(1) << 24;

    Check& check_;
    const Scene& scene_;
    std::set<MeshId> seen_;
    uint64_t spent_ = 0;
};

}  // namespace

void check_open_glass(Check& check) {
    if (check.out.wants(Rule::open_glass)) OpenGlass(check).run();
}

}  // namespace steradian::lint_detail
