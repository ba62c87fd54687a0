// What the samplers promise as random numbers. All seeds are fixed; a right sampler would fail one of these with a
// probability of at most (number of tests) × (level), which is stated beside each level.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "shading/sampler.h"
#include "support/chi_square.h"
#include "support/support.h"

namespace steradian {
namespace {

using test::by_tier;
using test::chi_square;
using test::ChiSquare;

constexpr SamplerKind kKinds[] = {SamplerKind::sobol, SamplerKind::independent};
constexpr uint32_t kDimensions = 32;

const char* name(SamplerKind kind) { return kind == SamplerKind::sobol ? "sobol" : "independent"; }

struct Experiment {
    const char* name;
    bool one_pixel;
    SampleKey (*key)(const Sampler&, uint32_t i);  ///< the i-th sample
};

constexpr Experiment kExperiments[] = {
    {"one pixel, many samples", true, [](const Sampler& s, uint32_t i) { return s.key(100, 200, i); }},
    {"many pixels, first sample", false, [](const Sampler& s, uint32_t i) { return s.key(i & 255, i >> 8, 0); }},
    {"a column of pixels, sample 77", false, [](const Sampler& s, uint32_t i) { return s.key(5, i, 77); }},
};

/// The samples of one pixel in two groups of the Sobol sampler are not independent of each other: in each group they
/// are shuffled in nested blocks. With 16 × 16 cells the statistic is a sum over the 15 × 15 products of Walsh
/// functions of the first four digits. Each such function is the parity of some bits of the shuffled index, i being the
/// lowest of them; every i = 0 … 3 is the lowest for 8, 4, 2, 1 functions, as the first digits depend on the first bits
/// one to one. A product vanishes over every block of 2^(i+1) samples if i differs; if not, it is one coin for the
/// whole block. So the sum is Σ g χ²₁ with 64, 16, 4, 1 terms of g = 2, 4, 8, 16 (mean 240, for independent samples
/// 255). This is Chernoff's bound of the probability that it exceeds x: min over λ of e^(-λx) Π (1 - 2λg)^(-1/2).
double padded_upper_tail(double x) {
    double least = 0;
    for (double lambda = 0; lambda < 1.0 / 32; lambda += 1.0 / 4096) {
        double exponent = -lambda * x;
        for (const auto& [gain, terms] : {std::pair{2, 64}, {4, 16}, {8, 4}, {16, 1}})
            exponent -= terms / 2.0 * std::log1p(-2 * lambda * gain);
        least = std::min(least, exponent);
    }
    return std::exp(least);
}

// 2 kinds × 3 experiments × 496 pairs at 1e-7: below 3e-4 together (Bonferroni). One-sided: within a group Sobol points
// are more uniform than random ones, and that is no fault.
TEST(SamplerStatistics, EveryPairOfDimensionsIsUniform) {
    constexpr double kLevel = 1e-7;
    constexpr size_t kSide = 16;
    const uint32_t count = by_tier(1u << 16, 1u << 20);
    const std::vector<double> expected(kSide * kSide, double(count) / (kSide * kSide));
    for (const SamplerKind kind : kKinds)
        for (const auto& experiment : kExperiments) {
            const Sampler sampler(kind, 12345);
            std::vector<std::array<uint8_t, kDimensions>> cells(count);
            for (uint32_t i = 0; i < count; ++i)
                for (uint32_t d = 0; d < kDimensions; ++d)
                    cells[i][d] = static_cast<uint8_t>(sampler.bits(experiment.key(sampler, i), d) >> 28);
            for (uint32_t a = 0; a < kDimensions; ++a)
                for (uint32_t b = a + 1; b < kDimensions; ++b) {
                    std::vector<double> observed(kSide * kSide);
                    for (const auto& cell : cells) ++observed[cell[a] * kSide + cell[b]];
                    const ChiSquare result = chi_square(observed, expected);
                    const bool padded = kind == SamplerKind::sobol && experiment.one_pixel && a / 4 != b / 4;
                    EXPECT_GE(padded ? padded_upper_tail(result.statistic) : result.p_value, kLevel)
                        << name(kind) << ", " << experiment.name << ", dimensions " << a << ", " << b << ": " << result;
                }
        }
}

// The statistics of many pixels follow from that theory: their mean over pixels and pairs is 240.
TEST(SamplerStatistics, PaddedPairsVaryAsTheyShould) {
    constexpr uint32_t kPixels = 200, kSamples = 4096;
    const Sampler sampler(SamplerKind::sobol, 77);
    const std::vector<double> expected(256, kSamples / 256.0);
    double sum = 0;
    for (uint32_t p = 0; p < kPixels; ++p) {
        const uint32_t a = p % 4, b = 4 + p / 4 % 8;
        std::vector<double> observed(256);
        for (uint32_t n = 0; n < kSamples; ++n) {
            const SampleKey key = sampler.key(p, 1, n);
            const uint32_t row = sampler.bits(key, a) >> 28, column = sampler.bits(key, b) >> 28;
            ++observed[row * 16 + column];
        }
        sum += chi_square(observed, expected).statistic;
    }
    // One statistic has variance 2 Σ g² = 2048; 5.5 standard deviations of the mean.
    EXPECT_NEAR(sum / kPixels, 240, 5.5 * std::sqrt(2048.0 / kPixels));
}

/// For independent uniform numbers Σ 12 (a - ½)(b - ½) / √n has mean 0 and variance 1, and is nearly normal for the n
/// used here; that also holds when the pairs share members, as neighbours do, since different products of independent
/// numbers are uncorrelated.
class Correlation {
public:
    void add(float a, float b) {
        sum_ += 12 * (static_cast<double>(a) - 0.5 + 0x1p-25) * (static_cast<double>(b) - 0.5 + 0x1p-25);
        count_ += 1;
    }
    double deviation() const { return sum_ / std::sqrt(count_); }

private:
    double sum_ = 0, count_ = 0;
};

// The normal distribution exceeds 5.5 in size with probability 3.8e-8. Fewer than 2000 are checked: below 1e-4
// together.
constexpr double kLargestDeviation = 5.5;

TEST(SamplerStatistics, NeighbouringPixelsAreUncorrelated) {
    struct Step {
        uint32_t x, y;
    };
    const uint32_t side = by_tier(128u, 1024u);
    for (const SamplerKind kind : kKinds)
        for (const Step step : {Step{1, 0}, {0, 1}, {1, 1}, {2, 0}, {0, 2}, {16, 0}, {0, 16}, {64, 64}})
            for (const uint32_t sample : {0u, 3u})
                for (uint32_t a = 0; a < 8; ++a)
                    for (const uint32_t b : {a, (a + 1) % 8}) {
                        const Sampler sampler(kind, 99);
                        Correlation correlation;
                        for (uint32_t y = 0; y < side; ++y)
                            for (uint32_t x = 0; x < side; ++x)
                                correlation.add(sampler.get_1d(sampler.key(x, y, sample), a),
                                                sampler.get_1d(sampler.key(x + step.x, y + step.y, sample), b));
                        EXPECT_LT(std::fabs(correlation.deviation()), kLargestDeviation)
                            << name(kind) << " step " << step.x << ", " << step.y << " sample " << sample
                            << " dimensions " << a << ", " << b;
                    }
}

TEST(SamplerStatistics, SeedsAreUncorrelated) {
    const uint32_t side = by_tier(128u, 1024u);
    for (const SamplerKind kind : kKinds)
        for (const uint64_t other : {uint64_t{1}, uint64_t{2}, uint64_t{1} << 32, uint64_t{1} << 63, ~uint64_t{0}})
            for (uint32_t d = 0; d < 8; ++d) {
                const Sampler first(kind, 0), second(kind, other);
                Correlation same_pixel, next_pixel;
                for (uint32_t y = 0; y < side; ++y)
                    for (uint32_t x = 0; x < side; ++x) {
                        const float u = first.get_1d(first.key(x, y, 0), d);
                        same_pixel.add(u, second.get_1d(second.key(x, y, 0), d));
                        next_pixel.add(u, second.get_1d(second.key(x + 1, y, 0), d));
                    }
                EXPECT_LT(std::fabs(same_pixel.deviation()), kLargestDeviation) << name(kind) << other << ", " << d;
                EXPECT_LT(std::fabs(next_pixel.deviation()), kLargestDeviation) << name(kind) << other << ", " << d;
            }
}

TEST(SamplerStatistics, GroupsAreUncorrelatedWhateverTheSample) {
    // Within a group the samples of a pixel avoid each other on purpose; between groups nothing may be related.
    const uint32_t side = by_tier(64u, 256u);
    for (const SamplerKind kind : kKinds)
        for (const uint32_t lag : {0u, 1u, 2u, 3u, 8u})
            for (const uint32_t other : {4u, 5u, 8u, 31u}) {
                const Sampler sampler(kind, 5);
                Correlation correlation;
                for (uint32_t y = 0; y < side; ++y)
                    for (uint32_t x = 0; x < side; ++x)
                        for (uint32_t n = 0; n < 8; ++n)
                            correlation.add(sampler.get_1d(sampler.key(x, y, n), 0),
                                            sampler.get_1d(sampler.key(x, y, n + lag), other));
                EXPECT_LT(std::fabs(correlation.deviation()), kLargestDeviation) << name(kind) << lag << ", " << other;
            }
}

// Light samples of a long render have indices beyond 2^32, where the Sobol sequence has come to its end.
TEST(SamplerStatistics, SamplesBeyondTheSequenceAreNew) {
    const uint32_t side = by_tier(128u, 1024u);
    for (const SamplerKind kind : kKinds)
        for (const uint64_t round : {1u, 2u, 1000u})
            for (uint32_t d = 0; d < 8; ++d) {
                const Sampler sampler(kind, 5);
                Correlation correlation;
                for (uint32_t y = 0; y < side; ++y)
                    for (uint32_t x = 0; x < side; ++x)
                        correlation.add(sampler.get_1d(sampler.key(x, y, 7), d),
                                        sampler.get_1d(sampler.key(x, y, 7 + (round << 32)), d));
                EXPECT_LT(std::fabs(correlation.deviation()), kLargestDeviation) << name(kind) << round << ", " << d;
            }
}

TEST(SamplerStatistics, IndependentSamplesAreUncorrelated) {
    const uint32_t side = by_tier(128u, 1024u);
    const Sampler sampler(SamplerKind::independent, 5);
    for (const uint32_t lag : {1u, 2u, 3u, 4u, 64u, 65536u})
        for (uint32_t d = 0; d < 8; ++d) {
            Correlation correlation;
            for (uint32_t y = 0; y < side; ++y)
                for (uint32_t x = 0; x < side; ++x)
                    correlation.add(sampler.get_1d(sampler.key(x, y, 7), d),
                                    sampler.get_1d(sampler.key(x, y, 7 + lag), d));
            EXPECT_LT(std::fabs(correlation.deviation()), kLargestDeviation) << lag << ", " << d;
        }
}

// Owen's scramble is defined by independent fair coins, one for each node of the binary tree of digits. In dimension 0
// the shuffle of the index is such a scramble too, and two in a row are one. The 15 coins of the first four levels are
// read off the points and their joint distribution is tested: 32768 outcomes. (Scrambling by additions and
// multiplications alone fails this: there the coins of one level have a fixed parity.)
TEST(SamplerStatistics, ScrambleTossesIndependentCoins) {
    constexpr uint32_t kLevels = 4, kNodes = 15;
    const uint32_t pixels = by_tier(1u << 18, 1u << 22);
    for (const uint32_t dimension : {0u, 8u}) {
        const Sampler sampler(SamplerKind::sobol, 3);
        std::vector<double> observed(1u << kNodes), expected(1u << kNodes, double(pixels) / (1u << kNodes));
        for (uint32_t p = 0; p < pixels; ++p) {
            uint32_t coins = 0;
            for (uint32_t level = 0, node = 0; level < kLevels; ++level)
                for (uint32_t index = 0; index < 1u << level; ++index, ++node) {
                    // Sample `index` has its first `level` digits, last first, in front of zeros: it passes this node.
                    const uint32_t point = sampler.bits(sampler.key(p & 1023, p >> 10, index), dimension);
                    coins |= (point >> (31 - level) & 1) << node;
                }
            ++observed[coins];
        }
        const ChiSquare result = chi_square(observed, expected);
        EXPECT_TRUE(result.passes()) << dimension << ": " << result;
    }
}

// --- Convergence -----------------------------------------------------------------------------------------------------

/// The mean squared error of the integral of Π e^x / (e - 1), which is 1, over the four dimensions of a group.
double squared_error(SamplerKind kind, uint64_t seed, uint32_t samples, uint32_t pixels) {
    const Sampler sampler(kind, seed);
    double sum = 0;
    for (uint32_t p = 0; p < pixels; ++p) {
        double estimate = 0;
        for (uint32_t n = 0; n < samples; ++n) {
            const SampleKey key = sampler.key(p, 0, n);
            double exponent = 0;
            for (uint32_t d = 4; d < 8; ++d) exponent += static_cast<double>(sampler.get_1d(key, d)) + 0x1p-25;
            estimate += std::exp(exponent);
        }
        const double error = estimate / samples / std::pow(std::exp(1.0) - 1, 4) - 1;
        sum += error * error;
    }
    return sum / pixels;
}

TEST(SamplerStatistics, SobolConvergesFasterThanIndependentSamples) {
    // One factor has variance v = (e² - 1) / (2 (e - 1)²) - 1, the product (1 + v)⁴ - 1.
    const double e = std::exp(1.0);
    const double variance = std::pow((e * e - 1) / (2 * (e - 1) * (e - 1)), 4) - 1;
    constexpr uint32_t kPixels = 64;
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        // The mean of 64 squared normal errors lies within [0.34, 2.1] of its expectation but for 1e-6.
        const double independent = squared_error(SamplerKind::independent, seed, 1024, kPixels) / (variance / 1024);
        EXPECT_GT(independent, 0.34);
        EXPECT_LT(independent, 2.1);
        // Theory for smooth functions (Owen 1997): mean squared error of the order of log³n / n³ against 1 / n. From 64
        // to 1024 samples it falls by 16³ / (10/6)³ ≈ 900 against 16. The bounds lie at the geometric middle, a factor
        // of 7 from either, and no spread of 64 errors bridges that.
        const double few = squared_error(SamplerKind::sobol, seed, 64, kPixels);
        const double many = squared_error(SamplerKind::sobol, seed, 1024, kPixels);
        EXPECT_LT(many * 120, few);
        EXPECT_LT(many * 120, variance / 1024);
    }
}

}  // namespace
}  // namespace steradian
