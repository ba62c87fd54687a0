// Where the random numbers come from. Every number is a pure function of (seed, absolute pixel, sample index,
// dimension); there is no state. Two kinds: Owen-scrambled Sobol (default) and independent.
//
// The Sobol sampler is padded: dimensions 4g … 4g + 3 are the first four of the Sobol sequence, Owen-scrambled by
// hashing (Laine & Karras 2011, Burley 2020 "Practical Hash-based Owen Scrambling"), with the sample index shuffled by
// another nested uniform scramble per (pixel, g). So there is no highest dimension, and dimensions of different groups
// are independent of each other.
#pragma once

#include <cstdint>

#include "math/vector.h"
#include "steradian/settings.h"

namespace steradian {

/// One sample of one pixel, hashed with the seed: what every number of that sample is derived from.
struct SampleKey {
    uint64_t pixel = 0;   ///< hash of (seed, x, y)
    uint64_t sample = 0;  ///< index of the sample in its sequence
    uint64_t index = 0;   ///< of the sample in its pixel, for reports
};

class Sampler {
public:
    /// `replicates` independent sequences for each pixel take turns.
    Sampler(SamplerKind kind, uint64_t seed, uint32_t replicates = 1) noexcept
        : kind_(kind), seed_(seed), replicates_(replicates) {}

    /// x, y: absolute pixel coordinates in the full picture, whatever the crop.
    SampleKey key(uint32_t x, uint32_t y, uint64_t sample) const noexcept;

    /// 32 uniform bits.
    uint32_t bits(const SampleKey& key, uint32_t dimension) const noexcept;
    /// In [0, 1), multiples of 2^-24.
    float get_1d(const SampleKey& key, uint32_t dimension) const noexcept { return to_unit(bits(key, dimension)); }
    /// get_1d of (dimension, dimension + 1), at less cost. Keep both within one group of four: `dimension` even.
    Vec2 get_2d(const SampleKey& key, uint32_t dimension) const noexcept;

private:
    static float to_unit(uint32_t bits) noexcept { return static_cast<float>(bits >> 8) * 0x1p-24f; }

    SamplerKind kind_;
    uint64_t seed_;
    uint32_t replicates_;
};

}  // namespace steradian
