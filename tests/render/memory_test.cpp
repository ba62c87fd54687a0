// The estimates of memory against what is then held.
#include <gtest/gtest.h>

#include "render/film.h"
#include "render/memory_estimate.h"
#include "render/render_scene.h"
#include "test_scenes.h"

namespace steradian {
namespace {

Scene grid(uint32_t n) {
    Scene s;
    Mesh mesh;
    for (uint32_t y = 0; y <= n; ++y)
        for (uint32_t x = 0; x <= n; ++x)
            mesh.positions.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(x * 7 % 11)});
    for (uint32_t y = 0; y < n; ++y)
        for (uint32_t x = 0; x < n; ++x) {
            const uint32_t a = y * (n + 1) + x, b = a + n + 1;
            mesh.indices.insert(mesh.indices.end(), {a, a + 1, b + 1, a, b + 1, b});
        }
    const auto id = add<MeshId>(s.meshes, std::move(mesh));
    test::place(s, id, test::diffuse(s, {0.5f, 0.5f, 0.5f}));
    return s;
}

void expect_hierarchy(const Scene& scene, BvhBuilder builder, BvhLayout layout) {
    Execution execution;
    execution.bvh = builder;
    execution.bvh_layout = layout;
    const MemoryEstimate estimate = estimate_memory(scene, {}, execution);
    Diagnostics diagnostics;
    const auto prepared = prepare(scene, execution, diagnostics);
    ASSERT_TRUE(prepared.ok()) << prepared.error().str();
    const ShadingScene& shading = (*prepared)->shading;
    const uint64_t held = (*prepared)->accel.statistics().bytes +
                          shading.instances.size() * sizeof(ShadingScene::InstanceData) +
                          shading.lights.size() * sizeof(ShadingScene::LightData);
    EXPECT_NEAR(static_cast<double>(estimate.hierarchy) / static_cast<double>(held), 1, 0.2)
        << estimate.hierarchy << " estimated, " << held << " held";
}

TEST(MemoryEstimate, TheHierarchyOfAMesh) {
    for (const BvhLayout layout : {BvhLayout::full, BvhLayout::compact})
        for (const BvhBuilder builder :
             {BvhBuilder::sah, BvhBuilder::median, BvhBuilder::fast, BvhBuilder::high_quality})
            expect_hierarchy(grid(200), builder, layout);
}

TEST(MemoryEstimate, TheSceneIsWhatItsArraysHold) {
    const Scene scene = grid(100);
    EXPECT_NEAR(static_cast<double>(estimate_memory(scene, {}).scene), 101 * 101 * 12.0 + 20000 * 12.0, 2000);
}

TEST(MemoryEstimate, ThePictureGrowsWithItsPixelsAndThreads) {
    RenderSettings settings;
    settings.width = settings.height = 4096;
    const uint64_t whole = picture_bytes(settings, {1});
    // Sums, the picture and what a worker traces at once: the same for all its tiles.
    const double pixels = 4096.0 * 4096,
                 tile = double(Film::tile_bytes()) / (Execution().tile_size * Execution().tile_size);
    EXPECT_NEAR(static_cast<double>(whole), pixels * (sizeof(RgbSum) + 3 * sizeof(float) + tile), 64e6);
    EXPECT_GT(picture_bytes(settings, {64}), whole);
    settings.crop = Crop{0, 0, 4096, 1024};
    EXPECT_NEAR(static_cast<double>(picture_bytes(settings, {1})), static_cast<double>(whole) / 4, 8e6);
}

TEST(MemoryEstimate, ASceneThatWasNotCheckedYetIsFine) {
    Scene scene = grid(2);
    scene.lights = {AreaLight{InstanceId(99)}, EnvironmentLight{{1, 1, 1}, ImageId(7)}};
    scene.shapes[0] = MeshId(5);
    scene.lights.push_back(AreaLight{InstanceId(0)});
    EXPECT_GT(estimate_memory(scene, {}).peak(), 0u);
    scene.instances[0].shape = ShapeId(8);
    EXPECT_GT(estimate_memory(scene, {}).peak(), 0u);
}

}  // namespace
}  // namespace steradian
