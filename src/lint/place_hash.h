// Vertices in the same place, whichever zeros their coordinates have, hash alike.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "math/vector.h"

namespace steradian::lint_detail {

inline uint64_t place_hash(std::span<const Vec3> places) {
    uint64_t h = 0;
    for (const Vec3& p : places)
        for (int axis = 0; axis < 3; ++axis) {
            h ^= std::bit_cast<uint32_t>(p[axis] + 0.0f);  // -0 is where 0 is
            h = (h ^ (h >> 29)) * 0x9e3779b97f4a7c15u;
        }
    return h ^ (h >> 32);
}

}  // namespace steradian::lint_detail
