// pdf_light is the density of sample_light: its integral over all directions in which the light is seen is the share of
// samples that there are. Over a grid of directions, so that what pdf_light says of any direction counts, not only of
// those that sample_light comes up with.
#include <gtest/gtest.h>

#include <cstring>
#include <optional>

#include "shading/area_lights.h"
#include "shading/sampler.h"

namespace steradian {
namespace {

using test::AreaLightCase;
using test::World;

/// The light as it is seen along wi: nothing where it is not, or where it is seen more edge-on than `min_cosine`. (The
/// density of a curved surface that is sampled by area has no bound towards its rim, where it is not to be integrated.)
std::optional<double> seen_density(const World& world, const SurfacePoint& from, Vec3 wi, double min_cosine) {
    const Ray ray = spawn_ray(from, wi);
    const Hit hit = world.accel.intersect(ray);
    if (world.shading.environment || !world.shading.suns.empty()) return pdf_light(world.shading, 0, from, wi, nullptr);
    if (!hit.found()) return std::nullopt;
    const SurfacePoint point = surface_at(world.shading, ray, hit);
    if (std::fabs(dot(Vec3d(wi), Vec3d(point.ng))) < min_cosine) return std::nullopt;
    return pdf_light(world.shading, 0, from, wi, &point);
}

/// Share of the numbers for which sample_light finds a direction in which the light is seen.
double share_of_samples(const World& world, const SurfacePoint& from, double min_cosine) {
    constexpr int kCount = 1 << 14;
    const Sampler sampler(SamplerKind::sobol, 3);
    int found = 0;
    for (uint64_t i = 0; i < kCount; ++i) {
        const SampleKey key = sampler.key(0, 0, i);
        const Vec2 u = sampler.get_2d(key, 0);
        const auto sample = sample_light(world.shading, 0, from, sampler.bits(key, 2), u);
        found += sample && seen_density(world, from, sample->wi, min_cosine);
    }
    return static_cast<double>(found) / kCount;
}

/// ∫ pdf_light dω by the midpoint rule in the height and the angle about an axis that goes through the light.
double integral(const World& world, const SurfacePoint& from, Vec3d towards, double cap, double min_cosine) {
    constexpr int kHeights = 400, kAngles = 400;
    const Frame3d frame = Frame3d::from_z(normalize(towards));
    double sum = 0;
    for (int i = 0; i < kHeights; ++i)
        for (int j = 0; j < kAngles; ++j) {
            const double z = 1 - cap * (i + 0.5) / kHeights, r = std::sqrt((1 - z) * (1 + z));
            const double phi = 2 * std::numbers::pi * (j + 0.5) / kAngles;
            const Vec3 wi = static_cast<Vec3>(frame.to_world({r * std::cos(phi), r * std::sin(phi), z}));
            sum += seen_density(world, from, wi, min_cosine).value_or(0);
        }
    return sum * 2 * std::numbers::pi * cap / (double(kHeights) * kAngles);
}

TEST(PdfLight, OfAreaLightsIntegratesToTheShareOfSamples) {
    std::vector<AreaLightCase> cases = test::area_light_cases();
    cases.push_back(test::area_light("disk with two sides", Disk{{0, 0, 0.1f}, {0.2f, 1, 0.1f}, 0.7f}, {}, true));
    for (const AreaLightCase& light : cases) {
        const World world(light.scene);
        for (const Vec3 p : {Vec3{1.3f, 1.1f, -0.4f}, Vec3{0.2f, -1.4f, 0.3f}, Vec3{0.4f, 1.2f, -0.3f}}) {
            const SurfacePoint from = test::receiver(p, {0, 1, 0});
            // Edges cut through the grid.
            EXPECT_NEAR(integral(world, from, -Vec3d(p), 1.999, 0.2), share_of_samples(world, from, 0.2), 0.02)
                << light.name << " " << p.x;
        }
    }
}

/// A point on a glowing sphere: from inside all of it is seen, from outside nothing.
TEST(PdfLight, OfASphereSeenFromItself) {
    const World world(test::area_light("", Sphere{{3, -2, 1}, 0.6f}, {}, true).scene);
    for (const float side : {-1.0f, 1.0f})
        for (const Vec3 n : {Vec3{0, 1, 0}, Vec3{0.48f, 0.6f, 0.64f}, Vec3{-0.8f, 0, 0.6f}}) {
            const Ray ray{Vec3{3, -2, 1} + n * 2.0f, 0, -n, kInfinity};
            const Hit hit = world.accel.intersect(ray);
            ASSERT_TRUE(hit.found());
            const SurfacePoint from = facing(surface_at(world.shading, ray, hit), n * side);
            const double seen = integral(world, from, Vec3d(from.ng), 1, 0);
            EXPECT_NEAR(seen, side < 0 ? 1 : 0, 1e-3);
            EXPECT_NEAR(share_of_samples(world, from, 0), 1, 1e-3);
            // What is sampled is on the inner side.
            const auto sample = sample_light(world.shading, 0, from, 0, {0.3f, 0.6f});
            ASSERT_TRUE(sample);
            EXPECT_EQ(dot(sample->wi, from.ng) > 0, side < 0);
        }
}

TEST(PdfLight, OfSunsIntegratesToOne) {
    for (const float diameter : {1.0f, 20.0f, 90.0f}) {
        Scene scene;
        scene.lights = {DirectionalLight{{0.3f, -1, 0.2f}, {1, 2, 3}, diameter}};
        const World world(std::move(scene));
        const SurfacePoint from = test::receiver({0, 0, 0}, {0.2f, 1, -0.3f});
        const double cap = 1.5 * (1 - std::cos(diameter * std::numbers::pi / 360));
        EXPECT_NEAR(integral(world, from, {-0.3, 1, -0.2}, cap, 0), 1, 3e-3) << diameter;
        EXPECT_NEAR(share_of_samples(world, from, 0), 1, 1e-3);
        // Samples are where there is density, and have it.
        const Sampler sampler(SamplerKind::independent, 3);
        for (uint64_t i = 0; i < 1000; ++i) {
            const SampleKey key = sampler.key(0, 0, i);
            const auto sample = sample_light(world.shading, 0, from, 0, sampler.get_2d(key, 0));
            ASSERT_TRUE(sample);
            ASSERT_EQ(sample->pdf, pdf_light(world.shading, 0, from, sample->wi, nullptr));
            ASSERT_EQ(sample->radiance, sky_radiance(world.shading, sample->wi, true));
        }
    }
}

TEST(PdfLight, OfEnvironmentsIntegratesToOne) {
    Scene constant;
    constant.lights = {EnvironmentLight{{1, 2, 3}}};
    Scene image;
    RawImage map{8, 4, 3, TexelFormat::f32, {}};
    std::vector<float> texels;
    for (int i = 0; i < 8 * 4 * 3; ++i) texels.push_back(static_cast<float>((i * 7) % 5));
    map.data.resize(texels.size() * sizeof(float));
    std::memcpy(map.data.data(), texels.data(), map.data.size());
    image.images.push_back(std::move(map));
    image.lights = {EnvironmentLight{{1, 1, 1}, ImageId{0}, ColorSpace::linear, 30, 1}};
    for (Scene* scene : {&constant, &image}) {
        const World world(std::move(*scene));
        for (const bool both_sides : {false, true}) {
            SurfacePoint from = test::receiver({0, 0, 0}, {0.2f, 1, -0.3f});
            from.both_sides = both_sides;
            EXPECT_NEAR(integral(world, from, {0, 1, 0}, 2, 0), 1, 2e-3);
            EXPECT_NEAR(share_of_samples(world, from, 0), 1, 1e-3);
        }
    }
}

/// Half of what an even sky is asked for is behind a surface that transmits, by the cosine.
TEST(PdfLight, OfAnEvenSkyOnBothSides) {
    Scene scene;
    scene.lights = {EnvironmentLight{{1, 2, 3}}};
    const World world(std::move(scene));
    SurfacePoint from = test::receiver({0, 0, 0}, {0.2f, 1, -0.3f});
    from.both_sides = true;
    constexpr int kCount = 1 << 14;
    const Sampler sampler(SamplerKind::sobol, 5);
    int behind = 0;
    double cosines = 0;
    for (uint64_t i = 0; i < kCount; ++i) {
        const SampleKey key = sampler.key(0, 0, i);
        const Vec2 u = sampler.get_2d(key, 0);
        const auto sample = sample_light(world.shading, 0, from, sampler.bits(key, 2), u);
        ASSERT_TRUE(sample);
        const float cosine = dot(sample->wi, from.ns);
        behind += cosine < 0;
        cosines += std::fabs(cosine);
        ASSERT_EQ(sample->pdf, pdf_light(world.shading, 0, from, sample->wi, nullptr));
        ASSERT_NEAR(sample->pdf, std::fabs(cosine) / (2 * std::numbers::pi), 1e-6);
    }
    EXPECT_NEAR(double(behind) / kCount, 0.5, 1e-3);
    EXPECT_NEAR(cosines / kCount, 2.0 / 3, 1e-3);
}

}  // namespace
}  // namespace steradian
