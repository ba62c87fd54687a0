// Scenes that are turned as on a turntable: the camera that goes round them, and what goes with it.
#include <cmath>
#include <numbers>

#include "math/transform.h"
#include "math/vector.h"
#include "scene_test.h"
#include "support/support.h"

namespace steradian {
namespace {

using namespace test;

class Turntable : public ::testing::Test {
protected:
    LoadedScene load(const std::string& name, std::optional<double> turn) {
        LoadOptions options;
        options.turn = turn;
        auto loaded = load_scene(folder_.file(name), options);
        if (!loaded) throw std::runtime_error(loaded.error().str());
        return std::move(loaded).value();
    }
    static const PerspectiveCamera& camera_of(const LoadedScene& loaded) {
        return std::get<PerspectiveCamera>(loaded.scene.cameras.at(loaded.settings.camera));
    }
    /// About +Y, counter-clockwise seen from above.
    static Vec3 turned(Vec3 v, double degrees) {
        return Vec3(transform_vector(rotation_degrees(degrees, {0, 1, 0}), v));
    }
    static void expect_near(Vec3 a, Vec3 b, float bound) {
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], bound) << i;
    }
    TemporaryFolder folder_;
};

/// A long box far from the origin.
constexpr const char* kBox =
    "v 10 0 0\nv 14 0 0\nv 14 1 0\nv 10 1 0\nv 10 0 -1\nv 14 0 -1\nv 14 1 -1\nv 10 1 -1\n"
    "f 1 2 3 4\nf 8 7 6 5\nf 1 5 6 2\nf 4 3 7 8\nf 1 4 8 5\nf 2 6 7 3\n";
constexpr Vec3 kMiddle{12, 0.5f, -0.5f};

TEST_F(Turntable, TheCameraGoesRoundTheMiddleTheOtherWay) {
    spit(folder_.file("box.obj"), kBox);
    const LoadedScene start = load("box.obj", 0);
    for (const double degrees : {30.0, 90.0, 200.0, -45.0}) {
        const LoadedScene loaded = load("box.obj", degrees);
        const Vec3 before = camera_of(start).position - kMiddle, now = camera_of(loaded).position - kMiddle;
        expect_near(now, turned(before, -degrees), 2e-5f);
        // The studio's lamps go with the camera, the model stays.
        const auto lamp = [](const LoadedScene& l) {
            const auto& light = std::get<AreaLight>(l.scene.lights.at(0));
            return std::get<Rectangle>(l.scene.shapes[index(l.scene.instances[index(light.instance)].shape)]).center;
        };
        expect_near(lamp(loaded) - kMiddle, turned(lamp(start) - kMiddle, -degrees), 2e-5f);
        EXPECT_EQ(loaded.scene.meshes.at(0).positions, start.scene.meshes.at(0).positions);
    }
}

/// Of the picture's height, how far from its middle the corner that is farthest out is, 1 at the edge.
double reach(const LoadedScene& loaded, const PerspectiveCamera& camera) {
    const Vec3d back = normalize(Vec3d(camera.position) - Vec3d(camera.look_at));
    const Vec3d right = normalize(cross(Vec3d{0, 1, 0}, back)), up = cross(back, right);
    const double slope = std::tan(double(camera.vertical_fov) * std::numbers::pi / 360);
    double most = 0;
    for (const Vec3& p : loaded.scene.meshes.at(0).positions) {
        const Vec3d q = Vec3d(p) - Vec3d(camera.position);
        const double depth = -dot(q, back);
        EXPECT_GT(depth, 0);
        most = std::max({most, std::fabs(dot(q, right)) / (depth * slope), std::fabs(dot(q, up)) / (depth * slope)});
    }
    return most;
}

TEST_F(Turntable, TheModelStaysInViewAndTouchesTheEdgeOnce) {
    spit(folder_.file("box.obj"), kBox);
    double most = 0;
    for (int degrees = 0; degrees < 360; ++degrees) {
        const LoadedScene loaded = load("box.obj", degrees);
        most = std::max(most, reach(loaded, camera_of(loaded)));
    }
    EXPECT_LE(most, 0.86 + 1e-5);
    EXPECT_GE(most, 0.86 - 1e-3);
}

TEST_F(Turntable, WhatIsFarAwayStaysWithTheCamera) {
    spit(folder_.file("scene.json"),
         R"({"version": 1, "cameras": {"front": {"position": [0, 0, 5], "look_at": [0, 0, 0]}},
      "materials": {"white": {"type": "diffuse", "reflectance": [0.8, 0.8, 0.8]}},
      "objects": [{"type": "sphere", "center": [3, 0, 0], "radius": 1, "material": "white"}],
      "lights": [{"type": "environment", "radiance": [1, 1, 1]},
                 {"type": "directional", "direction": [0, 0, -1], "irradiance": [1, 1, 1]},
                 {"type": "point", "position": [5, 2, 0], "flux": [1, 1, 1]}]})");
    const LoadedScene loaded = load("scene.json", 90);
    EXPECT_EQ(loaded.scene.cameras.size(), 2u);
    EXPECT_EQ(loaded.settings.camera, 1u);
    EXPECT_FLOAT_EQ(std::get<EnvironmentLight>(loaded.scene.lights.at(0)).rotation, -90);
    // Turned by -90 degrees: from -z to +x.
    expect_near(std::get<DirectionalLight>(loaded.scene.lights.at(1)).direction, {1, 0, 0}, 1e-6f);
    EXPECT_EQ(std::get<PointLight>(loaded.scene.lights.at(2)).position, (Vec3{5, 2, 0}));
    // A ball about its own middle looks the same from everywhere: it fills 86 % of the height.
    const PerspectiveCamera& camera = camera_of(loaded);
    const double distance = length(camera.position - Vec3{3, 0, 0});
    const double tangent = std::tan(double(camera.vertical_fov) * std::numbers::pi / 360) * 0.86;
    EXPECT_NEAR(distance, std::sqrt(1 + 1 / (tangent * tangent)), 1e-4);
    EXPECT_EQ(load("scene.json", std::nullopt).scene.cameras.size(), 1u);
}

}  // namespace
}  // namespace steradian
