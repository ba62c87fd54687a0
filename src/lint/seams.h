// Bodies that several objects make together: whose edges lie on each other, in the world.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "math/vector.h"

namespace steradian::lint_detail {

/// Numbers of places: points that are nearer to each other than a distance are one.
class Places {
public:
    explicit Places(double distance) : distance_(distance) {}

    /// The first place within the distance, or a new one.
    uint32_t number_of(Vec3d p);
    Vec3d at(uint32_t number) const { return places_[number]; }
    size_t count() const { return places_.size(); }

private:
    using Cell = std::array<int64_t, 3>;
    double distance_;
    std::vector<Vec3d> places_;
    std::map<Cell, std::vector<uint32_t>> in_cell_;
};

/// An edge of an object on which it has no neighbour of its own.
struct Rim {
    uint32_t from = 0, to = 0;  ///< places
    uint32_t object = 0;        ///< any number of the caller's
};

/// Those on which no other object has an edge, whichever way it runs. Their order stays.
std::vector<Rim> open_rims(const std::vector<Rim>& rims);

/// What of the open edges encloses an area: the gaps that are left where edges lie on each other without sharing
/// vertices let nothing through.
struct Hole {
    uint64_t edges = 0;
    Vec3d from, to;  ///< its first edge
};
struct OpenBody {
    std::vector<Hole> holes;
    uint32_t first = 0;  ///< the lowest object at a hole
};
/// Of what open_rims has left, by the numbers of bodies that `body_of` has for each object.
std::map<uint32_t, OpenBody> holes_of(const Places& places, const std::vector<Rim>& open,
                                      const std::vector<uint32_t>& body_of);

}  // namespace steradian::lint_detail
