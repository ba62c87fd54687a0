// Scenes that are empty, degenerate or hostile: refused with a name for the fault, or rendered without a bad pixel.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "steradian/render.h"
#include "support/support.h"
#include "test_scenes.h"

namespace steradian {
namespace {

Result<RenderResult> tiny(Scene scene) {
    RenderSettings settings;
    settings.width = settings.height = 16;
    settings.samples_per_pixel = 4;
    return render(std::move(scene), settings);
}

void expect_finite(Scene scene, const char* what) {
    const auto result = tiny(std::move(scene));
    ASSERT_TRUE(result.ok()) << what << ": " << result.error().str();
    EXPECT_EQ(result->statistics.bad_samples, 0u) << what;
    for (const float v : result->image.pixels) ASSERT_TRUE(std::isfinite(v) && v >= 0) << what;
}

Scene lit_plane() {
    Scene s;
    test::place(s, Rectangle{{0, 0, 0}, {5, 0, 0}, {0, 5, 0}}, test::diffuse(s, {0.5f, 0.5f, 0.5f}, true));
    s.lights = {PointLight{{0, 0, 3}, {1, 1, 1}}};
    s.cameras = {PerspectiveCamera{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 30}};
    return s;
}

/// At the first question, at the last one, and at those in between.
TEST(Prepare, AsksWhetherToStopAndSaysHowFarItIs) {
    int questions = 0;
    std::vector<double> told;
    PrepareHooks hooks;
    hooks.cancelled = [&] { return ++questions, false; };
    hooks.progress = [&](double fraction) { told.push_back(fraction); };
    Diagnostics diagnostics;
    const Execution one_thread{1};
    ASSERT_TRUE(prepare(lit_plane(), one_thread, diagnostics, hooks));
    ASSERT_GE(told.size(), 2u);
    EXPECT_EQ(told.front(), 0);
    EXPECT_EQ(told.back(), 1);
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    EXPECT_GT(questions, 5);
    for (int yes = 1; yes <= questions; ++yes) {
        int asked = 0;
        told.clear();
        hooks.cancelled = [&] { return ++asked == yes; };
        const auto prepared = prepare(lit_plane(), one_thread, diagnostics, hooks);
        ASSERT_FALSE(prepared) << yes << " of " << questions;
        EXPECT_EQ(prepared.error().code, ErrorCode::render_failed);
        EXPECT_EQ(asked, yes) << "asked again after a yes";
        for (const double fraction : told) EXPECT_LT(fraction, 1);
    }
}

TEST(Prepare, AnEmptySceneIsBlack) {
    Scene s;
    s.cameras = {PerspectiveCamera{}};
    const auto result = tiny(std::move(s));
    ASSERT_TRUE(result.ok());
    for (const float v : result->image.pixels) EXPECT_EQ(v, 0.0f);
}

TEST(Prepare, ASceneWithoutACameraIsRefused) {
    const auto result = tiny(Scene{});
    ASSERT_FALSE(result.ok());
    EXPECT_NE(result.error().message.find("no camera"), std::string::npos);
}

TEST(Prepare, DegenerateCamerasAreRefused) {
    for (const PerspectiveCamera& camera :
         {PerspectiveCamera{{1, 1, 1}, {1, 1, 1}}, PerspectiveCamera{{0, 0, 0}, {0, 5, 0}, {0, 1, 0}}}) {
        Scene s = lit_plane();
        s.cameras = {camera};
        const auto result = tiny(std::move(s));
        ASSERT_FALSE(result.ok());
        EXPECT_EQ(result.error().code, ErrorCode::bad_input);
    }
}

TEST(Prepare, DegenerateGeometryRendersWithoutABadPixel) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float scale : {1e-20f, 1e-6f, 1.0f, 1e6f, 1e14f}) {
        Scene s = lit_plane();
        const auto mesh = add<MeshId>(
            s.meshes, Mesh{{{0, 0, 1}, {0, 0, 1}, {scale, 0, 1}, {0, scale, 1}, {2 * scale, 0, 1}, {nan, 0, 0}},
                           {},
                           {},
                           {0, 1, 2, 0, 2, 4, 2, 2, 2, 0, 2, 3, 5, 2, 3}});
        test::place(s, mesh, MaterialId{0});
        expect_finite(std::move(s), "triangles");
    }
    Scene s = lit_plane();
    test::place(s, Rectangle{{0, 0, 1}, {1, 0, 0}, {1, 0, 0}}, MaterialId{0});
    test::place(s, Rectangle{{0, 0, 1}, {0, 0, 0}, {0, 0, 0}}, MaterialId{0});
    test::place(s, Sphere{{0, 0, 1}, 1e-30f}, MaterialId{0});
    test::place(s, Disk{{0, 0, 1}, {0, 0, 1e-30f}, 0.1f}, MaterialId{0});
    test::place(s, Sphere{{0, 0, 1}, 0.1f}, MaterialId{0}, scaling(1, -2, 1e-3));
    expect_finite(std::move(s), "shapes");
}

