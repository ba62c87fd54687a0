// Memory is estimated before it is taken: the estimate is right, and what does not fit is refused early.
#include <gtest/gtest.h>

#include <cstdlib>

#include "program.h"

namespace steradian::test {
namespace {

class Memory : public CommandTest {
protected:
    /// Renders with one sample and compares what was taken with what `info` says, within a fifth.
    void expect_estimate(const std::string& scene, const std::vector<std::string>& options) {
        std::vector<std::string> arguments{"render", scene, "--spp", "1", "-q", "-o", "a.exr"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const Outcome render = steradian(arguments), info = steradian({"info", scene, "--json"});
        ASSERT_EQ(render.code, 0) << render.err;
        ASSERT_EQ(info.code, 0) << info.err;
        const double estimate = std::atof(field(info.out, "peak_bytes").c_str());
        const auto taken = static_cast<double>(render.peak_bytes);
        EXPECT_GT(taken, 100e6) << "too little to tell it from the program itself";
        EXPECT_NEAR(estimate / taken, 1, 0.2) << estimate << " estimated, " << taken << " taken";
    }
};

TEST_F(Memory, TheEstimateForAMeshIsRight) {
    if (kSanitized) GTEST_SKIP() << "under a sanitizer";
    spit(folder_.file("grid.ply"), grid_ply(800));  // 1.3 million triangles
    expect_estimate("grid.ply", {});
}

TEST_F(Memory, TheEstimateForALargePictureIsRight) {
    if (kSanitized) GTEST_SKIP() << "under a sanitizer";
    std::string scene = kScene;
    scene.replace(scene.find("[32, 24]"), 8, "[2000, 2000]");
    spit(folder_.file("large.json"), scene);
    expect_estimate("large.json", {});
}

TEST_F(Memory, TheEstimateForManyLightsIsRight) {
    if (kSanitized) GTEST_SKIP() << "under a sanitizer";
    std::string scene =
        R"({"version": 1, "film": {"resolution": [1, 1]}, "camera": {"position": [0, 0, 5], "look_at": [0, 0, 0]}, "objects": [)";
    for (int i = 0; i < 150000; ++i)
        scene += std::string(i ? "," : "") + "\n{\"type\": \"sphere\", \"center\": [" + std::to_string(i % 391) + ", " +
                 std::to_string(i / 391) + ", 0], \"radius\": 0.1, \"light\": {\"radiance\": 1}}";
    spit(folder_.file("lights.json"), scene + "]}");
    expect_estimate("lights.json", {});
}

TEST_F(Memory, ASceneThatDoesNotFitIsRefusedBeforeTheHierarchyIsBuilt) {
    if (kSanitized) GTEST_SKIP() << "under a sanitizer";
    spit(folder_.file("grid.ply"), grid_ply(1500));  // 4.5 million triangles: 81 MB as they are, 360 MB to render
    const Outcome o = Process(folder_, {"render", "grid.ply", "--bvh", "high-quality", "--threads", "1", "-o", "a.png"},
                              limit_memory<(350 << 20)>)
                          .wait();
    EXPECT_EQ(o.code, 4) << o.err;
    EXPECT_NE(o.err.find("for its hierarchy"), std::string::npos) << o.err;
    expect_files({"grid.ply"});
}

TEST_F(Memory, APictureThatDoesNotFitIsRefusedBeforeTheSceneIsLoaded) {
    if (kSanitized) GTEST_SKIP() << "under a sanitizer";
    for (const std::vector<std::string>& picture :
         {std::vector<std::string>{"--size", "8000x8000"}, std::vector<std::string>{"--crop", "0,0,8000,8000"}}) {
        std::vector<std::string> arguments{"render", "missing.json"};
        arguments.insert(arguments.end(), picture.begin(), picture.end());
        const Outcome o = Process(folder_, arguments, limit_memory<(1 << 30)>).wait();
        EXPECT_EQ(o.code, 4) << o.err;
        EXPECT_NE(o.err.find("64000000 pixels"), std::string::npos) << o.err;
    }
}

}  // namespace
}  // namespace steradian::test
