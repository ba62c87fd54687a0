// Reproducible random numbers for tests, of another family than the renderer's samplers: xorshift64* (Vigna 2016).
#pragma once

#include <cstdint>

namespace steradian::test {

class Random {
public:
    explicit Random(uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15 + 0x2545f4914f6cdd1d) {
        for (int i = 0; i < 8; ++i) next();
    }
    uint64_t next() {
        state_ ^= state_ >> 12;
        state_ ^= state_ << 25;
        state_ ^= state_ >> 27;
        return state_ * 0x2545f4914f6cdd1d;
    }
    /// In [0, 1), multiples of 2^-53.
    double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }
    /// In [0, 1), multiples of 2^-24: the samplers' grid.
    float unit_float() { return static_cast<float>(next() >> 40) * 0x1p-24f; }
    double between(double a, double b) { return a + (b - a) * unit(); }

private:
    uint64_t state_;
};

}  // namespace steradian::test
