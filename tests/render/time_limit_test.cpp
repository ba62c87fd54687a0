// Renders that end by time. How many samples that makes is not known; that they are those of that number is.
#include <gtest/gtest.h>

#include <cmath>

#include "render_support.h"
#include "support/support.h"
#include "test_scenes.h"

namespace steradian {
namespace {

using test::run;

std::shared_ptr<const RenderScene> prepared() { return test::prepared(test::everything_scene()); }

RenderSettings square(uint32_t side, uint64_t samples) {
    RenderSettings s;
    s.width = s.height = side;
    s.samples_per_pixel = samples;
    s.max_depth = 5;
    return s;
}

Execution seconds(double limit) {
    Execution e;
    e.time_limit = limit;
    e.threads = 3;
    e.tile_size = 7;
    return e;
}

TEST(TimeLimit, GivesThePictureOfTheNumberOfSamplesThatWasReached) {
    const auto scene = prepared();
    for (const double limit : {0.001, 0.05, 0.4}) {
        const RenderResult timed = run(scene, square(29, 1'000'000), seconds(limit));
        EXPECT_TRUE(timed.complete);
        EXPECT_TRUE(timed.out_of_time);
        ASSERT_EQ(timed.min_samples, timed.max_samples);
        ASSERT_GE(timed.min_samples, 1u);
        EXPECT_EQ(timed.statistics.samples, timed.min_samples * 29 * 29);
        const RenderResult counted = run(scene, square(29, timed.min_samples));
        EXPECT_FALSE(counted.out_of_time);
        EXPECT_EQ(timed.image.pixels, counted.image.pixels) << timed.min_samples << " samples";
        EXPECT_EQ(timed.image.metadata, counted.image.metadata);
        EXPECT_EQ(timed.statistics.camera_rays, counted.statistics.camera_rays);
        EXPECT_EQ(timed.statistics.shadow_rays, counted.statistics.shadow_rays);
    }
}

TEST(TimeLimit, ThatIsNotReachedChangesNothing) {
    const auto scene = prepared();
    for (const uint64_t samples : {1, 5, 64, 100, 130}) {
        const RenderResult timed = run(scene, square(20, samples), seconds(1e6));
        const RenderResult plain = run(scene, square(20, samples));
        EXPECT_FALSE(timed.out_of_time);
        EXPECT_TRUE(timed.complete);
        EXPECT_EQ(timed.min_samples, samples);
        EXPECT_EQ(timed.image.pixels, plain.image.pixels) << samples;
        EXPECT_EQ(timed.image.metadata, plain.image.metadata);
    }
}

TEST(TimeLimit, AStoppedRenderIsPartialAllTheSame) {
    const auto scene = prepared();
    auto job = RenderJob::start(scene, square(200, kMaxSamplesPerPixel), seconds(1e6));
    ASSERT_TRUE(job.ok());
    while ((*job)->progress().samples_done < 50'000) (*job)->wait_for(0.001);
    EXPECT_GE((*job)->progress().samples_total, (*job)->progress().samples_done);
    (*job)->cancel();
    const auto result = (*job)->take();
    ASSERT_TRUE(result.ok());
    EXPECT_FALSE(result->complete);
    EXPECT_FALSE(result->out_of_time);
    EXPECT_EQ(result->image.metadata.at("steradian:partial"),
              std::to_string(result->min_samples) + " to " + std::to_string(result->max_samples) + " samples");
}

TEST(TimeLimit, IsTheEndThatProgressLooksForwardTo) {
    const auto scene = prepared();
    auto job = RenderJob::start(scene, square(40, kMaxSamplesPerPixel), seconds(1e4));
    ASSERT_TRUE(job.ok());
    while ((*job)->progress().samples_done < 10 * 40 * 40) (*job)->wait_for(0.001);
    const RenderProgress p = (*job)->progress();
    // So much of the time has gone, as it has of the samples; a tenth for what happens between two readings of the
    // clock.
    EXPECT_NEAR(double(p.samples_done) / double(p.samples_total) / (p.seconds / 1e4), 1, 0.1);
}

TEST(TimeLimit, OutsideItsRangeIsRefused) {
    const auto scene = prepared();
    for (const double bad : {-1.0, 1e-9, 1e12, double(NAN)}) {
        const auto job = RenderJob::start(scene, square(4, 1), seconds(bad));
        ASSERT_FALSE(job.ok());
        EXPECT_EQ(job.error().code, ErrorCode::usage);
    }
}

}  // namespace
}  // namespace steradian
