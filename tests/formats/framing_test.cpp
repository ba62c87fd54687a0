// Cameras of models that bring none: where they look from, and that pictures of every shape hold the model.
#include "formats/framing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "formats/front_view.h"
#include "math/transform.h"
#include "scene_test.h"
#include "support/random.h"
#include "support/support.h"

namespace steradian {
namespace {

using namespace test;

// --- What pictures hold -----------------------------------------------------------------------------------------

/// How far out points are in a picture, 1 at its edges; towards both sides and upwards or downwards.
struct Reach {
    double across = 0, up = 0;
    void add(const Reach& r) { across = std::max(across, r.across), up = std::max(up, r.up); }
};

Reach reach_of(const Scene& scene, const PerspectiveCamera& camera, double aspect) {
    const Vec3d back = normalize(Vec3d(camera.position) - Vec3d(camera.look_at));
    const Vec3d right = normalize(cross(Vec3d(camera.up), back)), up = cross(back, right);
    const double slope = std::tan(double(camera.vertical_fov) * std::numbers::pi / 360);
    Reach out;
    const auto add = [&](Vec3d p) {
        const Vec3d q = p - Vec3d(camera.position);
        const double depth = -dot(q, back);
        EXPECT_GT(depth, 0);
        out.add({std::fabs(dot(q, right)) / (depth * slope * aspect), std::fabs(dot(q, up)) / (depth * slope)});
    };
    for (const Instance& i : scene.instances) {
        const Shape& shape = scene.shapes[index(i.shape)];
        if (const auto* id = std::get_if<MeshId>(&shape))
            for (const Vec3& p : scene.meshes[index(*id)].positions)
                add(transform_point(i.world_from_object, Vec3d(p)));
    }
    return out;
}

constexpr double kAspects[] = {1e-3, 0.05, 9.0 / 32, 9.0 / 16, 0.75, 0.999, 1, 1.001, 4.0 / 3, 16.0 / 9, 3, 50, 1000};
/// Between edges and model in a square picture.
constexpr double kFilled = 0.86;

class Framing : public ::testing::Test {
protected:
    LoadedScene load(const std::string& name, std::optional<double> turn, std::optional<double> aspect) {
        LoadOptions options;
        options.turn = turn;
        options.aspect = aspect;
        auto loaded = load_scene(folder_.file(name), options);
        if (!loaded) throw std::runtime_error(loaded.error().str());
        return std::move(loaded).value();
    }
    Reach reach(const LoadedScene& loaded, double aspect) {
        return reach_of(loaded.scene, std::get<PerspectiveCamera>(loaded.scene.cameras.at(loaded.settings.camera)),
                        aspect);
    }
    TemporaryFolder folder_;
};

/// Of so many triangles in a box of this size around a point.
std::string soup(Random& random, int count, Vec3d size, Vec3d middle) {
    std::string text;
    const auto coordinate = [&](double extent, double center) {
        return " " + std::to_string(center + extent * (random.unit() - 0.5));
    };
    for (int i = 0; i < 3 * count; ++i)
        text += "v" + coordinate(size.x, middle.x) + coordinate(size.y, middle.y) + coordinate(size.z, middle.z) + "\n";
    for (int i = 0; i < count; ++i)
        text +=
            "f " + std::to_string(3 * i + 1) + " " + std::to_string(3 * i + 2) + " " + std::to_string(3 * i + 3) + "\n";
    return text;
}

TEST_F(Framing, NoPictureOfATurntableCutsTheModel) {
    Random random(5);
    for (const Vec3d size : {Vec3d{1, 1, 1}, Vec3d{10, 1, 1}, Vec3d{1, 10, 1}, Vec3d{1, 1, 10}, Vec3d{5, 0.1, 5}}) {
        spit(folder_.file("soup.obj"), soup(random, 20, size, {3, -2, 1}));
        for (const double aspect : kAspects) {
            Reach most;
            for (int k = 0; k < 24; ++k) most.add(reach(load("soup.obj", 15 * k, aspect), aspect));
            EXPECT_LE(most.across, kFilled + 1e-4) << aspect;
            EXPECT_LE(most.up, kFilled + 1e-4) << aspect;
            // The square in the middle of the picture is filled, one way or the other, but for angles between pictures.
            const double filled =
                aspect < 1 ? std::max(most.across, most.up / aspect) : std::max(most.across * aspect, most.up);
            EXPECT_GT(filled, 0.8) << aspect;
        }
    }
}

TEST_F(Framing, PicturesOfEveryShapeHoldTheModel) {
    Random random(6);
    for (const Vec3d size : {Vec3d{1, 1, 1}, Vec3d{10, 1, 1}, Vec3d{1, 10, 1}, Vec3d{1, 1, 10}}) {
        spit(folder_.file("soup.obj"), soup(random, 20, size, {3, -2, 1}));
        for (const double aspect : kAspects) {
            const Reach r = reach(load("soup.obj", std::nullopt, aspect), aspect);
            EXPECT_LE(std::max(r.across, r.up), kFilled + 1e-4) << aspect;
            const double filled = aspect < 1 ? std::max(r.across, r.up / aspect) : std::max(r.across * aspect, r.up);
            EXPECT_NEAR(filled, kFilled, 1e-4 + 1e-6 / aspect) << aspect;
        }
    }
}

TEST_F(Framing, TheSceneSaysItsShapeWhereNobodyElseDoes) {
    const std::string model = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    spit(folder_.file("model.obj"), model);
    spit(folder_.file("scene.json"),
         R"({"version": 1, "camera": {"position": [0, 0, 5], "look_at": [0, 0, 0]}, "film": {"resolution": [90, 160]},
             "materials": {"white": {"type": "diffuse", "reflectance": [1, 1, 1]}},
             "objects": [{"type": "mesh", "path": "model.obj", "material": "white"}]})");
    const auto field_of_view = [&](std::optional<double> aspect) {
        const LoadedScene loaded = load("scene.json", 0, aspect);
        return std::get<PerspectiveCamera>(loaded.scene.cameras.at(1)).vertical_fov;
    };
    EXPECT_EQ(field_of_view(std::nullopt), field_of_view(9.0 / 16));
    EXPECT_NE(field_of_view(std::nullopt), field_of_view(1));
    EXPECT_EQ(field_of_view(1), field_of_view(2));
}

// --- Where models are looked at from ------------------------------------------------------------------------------

/// Sheets in one mesh.
class Sheets {
public:
    /// Its corners counter-clockwise, seen from its front.
    Sheets& add(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
        const auto first = static_cast<uint32_t>(mesh_.positions.size());
        mesh_.positions.insert(mesh_.positions.end(), {a, b, c, d});
        for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) mesh_.indices.push_back(first + i);
        return *this;
    }
    /// A square about a point whose front is towards ±x (0), ±y (1) or ±z (2).
    Sheets& facing(int axis, float sign, Vec3 middle, float half = 1) {
        Vec3 u{}, v{};
        u[(axis + 1) % 3] = half, v[(axis + 2) % 3] = half * sign;  // u × v is along the axis
        return add(middle - u - v, middle + u - v, middle + u + v, middle - u + v);
    }
    Scene scene(const Affine& world_from_object = {}) const {
        Scene out;
        out.meshes = {mesh_};
        out.shapes = {MeshId{0}};
        out.instances = {Instance{ShapeId{0}, MaterialId{0}, world_from_object}};
        return out;
    }
    const Mesh& mesh() const { return mesh_; }

private:
    Mesh mesh_;
};

