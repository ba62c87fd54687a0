// What a node knows of its children: their boxes, and in which order they are visited.
#pragma once

#include <algorithm>
#include <array>

#include "accel/box.h"
#include "accel/wide_node.h"

namespace steradian {

inline void set_child_box(WideNode& node, uint32_t i, const Box& box) {
    for (int axis = 0; axis < 3; ++axis) node.plane[axis][0][i] = box.lo[axis], node.plane[axis][1][i] = box.hi[axis];
}
inline Box child_box(const WideNode& node, uint32_t i) {
    const auto& p = node.plane;
    return {{p[0][0][i], p[1][0][i], p[2][0][i]}, {p[0][1][i], p[1][1][i], p[2][1][i]}};
}
/// The first so many exist; nothing leads to the root.
inline uint32_t child_count(const WideNode& node) {
    uint32_t count = 0;
    while (count < kWidth && node.child[count] != ChildRef::node(0)) ++count;
    return count;
}

/// Orders the first `children` of a node by their centres along the diagonal of each octant. All octants are computed
/// side by side.
inline void set_child_order(WideNode& node, uint32_t children) {
    constexpr uint32_t kOctants = 8;
    float key[kWidth][kOctants];
    for (uint32_t i = 0; i < children; ++i) {
        const auto centre = [&](int axis) { return node.plane[axis][0][i] + node.plane[axis][1][i]; };
        const float x = centre(0), y = centre(1), z = centre(2);
        for (uint32_t octant = 0; octant < kOctants; ++octant)
            key[i][octant] = (octant & 1 ? -x : x) + (octant & 2 ? -y : y) + (octant & 4 ? -z : z);
    }
    // The place of each: how many are farther; children that do not exist come first, where they do no harm.
    uint32_t place[kWidth][kOctants];
    for (uint32_t i = 0; i < kWidth; ++i)
        std::fill_n(place[i], kOctants, i < children ? kWidth - children : i - children);
    for (uint32_t i = 0; i < children; ++i)
        for (uint32_t j = i + 1; j < children; ++j)
            for (uint32_t octant = 0; octant < kOctants; ++octant) {
                const uint32_t farther = key[j][octant] > key[i][octant];
                place[i][octant] += farther, place[j][octant] += 1 - farther;
            }
    std::fill_n(node.order, kWidth, 0u);
    for (uint32_t i = 0; i < kWidth; ++i)
        for (uint32_t octant = 0; octant < kOctants; ++octant) node.order[place[i][octant]] |= i << (3 * octant);
}

}  // namespace steradian
