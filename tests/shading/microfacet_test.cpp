// What the lobes of metals and rough glass stand on: Fresnel's equations, the tables of what is lost between
// microfacets, the limit of small roughness, and the direction of a grain.
#include <gtest/gtest.h>

#include <complex>

#include "shading/fresnel.h"
#include "shading/material_cases.h"
#include "shading/world.h"

namespace steradian {
namespace {

using test::Random;

Roughness with_alpha(float x, float y) { return {{x, y}, false, std::nullopt}; }

/// Against complex arithmetic, and against the dielectric where nothing is absorbed.
TEST(Fresnel, ConductorsReflectAsComplexNumbersSay) {
    Random random(51);
    for (int i = 0; i < 2000; ++i) {
        const double n = random.between(0.05, 4), k = random.between(0, 6), c = random.between(0, 1);
        const std::complex<double> index(n, k), t = std::sqrt(1.0 - (1 - c * c) / (index * index));
        const double s = std::norm((c - index * t) / (c + index * t)), p = std::norm((index * c - t) / (index * c + t));
        EXPECT_NEAR(fresnel_conductor(c, n, k), (s + p) / 2, 1e-10) << n << " " << k << " " << c;
        EXPECT_NEAR(fresnel_conductor(c, n, 0), fresnel_dielectric(c, n), 1e-7) << n << " " << c;
    }
    EXPECT_EQ(fresnel_conductor(0, 1, 0), 1);
}

TEST(Fresnel, MeansAreThoseOfTheFunctions) {
    const Rgb normal{0.9f, 0.5f, 0.04f}, grazing{1, 0.8f, 1};
    const ComplexIndex gold = *metal_index("gold");
    double schlick = 0, conductor = 0;
    const int n = 100000;
    for (int i = 0; i < n; ++i) {
        const double mu = (i + 0.5) / n;
        schlick += 2 * mu * fresnel_schlick(mu, normal, grazing).g / n;
        conductor += 2 * mu * fresnel_conductor(mu, gold).b / n;
    }
    EXPECT_NEAR(mean_fresnel_schlick(normal, grazing).g, schlick, 1e-6);
    EXPECT_NEAR(mean_fresnel_conductor(gold).b, conductor, 1e-5);
}

/// The colours at normal incidence that everybody knows.
TEST(Fresnel, MetalsHaveTheirColours) {
    const auto color = [](const char* name) { return fresnel_conductor(1, *metal_index(name)); };
    EXPECT_GT(color("gold").r, 0.99f);
    EXPECT_NEAR(color("gold").b, 0.36f, 0.02f);
    EXPECT_NEAR(color("copper").g, 0.62f, 0.02f);
    EXPECT_GT(color("silver").b, 0.96f);
    EXPECT_NEAR(color("aluminium").g, 0.916f, 0.01f);
    EXPECT_NEAR(color("iron").g, 0.51f, 0.02f);
    EXPECT_FALSE(metal_index("unobtainium"));
}

/// For α = 1, D = 1/π and the albedo is ∫ μ / (μ_o + μ) dμ = 1 - μ_o log((1 + μ_o) / μ_o).
TEST(MicrofacetEnergy, HasAClosedFormWhereAlphaIsOne) {
    const auto energy = MicrofacetEnergy::reflecting(with_alpha(1, 1));
    const Microfacets m = microfacets(with_alpha(1, 1), 1);
    double mean = 0;
    for (int i = 0; i < 1000; ++i) {
        const double mu = (i + 0.5) / 1000, lost = mu * std::log((1 + mu) / mu);
        EXPECT_NEAR(energy->loss(m, {std::sqrt(1 - mu * mu), 0, mu}), lost, 2e-4) << mu;
        mean += 2 * mu * lost / 1000;
    }
    EXPECT_NEAR(energy->mean_loss(m), mean, 1e-4);
}

/// By sampling: what visible normals reflect weighs G2 / G1.
TEST(MicrofacetEnergy, AgreesWithSampling) {
    Random random(52);
    for (const Vec2 alpha :
         {Vec2{0.01f, 0.01f}, Vec2{0.2f, 0.2f}, Vec2{0.6f, 0.6f}, Vec2{0.1f, 0.8f}, Vec2{0.9f, 0.05f}}) {
        const auto energy = MicrofacetEnergy::reflecting(with_alpha(alpha.x, alpha.y));
        const Microfacets m = microfacets(with_alpha(alpha.x, alpha.y), 1);
        const Ggx ggx = m.ggx();
        for (const double cosine : {0.95, 0.5, 0.15}) {
            const double phi = random.between(0, 6), sine = std::sqrt(1 - cosine * cosine);
            const Vec3d o{sine * std::cos(phi), sine * std::sin(phi), cosine};
            double sum = 0, squares = 0;
            const int n = 40000;
            for (int i = 0; i < n; ++i) {
                const Vec3d h = ggx.sample_visible(o, random.uniform2()), wi = h * (2 * dot(o, h)) - o;
                const double w = wi.z > 0 ? ggx.masking_over_cosine(o, wi) / ggx.visible_over_projected(o) : 0;
                sum += w, squares += w * w;
            }
            const double mean = sum / n, error = std::sqrt((squares / n - mean * mean) / n);
            EXPECT_NEAR(1 - energy->loss(m, o), mean, 5 * error + 2e-4) << alpha.x << " " << alpha.y << " " << cosine;
        }
    }
}

/// As the roughness goes to 0, light leaves where a mirror sends it, as much as it reflects.
TEST(MicrofacetEnergy, TheLimitIsAMirror) {
    Random random(53);
    Scene scene;
    const ComplexIndex copper = *metal_index("copper");
    scene.materials = {ConductorMaterial{copper, with_alpha(0, 0)}, ConductorMaterial{copper, with_alpha(1e-4f, 1e-4f)},
                       GlassMaterial{1.5f, {1, 1, 1}, {1, 1, 1}, with_alpha(1e-4f, 1e-4f)}};
    const ShapeId shape = add<ShapeId>(scene.shapes, Shape{Rectangle{}});
    for (uint32_t i = 0; i < 3; ++i) add<InstanceId>(scene.instances, Instance{shape, MaterialId(i), {}});
    Diagnostics diagnostics;
    const ShadingScene shading = std::move(make_shading_scene(std::move(scene), diagnostics)).value();
    const Vec3 wo = normalize(Vec3{0.5f, 0.2f, 0.6f});
    SurfacePoint point = test::receiver({}, {0, 0, 1});
    point.instance = 0;
    const Bsdf smooth = make_bsdf(shading, point);
    ASSERT_TRUE(is_specular(smooth));
    const auto mirror = sample(smooth, wo, 0.5f, {});
    ASSERT_TRUE(mirror);
    EXPECT_NEAR(mirror->weight.g, fresnel_conductor(wo.z, copper).g, 1e-6);
    point.instance = 1;
    const Bsdf rough = make_bsdf(shading, point);
    point.instance = 2;
    const Bsdf frosted = make_bsdf(shading, point);
    int near_mirror = 0, reflected = 0;
    const int n = 4000;
    for (int i = 0; i < n; ++i) {
        const float uc = random.uniform();
        const Vec2 u = random.uniform2();
        const auto s = sample(rough, wo, uc, u);
        ASSERT_TRUE(s);
        near_mirror += length(s->wi - mirror->wi) < 0.01f ? 1 : 0;
        EXPECT_NEAR(s->weight.g, mirror->weight.g, 2e-3);
        const auto g = sample(frosted, wo, uc, u);
        ASSERT_TRUE(g);
        reflected += g->transmitted ? 0 : 1;
        EXPECT_NEAR(g->weight.r, g->transmitted ? 1 / 2.25 : 1, 2e-3);
    }
    EXPECT_GT(near_mirror, n * 0.99);
    const double r = fresnel_dielectric(static_cast<double>(wo.z), 1.5);
    EXPECT_NEAR(reflected, n * r, 5 * std::sqrt(n * r));
}

/// The grain follows u: against the difference of two points whose u differs.
TEST(Tangents, FollowU) {
    const auto check = [](Shape shape, const Affine& placed, Vec3 a, Vec3 b) {
        Scene scene;
        test::add_shape(scene, std::move(shape), placed);
        const test::World world(std::move(scene));
        Vec2 uv[2];
        Vec3 p[2], tangent;
        for (int i = 0; i < 2; ++i) {
            const Ray ray = test::ray_towards({0.3, 0.4, 9}, Vec3d(i ? b : a));
            const Hit hit = world.accel.intersect(ray);
            ASSERT_TRUE(hit.found());
            const SurfacePoint point = surface_at(world.shading, ray, hit);
            uv[i] = point.uv, p[i] = point.p;
            if (i == 0) tangent = tangent_at(world.shading, point);
            EXPECT_NEAR(length(tangent), 1, 1e-6);
            EXPECT_NEAR(dot(tangent, point.ng), 0, i == 0 ? 1e-5 : 1);
        }
        EXPECT_GT(dot(tangent, p[1] - p[0]) * (uv[1].x - uv[0].x), 0);
    };
    const Affine placed = rotation_degrees(25, {0.3, 1, 0.2}) * scaling(1.5, 0.7, -1.2);
    for (const Affine& transform : {Affine{}, placed}) {
        check(Sphere{{0, 0, 0}, 1}, transform, {0.1f, 0.1f, 0}, {0.101f, 0.1f, 0});
        check(Rectangle{{0, 0, 0}, {1, 0.2f, 0}, {0, 1, 0}}, transform, {0.1f, 0.1f, 0}, {0.2f, 0.12f, 0});
        check(Disk{{0, 0, 0}, {0, 0.1f, 1}, 1}, transform, {0.1f, 0.1f, 0}, {0.2f, 0.1f, 0});
    }
    // A mesh whose u runs along -y.
    Scene scene;
    test::add_mesh(scene, Mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {{0, 0}, {0, 1}, {-1, 0}}, {0, 1, 2}});
    const test::World world(std::move(scene));
    SurfacePoint point = test::receiver({0.2f, 0.2f, 0}, {0, 0, 1});
    point.instance = point.prim = 0;
    EXPECT_NEAR(length(tangent_at(world.shading, point) - Vec3{0, -1, 0}), 0, 1e-6);
}

}  // namespace
}  // namespace steradian