/// The walls of a cube with the fronts inside, but for the one towards an axis.
Sheets room(int open_axis, float open_sign) {
    Sheets out;
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.0f, 1.0f}) {
            Vec3 middle{};
            middle[axis] = sign;
            if (axis != open_axis || sign != open_sign) out.facing(axis, -sign, middle);
        }
    return out;
}

Vec3d view_of(const Scene& scene) { return normalize(front_view(scene).towards_camera); }

TEST(FrontView, ABoxThatIsOpenAtASideIsLookedIntoFromThere) {
    for (const int axis : {0, 2})
        for (const float sign : {-1.0f, 1.0f}) {
            Vec3d open{};
            (axis == 0 ? open.x : open.z) = double(sign);
            EXPECT_GT(dot(view_of(room(axis, sign).scene()), open), 0.9999) << axis << sign;
        }
}

TEST(FrontView, ARoomWithoutACeilingIsLookedIntoFromAbove) {
    const Vec3d view = view_of(room(1, 1).scene());
    EXPECT_GT(view.y, 0.75);
    EXPECT_LT(view.y, 0.9);
}

TEST(FrontView, ASheetThatFacesAwayIsLookedAtFromItsFront) {
    for (const int axis : {0, 2})
        for (const float sign : {-1.0f, 1.0f}) {
            const Vec3d view = view_of(Sheets().facing(axis, sign, {}).scene());
            EXPECT_GT((axis == 0 ? view.x : view.z) * double(sign), 0.4) << axis << sign;
        }
}

TEST(FrontView, AMirroredRoomIsTheRoomMirrored) {
    Affine mirror;
    mirror.m[2][2] = -1;
    const Vec3d view = view_of(room(2, -1).scene(mirror));
    EXPECT_GT(view.z, 0.9999);
    EXPECT_LT(view_of(room(2, -1).scene()).z, -0.9999);
}

