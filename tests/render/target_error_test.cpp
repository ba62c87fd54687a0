// Renders that end when the error is small enough: the same bits, no bias from stopping, and claims that hold.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/names.h"
#include "render/sums.h"
#include "render_support.h"
#include "steradian/replay.h"
#include "support/support.h"
#include "test_scenes.h"

namespace steradian {
namespace {

using test::prepared;
using test::run;

RenderSettings up_to(float error, uint64_t most = kDefaultMostSamples, uint32_t side = 32) {
    RenderSettings s;
    s.width = s.height = side;
    s.samples_per_pixel = most;
    s.max_depth = 3;
    s.target_error = error;
    return s;
}

/// A room that is lit from a small lamp, with a block in front of it. Some pixels see the lamp with the very edge of
/// their filter only, one sample in a thousand.
Scene shadows() {
    Scene s;
    const MaterialId white = test::diffuse(s, {0.7f, 0.7f, 0.7f}, true);
    const MaterialId red = test::diffuse(s, {0.7f, 0.2f, 0.1f}, true);
    test::place(s, Rectangle{{0, 0, 0}, {30, 0, 0}, {0, 0, -30}}, white);
    test::place(s, Rectangle{{-2, 2, 0}, {0, 0, -3}, {0, 2, 0}}, red);
    test::place(s, Rectangle{{0, 2, -2}, {30, 0, 0}, {0, 30, 0}}, white);
    test::place(s, Sphere{{0.5f, 1, 0}, 0.5f}, white);
    const InstanceId lamp = test::place(s, Rectangle{{0.3f, 3, 0.5f}, {0.6f, 0, 0}, {0, 0, 0.6f}}, white);
    s.lights = {AreaLight{lamp, {10, 9, 8}, true, 1}};
    s.cameras = {PerspectiveCamera{{0, 1.5f, 6}, {0, 1, 0}, {0, 1, 0}, 40}};
    return s;
}

/// A room whose light comes over the edge of a wall.
Scene behind_a_wall() {
    Scene s;
    const MaterialId white = test::diffuse(s, {0.8f, 0.8f, 0.75f}, true);
    const MaterialId blue = test::diffuse(s, {0.1f, 0.2f, 0.7f}, true);
    test::place(s, Rectangle{{0, 0, 0}, {4, 0, 0}, {0, 0, -4}}, white);
    test::place(s, Rectangle{{0, 2, -3}, {4, 0, 0}, {0, 2, 0}}, blue);
    test::place(s, Rectangle{{-3, 2, 0}, {0, 0, -4}, {0, 2, 0}}, white);
    test::place(s, Rectangle{{-0.2f, 2, 0}, {0, 0, -4}, {0, 1.2f, 0}}, blue);
    test::place(s, Rectangle{{0, 4, 0}, {4, 0, 0}, {0, 0, -4}}, white);
    const InstanceId lamp = test::place(s, Sphere{{2, 3, -1}, 0.15f}, white);
    s.lights = {AreaLight{lamp, {90, 80, 70}, true, 1}};
    s.cameras = {PerspectiveCamera{{-1.5f, 1.5f, 6}, {-1, 1, 0}, {0, 1, 0}, 40}};
    return s;
}

/// Nine lamps of less than a pixel, and a mirror that shows them smaller still.
Scene beads() {
    Scene s;
    const MaterialId white = test::diffuse(s, {0.6f, 0.6f, 0.6f}, true);
    const auto mirror = add<MaterialId>(s.materials, Material(MirrorMaterial{{0.9f, 0.9f, 0.9f}}));
    test::place(s, Rectangle{{0, 0, 0}, {9, 0, 0}, {0, 0, -9}}, white);
    test::place(s, Sphere{{0.8f, 0.7f, 0}, 0.7f}, mirror);
    for (int i = 0; i < 9; ++i) {
        const float x = float(i % 3) * 1.1f - 1.3f, z = float(i / 3) * 1.2f - 2;
        const InstanceId bead = test::place(s, Sphere{{x, 0.3f + 0.35f * float(i % 4), z}, 0.05f}, white);
        s.lights.push_back(AreaLight{bead, {30 + 5 * float(i), 25, 40 - 3 * float(i)}, true, 1});
    }
    s.cameras = {PerspectiveCamera{{0, 1.5f, 6}, {0, 0.8f, 0}, {0, 1, 0}, 40}};
    return s;
}

TEST(TargetError, GivesTheSameBitsOnAnyNumberOfThreads) {
    const auto scene = prepared(shadows());
    RenderSettings settings = up_to(0.06f);
    settings.width = settings.height = 64;
    settings.integrator = IntegratorKind::direct;
    settings.crop = Crop{1, 2, 62, 59};
    settings.seed = 1;
    Execution one;
    one.threads = 1;
    const RenderResult first = run(scene, settings, one);
    ASSERT_TRUE(first.error);
    EXPECT_TRUE(first.error->certified) << first.error->reason;
    EXPECT_LT(first.min_samples, first.max_samples);
    for (const uint32_t threads : {2u, 5u}) {
        Execution other;
        other.threads = threads;
        other.tile_size = 5 * threads;
        const RenderResult again = run(scene, settings, other);
        EXPECT_EQ(again.image.pixels, first.image.pixels);
        EXPECT_EQ(again.image.metadata, first.image.metadata);
        EXPECT_EQ(again.error->bound, first.error->bound);
    }
    const auto& m = first.image.metadata;
    EXPECT_EQ(m.at("steradian:target_error"), "0.06");
    EXPECT_EQ(m.at("steradian:certified").substr(0, 5), "yes: ");
    EXPECT_NE(m.at("steradian:certified").find("95 % confidence"), std::string::npos);
    EXPECT_EQ(m.at("steradian:samples"), std::to_string(first.min_samples));
    EXPECT_EQ(m.at("steradian:max_samples"), std::to_string(first.max_samples));
    EXPECT_NEAR(std::stod(m.at("steradian:mean_samples")), first.mean_samples, 0.06);
    EXPECT_EQ(m.count("steradian:partial"), 0u);
}

TEST(TargetError, SamplesCanBeReplayed) {
    const auto scene = prepared(test::everything_scene());
    const RenderSettings settings = up_to(10, 64);
    const RenderResult picture = run(scene, settings);
    std::array<double, kReplicates> replicates{};
    for (uint64_t i = 0; i < 64; ++i) {
        const auto trace = replay(scene, settings, 11, 17, i);
        ASSERT_TRUE(trace.ok());
        EXPECT_EQ(trace->sample, i);
        replicates[i % kReplicates] += double(trace->radiance.g) * double(trace->filter_weight);
    }
    double sum = 0;
    for (const double r : replicates) sum += r;
    EXPECT_FLOAT_EQ(picture.image.pixels[(17 * 32 + 11) * 3 + 1], static_cast<float>(sum / 64));
}

TEST(TargetError, IsRefusedWhereTheTailsAreHeavy) {
    // A lamp of a few centimetres that is found by chance only.
    Scene s = shadows();
    std::get<Rectangle>(s.shapes[4]).half_u = {0.02f, 0, 0};
    std::get<Rectangle>(s.shapes[4]).half_v = {0, 0, 0.02f};
    std::get<AreaLight>(s.lights[0]).radiance = {9000, 8000, 7000};
    RenderSettings settings = up_to(3, 256);
    settings.light_sampling = LightSampling::bsdf;
    const RenderResult r = run(prepared(std::move(s)), settings);
    ASSERT_TRUE(r.error);
    EXPECT_TRUE(r.complete);
    EXPECT_FALSE(r.error->certified);
    EXPECT_EQ(r.image.metadata.at("steradian:certified").substr(0, 4), "no: ");
}

TEST(TargetError, IsNotForTimeToDecide) {
    Execution execution;
    execution.time_limit = 1;
    const auto job = RenderJob::start(prepared(shadows()), up_to(0.1f), execution);
    ASSERT_FALSE(job.ok());
    EXPECT_EQ(job.error().code, ErrorCode::usage);
}

/// The most that rounding a mean to single precision, and eight of them, can make.
void expect_parts_to_sum_up(const Image& image) {
    using test::channel;
    for (const char* c : {"R", "G", "B"}) {
        const std::vector<float> whole = channel(image, c);
        std::vector<double> sum(whole.size());
        for (size_t aov = size_t(kFirstLightPart); aov <= size_t(kLastLightPart); ++aov) {
            const std::vector<float> part = channel(image, std::string(name_of(static_cast<Aov>(aov))) + "." + c);
            for (size_t i = 0; i < part.size(); ++i) sum[i] += double(part[i]);
        }
        for (size_t i = 0; i < whole.size(); ++i)
            ASSERT_NEAR(sum[i], double(whole[i]), 1e-6 * double(whole[i]) + 1e-12) << c << i;
    }
}

TEST(TargetError, LeavesTheColourAloneWithAovs) {
    const auto scene = prepared(test::everything_scene());
    RenderSettings plain = up_to(0.2f, 4096), all = plain;
    all.aovs = AovSet::all();
    const RenderResult without = run(scene, plain), with = run(scene, all, {1, 16});
    EXPECT_EQ(image_hash(color_channels(with.image)), image_hash(without.image));
    EXPECT_LT(with.min_samples, with.max_samples);
    for (const uint32_t tile : {5u, 64u})
        EXPECT_EQ(image_hash(run(scene, all, {2, tile}).image), image_hash(with.image));
    expect_parts_to_sum_up(with.image);

    double samples = 0;
    for (const float n : test::channel(with.image, "samples.count")) samples += double(n);
    EXPECT_DOUBLE_EQ(samples / (32 * 32), with.mean_samples);
    // What has no noise is that of the picture without a target, where the edges of things are not.
    RenderSettings fixed = all;
    fixed.target_error = 0;
    fixed.samples_per_pixel = 1024;
    const Image other = run(scene, fixed).image;
    for (const char* c : {"object.id", "A", "CryptoObject00.G"}) {
        const std::vector<float> a = test::channel(with.image, c), b = test::channel(other, c);
        int differ = 0;
        for (size_t i = 0; i < a.size(); ++i) differ += std::fabs(a[i] - b[i]) > 0.25f;
        EXPECT_LT(differ, 5) << c;
    }
}

/// The variance that the file claims, against pictures with other seeds: spheres on a floor under an even sky, where
/// noise is nearly normal, with samplers that are and are not better than independent samples.
TEST(TargetError, TellsTheVarianceOfItsPixels) {
    Scene s;
    const MaterialId white = test::diffuse(s, {0.7f, 0.7f, 0.7f}, true);
    test::place(s, Rectangle{{0, 0, 0}, {30, 0, 0}, {0, 0, -30}}, white);
    for (const float x : {-1.0f, 0.0f, 1.0f}) test::place(s, Sphere{{x, 0.5f, 0}, 0.5f}, white);
    s.lights = {EnvironmentLight{{1, 1, 1}}};
    s.cameras = {PerspectiveCamera{{0, 4, 6}, {0, 0.5f, 0}, {0, 1, 0}, 30}};
    const auto scene = prepared(std::move(s));
    for (const SamplerKind sampler : {SamplerKind::independent, SamplerKind::sobol}) {
        RenderSettings settings = up_to(0.06f);
        settings.sampler = sampler;
        settings.integrator = IntegratorKind::direct;
        settings.aovs = {Aov::variance};
        constexpr int kPictures = 24;
        std::vector<double> sum(32 * 32), squares(32 * 32);
        double claimed = 0;
        for (int seed = 0; seed < kPictures; ++seed) {
            settings.seed = 90 + uint64_t(seed);
            const Image image = run(scene, settings).image;
            const std::vector<float> g = test::channel(image, "G"), v = test::channel(image, "variance.G");
            for (size_t i = 0; i < g.size(); ++i) {
                sum[i] += double(g[i]), squares[i] += double(g[i]) * double(g[i]);
                claimed += double(v[i]) / kPictures;
            }
        }
        double found = 0, spread = 0;
        for (size_t i = 0; i < sum.size(); ++i) {
            const double v = std::max(squares[i] - sum[i] * sum[i] / kPictures, 0.0) / (kPictures - 1);
            found += v;
            // Of a variance with so many degrees of freedom, and of as many means of one with six.
            spread += v * v * (2.0 / (kPictures - 1) + 2.0 / 6 / kPictures);
        }
        EXPECT_NEAR(claimed, found, 5 * std::sqrt(spread));
        EXPECT_LT(5 * std::sqrt(spread), 0.15 * found);
    }
}

TEST(TargetError, IsPartialWhenStopped) {
    auto job = RenderJob::start(prepared(test::everything_scene()), up_to(1e-4f), {});
    ASSERT_TRUE(job.ok());
    while ((*job)->progress().samples_done < 10000) (*job)->wait_for(0.001);
    EXPECT_GE((*job)->progress().samples_total, (*job)->progress().samples_done);
    (*job)->cancel();
    const auto r = (*job)->take();
    ASSERT_TRUE(r.ok());
    EXPECT_FALSE(r->complete);
    EXPECT_FALSE(r->error);
    EXPECT_EQ(r->image.metadata.count("steradian:partial"), 1u);
    EXPECT_EQ(r->image.metadata.count("steradian:certified"), 0u);
    for (const float value : r->image.pixels) EXPECT_TRUE(std::isfinite(value));
}

// --- Many seeds ------------------------------------------------------------------------------------------------------

struct Trial {
    const char* name;
    Scene scene;
    RenderSettings settings;
    bool heavy_tails = false;  ///< certifying them is not to be expected
};

/// In few pixels that a lamp is in with its very edge only, there is little that one group could tell the other.
std::vector<Trial> trials() {
    std::vector<Trial> out{{"shadows, direct", shadows(), up_to(0.06f, kDefaultMostSamples, 48)},
                           {"shadows, few pixels, direct", shadows(), up_to(0.1f), true},
                           {"glass and mirrors, path", test::everything_scene(), up_to(0.1f)},
                           {"behind a wall, path", behind_a_wall(), up_to(0.1f, kDefaultMostSamples, 48)},
                           {"beads, path", beads(), up_to(0.1f, kDefaultMostSamples, 48)},
                           {"shadows, path, independent", shadows(), up_to(0.1f, kDefaultMostSamples, 48)}};
    out[0].settings.integrator = out[1].settings.integrator = IntegratorKind::direct;
    out[5].settings.sampler = SamplerKind::independent;
    return out;
}

/// The mean of independent pictures without a target, and the variance of each value of it.
struct Reference {
    std::vector<double> mean, variance;
};
Reference reference(const std::shared_ptr<const RenderScene>& scene, RenderSettings settings, uint64_t pictures,
                    uint64_t samples) {
    settings.target_error = 0;
    settings.samples_per_pixel = samples;
    settings.sampler = SamplerKind::sobol;
    Reference out;
    std::vector<double> squares;
    for (uint64_t i = 0; i < pictures; ++i) {
        settings.seed = 1'000'000 + i;
        const std::vector<float> p = run(scene, settings).image.pixels;
        out.mean.resize(p.size()), squares.resize(p.size());
        for (size_t k = 0; k < p.size(); ++k) out.mean[k] += double(p[k]), squares[k] += double(p[k]) * double(p[k]);
    }
    const auto n = double(pictures);
    for (size_t k = 0; k < squares.size(); ++k) {
        out.mean[k] /= n;
        out.variance.push_back(std::max(squares[k] / n - out.mean[k] * out.mean[k], 0.0) / (n - 1));
    }
    return out;
}

/// What many pictures with a target tell, against the truth.
class Record {
public:
    Record(const Reference& truth, uint32_t side)
        : truth_(truth), side_(side), sum_(squares() + 1), squares_(squares() + 1), from_reference_(squares() + 1) {
        for (size_t k = 0; k < truth.mean.size(); ++k) {
            const double scale = truth.mean[k] + 0.01;
            reference_error_ += truth.variance[k] / (scale * scale) / double(truth.mean.size());
            // Channels share their noise: the square of a sum of deviations, three channels at most.
            for (const size_t g : {square_of(k), squares()})
                from_reference_[g] += 3 * truth.variance[k] / (scale * scale);
        }
    }

