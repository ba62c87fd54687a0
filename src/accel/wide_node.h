// What the kernels traverse: nodes with eight children.
#pragma once

#include <cstdint>

namespace steradian {

inline constexpr uint32_t kWidth = 8;
/// Triangles of a block.
inline constexpr uint32_t kBlock = 4;

/// What leaves hold.
enum class ItemKind : uint32_t { block, shape, instance };

/// What a child is, in 32 bits: the index of a node, or a run of up to kMaxRun items of one kind that follow each
/// other.
class ChildRef {
public:
    static constexpr uint32_t kMaxRun = 4;
    static constexpr uint32_t kMaxItems = 1u << 27;
    static constexpr uint32_t kLeaf = 1u << 31;
    /// References from here on are leaves that do not hold blocks, or none at all.
    static constexpr uint32_t kFirstOther = kLeaf | 1u << 29;

    static constexpr uint32_t node(uint32_t index) { return index; }
    static constexpr uint32_t leaf(ItemKind kind, uint32_t first, uint32_t count) {
        return kLeaf | static_cast<uint32_t>(kind) << 29 | (count - 1) << 27 | first;
    }
    static constexpr bool is_leaf(uint32_t ref) { return ref >= kLeaf; }
    static constexpr ItemKind kind(uint32_t leaf_ref) { return static_cast<ItemKind>(leaf_ref >> 29 & 3); }
    static constexpr uint32_t first(uint32_t leaf_ref) { return leaf_ref & (kMaxItems - 1); }
    static constexpr uint32_t count(uint32_t leaf_ref) { return (leaf_ref >> 27 & 3) + 1; }
};

/// Eight children, their boxes side by side for the slab test.
struct alignas(64) WideNode {
    float plane[3][2][kWidth];  ///< [axis][lower, upper]; +inf and -inf where there is no child: never hit
    uint32_t child[kWidth];     ///< see ChildRef
    /// For each of the eight octants of directions the children from far to near: bits [3 o, 3 o + 3) of entry i say
    /// which child comes at place i. Bit 0 of the octant is set where x decreases, bit 1 for y, bit 2 for z.
    uint32_t order[kWidth];
};
static_assert(sizeof(WideNode) == 256);

}  // namespace steradian
