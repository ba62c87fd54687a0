// How the triangles of a mesh hang together: vertices in the same place are one, whatever their normals and texture
// coordinates.
#pragma once

#include <cstdint>
#include <vector>

#include "math/vector.h"
#include "steradian/scene.h"

namespace steradian::lint_detail {

/// A side of a triangle that has no neighbour on it, in the triangle's own direction.
struct LooseEdge {
    uint32_t a = 0, b = 0;  ///< vertices of the mesh, the first ones in their places
    uint32_t triangle = 0;
    bool operator==(const LooseEdge&) const = default;
};

struct Topology {
    std::vector<LooseEdge> loose;  ///< by their vertices
    uint64_t flipped = 0;          ///< edges of two triangles that run along them in the same direction
    /// Of each corner the first vertex in its place; kLeftOut at triangles without area and unusable vertices.
    std::vector<uint32_t> place;
    static constexpr uint32_t kLeftOut = 0xffffffffu;

    bool left_out(size_t triangle) const { return place[3 * triangle] == kLeftOut; }
    /// Every edge is passed as often in one direction as in the other.
    bool closed() const { return loose.empty() && flipped == 0; }
};

/// Takes 12 bytes a triangle as long as it is kept, and 60 while it is made.
Topology topology_of(const Mesh& mesh);

/// Triangles that hang together, numbered in order of their first ones; of those left out 0.
struct Components {
    std::vector<uint32_t> of_triangle;
    std::vector<double> volume;   ///< signed: negative where they are inside out
    std::vector<uint32_t> first;  ///< triangle
};
Components components_of(const Mesh& mesh, const Topology& topology);

}  // namespace steradian::lint_detail
