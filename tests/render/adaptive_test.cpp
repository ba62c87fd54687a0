// The film of pictures with a target for their error: what it samples, and when it stops.
#include "render/adaptive_film.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <utility>

namespace steradian {
namespace {

/// Steele, Lea and Flood 2014, "Fast splittable pseudorandom number generators".
struct SplitMix {
    using result_type = uint64_t;
    uint64_t state = 0;
    static constexpr uint64_t min() { return 0; }
    static constexpr uint64_t max() { return ~uint64_t(0); }
    uint64_t operator()() {
        uint64_t z = state += 0x9e3779b97f4a7c15;
        z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
        z = (z ^ z >> 27) * 0x94d049bb133111eb;
        return z ^ z >> 31;
    }
};

/// Plays the renderer: sums of samples of mean 1 (x below 8) or 0.2, whose noise has a deviation of its own for each of
/// the two. Every sum of a replicate over its first n samples is always the same, as it is when rendered.
class Player {
public:
    /// A seed for each group.
    Player(std::array<uint64_t, 2> seeds, double bright, double dark) : seeds_(seeds), bright_(bright), dark_(dark) {}

    /// Rare: one sample in `rate` has all the noise, so that its distribution is as skewed as that of a small lamp.
    void make_rare(double rate) { rate_ = rate; }

    void pass(AdaptiveFilm& film) {
        for (size_t unit = 0; unit < film.units(); ++unit) {
            const WorkUnit& work = film.work(unit);
            TileSums sums = film.sums(unit);
            for (uint32_t i = 0; i < work.tile.pixels(); ++i)
                for (uint32_t r = 0; r < work.replicates; ++r) add(work, i, r, sums.color[i * work.replicates + r]);
            drawn_ += uint64_t(work.samples) * work.tile.pixels();
            again_ += film.again(unit);
            counts_[{work.tile.x0, work.tile.y0, work.first_replicate}] = work.first_sample + work.samples;
            film.commit(unit, std::move(sums));
        }
    }
    void finish(AdaptiveFilm& film) {
        while (film.begin_pass()) pass(film);
    }

    /// Of a group, in each cell.
    std::vector<uint64_t> counts(size_t group) const {
        std::vector<uint64_t> out;
        for (const auto& [place, count] : counts_)
            if (place[2] == group * kGroupReplicates) out.push_back(count);
        return out;
    }
    uint64_t drawn() const { return drawn_; }
    /// Units that were begun anew.
    int again() const { return again_; }

private:
    void add(const WorkUnit& work, uint32_t pixel, uint32_t replicate, RgbSum& sum) {
        const uint32_t x = work.tile.x0 + pixel % work.tile.width(), y = work.tile.y0 + pixel / work.tile.width();
        const uint32_t sequence = work.first_replicate + replicate;
        const double mean = x < 8 ? 1 : 0.2, deviation = x < 8 ? bright_ : dark_;
        const uint64_t first = work.first_sample / work.replicates, count = work.samples / work.replicates;
        // Steps of eight samples have a generator each.
        for (uint64_t step = first / 8; step < (first + count) / 8; ++step) {
            SplitMix random{seeds_[sequence / kGroupReplicates]};
            for (const uint64_t part : {uint64_t(x), uint64_t(y), uint64_t(sequence), step})
                random.state = random() ^ part;
            const double value = 8 * mean + deviation * noise(random);
            sum += RgbSum{value, value, value};
        }
    }
    /// Of eight samples.
    double noise(SplitMix& random) const {
        if (rate_ == 0) return std::sqrt(8.0) * std::normal_distribution<double>()(random);
        return std::sqrt(rate_) * (std::poisson_distribution<int>(8 / rate_)(random) - 8 / rate_);
    }

