// Irradiance from every kind of light against its closed form. The midpoints of a grid stand for the random numbers
// where the integrands are smooth, so that the estimates are right to far more digits than are asked for.
#include <gtest/gtest.h>

#include <functional>

#include "shading/area_lights.h"
#include "shading/sampler.h"

namespace steradian {
namespace {

using test::World;

double contribution(const ShadingScene& scene, const SurfacePoint& from, uint32_t choice, Vec2 u) {
    const auto sample = sample_light(scene, 0, from, choice, u);
    if (!sample) return 0;
    const double cosine = dot(Vec3d(sample->wi), Vec3d(from.ns));
    return max_of(cosine, 0.0) * sample->radiance.r / (sample->pdf > 0 ? sample->pdf : 1);
}

/// ∫ L cos over a light without parts.
double irradiance(const ShadingScene& scene, const SurfacePoint& from, int side = 256) {
    double sum = 0;
    for (int i = 0; i < side * side; ++i)
        sum += contribution(scene, from, 0,
                            {static_cast<float>((i / side + 0.5) / side), static_cast<float>((i % side + 0.5) / side)});
    return sum / (static_cast<double>(side) * side);
}

struct Estimate {
    double mean = 0, standard_error = 0;
};

/// For integrands that are not smooth: the mean over 16 independent scrambles of 2^14 points, and its standard error.
Estimate irradiance_by_seeds(const ShadingScene& scene, const SurfacePoint& from) {
    constexpr int kSeeds = 16, kCount = 1 << 14;
    double means[kSeeds] = {}, mean = 0, squares = 0;
    for (int seed = 0; seed < kSeeds; ++seed) {
        const Sampler sampler(SamplerKind::sobol, static_cast<uint64_t>(seed));
        for (uint64_t i = 0; i < kCount; ++i)
            means[seed] += contribution(scene, from, 0, sampler.get_2d(sampler.key(0, 0, i), 0)) / kCount;
        mean += means[seed] / kSeeds;
    }
    for (const double m : means) squares += (m - mean) * (m - mean);
    return {mean, std::sqrt(squares / (kSeeds - 1) / kSeeds)};
}

/// The same over a light with parts, by a lattice in three dimensions: the powers of the root of x³ = x + 1.
double irradiance_of_parts(const ShadingScene& scene, const SurfacePoint& from) {
    constexpr int kCount = 1 << 20;
    double sum = 0;
    for (int i = 0; i < kCount; ++i) {
        const double a = i * 0.7548776662466927, b = i * 0.5698402909980532;
        sum += contribution(scene, from, static_cast<uint32_t>((i + 0.5) / kCount * 0x1p32),
                            {static_cast<float>(a - std::floor(a)) * kOneMinusEpsilon,
                             static_cast<float>(b - std::floor(b)) * kOneMinusEpsilon});
    }
    return sum / kCount;
}

/// Lambert 1760: the irradiance of a polygon of radiance 1 that is above the horizon altogether.
double polygon_irradiance(const std::vector<Vec3d>& corners, Vec3d p, Vec3d n) {
    double sum = 0;
    for (size_t i = 0; i < corners.size(); ++i) {
        const Vec3d a = normalize(corners[i] - p), b = normalize(corners[(i + 1) % corners.size()] - p);
        const Vec3d c = cross(a, b);
        const double s = length(c);
        if (s > 0) sum += std::atan2(s, dot(a, b)) * dot(c, n) / s;
    }
    return std::fabs(sum) / 2;
}

struct RectangleCase {
    const char* name;
    Rectangle rectangle;
    Vec3 p, n;
    double tolerance = 1e-5;
};

TEST(Irradiance, RectanglesAsPolygons) {
    const Rectangle down{{0, 2, 0}, {1, 0, 0}, {0, 0, 0.5f}};  // half_u × half_v is -Y
    const RectangleCase cases[] = {
        {"centred", down, {0, 0, 0}, {0, 1, 0}},
        {"below a corner", down, {1, 0, 0.5f}, {0, 1, 0}},
        {"offset", down, {3, 0.5f, -2}, {0, 1, 0}},
        {"close", down, {0.2f, 1.95f, 0.1f}, {0, 1, 0}, 1e-3},  // z = 0.05: the integrand is steep
        {"perpendicular", down, {1.5f, 0, 0}, {-1, 0, 0}},
        {"oblique", down, {0.5f, 0, 1}, {0.3f, 1, -0.2f}},
        {"small, by area", {{0, 100, 0}, {0.01f, 0, 0}, {0, 0, 0.01f}}, {0, 0, 0}, {0, 1, 0}},
        {"edge-on, by area", {{0, 1e-4f, 0}, {0.01f, 0, 0}, {0, 0, 0.01f}}, {4, 0, 0}, {-1, 0.1f, 0}, 1e-4},
        {"parallelogram", {{0, 2, 0}, {1, 0, 0}, {0.7f, 0, 0.5f}}, {0.4f, 0, 0}, {0, 1, 0}},
    };
    for (const RectangleCase& c : cases) {
        Scene scene = test::area_light("", c.rectangle, {}).scene;
        const World world(std::move(scene));
        const Vec3d m = c.rectangle.center, u = c.rectangle.half_u, v = c.rectangle.half_v;
        const SurfacePoint from = test::receiver(c.p, c.n);
        const double expected = polygon_irradiance({m - u - v, m + u - v, m + u + v, m - u + v}, c.p, Vec3d(from.ns));
        EXPECT_NEAR(irradiance(world.shading, from) / expected, 1, c.tolerance) << c.name;
    }
}

TEST(Irradiance, SmallRectanglesFarAway) {
    // L A cos θ cos θ' / d². The next term of the expansion about the centre is half²/6 (∂²/∂x² + ∂²/∂z²) of that, and
    // either derivative is below 24 / d² of the value.
    for (const float half : {1e-5f, 1e-4f, 1e-2f, 0.1f}) {
        const World world(test::area_light("", Rectangle{{30, 20, 10}, {half, 0, 0}, {0, 0, half}}, {}).scene);
        const double d2 = 1400, area = 4.0 * half * half;
        EXPECT_NEAR(irradiance(world.shading, test::receiver({}, {0, 1, 0}), 16) / (area * 400 / (d2 * d2)), 1,
                    1e-6 + 8 * half * half / d2)
            << half;
    }
}

TEST(Irradiance, CentredRectangleFormFactor) {
    // Howell's C-3, four times: X = half width / distance, Y = half depth / distance.
    const World world(test::area_light("", Rectangle{{0, 2, 0}, {1, 0, 0}, {0, 0, 0.5f}}, {}).scene);
    const double x = 0.5, y = 0.25;
    const double quarter = (x / std::sqrt(1 + x * x) * std::atan(y / std::sqrt(1 + x * x)) +
                            y / std::sqrt(1 + y * y) * std::atan(x / std::sqrt(1 + y * y))) /
                           2;
    EXPECT_NEAR(irradiance(world.shading, test::receiver({}, {0, 1, 0})), 4 * quarter, 1e-5);
}

TEST(Irradiance, TransformedMeshesAsPolygons) {
    for (const bool mirrored : {false, true}) {
        const Affine transform =
            translation(0.2, 3, -0.3) * rotation_degrees(25, {1, 0, 1}) * scaling(mirrored ? -1.4 : 1.4, 0.7, 2);
        Scene scene;
        Mesh mesh;
        mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 0.2f, 1}, {0, 0, 1}};
        mesh.indices = {0, 1, 2, 0, 2, 3, 1, 1, 2};  // facing down; the last triangle has no area
        add<MeshId>(scene.meshes, mesh);
        add<InstanceId>(scene.lights,
                        Light{AreaLight{test::add_shape(scene, MeshId{0}, transform), {1, 1, 1}, false, 1}});
        const World world(std::move(scene));
        const SurfacePoint from = test::receiver({0.3f, 0, 0.2f}, {0.1f, 1, 0});
        double expected = 0;
        for (const auto& t : {std::array{0, 1, 2}, std::array{0, 2, 3}}) {
            std::vector<Vec3d> corners;
            for (const int i : t) corners.push_back(transform_point(transform, mesh.positions[static_cast<size_t>(i)]));
            expected += polygon_irradiance(corners, from.p, Vec3d(from.ns));
        }
        EXPECT_NEAR(irradiance_of_parts(world.shading, from) / expected, 1, 1e-4) << mirrored;
    }
}

