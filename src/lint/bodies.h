// Objects that enclose a space, and what is inside of them.
#pragma once

#include <map>
#include <memory>
#include <optional>

#include "lint/topology.h"
#include "lint/world.h"

namespace steradian::lint_detail {

/// How often the surface goes around a point, counter-clockwise as seen from outside: 1 inside of a closed body, 0
/// outside, -1 inside of one that is inside out; anything for surfaces that are not closed. The sum of solid angles of
/// all triangles over 4π (Van Oosterom and Strackee 1983, equation 8). Triangles of component `without` do not count.
double winding_number(const Mesh& mesh, Vec3d p, const Components* components = nullptr, uint32_t without = 0);

class Bodies {
public:
    Bodies(const Scene& scene, const World& world) : scene_(scene), world_(world) {}

    /// Kept until that of another mesh is asked for, and for as long as somebody holds it.
    std::shared_ptr<const Topology> topology(MeshId id);
    /// Whether the surface has no holes: spheres, and meshes that are closed and wound consistently.
    bool closed(uint32_t instance);
    /// Whether a point in the world is inside of a closed body. Nothing where that cannot be said: too near to the
    /// surface, or it would take too long.
    std::optional<bool> inside(uint32_t instance, Vec3d point);

private:
    /// Triangles in all that points are compared with: some seconds of one core.
    static constexpr uint64_t kBudget = uint64_t(1) << 26;

    const Scene& scene_;
    const World& world_;
    std::map<MeshId, bool> closed_;
    std::shared_ptr<const Topology> last_;
    MeshId last_mesh_{};
    uint64_t spent_ = 0;
};

}  // namespace steradian::lint_detail
