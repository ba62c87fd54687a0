// What is known of a light, or of many together, without looking at any of them: where they are, which way they shine
// and how strongly. From that follows how much may arrive at a point.
//
// A. Conty Estevez and C. Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting", Proc. ACM Comput.
// Graph. Interact. Tech. 1(2), 2018: sections 4.1 (bounds of directions), 4.4 (cost of a split), 4.5 (importance).
#pragma once

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

/// A LightBounds in the form in which receivers look at it, rounded outwards.
struct LightNode {
    Vec3 center;
    float radius2 = 0;  ///< of a sphere around the box, squared, m²
    Vec3 axis;
    float cos_o = -1, sin_o = 0, cos_e = 0;
    float strength = 0;   ///< as a fraction of the whole tree's, > 0
    uint32_t lights = 1;  ///< below it; 1 for leaves
    uint32_t child = 0;  ///< of the leaf: the light's index; else of the node: its first child, the other is next to it
    bool two_sided = false;

    static LightNode from(const LightBounds& bounds, double total_strength);
};

/// What arrives is about numerator / distance2; a numerator of 0 says that nothing can. Both are between 1e-100 and
/// 1e100 otherwise, so that products of two are numbers.
struct LightImportance {
    double numerator = 0, distance2 = 1;
};

/// Cosines are computed in float and are right to better than this, even where the sine of the angle is the rounding of
/// its cosine. Nothing is given up that is nearer to the limits.
inline constexpr float kCosineSlack = 2e-3f;

inline float sine_of(float cosine) { return std::sqrt(max_of(1 - cosine * cosine, 0.0f)); }

/// Never nothing where a light can contribute.
inline LightImportance light_importance(const LightNode& node, const LightReceiver& at) {
    constexpr double kLeast = 1e-100;
    const Vec3 d = at.p - node.center;
    const float d2 = dot(d, d);
    // Inside the sphere anything may come from anywhere; so it may where numbers end.
    if (!(d2 > node.radius2) || !(d2 < 1e37f) || !(d2 > 1e-30f))
        return {max_of(double(node.strength), kLeast), max_of(double(node.radius2), 1e-30)};
    const float per_d2 = 1 / d2, per_distance = std::sqrt(per_d2);
    const float sin2_u = min_of(node.radius2 * per_d2, 1.0f), sin_u = std::sqrt(sin2_u), cos_u = std::sqrt(1 - sin2_u);

    // cos of θ' = max(θ - θ_o - θ_u, 0): between the light's direction and the nearest normal that there may be.
    float cos_t = dot(node.axis, d) * per_distance, cos_emitted = 1;
    if (node.two_sided) cos_t = std::fabs(cos_t);
    if (cos_t < node.cos_o) {
        const float sin_t = sine_of(cos_t);
        const float cos_x = cos_t * node.cos_o + sin_t * node.sin_o, sin_x = sin_t * node.cos_o - cos_t * node.sin_o;
        if (cos_x < cos_u) cos_emitted = cos_x * cos_u + sin_x * sin_u;
        if (cos_emitted < node.cos_e - kCosineSlack) return {};
    }

    // cos of θ_i' = max(θ_i - θ_u, 0) at the receiver.
    float cos_received = 1;
    if (at.n != Vec3{}) {
        float cos_i = -dot(at.n, d) * per_distance;
        if (at.both_sides) cos_i = std::fabs(cos_i);
        if (cos_i < cos_u) cos_received = cos_i * cos_u + sine_of(cos_i) * sin_u;
        if (cos_received < -kCosineSlack) return {};
    }
    const double cosines = double(max_of(cos_emitted, kCosineSlack)) * max_of(cos_received, kCosineSlack);
    return {max_of(node.strength * cosines, kLeast), d2};
}

}  // namespace steradian