TEST(Irradiance, Disks) {
    const double r = 0.8, h = 1.5;
    const World world(test::area_light("", Disk{{0, 1.5f, 0}, {0, -2, 0}, 0.8f}, {}).scene);
    // Coaxial, then a parallel element at distance a from the axis (Howell B-12 and B-13).
    EXPECT_NEAR(irradiance(world.shading, test::receiver({}, {0, 1, 0})), std::numbers::pi * r * r / (r * r + h * h),
                3e-5);
    for (const double a : {0.5, 1.0, 4.0}) {
        const double s = h * h + a * a + r * r;
        const double expected =
            std::numbers::pi / 2 * (1 - (h * h + a * a - r * r) / std::sqrt(s * s - 4 * a * a * r * r));
        const SurfacePoint from =
            test::receiver({static_cast<float>(a * 0.6), 0, static_cast<float>(a * 0.8)}, {0, 1, 0});
        EXPECT_NEAR(irradiance(world.shading, from) / expected, 1, 3e-5) << a;
    }
}

TEST(Irradiance, Spheres) {
    const Affine placed = translation(1, 2, 3) * rotation_degrees(20, {0, 1, 1}) * scaling(2, 2, -2);
    for (const bool instanced : {false, true}) {
        const Sphere sphere = instanced ? Sphere{{0, 0, 0}, 0.4f} : Sphere{{1, 2, 3}, 0.8f};
        const World world(test::area_light("", sphere, instanced ? placed : Affine{}).scene);
        for (const Vec3 p : {Vec3{1, 0, 3}, Vec3{-1, 0, 2}, Vec3{0, 1, 2.2f}, Vec3{400, 0, 300}}) {
            const Vec3d to = Vec3d{1, 2, 3} - Vec3d(p);
            const double d = length(to), cosine = to.y / d;
            if (cosine * d < 0.8) continue;  // below the horizon in part
            const double expected = std::numbers::pi * 0.64 / (d * d) * cosine;
            EXPECT_NEAR(irradiance(world.shading, test::receiver(p, {0, 1, 0}), 128) / expected, 1, 1e-5);
        }
        // From inside, where only a light with two sides shines: π on every side.
        Scene both = world.shading.scene;
        std::get<AreaLight>(both.lights[0]).two_sided = true;
        const World hollow(std::move(both));
        const SurfacePoint inside = test::receiver({1.2f, 2.3f, 2.9f}, {0, 1, 0});
        EXPECT_EQ(irradiance(world.shading, inside, 8), 0);
        // The square root in the warp spoils the midpoint rule, so here the seeds themselves say how far off the mean
        // may be. With 15 degrees of freedom six standard errors are exceeded once in 40 000 times.
        const Estimate e = irradiance_by_seeds(hollow.shading, inside);
        EXPECT_LT(e.standard_error, 2.5e-4 * std::numbers::pi);
        EXPECT_NEAR(e.mean, std::numbers::pi, 6 * e.standard_error);
    }
}

