// Triangles as the leaves keep them: four at a time, coordinate by coordinate.
#pragma once

#include <cstdint>

#include "accel/bvh.h"

namespace steradian {

struct alignas(32) TriangleBlock {
    float vertex[3][3][kBlock];  ///< [which][axis][lane]
    uint32_t prim[kBlock];       ///< kNoHit where the block is not full; the vertices repeat the first triangle then

    Vec3 corner(int which, uint32_t lane) const {
        return {vertex[which][0][lane], vertex[which][1][lane], vertex[which][2][lane]};
    }
};
static_assert(sizeof(TriangleBlock) == 160);

/// Stands for the blocks of a level without triangles: the kernels prefetch before they know what is there, and an
/// address without memory behind it would cost more than one that has some.
inline constexpr TriangleBlock kNoBlocks{};

}  // namespace steradian
