// Nodes with eight children in half the bytes: planes in eight bits, after Ylitie, Karras & Laine 2017, "Efficient
// Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", section 2, and Benthin et al. 2018, "Compressed-Leaf
// Bounding Volume Hierarchies".
//
// A plane is decoded by fixed float operations, q * scale + origin with a rounding each, so it is monotone in q, and 0
// decodes to the origin. The quantiser relies on no bound for the roundings: it compares what is decoded with what was
// there, plane by plane, and moves outwards until the decoded box contains the true one. So the slab test of a decoded
// box contains that of the true one without any tolerance (box.h), and hits are the same bits as with the planes
// themselves: they are defined by the primitives' own boxes.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "accel/box.h"
#include "accel/wide_node.h"

namespace steradian {

struct alignas(64) CompactNode {
    uint32_t child[kWidth];  ///< see ChildRef
    /// For each octant of directions (as in WideNode) the children from far to near, three bits a place. Those that do
    /// not exist come first.
    uint8_t order[8][3];
    /// At least 2^-126, so that no product with it is denormal. The lowest bits of scale[0] say which children exist,
    /// and are nevertheless part of it: any scale is as good as another one that is a little larger.
    float scale[3];
    uint8_t plane[3][2][kWidth];  ///< [axis][lower, upper]
    float origin[3];

    /// 24 bits of `order`, below others that mean nothing; `octant_shift` is three times the octant.
    uint32_t order_of(uint32_t octant_shift) const {
        uint32_t bits = 0;
        std::memcpy(&bits, reinterpret_cast<const char*>(this) + offsetof(CompactNode, order) + octant_shift,
                    sizeof(bits));
        return bits;
    }
    /// A bit for every child that exists.
    uint32_t present() const { return std::bit_cast<uint32_t>(scale[0]) & 0xff; }
    /// The same for the places of `order`.
    uint32_t present_in_order() const { return std::bit_cast<uint32_t>(scale[0]) >> 8 & 0xff; }
    float decoded(int axis, int upper, uint32_t i) const {
        return static_cast<float>(plane[axis][upper][i]) * scale[axis] + origin[axis];
    }
    Box box(uint32_t i) const {
        return {{decoded(0, 0, i), decoded(1, 0, i), decoded(2, 0, i)},
                {decoded(0, 1, i), decoded(1, 1, i), decoded(2, 1, i)}};
    }
};
static_assert(sizeof(CompactNode) == 128);

/// The first `children` children of a node. Their planes must be finite, at most 1e30, and lower <= upper.
CompactNode quantise(const WideNode& node, uint32_t children);

}  // namespace steradian