    void add(const RenderResult& r, double target) {
        std::vector<double> off(squares() + 1);
        double square = 0;
        for (size_t k = 0; k < truth_.mean.size(); ++k) {
            const double d = (double(r.image.pixels[k]) - truth_.mean[k]) / (truth_.mean[k] + 0.01);
            square += d * d;
            off[square_of(k)] += d, off[squares()] += d;
        }
        for (size_t g = 0; g <= squares(); ++g) sum_[g] += off[g], squares_[g] += off[g] * off[g];
        // What the reference adds to the differences is no error of the picture.
        const double error = std::sqrt(std::max(square / double(truth_.mean.size()) - reference_error_, 0.0));
        ++pictures;
        certified += r.error->certified;
        beyond_target += r.error->certified && error > target;
        beyond_bound += r.error->certified && error > r.error->bound;
        estimates += r.error->estimate * r.error->estimate;
        errors += error * error;
        samples += r.mean_samples;
        drawn += double(r.statistics.samples) / double(side_ * side_);
    }

    /// Of the whole picture's sum, relative to the truth, in standard errors, with its sign.
    double bias() const { return deviation(squares()); }
    /// The largest, of squares of 8 × 8 pixels: their sums are nearly normal, values by themselves are not.
    double worst_bias() const {
        double worst = 0;
        for (size_t g = 0; g < squares(); ++g) worst = std::max(worst, std::fabs(deviation(g)));
        return worst;
    }
    /// The bias of the whole, as a share of the truth.
    double relative_bias() const { return sum_[squares()] / pictures / double(truth_.mean.size()); }

