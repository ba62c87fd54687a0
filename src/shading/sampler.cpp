#include "shading/sampler.h"

#include <array>
#include <bit>

namespace steradian {
namespace {

constexpr uint64_t kGolden = 0x9e3779b97f4a7c15;  // 2^64 divided by the golden ratio, odd

/// A bijection of 64 bits in which every input bit reaches every output bit: the finaliser of SplitMix64 (Steele, Lea &
/// Flood 2014, with Stafford's thirteenth set of constants).
constexpr uint64_t mix(uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
    x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
    return x ^ (x >> 31);
}

constexpr uint32_t reverse_bits(uint32_t x) {
    x = (x >> 16) | (x << 16);
    x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
    x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
    return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}

// --- Owen's nested uniform scramble ----------------------------------------------------------------------------------
//
// Whether a bit flips is a fair coin that depends on the key and on all bits before it. Here the bits of the number are
// reversed, so that "before" means "below". A plain hash of additions and multiplications has too few degrees of
// freedom in its first levels (the parity of the coins of one level follows from that of the level above), and those
// are what a few samples see. So six levels are true coins, and only the rest, keyed by what lies before it, is hashed
// as a whole.

/// Six levels: the coin of a bit is bit number (1, bits below it) of the key: 1 + 2 + 4 + … + 32 = 63 coins.
constexpr uint32_t flip_six(uint32_t x, uint64_t key) {
    uint32_t flips = 0;
    for (uint32_t level = 0; level < 6; ++level) {
        const uint32_t one = 1u << level;
        flips |= static_cast<uint32_t>(key >> (one | (x & (one - 1))) & 1) << level;
    }
    return (x ^ flips) & 63;
}

/// All levels at once, by operations that carry upwards only: additions, odd multiplications, x ^= x * even (Laine &
/// Karras 2011, section 3.1). The even constants are Vegdahl's (2021), found by search for a full avalanche.
constexpr uint32_t flip_all(uint32_t x, uint64_t key) {
    x ^= x * 0x3d20adeau;
    x += static_cast<uint32_t>(key);
    x *= static_cast<uint32_t>(key >> 32) | 1;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

constexpr uint64_t key_below(uint64_t key, uint32_t bits_below) {
    return mix(key + (bits_below + uint64_t{1}) * kGolden);
}

/// Of a point: its first levels are those that matter.
constexpr uint32_t scramble_point(uint32_t x, uint64_t key) {
    const uint32_t first = x & 63;
    return flip_six(first, key) | flip_all(x >> 6, key_below(key, first)) << 6;
}

/// Of a sample index: its last levels are those in which the samples of a pixel differ.
constexpr uint32_t scramble_index(uint32_t x, uint64_t key) {
    const uint32_t rest = x & 0x3ffffff, last = x >> 26;
    return (flip_all(rest, key) & 0x3ffffff) | flip_six(last, key_below(key, rest)) << 26;
}

// --- The first four dimensions of the Sobol sequence -----------------------------------------------------------------

using Columns = std::array<uint32_t, 32>;

/// Column i is the point of index 2^i as a 32-bit fraction. From a primitive polynomial of degree s whose inner
/// coefficients are the bits of a, and the first s odd initial numbers (Bratley & Fox 1988, equation 2).
template <size_t S>
constexpr Columns sobol_columns(uint32_t a, const std::array<uint32_t, S>& initial) {
    Columns v{};
    for (size_t i = 0; i < 32; ++i) {
        if (i < S) {
            v[i] = initial[i] << (31 - i);
            continue;
        }
        v[i] = v[i - S] ^ (v[i - S] >> S);
        for (size_t k = 1; k < S; ++k)
            if (a >> (S - 1 - k) & 1) v[i] ^= v[i - k];
    }
    return v;
}

/// Polynomials and initial numbers of Joe & Kuo 2008: x + 1, x² + x + 1, x³ + x + 1. The zeroth dimension is the van
/// der Corput sequence, which needs no table.
constexpr std::array<Columns, 3> kColumns{sobol_columns<1>(0, {1}), sobol_columns<2>(1, {1, 3}),
                                          sobol_columns<3>(1, {1, 3, 1})};

/// entry[k][n]: what bits 4k … 4k + 3 of the reversed index, if they are n, add to the reversed point.
using ReversedTable = std::array<std::array<uint32_t, 16>, 8>;

constexpr ReversedTable reversed_table(const Columns& columns) {
    ReversedTable table{};
    for (size_t k = 0; k < 8; ++k)
        for (size_t n = 0; n < 16; ++n)
            for (size_t bit = 0; bit < 4; ++bit)
                if (n >> bit & 1) table[k][n] ^= reverse_bits(columns[31 - (4 * k + bit)]);
    return table;
}

constexpr std::array<ReversedTable, 3> kReversed{reversed_table(kColumns[0]), reversed_table(kColumns[1]),
                                                 reversed_table(kColumns[2])};

/// The Sobol point; index and point have their bits reversed, since that is how they are scrambled.
inline uint32_t sobol_reversed(uint32_t reversed_index, uint32_t dimension) {
    if (dimension == 0) return reverse_bits(reversed_index);
    const ReversedTable& table = kReversed[dimension - 1];
    uint32_t x = 0;
    for (uint32_t k = 0; k < 8; ++k) x ^= table[k][reversed_index >> (4 * k) & 15];
    return x;
}

/// What the four dimensions of a group share.
struct SobolGroup {
    uint64_t key;
    uint32_t reversed_index;
};

inline SobolGroup sobol_group(const SampleKey& key, uint32_t dimension) {
    // The sequence has 2^32 points; what lies beyond begins another one.
    const uint64_t pixel = key.pixel ^ (key.sample >> 32) * kGolden;
    const uint64_t group = mix(pixel + (dimension / 4 + 1) * kGolden);
    return {group, scramble_index(reverse_bits(static_cast<uint32_t>(key.sample)), group)};
}

inline uint32_t sobol_bits(const SobolGroup& group, uint32_t dimension) {
    // Turned, so that it is none of the keys that scramble_index derives.
    const uint64_t own = mix(std::rotl(group.key, 32) + (dimension % 4 + 1) * kGolden);
    return reverse_bits(scramble_point(sobol_reversed(group.reversed_index, dimension % 4), own));
}

uint32_t independent_bits(const SampleKey& key, uint32_t dimension) {
    // The stride differs from pixel to pixel, so that two pixels do not share a run of samples when their hashes happen
    // to be a small multiple of a common stride apart.
    const uint64_t stride = std::rotl(key.pixel, 32) | 1;
    const uint64_t sample = mix(key.pixel + (key.sample + 1) * stride);
    return static_cast<uint32_t>(mix(sample + (dimension + uint64_t{1}) * kGolden) >> 32);
}

}  // namespace

SampleKey Sampler::key(uint32_t x, uint32_t y, uint64_t sample) const noexcept {
    const uint64_t place = uint64_t{y} << 32 | x;
    const uint64_t pixel = mix(mix(seed_ + kGolden) ^ place);
    if (replicates_ == 1) return {pixel, sample, sample};
    return {mix(pixel + (sample % replicates_ + 1) * kGolden), sample / replicates_, sample};
}

uint32_t Sampler::bits(const SampleKey& key, uint32_t dimension) const noexcept {
    return kind_ == SamplerKind::sobol ? sobol_bits(sobol_group(key, dimension), dimension)
                                       : independent_bits(key, dimension);
}

Vec2 Sampler::get_2d(const SampleKey& key, uint32_t dimension) const noexcept {
    if (kind_ != SamplerKind::sobol || dimension % 4 == 3) {
        const float u = get_1d(key, dimension);
        const float v = get_1d(key, dimension + 1);
        return {u, v};
    }
    const SobolGroup group = sobol_group(key, dimension);
    return {to_unit(sobol_bits(group, dimension)), to_unit(sobol_bits(group, dimension + 1))};
}

}  // namespace steradian