TEST(FrontView, OrdinaryModelsAreSeenAsUsual) {
    const auto is_usual = [](const Scene& scene) {
        const View view = front_view(scene);
        return view.turn == 0 && length(view.towards_camera - kUsualView) == 0;
    };
    Sheets solid, inverted, leaves;
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.0f, 1.0f}) {
            Vec3 middle{};
            middle[axis] = sign;
            solid.facing(axis, sign, middle), inverted.facing(axis, -sign, middle);
        }
    EXPECT_TRUE(is_usual(solid.scene()));
    EXPECT_TRUE(is_usual(inverted.scene()));  // it is no better from anywhere
    Random random(3);
    for (int i = 0; i < 300; ++i) {
        const auto coordinate = [&] { return static_cast<float>(20 * random.unit()); };
        const Vec3 middle{coordinate(), coordinate(), coordinate()};
        leaves.facing(i % 3, random.unit() < 0.5 ? -1.0f : 1.0f, middle);
    }
    EXPECT_TRUE(is_usual(leaves.scene()));
    // A ground, and open things whose insides are seen a little.
    EXPECT_TRUE(is_usual(Sheets().facing(1, 1, {}).scene()));
    EXPECT_TRUE(is_usual(Sheets().facing(2, 1, {}).scene()));
    EXPECT_TRUE(is_usual(Scene{}));
}

/// A sheet that is seen from everywhere but behind, and one that faces to the side that is turned away.
Scene two_sheets(float half) {
    return Sheets().facing(0, 1, {0, 0, 0}, 1).facing(2, -1, {0, 0, -1.5f - half}, half).scene();
}

TEST(FrontView, AFewBacksAreNoReasonToGoElsewhere) {
    EXPECT_EQ(front_view(two_sheets(0.25f)).turn, 0);
    EXPECT_NE(front_view(two_sheets(1)).turn, 0);
}

TEST(FrontView, TheNearestSurfaceCounts) {
    // A back behind a front that hides it from the usual view, and the other way round.
    EXPECT_EQ(front_view(Sheets().facing(2, 1, {0, 0, 1}, 2).facing(2, -1, {}, 0.5f).scene()).turn, 0);
    EXPECT_EQ(front_view(Sheets().facing(2, -1, {}, 0.5f).facing(2, 1, {0, 0, 1}, 2).scene()).turn, 0);
    EXPECT_EQ(front_view(Sheets().facing(2, -1, {0, 0, 1}, 2).facing(2, 1, {}, 0.5f).scene()).turn, 180);
    EXPECT_EQ(front_view(Sheets().facing(2, 1, {}, 0.5f).facing(2, -1, {0, 0, 1}, 2).scene()).turn, 180);
}

TEST(FrontView, WhatWouldTakeLongIsSeenAsUsual) {
    const auto copies = [](size_t count, float scale) {
        const Mesh one = Sheets().facing(2, -1, {}).mesh();
        Scene scene = Sheets().facing(2, -1, {}).scene();
        Mesh& mesh = scene.meshes[0];
        for (size_t i = 0; i < count; ++i) {
            const auto first = static_cast<uint32_t>(mesh.positions.size());
            for (const Vec3 p : one.positions) mesh.positions.push_back(p * scale);
            for (const uint32_t k : one.indices) mesh.indices.push_back(first + k);
        }
        return scene;
    };
    EXPECT_EQ(front_view(copies(200, 1)).turn, 180);
    EXPECT_EQ(front_view(copies(50'000, 1)).turn, 0);         // many pixels each
    EXPECT_EQ(front_view(copies(160'000, 1e-3f)).turn, 180);  // hardly any
    EXPECT_EQ(front_view(copies(170'000, 1e-3f)).turn, 0);    // two triangles and four vertices each
}

TEST_F(Framing, TheStudioStandsAsTheCameraSeesIt) {
    // Two sheets that look the same from their fronts, by +z and by -z.
    spit(folder_.file("front.obj"), "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n");
    spit(folder_.file("back.obj"), "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 4 3 2 1\n");
    const LoadedScene front = load("front.obj", std::nullopt, std::nullopt);
    const LoadedScene back = load("back.obj", std::nullopt, std::nullopt);
    const auto half_turn = [](Vec3 a, Vec3 b) {
        EXPECT_NEAR(a.x, -b.x, 1e-5);
        EXPECT_NEAR(a.y, b.y, 1e-5);
        EXPECT_NEAR(a.z, -b.z, 1e-5);
    };
    half_turn(std::get<PerspectiveCamera>(front.scene.cameras.at(0)).position,
              std::get<PerspectiveCamera>(back.scene.cameras.at(0)).position);
    for (size_t i = 0; i < 2; ++i) {
        const auto lamp = [&](const LoadedScene& l) {
            const auto& light = std::get<AreaLight>(l.scene.lights.at(i));
            return std::get<Rectangle>(l.scene.shapes[index(l.scene.instances[index(light.instance)].shape)]).center;
        };
        half_turn(lamp(front), lamp(back));
    }
}

}  // namespace
}  // namespace steradian
