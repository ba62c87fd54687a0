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
        loaded->settings.width = loaded->settings.height = 128;
        loaded->settings.seed = seed;
        auto result = render(std::move(loaded->scene), loaded->settings);
        if (!result) throw std::runtime_error(result.error().str());
        return std::move(result->image);
    }

    std::filesystem::path folder_;
};

TEST_F(CourseScenes, AWhiteSphereInAWhiteEnvironmentIsOneInEveryPixel) {
    for (const float v : picture("sphere.json", 1).pixels) ASSERT_NEAR(v, 1, 1e-5);
}

TEST_F(CourseScenes, TwoSpheresHaveTheirMean) {
    std::vector<double> means;
    for (uint64_t seed = 1; seed <= 16; ++seed)
        means.push_back(mean_over(picture("two_spheres.json", seed), {0, 0, 128, 128, {}, false}, 0));
    EXPECT_NEAR(estimate(means).mean, 0.27657896, 2e-3);
}

}  // namespace
}  // namespace steradian::analytic