TEST(Irradiance, EllipsoidsByTheirOutline) {
    const Affine placed = translation(0.3, 3, -0.2) * rotation_degrees(50, {1, 1, 0}) * scaling(1.5, 0.6, 0.9);
    const World world(test::area_light("", Sphere{{}, 0.5f}, placed).scene);
    const SurfacePoint from = test::receiver({0.5f, 0, 1}, {0, 1, 0});
    // The outline is where the polar plane of the receiving point cuts the sphere, in the object's space.
    const Vec3d o = transform_point(*inverse(placed), from.p);
    const double r = 0.5, d = length(o);
    const Frame frame = Frame::from_z(static_cast<Vec3>(normalize(o)));
    std::vector<Vec3d> outline;
    for (int i = 0; i < 20000; ++i) {
        const double phi = 2 * std::numbers::pi * i / 20000, circle = r * std::sqrt(1 - r * r / (d * d));
        const Vec3d q = o * (r * r / (d * d)) + Vec3d(frame.x) * (circle * std::cos(phi)) +
                        Vec3d(frame.y) * (circle * std::sin(phi));
        outline.push_back(transform_point(placed, q));
    }
    const double expected = polygon_irradiance(outline, from.p, Vec3d(from.ns));
    EXPECT_NEAR(irradiance(world.shading, from, 1024) / expected, 1, 2e-4);  // the rim cuts through the grid
}