    int pictures = 0, certified = 0, beyond_target = 0, beyond_bound = 0;
    double samples = 0, drawn = 0, estimates = 0, errors = 0;

private:
    /// Of 8 × 8 pixels.
    size_t squares() const { return size_t(side_ / 8) * (side_ / 8); }
    size_t square_of(size_t value) const { return value / 3 / side_ / 8 * (side_ / 8) + value / 3 % side_ / 8; }
    double deviation(size_t g) const {
        const double n = pictures, mean = sum_[g] / n;
        const double variance = std::max(squares_[g] / n - mean * mean, 0.0) / (n - 1);
        return mean / std::sqrt(variance + from_reference_[g]);
    }

    const Reference& truth_;
    const uint32_t side_;
    double reference_error_ = 0;
    std::vector<double> sum_, squares_, from_reference_;
};

class ManySeeds : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(TargetError, ManySeeds, testing::Range(0, 6));

/// Over many seeds: no bias from stopping, and the true error is within the target as often as is claimed.
TEST_P(ManySeeds, HaveNoBiasAndKeepTheirPromise) {
    if (GetParam() > 0 && !test::run_everything()) GTEST_SKIP() << "one scene is enough for the quick tier";
    Trial trial = trials().at(size_t(GetParam()));
    const auto scene = prepared(std::move(trial.scene));
    const Reference truth =
        reference(scene, trial.settings, test::by_tier<uint64_t>(16, 32), test::by_tier<uint64_t>(128, 1024));
    Record record(truth, trial.settings.width);
    for (int seed = 0; seed < test::by_tier(12, 200); ++seed) {
        trial.settings.seed = 5000 + uint64_t(seed);
        record.add(run(scene, trial.settings), double(trial.settings.target_error));
    }
    const double n = record.pictures;
    std::printf(
        "%s: %d of %d certified, %d beyond the target, %d beyond the bound; bias %+.2f standard errors "
        "(%+.1e), worst square %.2f; estimate %.4f, error %.4f; %.0f samples a pixel that count of %.0f\n",
        trial.name, record.certified, record.pictures, record.beyond_target, record.beyond_bound, record.bias(),
        record.relative_bias(), record.worst_bias(), std::sqrt(record.estimates / n), std::sqrt(record.errors / n),
        record.samples / n, record.drawn / n);
    // Student's t with 11 or 199 degrees of freedom, for 37 values in all trials: by chance in less than one of 500.
    const double by_chance = test::by_tier(6.2, 4.4);
    EXPECT_LT(std::fabs(record.bias()), by_chance);
    EXPECT_LT(record.worst_bias(), by_chance);
    // What is refused is refused for a reason, but these scenes are not to be refused as a rule.
    EXPECT_GE(record.certified, trial.heavy_tails ? 1 : record.pictures * 3 / 4);
    const double claimed = 1 - ErrorReport::confidence;
    const double allowed = claimed * n + 3 * std::sqrt(claimed * (1 - claimed) * n);
    EXPECT_LE(record.beyond_target, allowed);
    EXPECT_LE(record.beyond_bound, allowed);
}

}  // namespace
}  // namespace steradian
