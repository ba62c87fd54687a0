// Random numbers that are the same everywhere: neither <random> nor the C library's sine decides what is measured.
#pragma once

#include <cmath>
#include <cstdint>

#include "math/elementary.h"
#include "math/vector.h"

namespace steradian::bench {

/// SplitMix64's finaliser: a hash of 64 bits.
inline uint64_t scramble(uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

class Random {
public:
    explicit Random(uint64_t seed) : state_(scramble(seed)) {}
    /// [0, 1)
    double unit() { return double(scramble(state_ += 0x9e3779b97f4a7c15u) >> 11) * 0x1p-53; }
    float between(double lo, double hi) { return static_cast<float>(lo + (hi - lo) * unit()); }
    /// In [-1, 1]³.
    Vec3 in_cube() {
        const double x = unit(), y = unit(), z = unit();
        return Vec3(Vec3d{2 * x - 1, 2 * y - 1, 2 * z - 1});
    }
    Vec3 cosine_about(Vec3 n) {
        const double u = unit(), angle = 2 * std::numbers::pi * unit(), r = std::sqrt(u);
        const Vec3d local{r * math::cos(angle), r * math::sin(angle), std::sqrt(1 - u)};
        return normalize(Frame::from_z(n).to_world(Vec3(local)));
    }

private:
    uint64_t state_;
};

}  // namespace steradian::bench
