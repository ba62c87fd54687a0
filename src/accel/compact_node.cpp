#include "accel/compact_node.h"

#include <algorithm>
#include <cmath>

namespace steradian {
namespace {

constexpr float kMost = 255;

float decode(float q, float scale, float origin) { return q * scale + origin; }

/// About the least scale with these lowest 16 bits with which the last of 256 planes from `origin` on lies at or beyond
/// `end`.
float scale_for(float origin, float end, uint32_t lowest) {
    constexpr uint32_t kUnit = 1u << 16, kLeast = 0x0080u << 16;  // 2^-126
    const float wanted = static_cast<float>((double(end) - origin) / kMost);
    uint32_t bits = std::max(kLeast, std::bit_cast<uint32_t>(wanted) / kUnit * kUnit) | lowest;
    // Cut off, so usually too small; more often when the sum with the origin is rounded down.
    while (!(decode(kMost, std::bit_cast<float>(bits), origin) >= end)) bits += kUnit;
    return std::bit_cast<float>(bits);
}

/// The last plane at or below x, which is not below the origin; or the one before it.
uint8_t quantise_down(float x, float scale, float origin) {
    float q = std::clamp(std::floor((x - origin) / scale), 0.0f, kMost);
    while (decode(q, scale, origin) > x) --q;
    if (q < kMost && decode(q + 1, scale, origin) <= x) ++q;
    return static_cast<uint8_t>(q);
}

/// The first plane at or above x, which is not beyond the last plane; or the one behind it.
uint8_t quantise_up(float x, float scale, float origin) {
    float q = std::clamp(std::ceil((x - origin) / scale), 0.0f, kMost);
    while (decode(q, scale, origin) < x) ++q;
    if (q > 0 && decode(q - 1, scale, origin) >= x) --q;
    return static_cast<uint8_t>(q);
}

}  // namespace

CompactNode quantise(const WideNode& node, uint32_t children) {
    CompactNode out{};
    std::copy_n(node.child, kWidth, out.child);
    for (uint32_t octant = 0; octant < 8; ++octant) {
        uint32_t word = 0;
        for (uint32_t place = 0; place < kWidth; ++place)
            word |= (node.order[place] >> (3 * octant) & 7) << (3 * place);
        for (int byte = 0; byte < 3; ++byte) out.order[octant][byte] = static_cast<uint8_t>(word >> (8 * byte));
    }
    const uint32_t present = (1u << children) - 1, present_in_order = 0xffu << (kWidth - children) & 0xff;
    for (int axis = 0; axis < 3; ++axis) {
        const float *lower = node.plane[axis][0], *upper = node.plane[axis][1];
        const float origin = *std::min_element(lower, lower + children);
        out.origin[axis] = origin;
        out.scale[axis] = scale_for(origin, *std::max_element(upper, upper + children),
                                    axis == 0 ? present_in_order << 8 | present : 0);
        const float scale = out.scale[axis];
        for (uint32_t i = 0; i < children; ++i) {
            out.plane[axis][0][i] = quantise_down(lower[i], scale, origin);
            out.plane[axis][1][i] = quantise_up(upper[i], scale, origin);
        }
    }
    return out;
}

}  // namespace steradian
