// What replicates tell of the error, against noise whose distribution is known.
#include "render/error_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace steradian {
namespace {

/// Draws the mean of one replicate.
using Draw = std::function<double(std::mt19937_64&)>;

struct Pixel {
    std::vector<RgbSum> sums;
    double mean = 0;
};
Pixel pixel(const Draw& draw, std::mt19937_64& random) {
    Pixel out;
    for (uint32_t r = 0; r < kReplicates; ++r) {
        const double x = draw(random);
        out.sums.push_back({x, x, x});
        out.mean += x / kReplicates;
    }
    return out;
}
ErrorSums error_of(const Pixel& p, double around) {
    const std::span all(p.sums);
    return pixel_error({all.first(kGroupReplicates), 1}, {all.last(kGroupReplicates), 1}, {around, around, around});
}

struct Noise {
    const char* name;
    double mean;
    double error;  ///< √Var / (mean + 0.01) of the mean of all replicates
    Draw draw;
};
std::vector<Noise> noises() {
    // Rare bright samples: `rate` of them in a replicate, on average.
    const auto rare = [](double rate) {
        return [rate](std::mt19937_64& random) {
            return 0.2 + double(std::poisson_distribution<int>(rate)(random)) / rate;
        };
    };
    const auto of_rare = [](double rate) { return std::sqrt(1 / (rate * kReplicates)) / 1.21; };
    return {{"normal", 1, 0.1 / std::sqrt(8.0) / 1.01,
             [](std::mt19937_64& random) { return std::normal_distribution<double>(1, 0.1)(random); }},
            {"dark", 0.001, 0.001 / std::sqrt(8.0) / 0.011,
             [](std::mt19937_64& random) { return std::exponential_distribution<double>(1000)(random); }},
            {"two in a replicate", 1.2, of_rare(2), rare(2)},
            {"one in eight replicates", 1.2, of_rare(0.125), rare(0.125)}};
}

/// The estimate is no smaller than the truth, and where replicates have more than rare samples not much larger.
TEST(ErrorEstimate, TellsTheVarianceOfWhatIsKnown) {
    constexpr int kPixels = 40000;
    for (const Noise& noise : noises()) {
        std::mt19937_64 random(1);
        ErrorSums sums;
        for (int i = 0; i < kPixels; ++i) sums += error_of(pixel(noise.draw, random), noise.mean);
        const double ratio = sums.v / sums.pixels / (noise.error * noise.error);
        const double standard_error = std::sqrt(sums.squares) / sums.v;
        EXPECT_GT(ratio, 1 - 5 * standard_error) << noise.name;
        EXPECT_LT(ratio, noise.error < 0.2 ? 1.1 : 2.5) << noise.name;
    }
}

/// With enough pixels the true squared error is beyond the margin as often as it may be, or less: at every level, and
/// for distributions far from normal.
TEST(ErrorEstimate, MarginHoldsAsOftenAsItSays) {
    constexpr int kPictures = 400;
    for (const Noise& noise : noises())
        for (const int pixels : {100, 600}) {
            std::mt19937_64 random(2);
            std::array<int, 2> beyond{};
            const std::array<double, 2> doubts{0.05, 0.01};
            int trusted = 0;
            for (int k = 0; k < kPictures; ++k) {
                ErrorSums sums;
                double square = 0;
                for (int i = 0; i < pixels; ++i) {
                    const Pixel p = pixel(noise.draw, random);
                    const double off = (p.mean - noise.mean) / (noise.mean + 0.01);
                    square += off * off;
                    sums += error_of(p, noise.mean);
                }
                if (error_freedom(sums) < 16) continue;
                ++trusted;
                for (size_t d = 0; d < doubts.size(); ++d)
                    beyond[d] += square > sums.v * error_margin(sums, doubts[d]) + unseen_error(doubts[d]);
            }
            EXPECT_GT(trusted, kPictures / 2) << noise.name << ", " << pixels << " pixels";
            for (size_t d = 0; d < doubts.size(); ++d) {
                const double expected = doubts[d] * trusted;
                EXPECT_LE(beyond[d], expected + 4 * std::sqrt(expected)) << noise.name << ", " << pixels << " pixels";
            }
        }
}

/// Normal noise: the margin by itself, without what is added for the unseen, is neither too small nor too large.
TEST(ErrorEstimate, MarginOfNormalNoiseIsExact) {
    constexpr int kPictures = 1000, kPixels = 200;
    const Noise noise = noises()[0];
    std::mt19937_64 random(3);
    int beyond = 0;
    for (int k = 0; k < kPictures; ++k) {
        ErrorSums sums;
        double square = 0;
        for (int i = 0; i < kPixels; ++i) {
            const Pixel p = pixel(noise.draw, random);
            square += (p.mean - 1) * (p.mean - 1) / (1.01 * 1.01);
            sums += error_of(p, 1);
        }
        EXPECT_NEAR(error_freedom(sums) / kPixels, 6, 2.5);  // degrees of freedom of two groups of four
        beyond += square > sums.v * error_margin(sums, 0.05);
    }
    // 50 expected, with a standard deviation of 7; the estimate of the freedom makes it a little less or more.
    EXPECT_NEAR(beyond, 50, 30);
}

TEST(ErrorEstimate, OneSampleThatMakesMostOfTheErrorIsNotTrusted) {
    std::mt19937_64 random(4);
    const Noise noise = noises()[0];
    ErrorSums sums;
    for (int i = 0; i < 10000; ++i) sums += error_of(pixel(noise.draw, random), 1);
    EXPECT_TRUE(judge(sums, 0.1).certified) << judge(sums, 0.1).reason;
    Pixel firefly = pixel(noise.draw, random);
    firefly.sums[3] = {800, 800, 800};
    sums += error_of(firefly, 1);
    const ErrorReport report = judge(sums, 100);  // the bound is not why
    EXPECT_FALSE(report.certified);
    EXPECT_NE(report.reason.find("heavy tails"), std::string::npos) << report.reason;
}

/// One group tells the same error, with less certainty.
TEST(ErrorEstimate, OneGroupTellsTheErrorOfBoth) {
    const Noise noise = noises()[0];
    std::mt19937_64 random(5);
    std::array<ErrorSums, 3> sums;
    constexpr int kPixels = 20000;
    for (int i = 0; i < kPixels; ++i) {
        const Pixel p = pixel(noise.draw, random);
        const std::span all(p.sums);
        sums[0] += group_error({all.first(kGroupReplicates), 1}, {1, 1, 1});
        sums[1] += group_error({all.last(kGroupReplicates), 1}, {1, 1, 1});
        sums[2] += error_of(p, 1);
    }
    for (const size_t group : {0, 1}) {
        const ErrorSums& s = sums[group];
        EXPECT_NEAR(s.v / sums[2].v, 1, 0.02);
        const double v2 = noise.error * noise.error * noise.error * noise.error * kPixels;
        EXPECT_NEAR(s.products / v2, 1, 0.07);          // two of one degree of freedom each: Var = 8 / 20000
        EXPECT_NEAR(s.squares / v2, 1 + 2.0 / 3, 0.1);  // three degrees of freedom
        EXPECT_NEAR(error_freedom(s, Teller::one_group) / kPixels, 3, 0.3);
        EXPECT_GT(error_margin(s, 0.05, Teller::one_group), error_margin(sums[2], 0.05));
    }
    EXPECT_NEAR(error_freedom(sums[2]) / kPixels, 6, 0.4);
}

/// The ratio of two estimates of one error is beyond the margin as often as is said.
TEST(ErrorEstimate, RepetitionsAreWithinTheirMargin) {
    const Noise noise = noises()[0];
    std::mt19937_64 random(6);
    constexpr int kPictures = 1000;
    int beyond = 0;
    for (int k = 0; k < kPictures; ++k) {
        std::array<ErrorSums, 2> sums;
        for (int i = 0; i < 100; ++i) {
            const Pixel p = pixel(noise.draw, random);
            const std::span all(p.sums);
            sums[0] += group_error({all.first(kGroupReplicates), 1}, {1, 1, 1});
            sums[1] += group_error({all.last(kGroupReplicates), 1}, {1, 1, 1});
        }
        beyond += sums[1].v > sums[0].v * repetition_margin(sums[0], 0.05, Teller::one_group);
    }
    EXPECT_NEAR(beyond, 50, 30);  // a standard deviation of 7, and the freedom is itself estimated
}

/// Without any noise that could be seen, what is not seen decides.
TEST(ErrorEstimate, FewPixelsAreNotEnoughForASmallTarget) {
    EXPECT_NEAR(unseen_error(0.05), 2.9957, 1e-4);
    for (const double target : {0.3, 0.05, 0.01}) {
        const double enough = 2 * unseen_error(0.05) / (target * target);
        EXPECT_TRUE(enough_pixels(enough * 1.001, target));
        EXPECT_FALSE(enough_pixels(enough * 0.999, target));
        EXPECT_TRUE(judge({enough * 1.001, 0, 0, 0}, target).certified);
        const ErrorReport report = judge({enough * 0.999, 0, 0, 0}, target);
        EXPECT_FALSE(report.certified);
        EXPECT_NE(report.reason.find("pixels"), std::string::npos);
    }
}

}  // namespace
}  // namespace steradian
