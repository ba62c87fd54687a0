// Boxes and the slab test: the one function that decides, in fixed IEEE operations, where along a ray a box lies.
//
// Every box test of the kernels, scalar or SIMD, computes exactly this:
//
//     t_in  = -inf or a start;  for each axis: t = (near plane - o) * (1 / d);  t_in  = t > t_in  ? t : t_in
//     t_out = +inf;             for each axis: t = (far plane - o) * (1 / d);   t_out = t < t_out ? t : t_out
//     t_out = t_out * kFarScale + kFarPad;      hit when t_in <= t_out
//
// The near plane is chosen by the sign bit of 1 / d, so -0 works. 0 * inf is NaN (the origin lies in the plane of a
// slab that the ray runs along); the comparisons ignore it, which keeps such a ray inside.
//
// Monotone: rounding is monotone, so every step is a monotone function of the planes. For boxes inner ⊆ outer the
// computed intervals obey outer.in <= inner.in and inner.out <= outer.out, without any tolerance. Traversal relies on
// it.
//
// Conservative (after Ize 2013, "Robust BVH Ray Traversal"): a computed t has three roundings (difference, reciprocal,
// product), so it is off by at most e = 3 * 2^-24 (1 + tiny) relatively; for |d| > 2^126, where 1 / d is denormal, by
// e = 2^-22 + 2^-23. Where the exact ray meets the exact box, t_in and t_out therefore overlap once t_out grows by
// 2 e + 2^-24 (the last for the product with the factor itself): 0.44 * 2^-20 ordinarily, 0.82 * 2^-20 at worst. The
// rest of kFarScale - 1 = 2^-20 is slack for the primitive tests, which compute in double. kFarPad does the same for
// times so small that their products are denormal, where a relative factor does nothing.
#pragma once

#include <cmath>

#include "math/ray.h"
#include "math/vector.h"

namespace steradian {

inline constexpr float kFarScale = 1 + 0x1p-20f;
inline constexpr float kFarPad = 0x1p-126f;
/// The smallest normal float: smaller components of a direction count as 0, so that 1 / d is finite or d is 0.
inline constexpr float kMinDirection = 0x1p-126f;

/// Empty when lo > hi, which is how it starts.
struct Box {
    Vec3 lo{kInfinity, kInfinity, kInfinity}, hi{-kInfinity, -kInfinity, -kInfinity};

    void extend(Vec3 p) {
        lo = {min_of(lo.x, p.x), min_of(lo.y, p.y), min_of(lo.z, p.z)};
        hi = {max_of(hi.x, p.x), max_of(hi.y, p.y), max_of(hi.z, p.z)};
    }
    void extend(const Box& b) {
        lo = {min_of(lo.x, b.lo.x), min_of(lo.y, b.lo.y), min_of(lo.z, b.lo.z)};
        hi = {max_of(hi.x, b.hi.x), max_of(hi.y, b.hi.y), max_of(hi.z, b.hi.z)};
    }
    bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
    /// Half the surface; in double, because 1e15 squared times a count does not fit into a float.
    double half_area() const {
        if (empty()) return 0;
        const double x = double(hi.x) - lo.x, y = double(hi.y) - lo.y, z = double(hi.z) - lo.z;
        return x * y + y * z + z * x;
    }
    bool operator==(const Box&) const = default;
};

/// A range of t, empty unless in <= out.
struct Interval {
    float in = -kInfinity, out = kInfinity;

    bool empty() const { return !(in <= out); }
    /// The nearest value inside; must not be called on an empty one.
    float clamp(float t) const { return t < in ? in : t > out ? out : t; }
};

/// What the slab test needs of a ray.
struct SlabRay {
    float o[3];
    float inv_d[3];
    bool negative[3];

    SlabRay() = default;
    /// `ray` must be usable, see canonical().
    explicit SlabRay(const Ray& ray) {
        for (int axis = 0; axis < 3; ++axis) {
            o[axis] = ray.o[axis];
            inv_d[axis] = 1 / ray.d[axis];
            negative[axis] = std::signbit(inv_d[axis]);
        }
    }
};

/// The box's interval on the whole line, behind the origin too.
inline Interval slab_interval(const Box& box, const SlabRay& ray) {
    Interval range;
    for (int axis = 0; axis < 3; ++axis) {
        const float lo = box.lo[axis], hi = box.hi[axis];
        const float near = ((ray.negative[axis] ? hi : lo) - ray.o[axis]) * ray.inv_d[axis];
        const float far = ((ray.negative[axis] ? lo : hi) - ray.o[axis]) * ray.inv_d[axis];
        range.in = near > range.in ? near : range.in;
        range.out = far < range.out ? far : range.out;
    }
    range.out = range.out * kFarScale + kFarPad;
    return range;
}

/// Brings a ray into the form that the tests are defined for: tmin at least 0, components of d below kMinDirection 0.
/// False when the ray hits nothing by definition: no direction, something not finite, an empty range.
inline bool canonical(const Ray& in, Ray& out) {
    if (!is_finite(in.o) || !is_finite(in.d)) return false;
    out = in;
    // Nearly always nothing is to be done, and what is written again here is waited for where the ray is copied next.
    if (!(in.tmin >= 0) || std::signbit(in.tmin)) [[unlikely]]
        out.tmin = 0;
    for (int axis = 0; axis < 3; ++axis)
        if (std::fabs(in.d[axis]) < kMinDirection) [[unlikely]]
            out.d[axis] = std::copysign(0.0f, in.d[axis]);
    return max_component(abs(out.d)) > 0 && out.tmin <= out.tmax && out.tmin < kInfinity;
}

/// `x` rounded to float and then moved one float down (up): bounds that hold although x itself was rounded.
inline float below(double x) { return std::nextafter(static_cast<float>(x), -kInfinity); }
inline float above(double x) { return std::nextafter(static_cast<float>(x), kInfinity); }

}  // namespace steradian
