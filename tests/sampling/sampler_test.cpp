// What the samplers promise exactly: ranges, stratification, bits.
#include "shading/sampler.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/hash.h"

namespace steradian {
namespace {

constexpr SamplerKind kKinds[] = {SamplerKind::sobol, SamplerKind::independent};

TEST(Sampler, NumbersAreMultiplesOfTheGridBelowOne) {
    for (const SamplerKind kind : kKinds) {
        const Sampler sampler(kind, 1);
        float largest = 0;
        for (uint32_t i = 0; i < 100'000; ++i) {
            const SampleKey key = sampler.key(i % 317, i / 317, i % 5);
            const float u = sampler.get_1d(key, i % 40);
            EXPECT_GE(u, 0);
            EXPECT_LE(u, 1 - 0x1p-24f);
            EXPECT_EQ(u, static_cast<float>(static_cast<uint32_t>(u * 0x1p24f)) * 0x1p-24f);
            EXPECT_EQ(u, static_cast<float>(sampler.bits(key, i % 40) >> 8) * 0x1p-24f);
            largest = max_of(largest, u);
        }
        // The chance that all 100 000 are below 0.999 is 1e-43.
        EXPECT_GT(largest, 0.999f);
    }
}

TEST(Sampler, PairsAreTwoSingleNumbers) {
    for (const SamplerKind kind : kKinds) {
        const Sampler sampler(kind, 9);
        for (uint32_t i = 0; i < 1000; ++i) {
            const SampleKey key = sampler.key(i, 2 * i, i);
            const Vec2 u = sampler.get_2d(key, i);
            EXPECT_EQ(u.x, sampler.get_1d(key, i));
            EXPECT_EQ(u.y, sampler.get_1d(key, i + 1));
        }
    }
}

TEST(Sampler, EverythingMatters) {
    for (const SamplerKind kind : kKinds) {
        const Sampler a(kind, 1), b(kind, 2);
        const uint32_t base = a.bits(a.key(3, 4, 5), 6);
        EXPECT_NE(base, b.bits(b.key(3, 4, 5), 6));
        EXPECT_NE(base, a.bits(a.key(4, 3, 5), 6));
        EXPECT_NE(base, a.bits(a.key(3, 5, 5), 6));
        EXPECT_NE(base, a.bits(a.key(3, 4, 6), 6));
        EXPECT_NE(base, a.bits(a.key(3, 4, 5), 7));
        EXPECT_NE(base, a.bits(a.key(3, 4, 5), 10));
        EXPECT_EQ(base, a.bits(a.key(3, 4, 5), 6));
    }
}

// --- Nets ------------------------------------------------------------------------------------------------------------

using Points = std::vector<std::vector<uint32_t>>;  // [dimension][sample]

/// Whether all boxes that cut dimension i into 2^k_i parts, Σ k = m - t, hold exactly 2^t of the 2^m points.
bool is_net(const Points& points, const std::vector<size_t>& dimensions, int m, int t) {
    std::vector<int> cuts(dimensions.size());
    const auto holds = [&] {
        std::vector<int> count(size_t{1} << (m - t));
        for (size_t n = 0; n < (size_t{1} << m); ++n) {
            size_t box = 0;
            for (size_t i = 0; i < dimensions.size(); ++i)
                if (cuts[i]) box = box << cuts[i] | points[dimensions[i]][n] >> (32 - cuts[i]);
            if (++count[box] > 1 << t) return false;
        }
        return true;
    };
    const auto all = [&](auto& self, size_t i, int left) -> bool {
        if (i + 1 == cuts.size()) {
            cuts[i] = left;
            return holds();
        }
        for (cuts[i] = 0; cuts[i] <= left; ++cuts[i])
            if (!self(self, i + 1, left - cuts[i])) return false;
        return true;
    };
    return all(all, 0, m - t);
}

Points sobol_points(uint64_t seed, uint32_t group, uint64_t first, int m) {
    const Sampler sampler(SamplerKind::sobol, seed);
    Points points(4);
    for (uint32_t d = 0; d < 4; ++d)
        for (uint64_t n = 0; n < uint64_t{1} << m; ++n)
            points[d].push_back(sampler.bits(sampler.key(17, 4, first + n), 4 * group + d));
    return points;
}

/// The quality that theory guarantees: t = Σ (e_i - 1), where the e_i are the degrees of the polynomials of the
/// dimensions (Sobol 1967; Niederreiter 1988): 1, 1, 2, 3.
int guaranteed_t(const std::vector<size_t>& dimensions) {
    constexpr int kDegree[] = {1, 1, 2, 3};
    int t = 0;
    for (const size_t d : dimensions) t += kDegree[d] - 1;
    return t;
}

TEST(SobolSampler, EveryAlignedPowerOfTwoIsANet) {
    const std::vector<std::vector<size_t>> projections{{0},    {1},    {2},    {3},    {0, 1},    {0, 2},
                                                       {1, 2}, {0, 3}, {1, 3}, {2, 3}, {0, 1, 2}, {0, 1, 2, 3}};
    for (uint64_t seed = 0; seed < 4; ++seed)
        for (const uint32_t group : {0u, 1u, 9u})
            for (int m = 0; m <= 9; ++m)
                for (const uint64_t block : {uint64_t{0}, uint64_t{1}, uint64_t{5}}) {
                    const Points points = sobol_points(seed, group, block << m, m);
                    for (const auto& dimensions : projections) {
                        // One dimension is always a (0, m, 1)-net: its matrix is triangular.
                        const int t = dimensions.size() == 1 ? 0 : std::min(m, guaranteed_t(dimensions));
                        EXPECT_TRUE(is_net(points, dimensions, m, t))
                            << "seed " << seed << " group " << group << " 2^" << m << " points from " << (block << m)
                            << ", " << dimensions.size() << " dimensions from " << dimensions[0];
                    }
                }
}

TEST(SobolSampler, FirstPairOfAGroupIsAPerfectNetInItsFirstBits) {
    const Points points = sobol_points(3, 2, 0, 14);
    for (int m = 0; m <= 14; ++m) EXPECT_TRUE(is_net(points, {0, 1}, m, 0)) << m;
}

TEST(SobolSampler, NetTestNoticesOthers) {
    const Sampler sampler(SamplerKind::independent, 1);
    Points points(4);
    for (uint32_t d = 0; d < 4; ++d)
        for (uint64_t n = 0; n < 256; ++n) points[d].push_back(sampler.bits(sampler.key(0, 0, n), d));
    EXPECT_FALSE(is_net(points, {0}, 8, 0));
    EXPECT_FALSE(is_net(points, {0, 1}, 8, 3));
}

// --- Bits ------------------------------------------------------------------------------------------------------------

std::string hash_of(SamplerKind kind) {
    Hasher hasher;
    for (const uint64_t seed : {uint64_t{0}, uint64_t{1}, ~uint64_t{0}}) {
        const Sampler sampler(kind, seed);
        for (const uint32_t x : {0u, 1u, 511u, 1048575u})
            for (const uint32_t y : {0u, 2u, 1048575u})
                for (const uint64_t n : {0u, 1u, 2u, 3u, 63u, 64u, 1000u, 999'999'999u, 4'294'967'295u})
                    for (uint32_t d = 0; d < 140; ++d) hasher.value(sampler.bits(sampler.key(x, y, n), d));
    }
    return hasher.hex();
}

TEST(SamplerBits, AreWhatTheyWere) {
    EXPECT_EQ(hash_of(SamplerKind::sobol), "122bd584f4d28b2d377e4ccecc32e00c");
    EXPECT_EQ(hash_of(SamplerKind::independent), "b5bfbe533389448c7dce45eb76fba1db");
}

}  // namespace
}  // namespace steradian
