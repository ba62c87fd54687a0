// Random numbers for the tests, the same on every machine.
#pragma once

#include <cmath>
#include <cstdint>

#include "math/vector.h"

namespace steradian::test {

/// SplitMix64 (Steele, Lea & Flood 2014).
class Random {
public:
    explicit Random(uint64_t seed) : state_(seed) {}

    uint64_t bits() {
        uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    uint32_t below(uint32_t n) { return static_cast<uint32_t>((bits() >> 32) * n >> 32); }
    /// In [0, 1).
    double unit() { return double(bits() >> 11) * 0x1p-53; }
    double uniform(double lo, double hi) { return lo + (hi - lo) * unit(); }
    /// 10^uniform(lo, hi)
    double decades(double lo, double hi) { return std::pow(10.0, uniform(lo, hi)); }
    Vec3 in_cube(double half) {
        const double x = uniform(-half, half), y = uniform(-half, half), z = uniform(-half, half);
        return Vec3(Vec3d{x, y, z});
    }
    Vec3 direction() {
        while (true) {
            const Vec3 v = in_cube(1);
            if (dot(v, v) > 1e-4f && dot(v, v) <= 1) return normalize(v);
        }
    }

private:
    uint64_t state_;
};

}  // namespace steradian::test
