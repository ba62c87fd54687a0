// Triangles in leaves with the vertices that they share, so that a block of four takes about half the bytes of a
// TriangleBlock. Vertices are floats as they were: nothing is lost.
//
// A block is a number of 8-byte units:
//
//     32 bits   header: nine indices of three bits, then a code for the number of vertices, then two flags
//     12 n      the vertices' coordinates: n of x, n of y, n of z
//     32        id of the first triangle, the smallest one
//     3 x 16    what is to be added to it for the others; 0 where there is no triangle, or the first one once more
//               (3 x 32: their ids, kNoHit where there is none, when a difference does not fit: flag kLongIds)
//
// The first triangle has the vertices 0, 1, 2; index 3 c + k - 1 of the header is the vertex of corner c of triangle k.
// Where there is no triangle, it is the first once more. Four triangles with more than eight vertices are written with
// twelve, each where two vectors of eight floats have them, from the first one and from the ninth on: corners 0 and 1
// are found in the first vector and corner 2 in the second, by the same indices as ever.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>

#include "accel/bvh.h"
#include "math/vector.h"

namespace steradian {

/// A run of blocks, the last of which says so, begins at blocks[offset of its reference].
class CompactRef {
public:
    static constexpr uint32_t kMaxUnits = 1u << 29;
    static constexpr uint32_t leaf(uint32_t offset) { return ChildRef::kLeaf | offset; }
    static constexpr uint32_t offset(uint32_t leaf_ref) { return leaf_ref & (kMaxUnits - 1); }
};
/// What a triangle takes at most, alone in its block: 4 + 36 + 16 bytes.
inline constexpr uint32_t kMaxUnitsPerTriangle = 7;
/// Loads of eight floats reach this far behind the last block.
inline constexpr uint32_t kPaddingUnits = 8;

/// Reads a block.
struct CompactBlock {
    static constexpr uint32_t kIndexBits = 27, kCodeMask = 7;
    static constexpr uint32_t kLongIds = 1u << 30, kLast = 1u << 31;
    static constexpr uint32_t kMinVertices = 3, kManyVertices = 12, kCodeOfMany = 6;
    static constexpr uint32_t kSecondVector = 8;  ///< of twelve vertices corner 2 is found from here on

    const uint64_t* unit;
    const char* at;
    uint32_t header;

    explicit CompactBlock(const uint64_t* first)
        : unit(first), at(reinterpret_cast<const char*>(first)), header(word(0)) {}

    uint32_t code() const { return header >> kIndexBits & kCodeMask; }
    bool many() const { return code() == kCodeOfMany; }
    uint32_t vertices() const { return many() ? kManyVertices : kMinVertices + code(); }
    bool last() const { return header & kLast; }
    uint32_t units() const { return units_for(vertices(), header & kLongIds); }
    static uint32_t units_for(uint32_t vertices, bool long_ids) {
        return (4 + 12 * vertices + (long_ids ? 16 : 10) + 7) / 8;
    }

    /// Coordinates of the vertices.
    const char* axis(int which) const { return at + 4 + size_t(4 * vertices()) * static_cast<size_t>(which); }
    /// Which vertex of the first vector, or of the second one, a corner is.
    uint32_t index(uint32_t corner, uint32_t lane) const {
        return lane == 0 ? corner : header >> (3 * (3 * corner + lane - 1)) & 7;
    }
    Vec3 corner(uint32_t which, uint32_t lane) const {
        const uint32_t vertex = index(which, lane) + (which == 2 && many() ? kSecondVector : 0);
        Vec3 p;
        for (int a = 0; a < 3; ++a) std::memcpy(&p[a], axis(a) + size_t(4) * vertex, sizeof(float));
        return p;
    }
    /// kNoHit where there is no triangle.
    uint32_t prim(uint32_t lane) const {
        const size_t ids = 4 + size_t(12) * vertices();
        const uint32_t first = word(ids);
        if (lane == 0) return first;
        if (header & kLongIds) return word(ids + size_t(4) * lane);
        uint16_t more = 0;
        std::memcpy(&more, at + ids + 2 + size_t(2) * lane, sizeof(more));
        return more ? first + more : kNoHit;
    }

private:
    uint32_t word(size_t offset) const {
        uint32_t w = 0;
        std::memcpy(&w, at + offset, sizeof(w));
        return w;
    }
};

/// body(block) for every block of the run that begins there.
template <class Body>
void for_each_block(const uint64_t* first, const Body& body) {
    CompactBlock block(first);
    for (; !block.last(); block = CompactBlock(block.unit + block.units())) body(block);
    body(block);
}

struct PackedTriangle {
    uint32_t id;
    Vec3 corner[3];
};
/// Appends blocks of all triangles of a leaf, at least one of them. Reorders them so that those that share vertices
/// come together.
void append_compact_blocks(std::span<PackedTriangle> triangles, std::vector<uint64_t>& out);

}  // namespace steradian
