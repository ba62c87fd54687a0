// Shadow rays: a light does not shadow itself, the receiving surface does not either, and what is close to the light
// does.
#include <gtest/gtest.h>

#include "shading/area_lights.h"
#include "support/support.h"

namespace steradian {
namespace {

using test::AreaLightCase;
using test::Random;
using test::World;

/// The light's scene, scaled and moved, and a floor below and a ceiling above it to receive on.
Scene with_floor(const AreaLightCase& light, double scale, Vec3d offset) {
    Scene scene = light.scene;
    Affine& placed = scene.instances[0].world_from_object;
    placed = translation(offset.x, offset.y, offset.z) * scaling(scale, scale, scale) * placed;
    const auto s = static_cast<float>(scale);
    for (const double y : {-2.0, 2.0})
        test::add_shape(scene, Rectangle{static_cast<Vec3>(offset + Vec3d{0.1, y, 0} * scale), Vec3{0, 0.2f, 4} * s,
                                         Vec3{4, -0.3f, 0} * s});
    return scene;
}

TEST(ShadowRays, NeitherEndIsInTheWay) {
    const int n = test::by_tier(2000, 100000);
    for (const AreaLightCase& light : test::area_light_cases())
        for (const double scale : {1e-3, 1.0, 1e6})
            for (const double far : {0.0, 1e5}) {
                if (far > 1e5 * scale) continue;
                SCOPED_TRACE(light.name + " at scale " + std::to_string(scale) + ", offset " + std::to_string(far));
                const Vec3d offset{far, -far, 0.5 * far};
                const World world(with_floor(light, scale, offset));
                Random random(11);
                int sampled = 0, blocked = 0;
                for (int i = 0; i < n; ++i) {
                    const double y = i % 2 ? 2 : -2;
                    const Vec3d start = offset + Vec3d{random.between(-3, 3), 0.5 * y, random.between(-3, 3)} * scale;
                    const Vec3d end = offset + Vec3d{random.between(-3.9, 3.9), y, random.between(-3.9, 3.9)} * scale;
                    const Ray ray = test::ray_towards(start, end);
                    const Hit hit = world.accel.intersect(ray);
                    if (!hit.found() || hit.instance == 0) continue;
                    const SurfacePoint point = surface_at(world.shading, ray, hit);
                    const uint32_t choice = random.bits32();
                    const auto sample = sample_light(world.shading, 0, point, choice, random.uniform2());
                    // The ceiling is seen from below, the side that its normal does not point to.
                    if (!sample || dot(sample->wi, point.ng) * -y < 1e-4) continue;
                    ++sampled;
                    blocked += world.accel.occluded(sample->shadow_ray);
                }
                EXPECT_GT(sampled, n / 50);
                EXPECT_EQ(blocked, 0);
            }
}

/// Receivers that see a light under ever smaller angles, far away, where the rounding of the ray's direction is larger
/// than the offset of the target.
TEST(ShadowRays, GrazingTheLight) {
    for (const AreaLightCase& light : test::area_light_cases()) {
        SCOPED_TRACE(light.name);
        const World world(light.scene);
        Random random(23);
        int sampled = 0, blocked = 0;
        for (int i = 0; i < 20000; ++i) {
            const Vec3d direction = random.direction();
            const double distance = std::pow(10, random.between(0.5, 4));
            const Vec3d flat{direction.x, direction.y * std::pow(10, random.between(-5, 0)), direction.z};
            const SurfacePoint from = test::receiver(static_cast<Vec3>(flat * distance), {0, 1, 0});
            const auto sample = sample_light(world.shading, 0, from, random.bits32(), random.uniform2());
            if (!sample) continue;
            ++sampled;
            blocked += world.accel.occluded(sample->shadow_ray);
        }
        EXPECT_GT(sampled, 1000);
        EXPECT_EQ(blocked, 0);
    }
}

TEST(ShadowRays, AnOccluderCloseToTheLightIsSeen) {
    Random random(31);
    for (const AreaLightCase& light : test::area_light_cases()) {
        SCOPED_TRACE(light.name);
        const World world(light.scene);
        for (int i = 0; i < 200; ++i) {
            const SurfacePoint from =
                test::receiver(static_cast<Vec3>(random.direction() * random.between(2, 20)), {0, 1, 0});
            const auto sample = sample_light(world.shading, 0, from, random.bits32(), random.uniform2());
            if (!sample) continue;
            // A little disk across the ray, 1e-4 of the distance before its end and as far after its beginning.
            const Vec3d o = sample->shadow_ray.o, d = sample->shadow_ray.d;
            for (const double t : {1e-4, 1 - 1e-4}) {
                Scene scene;
                const auto size = static_cast<float>(1e-3 * length(d));
                test::add_shape(scene, Disk{static_cast<Vec3>(o + d * t), sample->shadow_ray.d, size});
                EXPECT_TRUE(World(std::move(scene)).accel.occluded(sample->shadow_ray)) << t;
            }
        }
    }
}

TEST(ShadowRays, PointLights) {
    Scene scene;
    scene.lights = {PointLight{{0, 5, 0}, {1, 1, 1}}, SpotLight{{0, 5, 0}, {0, -1, 0}, {1, 1, 1}, 60, 80}};
    test::add_shape(scene, Disk{{0, 5.0005f, 0}, {0, 1, 0}, 1});  // just behind the lights
    const World world(scene);
    test::add_shape(scene, Disk{{0, 4.9995f, 0}, {0, 1, 0}, 1});  // just before them
    const World covered(std::move(scene));
    for (const uint32_t light : {0u, 1u}) {
        const auto sample = sample_light(world.shading, light, test::receiver({1, 0, 1}, {0, 1, 0}), 0, {});
        ASSERT_TRUE(sample);
        EXPECT_FALSE(world.accel.occluded(sample->shadow_ray));
        EXPECT_TRUE(covered.accel.occluded(sample->shadow_ray));
        // From where the light is there is no direction to it.
        EXPECT_FALSE(sample_light(world.shading, light, test::receiver({0, 5, 0}, {0, 1, 0}), 0, {}));
    }
}

}  // namespace
}  // namespace steradian
