#include <algorithm>

#include "accel/split.h"

namespace steradian {

Halves split_median(std::span<BuildPrimitive> primitives, const RangeBounds& bounds) {
    const Box centroids = bounds.centroids.box();
    const Vec3 size = centroids.hi - centroids.lo;
    const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
    const size_t half = primitives.size() / 2;
    std::nth_element(primitives.begin(), primitives.begin() + static_cast<std::ptrdiff_t>(half), primitives.end(),
                     [axis](const BuildPrimitive& a, const BuildPrimitive& b) {
                         const float ca = a.centroid(axis), cb = b.centroid(axis);
                         return ca < cb || (ca == cb && a.id < b.id);
                     });
    return {half, {range_bounds(primitives.first(half)), range_bounds(primitives.subspan(half))}};
}

}  // namespace steradian