    std::array<uint64_t, 2> seeds_;
    double bright_, dark_, rate_ = 0;
    uint64_t drawn_ = 0;
    int again_ = 0;
    std::map<std::array<uint32_t, 3>, uint64_t> counts_;
};

/// Relative to the truth, R of each pixel.
std::vector<double> deviations(const Image& image) {
    std::vector<double> out;
    for (uint32_t i = 0; i < image.width * image.height; ++i) {
        const double truth = i % image.width < 8 ? 1 : 0.2;
        out.push_back((double(image.pixels[i * 3]) - truth) / (truth + 0.01));
    }
    return out;
}

double true_error(const Image& image) {
    double sum = 0;
    const std::vector<double> off = deviations(image);
    for (const double d : off) sum += d * d;
    return std::sqrt(sum / double(off.size()));
}

TEST(AdaptiveFilm, EstimatesTheErrorOfKnownNoise) {
    Player player({1, 2}, 0.8, 0.1);
    AdaptiveFilm film({0, 0, 64, 64}, 10, 64);  // a target that is reached at once
    player.finish(film);
    EXPECT_EQ(film.samples().max, 64u);
    // 1/8 of the pixels are bright. A variance of σ²/64 each.
    const double expected = std::sqrt((0.8 * 0.8 / (1.01 * 1.01) / 8 + 0.1 * 0.1 / (0.21 * 0.21) * 7 / 8) / 64);
    EXPECT_NEAR(film.report().estimate / expected, 1, 0.03);  // 4096 pixels with 6 degrees of freedom: 0.6 %
    EXPECT_NEAR(true_error(film.develop()) / expected, 1, 0.05);
    EXPECT_GT(film.report().bound, film.report().estimate);
    EXPECT_TRUE(film.report().certified);
}

TEST(AdaptiveFilm, StopsAtTheTargetAndSamplesWhereTheNoiseIs) {
    int beyond = 0, certified = 0;
    constexpr int kPictures = 30;
    for (int seed = 0; seed < kPictures; ++seed) {
        Player player({uint64_t(seed), uint64_t(seed) + 1000}, 1.5, 0.02);
        AdaptiveFilm film({0, 0, 40, 56}, 0.06, 1 << 20);
        player.finish(film);
        const ErrorReport report = film.report();
        certified += report.certified;
        EXPECT_GT(report.bound, 0.045);  // and not with many times the samples
        beyond += true_error(film.develop()) > report.bound;
        const AdaptiveFilm::Samples samples = film.samples();
        EXPECT_EQ(samples.min, 64u);
        EXPECT_GT(samples.max, 4 * samples.min);
        EXPECT_LE(samples.total, player.drawn());
        for (const size_t group : {0, 1}) {
            const std::vector<uint64_t> counts = player.counts(group);  // columns of seven cells
            for (size_t i = 0; i < 7; ++i) EXPECT_GE(counts[i], 128u) << i;
            // Those beside them have a third of their deviation.
            for (size_t i = 14; i < counts.size(); ++i) EXPECT_EQ(counts[i], 32u) << i;
        }
    }
    EXPECT_GE(certified, kPictures * 9 / 10);
    // Claimed is 5 % at most; three standard deviations of a binomial above it.
    EXPECT_LE(beyond, 0.05 * kPictures + 3 * std::sqrt(0.05 * 0.95 * kPictures));
}

/// Why stopping makes no bias: how much of a group counts does not depend on anything that it brought. With rare bright
/// samples groups differ much in what they find out.
TEST(AdaptiveFilm, WhatCountsOfAGroupIsFoundOutByTheOtherAlone) {
    int different = 0, again = 0;
    for (uint64_t seed = 0; seed < 10; ++seed) {
        const auto counts = [&](std::array<uint64_t, 2> seeds) {
            Player player(seeds, 1, 0.3);
            player.make_rare(3000);
            AdaptiveFilm film({0, 0, 48, 48}, 0.2, 1 << 14);
            player.finish(film);
            again += player.again();
            return std::array{player.counts(0), player.counts(1)};
        };
        const auto plain = counts({seed, seed + 100}), other = counts({seed, seed + 200}),
                   another = counts({seed + 300, seed + 100});
        EXPECT_EQ(plain[1], other[1]);
        EXPECT_EQ(plain[0], another[0]);
        different += (plain[0] != other[0]) + (plain[1] != another[1]);
    }
    EXPECT_EQ(different, 20);
    EXPECT_GT(again, 0);  // or groups that are begun anew were not tested
}

/// The mean over many pictures, of noise whose variance and third moment go together: a rule that stops a group by what
/// it brought fails this by far.
TEST(AdaptiveFilm, TheMeanHasNoBias) {
    double sum = 0, squares = 0, samples = 0;
    constexpr int kPictures = 100;
    for (int seed = 0; seed < kPictures; ++seed) {
        Player player({uint64_t(seed), uint64_t(seed) + 1000}, 1, 0.3);
        player.make_rare(300);
        AdaptiveFilm film({0, 0, 40, 24}, 0.2, 1 << 16);
        player.finish(film);
        double off = 0;
        const std::vector<double> all = deviations(film.develop());
        for (const double d : all) off += d / double(all.size());
        sum += off, squares += off * off;
        samples += double(film.samples().total) / double(all.size());
    }
    const double n = kPictures, mean = sum / n, error = std::sqrt((squares / n - mean * mean) / (n - 1));
    EXPECT_LT(std::fabs(mean), 3.3 * error) << mean << " with a standard error of " << error;
    EXPECT_LT(error, 0.002);
    EXPECT_GT(samples / n, 80);  // they did get more samples than at first
}

TEST(AdaptiveFilm, SaysWhenTheSamplesDidNotSuffice) {
    Player player({3, 4}, 2, 0.5);
    AdaptiveFilm film({0, 0, 64, 64}, 0.06, 140);
    player.finish(film);
    EXPECT_EQ(film.samples().min, 128u);  // the largest power of two for each replicate
    EXPECT_EQ(film.samples().max, 128u);
    EXPECT_FALSE(film.report().certified);
    EXPECT_NE(film.report().reason.find("did not suffice"), std::string::npos) << film.report().reason;
}

/// Where certifying is out of reach, there is no point in more samples than the noise needs.
TEST(AdaptiveFilm, PicturesOfAFewPixelsStopAtTheirNoise) {
    Player player({4, 5}, 1, 0.2);
    AdaptiveFilm film({0, 0, 16, 16}, 0.06, 1 << 20);
    player.finish(film);
    EXPECT_LT(film.report().estimate, 0.06);
    EXPECT_GT(film.report().estimate, 0.03);
    EXPECT_FALSE(film.report().certified);
}

/// A group's share of a pixel is one half however many samples it has; and every pixel of any window has its place.
TEST(AdaptiveFilm, CoversAnyWindowOnceAndWeighsGroupsAlike) {
    for (const Crop window : {Crop{0, 0, 1, 1}, Crop{3, 5, 30, 6}, Crop{7, 7, 9, 25}, Crop{5, 8, 21, 17}}) {
        AdaptiveFilm film(window, 10, 64);
        ASSERT_TRUE(film.begin_pass());
        for (size_t unit = 0; unit < film.units(); ++unit) {
            const WorkUnit& w = film.work(unit);
            EXPECT_EQ(w.tile.x0 / 8, (w.tile.x1 - 1) / 8);
            EXPECT_EQ(w.tile.y0 / 8, (w.tile.y1 - 1) / 8);
            TileSums sums = film.sums(unit);
            // The value of a pixel says where it is; blue, which group brought it.
            for (uint32_t i = 0; i < w.tile.pixels(); ++i)
                for (uint32_t r = 0; r < w.replicates; ++r) {
                    const double x = w.tile.x0 + i % w.tile.width(), y = w.tile.y0 + i / w.tile.width();
                    const double each = w.samples / double(w.replicates);
                    sums.color[i * w.replicates + r] += RgbSum{each * x, each * y, w.first_replicate ? 3 * each : each};
                }
            film.commit(unit, std::move(sums));
        }
        const Image image = film.develop();
        for (uint32_t y = window.y0; y < window.y1; ++y)
            for (uint32_t x = window.x0; x < window.x1; ++x) {
                const float* p = &image.pixels[((y - window.y0) * image.width + x - window.x0) * 3];
                EXPECT_EQ(p[0], float(x));
                EXPECT_EQ(p[1], float(y));
                EXPECT_EQ(p[2], 2);
            }
        EXPECT_FALSE(film.begin_pass());
    }
}

}  // namespace
}  // namespace steradian