TEST(Irradiance, DeltaLights) {
    Scene scene;
    scene.lights = {PointLight{{0, 2, 1}, {8, 4, 2}}, SpotLight{{0, 2, 0}, {0, -3, 0}, {8, 8, 8}, 20, 40},
                    DirectionalLight{{0, -2, 0}, {3, 2, 1}},
                    SpotLight{{0, 2, 0}, {0, -3, 0}, {8, 8, 8}, 20, 40, SpotFalloff::squared}};
    const World world(std::move(scene));
    const SurfacePoint from = test::receiver({}, {0, 1, 0});
    const auto point = sample_light(world.shading, 0, from, 0, {});
    ASSERT_TRUE(point);
    EXPECT_EQ(point->pdf, 0);
    EXPECT_FLOAT_EQ(point->radiance.r, 8.0f / 5);
    EXPECT_FLOAT_EQ(point->radiance.b, 2.0f / 5);
    EXPECT_FLOAT_EQ(point->wi.y, 2 / std::sqrt(5.0f));
    EXPECT_EQ(pdf_light(world.shading, 0, from, point->wi, nullptr), 0);

    // On the axis, inside the inner cone, halfway in the cosine (smoothstep gives 1/2), and outside.
    const double ci = std::cos(20 * std::numbers::pi / 180), co = std::cos(40 * std::numbers::pi / 180);
    const auto spot_at = [&](double cosine, uint32_t light = 1) {
        const double x = 2 * std::sqrt(1 / (cosine * cosine) - 1);
        const auto s =
            sample_light(world.shading, light, test::receiver({static_cast<float>(x), 0, 0}, {0, 1, 0}), 0, {});
        return s ? s->radiance.g * (4 + x * x) : 0;
    };
    EXPECT_NEAR(spot_at(1), 8, 1e-5);
    EXPECT_NEAR(spot_at(ci + 1e-3), 8, 1e-5);
    EXPECT_NEAR(spot_at((ci + co) / 2), 4, 1e-5);
    EXPECT_NEAR(spot_at(co + (ci - co) / 4), 8 * (3.0 / 16 - 2.0 / 64), 1e-5);
    EXPECT_EQ(spot_at(co - 1e-3), 0);
    EXPECT_NEAR(spot_at(co + (ci - co) / 4, 3), 8.0 / 16, 1e-5);
    EXPECT_NEAR(spot_at(ci + 1e-3, 3), 8, 1e-5);
    EXPECT_EQ(spot_at(co - 1e-3, 3), 0);

    const auto sun = sample_light(world.shading, 2, from, 0, {});
    ASSERT_TRUE(sun);
    EXPECT_EQ(sun->radiance, (Rgb{3, 2, 1}));
    EXPECT_EQ(sun->wi, (Vec3{0, 1, 0}));
    EXPECT_EQ(sun->shadow_ray.tmax, kInfinity);
    for (uint32_t light = 0; light < 3; ++light) EXPECT_EQ(light_sample_count(world.shading, light), 1u);
}

TEST(Irradiance, OneSideOrTwo) {
    const Rectangle up{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
    for (const bool mirrored : {false, true})
        for (const bool two_sided : {false, true}) {
            const World world(test::area_light("", up, mirrored ? scaling(-1, 1, 1) : Affine{}, two_sided).scene);
            for (const float y : {1.0f, -1.0f}) {
                const SurfacePoint from = test::receiver({0, y, 0}, {0, -y, 0});
                const bool lit = y > 0 || two_sided;
                EXPECT_EQ(irradiance(world.shading, from, 4) > 0, lit);
                const Ray ray{from.p, 0, from.ns, kInfinity};
                const Hit hit = world.accel.intersect(ray);
                ASSERT_TRUE(hit.found());
                const SurfacePoint point = surface_at(world.shading, ray, hit);
                EXPECT_EQ(is_black(emitted_radiance(world.shading, point, -ray.d)), !lit);
                EXPECT_EQ(pdf_light(world.shading, 0, from, ray.d, &point) > 0, lit);
            }
        }
}

TEST(Irradiance, NothingFromLightsWithoutAreaOrPower) {
    Mesh flat;
    flat.positions = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
    flat.indices = {0, 1, 2};
    std::vector<Scene> scenes;
    scenes.push_back(test::area_light("", Rectangle{{0, 1, 0}, {0, 0, 0}, {1, 0, 0}}, {}).scene);
    scenes.push_back(test::area_light("", Disk{{0, 1, 0}, {0, 1, 0}, 0}, {}).scene);
    scenes.push_back(test::area_light("", Sphere{{0, 1, 0}, 0}, {}).scene);
    scenes.push_back(test::area_light("", MeshId{0}, {}).scene);
    scenes.back().meshes.push_back(flat);
    scenes.push_back(test::area_light("", MeshId{0}, {}).scene);
    scenes.back().meshes.push_back({});
    scenes.push_back(test::area_light("", Sphere{{0, 3, 0}, 1}, {}).scene);
    std::get<AreaLight>(scenes.back().lights[0]).radiance = {};
    for (Scene& scene : scenes) {
        Diagnostics diagnostics;
        const ShadingScene shading = std::move(make_shading_scene(std::move(scene), diagnostics)).value();
        for (const Vec3 p : {Vec3{}, Vec3{0, 1, 0}, Vec3{3, 3, 3}})
            EXPECT_FALSE(sample_light(shading, 0, test::receiver(p, {0, 1, 0}), 77, {0.3f, 0.6f}));
    }
}

}  // namespace
}  // namespace steradian