TEST(Prepare, DegenerateLightsRenderWithoutABadPixel) {
    for (const Rgb radiance : {Rgb{0, 0, 0}, Rgb{1e-38f, 0, 0}, Rgb{1e20f, 1e20f, 1e20f}}) {
        Scene s = lit_plane();
        const MaterialId grey{0};
        for (const Shape& shape :
             {Shape(Rectangle{{0, 0, 1}, {0, 0, 0}, {0, 1, 0}}), Shape(Sphere{{2, 0, 1}, 1e-12f}),
              Shape(Disk{{0, 2, 1}, {0, 0, -1}, 1e-12f}), Shape(Rectangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})})
            s.lights.push_back(AreaLight{test::place(s, shape, grey), radiance, true, 3});
        const auto mesh =
            add<MeshId>(s.meshes, Mesh{{{0, 0, 1}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, {}, {}, {0, 1, 2, 0, 3, 2}});
        s.lights.push_back(AreaLight{test::place(s, mesh, grey), radiance});
        const auto empty = add<MeshId>(s.meshes, Mesh{});
        s.lights.push_back(AreaLight{test::place(s, empty, grey), radiance});
        s.lights.push_back(PointLight{{0, 0, 0}, radiance});  // in the surface
        s.lights.push_back(EnvironmentLight{radiance});
        expect_finite(std::move(s), "lights");
    }
}

TEST(Prepare, CamerasInStrangePlacesRenderWithoutABadPixel) {
    for (const PerspectiveCamera& camera :
         {PerspectiveCamera{{0, 0, 0}, {0, 0, 1}}, PerspectiveCamera{{0, 0, 3}, {0, 0, 0}},
          PerspectiveCamera{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 1e-9f},
          PerspectiveCamera{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 179.99f}, PerspectiveCamera{{1e14f, 0, 5}, {0, 0, 0}}}) {
        Scene s = test::everything_scene();
        s.cameras = {camera};
        expect_finite(std::move(s), "camera");
    }
}

TEST(Prepare, ManyLightsLoad) {
    Scene s = lit_plane();
    const size_t count = test::by_tier<size_t>(10'000, 1'000'000);
    for (size_t i = 0; i < count; ++i) {
        const auto x = static_cast<float>(i % 1000), y = static_cast<float>(i / 1000);
        s.lights.push_back(AreaLight{test::place(s, Sphere{{x, y, 20}, 0.2f}, MaterialId{0}), {1, 1, 1}});
    }
    Diagnostics diagnostics;
    EXPECT_TRUE(prepare(std::move(s), {}, diagnostics).ok());
}

TEST(Prepare, ASceneWithoutLightsIsWarnedAbout) {
    Scene s = lit_plane();
    s.lights.clear();
    Diagnostics diagnostics;
    ASSERT_TRUE(prepare(std::move(s), {}, diagnostics).ok());
    ASSERT_EQ(diagnostics.warnings().size(), 1u);
    EXPECT_NE(diagnostics.warnings()[0].message.find("no lights"), std::string::npos);
}

TEST(Prepare, WhatItDropsItReports) {
    Scene s = lit_plane();
    const auto mesh =
        add<MeshId>(s.meshes, Mesh{{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {2e15f, 0, 0}}, {}, {}, {0, 1, 2, 0, 1, 3}});
    test::place(s, mesh, MaterialId{0});
    Diagnostics diagnostics;
    ASSERT_TRUE(prepare(std::move(s), {}, diagnostics).ok());
    ASSERT_EQ(diagnostics.warnings().size(), 1u);
    EXPECT_EQ(diagnostics.warnings()[0].count, 1u);
}

}  // namespace
}  // namespace steradian
