#include "accel/split.h"

#include <algorithm>

namespace steradian {
namespace {

void extend(RangeBounds& bounds, std::span<const BuildPrimitive> by) {
    if (!by.empty()) bounds.extend(range_bounds(by));
}

/// Of halves whose sizes are known.
void find_bounds(const Range& range, Halves& halves) {
    extend(halves.bounds[0], range.own.first(halves.own)), extend(halves.bounds[0], range.added.first(halves.added));
    extend(halves.bounds[1], range.own.subspan(halves.own)),
        extend(halves.bounds[1], range.added.subspan(halves.added));
}

}  // namespace

Halves split_median(const Range& range, const RangeBounds& bounds) {
    const Box centroids = bounds.centroids.box();
    const Vec3 size = centroids.hi - centroids.lo;
    const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
    const auto divide = [axis](std::span<BuildPrimitive> part, size_t left) {
        std::nth_element(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(left), part.end(),
                         [axis](const BuildPrimitive& a, const BuildPrimitive& b) {
                             const float ca = a.centroid(axis), cb = b.centroid(axis);
                             return ca < cb || (ca == cb && a.id < b.id);
                         });
    };
    // Whole blocks to the left, so that at most one of all is not full in the end.
    size_t left = range.size() / 2;
    if (range.size() > kBlock) left = (left + kBlock - 1) / kBlock * kBlock;
    Halves halves;
    halves.own = std::min(range.own.size() - range.own.size() / 2, left), halves.added = left - halves.own;
    if (halves.added > range.added.size()) halves.added = range.added.size(), halves.own = left - halves.added;
    divide(range.own, halves.own), divide(range.added, halves.added);
    find_bounds(range, halves);
    return halves;
}

std::optional<ItemKind> only_kind(const Range& range) {
    const ItemKind kind = range.front().kind;
    for (const BuildPrimitive& p : range.own)
        if (p.kind != kind) return std::nullopt;
    for (const BuildPrimitive& p : range.added)
        if (p.kind != kind) return std::nullopt;
    return kind;
}

Halves split_by_kind(const Range& range) {
    const ItemKind kind = range.front().kind;
    const auto divide = [kind](std::span<BuildPrimitive> part) {
        const auto middle =
            std::partition(part.begin(), part.end(), [kind](const BuildPrimitive& p) { return p.kind == kind; });
        return static_cast<size_t>(middle - part.begin());
    };
    Halves halves;
    halves.own = divide(range.own), halves.added = divide(range.added);
    halves.by_kind = true;
    find_bounds(range, halves);
    return halves;
}

}  // namespace steradian
