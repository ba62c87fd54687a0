// What is known of a light, or of many together, without looking at any of them: where they are, which way they shine
// and how strongly. From that follows how much may arrive at a point.
//
// A. Conty Estevez and C. Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting", Proc. ACM Comput.
// Graph. Interact. Tech. 1(2), 2018: sections 4.1 (bounds of directions), 4.4 (cost of a split), 4.5 (importance).
#pragma once

#include "math/simd.h"
#include "math/vector.h"

namespace steradian {

/// Directions within θ_o of the axis are where normals point; light leaves up to θ_e away from a normal.
struct DirectionCone {
    Vec3d axis{0, 0, 1};     ///< unit
    double theta_o = 0;      ///< radians, [0, π]
    double theta_e = 0;      ///< radians, [0, π]
    bool two_sided = false;  ///< the same about -axis
};

struct LightBounds {
    Vec3d lo, hi;  ///< the box, world space; finite
    DirectionCone cone;
    double strength = 0;  ///< the most radiant intensity there is in any direction, about; W/sr, mean of the channels
};

LightBounds unite(const LightBounds& a, const LightBounds& b);

/// Where light arrives.
struct LightReceiver {
    Vec3 p;
    Vec3 n;                   ///< unit: light from behind counts for nothing; zero: from everywhere
    bool both_sides = false;  ///< light from behind counts as well
};

/// Four LightBounds in the form in which receivers look at them, rounded outwards.
struct alignas(16) FourLights {
    float center[3][4] = {};
    float radius2[4] = {1, 1, 1, 1};  ///< of a sphere around the box, squared, m²; in [1e-30, 1e37]
    float axis[3][4] = {};
    float cos_o[4] = {}, sin_o[4] = {}, cos_e[4] = {};
    float strength[4] = {};   ///< as a fraction of the whole tree's; 0: there is nothing
    float two_sided[4] = {};  ///< 0 or 1

    void set(int lane, const LightBounds& bounds, double total_strength);
};

/// Cosines are computed in float and are right to better than this, even where the sine of the angle is the rounding of
/// its cosine. Nothing is given up that is nearer to the limits.
inline constexpr float kCosineSlack = 2e-3f;

/// About what arrives at a point from each, in no particular unit: 0 where there is nothing or nothing can arrive, else
/// between 1e-100 and 1e100, so that sums are numbers. Never 0 where a light can contribute.
inline void light_importance(const FourLights& lights, const LightReceiver& at, double* out) {
    const Float4 zero = Float4::all(0), one = Float4::all(1), slack = Float4::all(kCosineSlack);
    const auto sine_of = [&](Float4 cosine) { return sqrt(larger(one - cosine * cosine, zero)); };
    const auto dot = [](const Float4(&a)[3], const Float4(&b)[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };

    const Float4 d[3] = {Float4::all(at.p.x) - Float4::load(lights.center[0]),
                         Float4::all(at.p.y) - Float4::load(lights.center[1]),
                         Float4::all(at.p.z) - Float4::load(lights.center[2])};
    const Float4 d2 = dot(d, d), radius2 = Float4::load(lights.radius2);
    // Inside the sphere anything may come from anywhere; so it may where numbers end.
    const Mask4 outside = radius2 < d2 && d2 < Float4::all(1e37f);
    const Float4 per_d2 = one / select(outside, d2, radius2), per_distance = sqrt(per_d2);
    const Float4 sin2_u = smaller(radius2 * per_d2, one), sin_u = sqrt(sin2_u), cos_u = sqrt(one - sin2_u);

    // cos of θ' = max(θ - θ_o - θ_u, 0): between the light's direction and the nearest normal that there may be.
    const Float4 axis[3] = {Float4::load(lights.axis[0]), Float4::load(lights.axis[1]), Float4::load(lights.axis[2])};
    const Float4 along = dot(axis, d) * per_distance;
    const Float4 cos_t = select(zero < Float4::load(lights.two_sided), abs(along), along), sin_t = sine_of(cos_t);
    const Float4 cos_o = Float4::load(lights.cos_o), sin_o = Float4::load(lights.sin_o);
    const Float4 cos_x = cos_t * cos_o + sin_t * sin_o, sin_x = sin_t * cos_o - cos_t * sin_o;
    const Float4 beyond = select(cos_x < cos_u, cos_x * cos_u + sin_x * sin_u, one);
    const Float4 emitted = select(cos_t < cos_o, beyond, one);
    Float4 cosines = select(emitted < Float4::load(lights.cos_e) - slack, zero, larger(emitted, slack));

    // cos of θ_i' = max(θ_i - θ_u, 0) at the receiver.
    if (at.n != Vec3{}) {
        const Float4 n[3] = {Float4::all(at.n.x), Float4::all(at.n.y), Float4::all(at.n.z)};
        const Float4 towards = zero - dot(n, d) * per_distance, cos_i = at.both_sides ? abs(towards) : towards;
        const Float4 received = select(cos_i < cos_u, cos_i * cos_u + sine_of(cos_i) * sin_u, one);
        cosines = cosines * select(received < zero - slack, zero, larger(received, slack));
    }
    alignas(16) float received_strength[4];
    (select(outside, cosines, one) * per_d2).store(received_strength);
    // In double, where the smallest of all do not vanish.
    for (int k = 0; k < 4; ++k) out[k] = double(lights.strength[k]) * received_strength[k];
}

}  // namespace steradian
