// Primitives in the order of a space-filling curve: near each other in the list is near each other in space.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "accel/split.h"
#include "base/large_array.h"

namespace steradian {

/// Cells of the same size along all axes: a flat scene is cut along its length first. In double, where neither the
/// smallest extent nor the largest leaves the range.
class MortonGrid {
public:
    static constexpr uint32_t kAxisBits = 21;

    explicit MortonGrid(const RangeBounds& bounds);
    /// Of a primitive within the bounds: 21 bits of each axis of the centroid, interleaved; x is the highest of each
    /// three.
    uint64_t code(const BuildPrimitive& p) const {
        uint64_t code = 0;
        for (int axis = 0; axis < 3; ++axis) code = code << 1 | spread(cell(p.centroid(axis) - lo_[axis]));
        return code;
    }

private:
    uint32_t cell(double from_lo) const {
        return std::min(static_cast<uint32_t>(from_lo * scale_), (1u << kAxisBits) - 1);
    }
    /// Two zeros before every bit of a number of 21 bits.
    static uint64_t spread(uint32_t x) {
        uint64_t v = x;
        v = (v | v << 32) & 0x1f00000000ffff;
        v = (v | v << 16) & 0x1f0000ff0000ff;
        v = (v | v << 8) & 0x100f00f00f00f00f;
        v = (v | v << 4) & 0x10c30c30c30c30c3;
        v = (v | v << 2) & 0x1249249249249249;
        return v;
    }

    Vec3d lo_;
    double scale_;
};

/// Brings primitives into such an order of their codes that the largest subtrees of the radix tree over the codes with
/// up to `most` of them follow each other, each in no order, and says where they begin, in ascending order, and where
/// the last one ends (codes that are all the same are cut by place). In place: beside the primitives there is a byte
/// for each of them; or, with `may_copy`, by way of a copy of all, which more workers than one can make. Uses all
/// workers of the caller's arena; the result does not depend on their number. Throws std::bad_alloc.
std::vector<uint32_t> sort_along_curve(LargeArray<BuildPrimitive>& primitives, const MortonGrid& grid, uint32_t most,
                                       bool may_copy);

}  // namespace steradian
