// How the builders divide a range of primitives in two.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "accel/box.h"
#include "accel/wide_node.h"
#include "math/simd.h"

namespace steradian {

/// What the builders move around: a box, whose it is and of what kind. Two vectors of four floats, with the rest in
/// their fourth lanes.
struct alignas(16) BuildPrimitive {
    float lo[3];
    uint32_t id;
    float hi[3];
    ItemKind kind;

    BuildPrimitive() = default;
    BuildPrimitive(const Box& box, uint32_t id_, ItemKind kind_)
        : lo{box.lo.x, box.lo.y, box.lo.z}, id(id_), hi{box.hi.x, box.hi.y, box.hi.z}, kind(kind_) {}

    /// Twice the centroid, which orders and bins as well as the centroid does.
    float centroid(int axis) const { return lo[axis] + hi[axis]; }
};
static_assert(sizeof(BuildPrimitive) == 32);

/// A box in two vectors; their fourth lanes mean nothing.
struct Box4 {
    Float4 lo = Float4::all(kInfinity), hi = Float4::all(-kInfinity);

    void extend(Float4 l, Float4 h) {
        lo = smaller(l, lo);
        hi = larger(h, hi);
    }
    void extend(const Box4& b) { extend(b.lo, b.hi); }
    Box box() const {
        alignas(16) float l[4], h[4];
        lo.store(l), hi.store(h);
        return {{l[0], l[1], l[2]}, {h[0], h[1], h[2]}};
    }
};

/// Bounds of a range: of the boxes, and of their (doubled) centroids.
struct RangeBounds {
    Box4 box, centroids;

    void extend(const BuildPrimitive& p) {
        const Float4 lo = Float4::load(p.lo).first_three(), hi = Float4::load(p.hi).first_three();
        box.extend(lo, hi);
        const Float4 centroid = lo + hi;
        centroids.extend(centroid, centroid);
    }
    void extend(const RangeBounds& other) {
        box.extend(other.box);
        centroids.extend(other.centroids);
    }
};
RangeBounds range_bounds(std::span<const BuildPrimitive> primitives);

/// What is to be divided: primitives in their places, and beside them what splits of boxes have added (SpatialSplit).
struct Range {
    std::span<BuildPrimitive> own, added = {};

    size_t size() const { return own.size() + added.size(); }
    const BuildPrimitive& front() const { return own.empty() ? added.front() : own.front(); }
};

/// Half the surface of boxes, in units of the range's largest extent: neither over- nor underflows where it matters.
class Area {
public:
    explicit Area(const RangeBounds& bounds) {
        const Box box = bounds.box.box();
        const float extent = max_component(box.hi - box.lo), scale = 1 / extent;
        scale_ = Float4::all(is_finite(scale) ? scale : 0.0f);
    }
    float operator()(const Box4& box) const { return half_area((box.hi - box.lo) * scale_); }

private:
    Float4 scale_;
};

/// What a leaf with `count` primitives of a kind costs, in visits of a node. An instance is a transform and a hierarchy
/// of its own.
inline float leaf_cost(ItemKind kind, size_t count) {
    const auto n = static_cast<float>(kind == ItemKind::block ? (count + 3) / 4 : count);
    return kind == ItemKind::instance ? 8 * n : n;
}

/// What a split made of a range: how many are on the left, neither none nor all, and the bounds of both sides.
struct Halves {
    size_t own = 0, added = 0;  ///< of Range::own and Range::added
    RangeBounds bounds[2];
    bool by_kind = false;  ///< not by place

    size_t left() const { return own + added; }
};

/// Nothing when there are several kinds.
std::optional<ItemKind> only_kind(const Range& range);
/// Those of the first primitive's kind to the left. There must be several kinds.
Halves split_by_kind(const Range& range);

/// Reorders the range around the median of (centroid, id) along the widest axis of the centroids, what was added by
/// itself: half are on the left, rounded up to whole blocks where there are more than one.
Halves split_median(const Range& range, const RangeBounds& bounds);

/// The binned surface-area heuristic (Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies").
struct SahSplit {
    float cost = 0;  ///< of both sides, weighed by the chance to meet them; without the visit of the node itself
    int axis = 0;
    uint32_t bin = 0;  ///< the first one on the right
};
/// Nothing when all centroids coincide, or all boxes lie in a line, which has no surface and so no cost. All primitives
/// cost what those of `kind` do.
std::optional<SahSplit> find_sah_split(const Range& range, const RangeBounds& bounds, ItemKind kind);
Halves apply_sah_split(const Range& range, const RangeBounds& bounds, const SahSplit& split);

}  // namespace steradian
