// How samples are spread over the cells of a picture.
#include "render/allocation.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numeric>

namespace steradian {
namespace {

constexpr SampleLimits kLimits{32, uint64_t(1) << 40};

/// Cells of 64 pixels whose single samples have these relative deviations, each told by `samples` of them.
std::vector<CellError> cells(const std::vector<double>& deviations, uint64_t samples) {
    std::vector<CellError> out;
    for (const double d : deviations) {
        const double v = d * d / double(samples);
        // Squares and products as normal replicates have them.
        out.push_back({samples, {64, 64 * v, 64 * v * v * (1 + 2.0 / 3), 64 * v * v}});
    }
    return out;
}

/// The mean squared error by such an allocation; a group's share of the samples is one half, as allocate() has it.
double error2(const std::vector<double>& deviations, const std::vector<uint64_t>& samples) {
    double sum = 0;
    for (size_t i = 0; i < samples.size(); ++i) sum += deviations[i] * deviations[i] / double(samples[i]);
    return sum / double(samples.size());
}

std::vector<double> many_deviations() {
    std::vector<double> out;
    for (int i = 0; i < 3000; ++i) out.push_back(0.3 * std::exp(4.0 * i / 3000));
    return out;
}

/// With many cells the margins are near 1, and the sum of samples is that of the best real numbers, (Σ d)² / goal, but
/// for what powers of two cost: a factor of (sinh(ln 2 / 2) / (ln 2 / 2))² = 1.04.
TEST(Allocation, IsTheLeastThatReachesTheTarget) {
    const std::vector<double> deviations = many_deviations();
    const double target = 0.02, n = double(deviations.size());
    for (const uint64_t told_by : {32, 4096}) {
        const std::vector<uint64_t> samples = allocate(cells(deviations, told_by), deviations.size(), target, kLimits);
        for (const uint64_t s : samples) EXPECT_TRUE(std::has_single_bit(s)) << s;
        const double reached = error2(deviations, samples) / (target * target);
        EXPECT_LT(reached, 1);
        EXPECT_GT(reached, 0.9);
        const double sum = std::accumulate(deviations.begin(), deviations.end(), 0.0);
        const double best = sum * sum / (n * target * target * reached);
        const double used = double(std::accumulate(samples.begin(), samples.end(), uint64_t(0)));
        EXPECT_LT(used / best, 1.06);
        EXPECT_GT(used / best, 1);
    }
}

TEST(Allocation, KeepsToTheLimits) {
    const std::vector<double> deviations = many_deviations();
    for (const uint64_t s : allocate(cells(deviations, 32), 3000, 5, kLimits)) EXPECT_EQ(s, 32u);
    for (const uint64_t s : allocate(cells(deviations, 32), 3000, 1e-5, {8, 256})) EXPECT_EQ(s, 256u);
    for (const uint64_t s : allocate(cells({0, 0, 0}, 32), 3, 0.1, kLimits)) EXPECT_EQ(s, 32u);
}

/// A cell that seems to have no noise may have met none of it.
TEST(Allocation, QuietCellsHaveAFloor) {
    std::vector<double> deviations(1000, 1.0);
    for (size_t i = 0; i < 500; ++i) deviations[i] = 0;
    const std::vector<uint64_t> samples = allocate(cells(deviations, 32), 1000, 0.01, kLimits);
    EXPECT_GT(samples[0], 32u);
    EXPECT_NEAR(double(samples[999]) / double(samples[0]), 20, 13);  // within a power of two: 16 or 32
}

/// Few cells, or a few that make all of the error, are known less well, and so get more.
TEST(Allocation, LeavesAMarginForWhatIsNotKnown) {
    double last = 1.03;
    for (const size_t count : {3000, 100, 12}) {
        // Of deviations over more than a power of two, so that the scale shows.
        std::vector<double> deviations;
        for (size_t i = 0; i < count; ++i) deviations.push_back(2 + 2 * double(i) / double(count));
        const double target = 0.1;
        const double reached = error2(deviations, allocate(cells(deviations, 1024), count, target, kLimits));
        EXPECT_LT(reached, 0.97 * target * target * last) << count;
        last = reached / (target * target);
    }
}

/// Nine cells of which one met something rare: the others have a third of its deviation.
TEST(Allocation, WhatTheCellsAroundMetIsExpectedHere) {
    std::vector<double> deviations(60 * 50, 1.0);
    deviations[10 * 60 + 20] = 48;
    deviations[0] = 48;
    const std::vector<uint64_t> samples = allocate(cells(deviations, 4096), 60, 0.02, kLimits);
    const uint64_t plain = samples[30 * 60 + 30], most = samples[10 * 60 + 20];
    for (size_t y = 0; y < 50; ++y)
        for (size_t x = 0; x < 60; ++x) {
            const bool near_one = x >= 19 && x <= 21 && y >= 9 && y <= 11, near_corner = x <= 1 && y <= 1;
            EXPECT_EQ(samples[y * 60 + x] > plain, near_one || near_corner) << x << ", " << y;
        }
    EXPECT_GE(most, 32 * plain);
    EXPECT_NEAR(double(most) / double(samples[11 * 60 + 21]), 3, 1.01);  // 2 or 4
}

/// As long as a few samples make most of what is known of the noise, more are asked for than the target needs.
TEST(Allocation, GoesOnUntilTheEstimateCanBeTrusted) {
    std::vector<CellError> quiet = cells(std::vector<double>(1000, 0.03), 32), heavy = quiet;
    // One pixel of variance 4, which one of its replicates alone tells.
    heavy[500].error += ErrorSums{0, 4, 16, 0};
    EXPECT_EQ(allocate(quiet, 1000, 0.3, kLimits)[500], 32u);
    const std::vector<uint64_t> samples = allocate(heavy, 1000, 0.3, kLimits);
    EXPECT_GE(samples[500], 256u);
}

}  // namespace
}  // namespace steradian
