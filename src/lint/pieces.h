// The surfaces of objects as triangles in the world, and what a ray meets of them, one by one: for the few rays of
// lint.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "lint/world.h"

namespace steradian::lint_detail {

using Corners = std::array<Vec3d, 3>;

/// The largest of the coordinates, without their signs.
inline double reach(Vec3d p) { return max_of(max_of(std::fabs(p.x), std::fabs(p.y)), std::fabs(p.z)); }

/// A mesh has its triangles, a rectangle two, a disk those of the polygon within it; a sphere none.
uint64_t count_pieces(const Scene& scene, uint32_t instance);
/// Nothing where a vertex is not usable.
std::optional<Corners> piece(const Scene& scene, uint32_t instance, uint32_t number);

class Rays {
public:
    Rays(const Scene& scene, const World& world) : scene_(scene), world_(world) {}

    /// Whether anything opaque lies on the way from `o` along the unit vector d, between the distances. Nothing where
    /// that would take too long.
    std::optional<bool> blocked(Vec3d o, Vec3d d, double from, double to);
    /// The first opaque object, but not this one, by its number.
    std::optional<uint32_t> cover(Vec3d o, Vec3d d, double from, double to, uint32_t but);

private:
    /// Pieces that are looked at in all: some seconds of one core.
    static constexpr uint64_t kBudget = uint64_t(1) << 26;

    bool meets(uint32_t instance, Vec3d o, Vec3d d, double from, double to);
    bool opaque(uint32_t instance) const { return optics_of(scene_, scene_.instances[instance].material).opaque; }

    const Scene& scene_;
    const World& world_;
    uint64_t spent_ = 0;
};

}  // namespace steradian::lint_detail
