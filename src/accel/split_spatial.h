// Splits of the boxes themselves: what reaches over a plane goes to both sides of it.
#pragma once

#include <vector>

#include "accel/split.h"

namespace steradian {

/// The plane at which a range is best divided in space, with `Box4`es cut at it (Stich, Friedrich & Dietrich 2009,
/// "Spatial Splits in Bounding Volume Hierarchies").
///
/// Only boxes are cut, never triangles: the two parts of a box are all of it. That is looser than the bounds of the
/// part of a triangle on each side, and it makes splits safe without any margin. By definition the t of a hit lies in
/// the interval of the primitive's whole box (instance.h), wherever the arithmetic of the primitive's test would have
/// put it. A plane through the box divides this interval at t_s, computed from the plane by the same operations for
/// both parts: the nearer part ends at t_s (or later, by kFarScale) where the farther one begins, so that every t >= 0
/// in the interval lies in the interval of one part at least; where t_s is not a number (the ray runs in the plane),
/// both parts ignore it, and both contain t. Nodes above contain the parts, and box tests are monotone. So the
/// traversal of a tree with split boxes finds every hit that it must. Negative t, which only hits in transformed
/// instances may have before they are clamped once more, could slip between t_s and t_s * kFarScale: no splits there.
///
/// A triangle in several leaves is found several times, as the same hit, which is not before itself.
struct SpatialSplit {
    float cost = 0;  ///< as of SahSplit
    int axis = 0;
    float plane = 0;
    uint32_t left = 0, right = 0;  ///< how many there will be on each side
};

/// Nothing when no plane has less than everything on both sides, or when more than `room` would be added. Only blocks
/// are cut; anything else goes where its centroid is.
std::optional<SpatialSplit> find_spatial_split(const Range& range, const RangeBounds& bounds, ItemKind kind,
                                               size_t room);
/// Appends what is added, which belongs to the right side, to `cut`.
Halves apply_spatial_split(const Range& range, const SpatialSplit& split, std::vector<BuildPrimitive>& cut);

/// Splits of boxes add at most one for this many primitives.
inline constexpr size_t kPrimitivesPerCut = 2;

/// The surface that both sides of a split share, as a share of that of `all`.
float overlap(const Halves& halves, const RangeBounds& all);

}  // namespace steradian
