// Primitives in the order of a space-filling curve: near each other in the list is near each other in space.
#pragma once

#include <cstdint>
#include <span>

#include "accel/split.h"
#include "base/large_array.h"

namespace steradian {

struct MortonKey {
    uint64_t code;   ///< 21 bits of each axis of the centroid, interleaved: x is the highest of each three
    uint32_t index;  ///< of the primitive
};

/// By (code, index), whatever the coordinates: primitives that the grid of 2^21 cells along the largest extent cannot
/// tell apart stay in the order in which they came. `bounds` are those of the span. Uses all workers of the caller's
/// arena; the result does not depend on their number. Throws std::bad_alloc.
LargeArray<MortonKey> morton_order(std::span<const BuildPrimitive> primitives, const RangeBounds& bounds);

}  // namespace steradian
