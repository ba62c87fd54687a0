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
    return {half, {range_bounds(primitives.first(half)), range_bounds(primitives.subspan(half))}, 0, false};
}

std::optional<ItemKind> only_kind(std::span<const BuildPrimitive> primitives) {
    const ItemKind kind = primitives.front().kind;
    for (const BuildPrimitive& p : primitives)
        if (p.kind != kind) return std::nullopt;
    return kind;
}

Halves split_by_kind(std::span<BuildPrimitive> primitives) {
    const ItemKind kind = primitives.front().kind;
    const auto middle = std::partition(primitives.begin(), primitives.end(),
                                       [kind](const BuildPrimitive& p) { return p.kind == kind; });
    const auto left = static_cast<size_t>(middle - primitives.begin());
    return {left, {range_bounds(primitives.first(left)), range_bounds(primitives.subspan(left))}, 0, true};
}

}  // namespace steradian
