// Where an instance's hits lie in the world: how far the rounding of rays on their way into its space takes them.
//
// A ray of the world, o + t d, becomes p(t) = o' + t d' in the space of an instance, with o' = B o and d' = B d rounded
// to float; A is world_from_object and B its inverse as computed. Say that a primitive has accepted a t, which by
// definition lies in the slab interval of the primitive's own box along p, and that this box is part of a box P. How
// far can o + t d be from A P? For rays that are near (is_near: o within a box N around the scene, |d| neither huge nor
// tiny), with w_i the extent of B N along axis i and n_i the largest magnitude in it:
//
//   1. p(t) lies within P grown by s w_i: computed planes are off by e = 3 * 2^-24 of their distance, of which the
//      exact one is at most w_i, and the far one is scaled by 1 + 2^-20 besides: s < 1.26 * 2^-20. (kFarPad adds
//      2^-74.)
//   2. o' is off by 2^-24 n_i, and t d' by 2^-24 |t d'_i| < 2^-24 (1 + s) w_i, from the rounding to float, and both by
//      2^-50 of the sums of magnitudes that the double arithmetic runs into, |B| (|o| + |t d|) and B's own translation;
//      components of d' below 2^-126 become 0.
//   3. A B is not quite the identity: its difference is computed, with what that computation may be off by.
//
// So o + t d lies within A P grown by |A| (1. + 2.) + 3. Along every axis a computed plane of the world's box that is
// another e of N's extent farther out is on the right side of t: the near one at once. Of the far ones before they are
// scaled, the same holds with the least time T that P's have before they are scaled in place of t, for which 1. to 3.
// are true as well; scaling is monotone and the same for both, so what T is within scales to what t is within. So t
// lies in the slab interval that the world's ray has with that larger box.
//
// rounding_margin() takes 1.38 * 2^-20 for 1.26 * 2^-20 and the 2^-24 (1 + s) of 2., 2^-23 for the 2^-24 of n_i,
// 2^-48 for 2^-50 and 2^-22 for e. |t d| itself is bounded by |A| w, since |d| is that of A B d but for a share of at
// most 2^-10.
//
// The world box of an instance is that of its geometry grown by the margin, so a hit of a near ray is where it was
// found: settle() has nothing to clamp. And it is in the slab interval of every part's world box, grown in the same
// way, which is what an upper level over parts of instances (open.h) needs. Rays that are not near, rare and never
// wrong, look at the whole boxes of such instances as well.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "accel/accel.h"
#include "accel/instance.h"

namespace steradian {

/// How far N reaches beyond the scene on all sides, in units of the scene's largest extent. More makes more rays near,
/// and boxes larger.
inline constexpr float kNearReach = 8;
/// Largest components of near directions.
inline constexpr float kMinNearDirection = 0x1p-30f, kMaxNearDirection = 0x1p30f;

/// N, for the bounds of a scene.
Box near_box(const Box& scene);

/// `ray` must be canonical.
inline bool is_near(const Box& near, const Ray& ray) {
    const float size = max_component(abs(ray.d));
    return ray.o.x >= near.lo.x && ray.o.y >= near.lo.y && ray.o.z >= near.lo.z && ray.o.x <= near.hi.x &&
           ray.o.y <= near.hi.y && ray.o.z <= near.hi.z && size >= kMinNearDirection && size <= kMaxNearDirection;
}

/// What a box of an instance grows by along each axis of the world. `world` is the instance's own before. Nothing where
/// the derivation above does not hold or the margin is no small part of the box: such instances keep their boxes, and
/// are not opened. It depends on the scene alone, since it is part of what a hit is.
std::optional<Vec3> rounding_margin(const PlacedGeometry& placed, const Affine& world_from_object, const Box& near);

/// Instances in their places.
struct Placement {
    std::span<const GeometryInstance> instances;
    std::vector<PlacedGeometry> placed;
    std::vector<std::optional<Vec3>> margins;  ///< 0 where rays are not transformed
    Box scene;                                 ///< bounds of everything, without margins
    Box near;

    /// Grows the world boxes. Everything else must be there but `near`.
    void add_margins();
    /// Of a box in the space of an instance.
    Box world_box(uint32_t instance, const Box& part) const;
};

}  // namespace steradian
