// Closed surfaces that are inside out where it matters: of glass, of what is black or dark from behind.
#include <fmt/format.h>

#include <cmath>

#include "lint/check.h"
#include "math/transform.h"

namespace steradian::lint_detail {
namespace {

class Orientation {
public:
    explicit Orientation(Check& check) : check_(check), scene_(check.scene), emits_one_sided_(scene_.instances.size()) {
        for (const Light& light : scene_.lights)
            if (const auto* area = std::get_if<AreaLight>(&light); area && !area->two_sided)
                emits_one_sided_[index(area->instance)] = true;
    }

    void run() {
        for (uint32_t m = 0; m < scene_.meshes.size(); ++m) {
            const auto users = check_.world.users(MeshId(m));
            const bool matters = std::any_of(users.begin(), users.end(), [&](uint32_t i) { return has_sides(i); });
            if (matters && scene_.meshes[m].indices.size() >= 12) look_at(MeshId(m));
        }
    }

private:
    bool is_glass(uint32_t i) const { return optics_of(scene_, scene_.instances[i].material).solid; }
    bool has_sides(uint32_t i) const {
        return is_glass(i) || emits_one_sided_[i] || optics_of(scene_, scene_.instances[i].material).one_sided;
    }

    void look_at(MeshId id) {
        const Mesh& mesh = scene_.meshes[index(id)];
        const std::shared_ptr<const Topology> kept = check_.bodies.topology(id);
        const Topology& topology = *kept;
        for (const uint32_t i : check_.world.users(id))
            if (topology.loose.empty() && topology.flipped > 0 && is_glass(i)) {
                add(i, fmt::format("{} is glass whose triangles are wound one way here and the other there: {} edges "
                                   "lie between",
                                   check_.object(i), topology.flipped));
                break;
            }
        if (!topology.closed()) return;
        const Components components = components_of(mesh, topology);
        const std::optional<uint32_t> component = inverted(id, mesh, components);
        // One finding for all instances of a mesh.
        for (const uint32_t i : check_.world.users(id)) {
            if (!has_sides(i)) continue;
            if (is_glass(i) && component && !in_other_glass(i, mesh))
                return add(i, fmt::format("{} is glass that is inside out{}: light that enters it counts as leaving it",
                                          check_.object(i), part(components, *component)));
            if (!is_glass(i) && faces_away(i, id, components)) return;
        }
    }

    /// Of what is seen from one side only. A room is seen from inside.
    bool faces_away(uint32_t i, MeshId id, const Components& components) {
        const std::optional<bool> from_inside = seen_from_inside(i);
        if (!from_inside || !is_thick(id, components.volume)) return false;
        double volume = 0;
        for (const double v : components.volume) volume += v;
        if ((volume > 0) != *from_inside) return false;
        add(i, fmt::format("{} is closed and faces {}, but cameras are {}: it is {}", check_.object(i),
                           volume > 0 ? "outwards" : "inwards", *from_inside ? "inside" : "outside",
                           emits_one_sided_[i] ? "dark" : "black"));
        return true;
    }

    /// More than the rounding of its coordinates makes.
    bool is_thick(MeshId id, std::span<const double> volumes) const {
        const double size = check_.world.mesh_box(id).size();
        double sum = 0;
        for (const double v : volumes) sum += std::fabs(v);
        return sum > 1e-6 * size * size * size;
    }

    /// A component that is inside out and lies in no other one, which it would be a hollow of.
    std::optional<uint32_t> inverted(MeshId id, const Mesh& mesh, const Components& components) const {
        constexpr int kMostLookedAt = 16;
        int looked_at = 0;
        for (uint32_t c = 0; c < components.volume.size() && looked_at < kMostLookedAt; ++c) {
            if (!(components.volume[c] < 0) || !is_thick(id, {&components.volume[c], 1})) continue;
            ++looked_at;
            const Vec3d p = mesh.positions[mesh.indices[3 * size_t(components.first[c])]];
            if (std::fabs(winding_number(mesh, p, &components, c)) < 0.01) return c;
        }
        return std::nullopt;
    }
    static std::string part(const Components& components, uint32_t component) {
        if (components.volume.size() == 1) return {};
        return fmt::format(" (one of {} parts, the one with triangle {})", components.volume.size(),
                           components.first[component]);
    }

    /// A bubble: a hollow that is an object of its own.
    bool in_other_glass(uint32_t i, const Mesh& mesh) {
        const Vec3d p = transform_point(scene_.instances[i].world_from_object, mesh.positions[mesh.indices[0]]);
        for (uint32_t k = 0; k < scene_.instances.size(); ++k)
            if (k != i && is_glass(k) && check_.world.box(k).contains(p) && check_.bodies.inside(k, p).value_or(true))
                return true;
        return false;
    }

    /// Nothing where that cannot be said, or not of all cameras alike.
    std::optional<bool> seen_from_inside(uint32_t i) {
        std::optional<bool> out;
        for (const Camera& camera : scene_.cameras) {
            const auto here =
                check_.bodies.inside(i, std::visit([](const auto& c) { return Vec3d(c.position); }, camera));
            if (!here || out.value_or(*here) != *here) return std::nullopt;
            out = here;
        }
        return out;
    }

    void add(uint32_t i, std::string message) {
        check_.out.add(Rule::inverted_normals, Element{ElementKind::instance, i}, std::move(message),
                       "triangles are counter-clockwise seen from outside");
    }

    Check& check_;
    const Scene& scene_;
    std::vector<bool> emits_one_sided_;
};

}  // namespace

void check_orientation(Check& check) {
    if (check.out.wants(Rule::inverted_normals)) Orientation(check).run();
}

}  // namespace steradian::lint_detail
