// The course's scenes of which the picture is known, from the folder of outside test files.
#include <gtest/gtest.h>

#include "analytic/check.h"
#include "steradian/load.h"
#include "support/support.h"

namespace steradian::analytic {
namespace {

class CourseScenes : public testing::Test {
protected:
    void SetUp() override {
        const auto shared = test::shared_folder();
        if (!shared) GTEST_SKIP() << "scenes/cs171 is not there";
        folder_ = *shared / "scenes/cs171";
    }

    /// As the file says but for the picture's size and the seed.
    Image picture(const std::string& name, uint64_t seed) const {
        auto loaded = load_scene((folder_ / name).string());
        if (!loaded) throw std::runtime_error(loaded.error().str());
        loaded->settings.width = loaded->settings.height = 64;
        loaded->settings.seed = seed;
        auto result = render(std::move(loaded->scene), loaded->settings);
        if (!result) throw std::runtime_error(result.error().str());
        return std::move(result->image);
    }

    std::filesystem::path folder_;
};

/// As the file says, but small.
TEST_F(CourseScenes, AllRenderWithoutABadSample) {
    size_t rendered = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
        const std::string name = entry.path().filename().string();
        if (entry.path().extension() != ".json") continue;
        auto loaded = load_scene(entry.path().string());
        ASSERT_TRUE(loaded.ok()) << loaded.error().str();
        loaded->settings.width = loaded->settings.height = 48;
        loaded->settings.samples_per_pixel = 8;
        const auto result = render(std::move(loaded->scene), loaded->settings);
        ASSERT_TRUE(result.ok()) << name;
        EXPECT_EQ(result->statistics.bad_samples, 0u) << name;
        EXPECT_GT(mean_over(result->image, {0, 0, 48, 48, {}, false}, 0), 0.01) << name;
        ++rendered;
    }
    EXPECT_GE(rendered, 8u);
}

TEST_F(CourseScenes, AWhiteSphereInAWhiteEnvironmentIsOneInEveryPixel) {
    for (const float v : picture("sphere.json", 1).pixels) ASSERT_NEAR(v, 1, 1e-5);
}

TEST_F(CourseScenes, TwoSpheresHaveTheirMean) {
    std::vector<double> means;
    for (uint64_t seed = 1; seed <= 16; ++seed)
        means.push_back(mean_over(picture("two_spheres.json", seed), {0, 0, 64, 64, {}, false}, 0));
    EXPECT_NEAR(estimate(means).mean, 0.27657896, 2e-3);
}

}  // namespace
}  // namespace steradian::analytic
