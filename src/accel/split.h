// How the builders divide a range of primitives in two.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "accel/box.h"

namespace steradian {

/// What the builders move around: a box and whose it is.
struct BuildPrimitive {
    Box box;
    uint32_t id = 0;

    /// Twice the centroid, which orders and bins as well as the centroid does.
    float centroid(int axis) const { return box.lo[axis] + box.hi[axis]; }
};

/// Bounds of a range: of the boxes, and of their (doubled) centroids.
struct RangeBounds {
    Box box, centroids;

    void extend(const BuildPrimitive& p) {
        box.extend(p.box);
        centroids.extend(Vec3{p.centroid(0), p.centroid(1), p.centroid(2)});
    }
    void extend(const RangeBounds& other) {
        box.extend(other.box);
        centroids.extend(other.centroids);
    }
};
RangeBounds range_bounds(std::span<const BuildPrimitive> primitives);

/// What a leaf with `count` primitives costs, in visits of a node.
struct LeafCost {
    double item_cost = 1;
    bool blocks = false;

    double operator()(size_t count) const { return item_cost * double(blocks ? (count + 3) / 4 : count); }
};

/// Reorders the range around the median of (centroid, id) along the widest axis of the centroids; returns how many are
/// on the left, half of them.
size_t split_median(std::span<BuildPrimitive> primitives, const RangeBounds& bounds);

/// The binned surface-area heuristic (Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies").
struct SahSplit {
    double cost = 0;  ///< of both sides, weighed by the chance to meet them; without the visit of the node itself
    int axis = 0;
    uint32_t bin = 0;  ///< the first one on the right
};
/// Nothing when all centroids coincide.
std::optional<SahSplit> find_sah_split(std::span<const BuildPrimitive> primitives, const RangeBounds& bounds,
                                       const LeafCost& leaf_cost);
/// Reorders the range; returns how many are on the left, neither none nor all.
size_t apply_sah_split(std::span<BuildPrimitive> primitives, const RangeBounds& bounds, const SahSplit& split);

}  // namespace steradian
