// What holds for every integrator, and what the small ones show.
#include <gtest/gtest.h>

#include <cmath>

#include "base/names.h"
#include "render_support.h"
#include "support/support.h"
#include "test_scenes.h"

namespace steradian {
namespace {

using test::prepared;
using test::run;

RenderSettings settings_of(IntegratorKind kind) {
    RenderSettings s;
    s.integrator = kind;
    s.width = 31;
    s.height = 23;
    s.samples_per_pixel = 70;  // one whole block and an open one
    s.filter = {FilterKind::box, 0.5f};
    return s;
}

std::vector<IntegratorKind> all_integrators() {
    std::vector<IntegratorKind> out;
    for (size_t i = 0; i < names_of<IntegratorKind>().size(); ++i) out.push_back(static_cast<IntegratorKind>(i));
    return out;
}

TEST(Integrators, GiveTheSameBitsOnAnyNumberOfThreadsAndTiles) {
    const auto scene = prepared(test::everything_scene());
    for (const IntegratorKind kind : all_integrators()) {
        RenderSettings settings = settings_of(kind);
        settings.samples_per_pixel = test::by_tier(kind == IntegratorKind::path ? 66 : 4, 150);
        const std::string expected = image_hash(run(scene, settings, {1, 16, BvhBuilder::sah, 64}).image);
        for (const Execution& execution :
             {Execution{7, 5, BvhBuilder::sah, 64}, Execution{2, 256, BvhBuilder::sah, 64, Isa::scalar}})
            EXPECT_EQ(image_hash(run(scene, settings, execution).image), expected) << name_of(kind);
    }
}

TEST(Integrators, AreEachAPictureOfItsOwn) {
    const auto scene = prepared(test::everything_scene());
    std::vector<std::string> hashes;
    for (const IntegratorKind kind : all_integrators()) {
        RenderSettings settings = settings_of(kind);
        settings.samples_per_pixel = 1;
        const RenderResult result = run(scene, settings);
        EXPECT_EQ(result.statistics.bad_samples, 0u) << name_of(kind);
        EXPECT_EQ(result.image.metadata.at("steradian:integrator"), name_of(kind));
        for (const std::string& other : hashes) EXPECT_NE(image_hash(result.image), other) << name_of(kind);
        hashes.push_back(image_hash(result.image));
    }
}

/// A floor in the plane z = 0, looked at along -Z from a height of 5.
Scene floor() {
    Scene s;
    test::place(s, Rectangle{{0, 0, 0}, {100, 0, 0}, {0, 100, 0}}, test::diffuse(s, {0.25f, 0.5f, 0.75f}));
    s.lights = {EnvironmentLight{{1, 1, 1}}};
    s.cameras = {PerspectiveCamera{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 0.05f}};
    return s;
}

double mean(const Image& image) {
    double sum = 0;
    for (size_t i = 0; i < image.pixels.size(); i += 3) sum += image.pixels[i];
    return sum / (static_cast<double>(image.pixels.size()) / 3);
}

TEST(AmbientOcclusion, OfAnOpenFloorIsNone) {
    const Image image = run(prepared(floor()), settings_of(IntegratorKind::ao)).image;
    for (const float v : image.pixels) ASSERT_EQ(v, 1);
}

/// Under a wide parallel plane at height h: the share of the cosine-weighted hemisphere in which h / cos θ is beyond
/// the distance d is (h/d)². The camera is between the planes.
TEST(AmbientOcclusion, CountsWhatIsNearerThanTheDistance) {
    Scene s = floor();
    test::place(s, Rectangle{{0, 0, 2}, {1000, 0, 0}, {0, 1000, 0}}, MaterialId{0});
    s.cameras = {PerspectiveCamera{{0, 0, 1}, {0, 0, 0}, {0, 1, 0}, 0.05f}};
    const auto scene = prepared(std::move(s));
    for (const double d : {1.0, 2.5, 4.0, 20.0}) {
        RenderSettings settings = settings_of(IntegratorKind::ao);
        settings.sampler = SamplerKind::independent;
        settings.ao_distance = static_cast<float>(d);
        const double expected = d <= 2 ? 1 : 4 / (d * d);
        const double n = 31 * 23 * 70;
        EXPECT_NEAR(mean(run(scene, settings).image), expected, 4.5 * std::sqrt(expected * (1 - expected) / n) + 1e-6)
            << d;
    }
    RenderSettings unlimited = settings_of(IntegratorKind::ao);
    EXPECT_LT(mean(run(scene, unlimited).image), 1e-3);
}

TEST(AmbientOcclusion, IsSeenOnTheSideOfTheCamera) {
    Scene s = floor();
    s.cameras = {PerspectiveCamera{{0, 0, -5}, {0, 0, 0}, {0, 1, 0}, 0.05f}};
    EXPECT_EQ(mean(run(prepared(std::move(s)), settings_of(IntegratorKind::ao)).image), 1);
}

const float* pixel(const Image& image, uint32_t x, uint32_t y) {
    return image.pixels.data() + (size_t(y) * image.width + x) * 3;
}

TEST(Inspectors, ShowWhatTheCameraFinds) {
    Scene s = floor();
    s.cameras = {PerspectiveCamera{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 90}};
    // A square that covers the left half of the picture up to x = 0, turned towards +X by 45 degrees.
    s.shapes.clear(), s.instances.clear();
    test::place(s, Rectangle{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, MaterialId{0});
    const auto scene = prepared(std::move(s));
    const auto show = [&](IntegratorKind kind) {
        RenderSettings settings = settings_of(kind);
        settings.width = settings.height = 10;
        settings.samples_per_pixel = 16;
        return run(scene, settings).image;
    };
    // Half a field of view of 45 degrees at 5 m: a pixel is 1 m wide, the square reaches from pixel 1 to 8.
    const Image normals = show(IntegratorKind::normals), albedo = show(IntegratorKind::albedo),
                depth = show(IntegratorKind::depth), uv = show(IntegratorKind::uv),
                primitive = show(IntegratorKind::primitive);
    for (const auto& [x, y] : {std::pair{1u, 1u}, {8u, 1u}, {4u, 5u}, {8u, 8u}}) {
        EXPECT_EQ(pixel(normals, x, y)[0], 0.5f);
        EXPECT_EQ(pixel(normals, x, y)[2], 1.0f);
        EXPECT_EQ(pixel(albedo, x, y)[0], 0.25f);
        EXPECT_EQ(pixel(albedo, x, y)[2], 0.75f);
        EXPECT_NEAR(pixel(depth, x, y)[0], 5, 1e-5);  // along -Z, not along the ray
        EXPECT_NEAR(pixel(uv, x, y)[0], (x - 0.5) / 8, 0.02);
        EXPECT_NEAR(pixel(uv, x, y)[1], (y - 0.5) / 8, 0.02);
        EXPECT_EQ(pixel(primitive, x, y)[0], pixel(primitive, 2, 2)[0]);
        EXPECT_GE(pixel(primitive, x, y)[1], 0.1f);
    }
    for (const Image* image : {&normals, &albedo, &depth, &uv, &primitive}) EXPECT_EQ(pixel(*image, 0, 0)[0], 0);
}

TEST(Inspectors, CostIsThatOfTheHierarchy) {
    Scene s = floor();
    s.cameras = {PerspectiveCamera{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 40}};
    s.shapes.clear(), s.instances.clear();
    // One shape: rays that miss visit the root alone, those that meet its box the shape as well.
    test::place(s, Rectangle{{0, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 0}}, MaterialId{0});
    RenderSettings settings = settings_of(IntegratorKind::cost);
    settings.width = settings.height = 9;
    settings.samples_per_pixel = 4;
    const Image image = run(prepared(std::move(s)), settings).image;
    for (const float v : {pixel(image, 0, 0)[0], pixel(image, 0, 0)[1], pixel(image, 0, 0)[2]}) EXPECT_EQ(v, 0);
    // Two visits are half way from the colour of one to that of four.
    EXPECT_NEAR(pixel(image, 4, 4)[0], 0.01f, 1e-6);
    EXPECT_NEAR(pixel(image, 4, 4)[2], 0.2f, 1e-6);
}

/// A mirror's tint, and glass reflects or transmits all that arrives, whatever refraction does to radiance.
TEST(Inspectors, AlbedoOfSpecularSurfaces) {
    for (const bool mirror : {false, true}) {
        Scene s;
        const auto material = add<MaterialId>(
            s.materials, mirror ? Material(MirrorMaterial{{0.5f, 0.5f, 0.5f}}) : Material(GlassMaterial{}));
        test::place(s, Sphere{{0, 0, 0}, 1}, material);
        s.lights = {EnvironmentLight{{1, 1, 1}}};
        s.cameras = {PerspectiveCamera{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 10}};
        const Image image = run(prepared(std::move(s)), settings_of(IntegratorKind::albedo)).image;
        for (const float v : image.pixels) ASSERT_NEAR(v, mirror ? 0.5f : 1.0f, 1e-6);
    }
}

TEST(Inspectors, PrimitivesHaveColoursOfTheirOwn) {
    Scene s;
    const MaterialId grey = test::diffuse(s, {0.5f, 0.5f, 0.5f});
    const auto mesh =
        add<MeshId>(s.meshes, Mesh{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {}, {}, {0, 1, 2, 0, 2, 3}});
    test::place(s, mesh, grey);
    s.lights = {EnvironmentLight{{1, 1, 1}}};
    s.cameras = {PerspectiveCamera{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 20}};
    RenderSettings settings = settings_of(IntegratorKind::primitive);
    settings.width = settings.height = 8;
    const Image image = run(prepared(std::move(s)), settings).image;
    EXPECT_NE(pixel(image, 1, 3)[0], pixel(image, 6, 4)[0]);
    EXPECT_EQ(pixel(image, 1, 3)[0], pixel(image, 2, 4)[0]);
}

}  // namespace
}  // namespace steradian
