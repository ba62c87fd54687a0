// Layers of open_pbr that have frames of their own: the coat's normal, and the direction of the base's grain.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "shading/bsdf.h"
#include "shading/fresnel.h"
#include "shading/material_cases.h"
#include "shading/open_pbr_tables.h"
#include "shading/relief.h"
#include "shading/world.h"
#include "support/chi_square.h"
#include "support/support.h"

namespace steradian {
namespace {

using test::Random;

Rgb texel_of(Vec3d n) {
    return {static_cast<float>((n.x + 1) / 2), static_cast<float>((n.y + 1) / 2), static_cast<float>((n.z + 1) / 2)};
}

/// A rectangle in the plane z = 0, u along +x and -v along +y, of one material.
class Layers {
public:
    /// Normals of nothing: no map.
    Layers(OpenPbrMaterial m, std::optional<Vec3d> coat, std::optional<Vec3d> base = std::nullopt) {
        Scene scene;
        const auto map = [&](Vec3d n) {
            return NormalMap{add<TextureId>(scene.textures, Texture{ConstantTexture{texel_of(n)}})};
        };
        if (coat) m.geometry_coat_normal = map(*coat);
        add<MaterialId>(scene.materials, Material{m});
        if (base) scene.reliefs = {{MaterialId{0}, map(*base)}};
        const ShapeId shape = add<ShapeId>(scene.shapes, Shape{Rectangle{}});
        add<InstanceId>(scene.instances, Instance{shape, MaterialId{0}, {}});
        world_ = std::make_unique<test::World>(std::move(scene));
    }
    /// As seen from there.
    Bsdf bsdf(Vec3d wo) const {
        const Ray ray = test::ray_towards(Vec3d{0.1, 0.2, 0} + wo * 3, {0.1, 0.2, 0});
        const Hit hit = world_->accel.intersect(ray);
        EXPECT_TRUE(hit.found());
        return make_bsdf(world_->shading, surface_at(world_->shading, ray, hit));
    }
    const ShadingScene& shading() const { return world_->shading; }

private:
    std::unique_ptr<test::World> world_;
};

OpenPbrMaterial white_coated(float coat_roughness) {
    OpenPbrMaterial m;
    m.base_color.value = {1, 1, 1};
    m.specular_roughness.value = 0.5f;
    m.coat_weight = 1;
    m.coat_roughness.value = coat_roughness;
    return m;
}

Vec3d tilted(double degrees, double azimuth = 0.6) {
    const double t = degrees * std::numbers::pi / 180;
    return {std::sin(t) * std::cos(azimuth), std::sin(t) * std::sin(azimuth), std::cos(t)};
}

/// Every bit of what it scatters, and of where it sends samples.
void expect_same(const Bsdf& a, const Bsdf& b, Vec3 wo, Random& random) {
    for (int i = 0; i < 20; ++i) {
        const Vec3 wi = static_cast<Vec3>(random.direction());
        const BsdfEval x = eval(a, wo, wi), y = eval(b, wo, wi);
        EXPECT_EQ(x.f_cos, y.f_cos);
        EXPECT_EQ(x.pdf, y.pdf);
        EXPECT_EQ(x.diffuse, y.diffuse);
        const float uc = random.uniform();
        const Vec2 u = random.uniform2();
        const auto s = sample(a, wo, uc, u), t = sample(b, wo, uc, u);
        ASSERT_EQ(s.has_value(), t.has_value());
        if (!s) continue;
        EXPECT_EQ(s->wi, t->wi);
        EXPECT_EQ(s->weight, t->weight);
        EXPECT_EQ(s->pdf, t->pdf);
    }
}

TEST(CoatNormal, AFlatMapIsNoMap) {
    Random random(71);
    OpenPbrMaterial m = white_coated(0.3f);
    m.fuzz_weight.value = 0.4f, m.coat_roughness_anisotropy = 0.5f, m.specular_roughness_anisotropy.value = 0.4f;
    for (const std::optional<Vec3d> base : {std::optional<Vec3d>(), std::optional<Vec3d>(tilted(30))}) {
        const Layers with(m, Vec3d{0, 0, 1}, base), without(m, std::nullopt, base);
        for (int i = 0; i < 50; ++i) {
            Vec3d wo = random.direction();
            if (std::fabs(wo.z) < 0.05) continue;
            expect_same(with.bsdf(wo), without.bsdf(wo), static_cast<Vec3>(wo), random);
        }
    }
}

/// Without a coat its normal does nothing, and one that is turned like all other layers' is one frame for all.
TEST(CoatNormal, OneNormalForAllIsTheReliefAlone) {
    Random random(72);
    const Vec3d n = tilted(40);
    OpenPbrMaterial bare = white_coated(0.3f);
    bare.coat_weight = 0;
    const Layers a(bare, n), b(bare, std::nullopt);
    const Layers c(white_coated(0.3f), n, n);
    for (int i = 0; i < 50; ++i) {
        const Vec3d wo = normalize(random.direction() + Vec3d{0, 0, 1.2});
        expect_same(a.bsdf(wo), b.bsdf(wo), static_cast<Vec3>(wo), random);
        EXPECT_TRUE(c.bsdf(wo).folded);
        EXPECT_FALSE(std::get<OpenPbrBsdf>(c.bsdf(wo).lobe).coat_apart);
    }
}

/// A polished coat on black is a mirror about its own normal, which reflects Fresnel's part, and the base's map has
/// nothing to do with it.
TEST(CoatNormal, APolishedCoatIsAMirrorAboutIt) {
    OpenPbrMaterial m = white_coated(0);
    m.base_weight = 0, m.specular_weight = 0;
    Random random(73);
    for (const std::optional<Vec3d> coat :
         {std::optional<Vec3d>(), std::optional<Vec3d>(tilted(10)), std::optional<Vec3d>(tilted(25, 2))}) {
        const Layers layers(m, coat, tilted(20, 4));
        const Vec3d n = coat.value_or(Vec3d{0, 0, 1});
        for (const Vec3d wo : {Vec3d{0, 0, 1}, tilted(30, 1), tilted(40, 3)}) {
            const Bsdf bsdf = layers.bsdf(wo);
            const Vec3d expected = test::mirrored(static_cast<Vec3>(wo), static_cast<Vec3>(n));
            ASSERT_GT(expected.z, 0.05);
            double sum = 0, near = 0;
            constexpr int kSamples = 2000;
            for (int i = 0; i < kSamples; ++i) {
                const float uc = random.uniform();
                const auto s = sample(bsdf, static_cast<Vec3>(wo), uc, random.uniform2());
                if (!s || !(s->weight.r > 0)) continue;
                sum += s->weight.r;
                near += length(Vec3d(s->wi) - expected) < 0.01 ? 1 : 0;
            }
            EXPECT_NEAR(sum / kSamples, fresnel_dielectric(dot(wo, n), 1.6), 2e-3);
            EXPECT_GT(near, 0.95 * kSamples);  // the tails of the distribution are long
        }
    }
}

struct Apart {
    OpenPbrMaterial material;
    Vec3d coat;
    std::optional<Vec3d> base;
};
std::vector<Apart> apart_cases() {
    std::vector<Apart> out;
    OpenPbrMaterial m = white_coated(0.4f);
    for (const double degrees : {5.0, 40.0, 80.0}) {
        out.push_back({m, tilted(degrees), std::nullopt});
        out.push_back({m, tilted(degrees), tilted(degrees, 3)});
        out.push_back({m, {0, 0, 1}, tilted(degrees)});
    }
    m.base_metalness.value = 1, m.coat_weight = 0.6f, m.coat_roughness_anisotropy = 0.6f;
    m.fuzz_weight.value = 0.5f;
    out.push_back({m, tilted(50), tilted(30, 2)});
    return out;
}

template <class Check>
void for_all_apart(const Check& check) {
    Random random(74);
    for (const Apart& a : apart_cases()) {
        const Layers layers(a.material, a.coat, a.base);
        for (const double cosine : {0.95, 0.5, 0.15, -0.6}) {
            const double s = std::sqrt(1 - cosine * cosine), phi = random.between(0, 6.28);
            const Vec3d wo{s * std::cos(phi), s * std::sin(phi), cosine};
            const Bsdf bsdf = layers.bsdf(wo);
            ASSERT_TRUE(std::get<OpenPbrBsdf>(bsdf.lobe).coat_apart);
            check(bsdf, static_cast<Vec3>(wo), random);
        }
    }
}

/// White layers show all of a white sky, whichever way their normals lean. Five standard errors, and what the tables
/// are off.
TEST(CoatNormal, InAWhiteFurnaceNothingIsLost) {
    const int n = test::by_tier(20000, 400000);
    for_all_apart([&](const Bsdf& bsdf, Vec3 wo, Random& random) {
        double sum = 0, squares = 0;
        for (int i = 0; i < n; ++i) {
            const float uc = random.uniform();
            const auto s = sample(bsdf, wo, uc, random.uniform2());
            const double w = s ? double(s->weight.r) : 0;
            sum += w, squares += w * w;
        }
        const double mean = sum / n, error = std::sqrt((squares / n - mean * mean) / n);
        EXPECT_NEAR(mean, 1, 5 * error + 4e-3);
        EXPECT_LT(error, 0.01);
    });
}

TEST(CoatNormal, SamplesFollowTheirDensity) {
    const uint64_t n = test::by_tier<uint64_t>(4000, 200000);
    for_all_apart([&](const Bsdf& bsdf, Vec3 wo, Random& random) {
        // Half of the directions are uniform, so that no cell expects nothing.
        const auto sampled = [&](uint64_t) -> std::optional<Vec3> {
            if (random.bits() % 2 == 0) return static_cast<Vec3>(random.direction());
            return sampled_as_evaluated(bsdf, wo, random);
        };
        const auto density = [&](Vec3 wi) {
            return (static_cast<double>(eval(bsdf, wo, wi).pdf) + 1 / (4 * std::numbers::pi)) / 2;
        };
        const test::ChiSquare result = test::chi_square_directions(sampled, density, n, 6, 8);
        EXPECT_TRUE(result.passes()) << result << ", cosine " << wo.z;
    });
}

TEST(CoatNormal, NothingLeaks) {
    for_all_apart([&](const Bsdf& bsdf, Vec3 wo, Random& random) {
        EXPECT_FALSE(only_reflects(bsdf));
        for (int i = 0; i < 200; ++i) {
            const Vec3 wi = static_cast<Vec3>(random.direction());
            const float uc = random.uniform();
            const auto s = sample(bsdf, wo, uc, random.uniform2());
            if (s) {
                EXPECT_GT(s->wi.z * wo.z, 0);
                EXPECT_FALSE(s->transmitted);
            }
            if (wi.z * wo.z < 0) {
                EXPECT_EQ(eval(bsdf, wo, wi).pdf, 0);
            }
        }
    });
}

// --- Grain -----------------------------------------------------------------------------------------------------

TEST(Grain, ShapesOfRoughness) {
    const Vec2 open = open_pbr_alpha(0.5f, 0.75f);
    EXPECT_NEAR(open.x, 0.25 * std::sqrt(2 / (1 + 1.0 / 16)), 1e-6);
    EXPECT_NEAR(open.y, open.x / 4, 1e-7);
    const Vec2 gltf = open_pbr_alpha(0.5f, 0.8f, GrainShape::gltf);
    EXPECT_NEAR(gltf.x, 0.25 + 0.75 * 0.64, 1e-6);
    EXPECT_NEAR(gltf.y, 0.25, 1e-7);
}

OpenPbrMaterial brushed(float anisotropy) {
    OpenPbrMaterial m;
    m.base_color.value = {1, 1, 1};
    m.base_metalness.value = 1;
    m.specular_roughness.value = 0.4f;
    m.specular_roughness_anisotropy.value = anisotropy;
    return m;
}

/// With the grain turned by an angle the surface scatters as it did from directions that are turned back.
TEST(Grain, IsTurnedCounterClockwise) {
    Random random(75);
    OpenPbrMaterial turned = brushed(0.8f);
    turned.geometry_tangent.rotation = 40;
    const Layers plain(brushed(0.8f), std::nullopt), other(turned, std::nullopt);
    const double c = std::cos(40 * std::numbers::pi / 180), s = std::sin(40 * std::numbers::pi / 180);
    const auto back = [&](Vec3d w) { return Vec3d{c * w.x + s * w.y, c * w.y - s * w.x, w.z}; };
    for (int i = 0; i < 100; ++i) {
        const Vec3d wo = normalize(random.direction() + Vec3d{0, 0, 1.1}),
                    wi = normalize(random.direction() + Vec3d{0, 0, 1.1});
        const Vec3 o = static_cast<Vec3>(wo), i2 = static_cast<Vec3>(wi);
        const float value = eval(other.bsdf(wo), o, i2).f_cos.r;
        const Vec3d wo_back = back(wo), wi_back = back(wi);
        const float expected =
            eval(plain.bsdf(wo_back), static_cast<Vec3>(wo_back), static_cast<Vec3>(wi_back)).f_cos.r;
        EXPECT_NEAR(value, expected, 1e-3f * expected + 1e-5f);
    }
}

/// A texture's direction and the angle add up, and where coordinates are mirrored, up in the image stays up.
TEST(Grain, DirectionsOfTextures) {
    const auto along = [&](double x, double y, float rotation, bool mirrored) {
        Scene scene;
        const auto number = [](double t) { return static_cast<float>((t + 1) / 2); };
        add<TextureId>(scene.textures, Texture{ConstantTexture{{number(x), number(y), 0}}});
        add<MaterialId>(scene.materials, Material{OpenPbrMaterial{}});
        // u along -x on the mirrored one.
        Mesh mesh{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}}, {}, {{0, 1}, {1, 1}, {1, 0}}, {0, 1, 2}};
        if (mirrored)
            for (Vec2& uv : mesh.uvs) uv.x = 1 - uv.x;
        const MeshId id = add<MeshId>(scene.meshes, std::move(mesh));
        const ShapeId shape = add<ShapeId>(scene.shapes, Shape{id});
        add<InstanceId>(scene.instances, Instance{shape, MaterialId{0}, {}});
        const test::World world(std::move(scene));
        const Ray ray = test::ray_towards({0.3, -0.3, 2}, {0.3, -0.3, 0});
        const SurfacePoint point = surface_at(world.shading, ray, world.accel.intersect(ray));
        return Vec3d(grain_at(world.shading, point, {rotation, TextureId{0}}));
    };
    const auto near = [](Vec3d a, Vec3d b) { EXPECT_LT(length(a - normalize(b)), 1e-6); };
    near(along(1, 0, 0, false), {1, 0, 0});
    near(along(0.3, 0.4, 0, false), {3, 4, 0});
    near(along(0.3, 0.4, 90, false), {-4, 3, 0});
    near(along(0.3, 0.4, 0, true), {-3, 4, 0});
    near(along(0.3, 0.4, 90, true), {4, 3, 0});
    near(along(0, 0, 30, false), {std::sqrt(3.0), 1, 0});
}

/// The coat keeps the direction of u when the base's grain is turned.
TEST(Grain, OfTheBaseIsNotThatOfTheCoat) {
    Random random(76);
    OpenPbrMaterial m = white_coated(0.4f);
    m.base_weight = 0, m.specular_weight = 0, m.coat_roughness_anisotropy = 0.8f;
    m.specular_roughness_anisotropy.value = 0.7f;
    OpenPbrMaterial turned = m;
    turned.geometry_tangent.rotation = 70;
    const Layers plain(m, std::nullopt), other(turned, std::nullopt);
    for (int i = 0; i < 50; ++i) {
        const Vec3d wo = normalize(random.direction() + Vec3d{0, 0, 1.1}),
                    wi = normalize(random.direction() + Vec3d{0, 0, 1.1});
        const float a = eval(plain.bsdf(wo), Vec3(wo), Vec3(wi)).f_cos.r,
                    b = eval(other.bsdf(wo), Vec3(wo), Vec3(wi)).f_cos.r;
        EXPECT_NEAR(a, b, 1e-5f * a + 1e-9f);
        EXPECT_TRUE(std::get<OpenPbrBsdf>(other.bsdf(wo).lobe).coat_apart);
    }
}

/// Tables over every grain against those of one: within what long grains are off anyway, low above the surface twice
/// as much.
TEST(Grain, TablesOverEveryGrain) {
    const auto every = MicrofacetEnergy::reflecting(TabulatedRoughness::every_grain());
    const auto every_coating = MicrofacetEnergy::coating(TabulatedRoughness::every_grain(), 1.5);
    for (const Vec2 alpha : {Vec2{0.3f, 0.3f}, Vec2{0.6f, 0.1f}, Vec2{1, 0.25f}, Vec2{1, 0.9f}, Vec2{0.2f, 0.15f}}) {
        Roughness one;
        one.value = alpha, one.squared = false;
        const auto exact = MicrofacetEnergy::reflecting(one), exact_coating = MicrofacetEnergy::coating(one, 1.5);
        const Microfacets m{alpha.x, alpha.y, std::sqrt(alpha.x), alpha.y / alpha.x};
        const Microfacets own{alpha.x, alpha.y};
        EXPECT_NEAR(every->mean_loss(m), exact->mean_loss(own), 3e-3);
        EXPECT_NEAR(every_coating->mean_loss(m), exact_coating->mean_loss(own), 3e-3);
        for (double mu = 0.1; mu < 1; mu += 0.15)
            for (double phi = 0.1; phi < 1.6; phi += 0.3) {
                const double s = std::sqrt(1 - mu * mu);
                const Vec3d w{s * std::cos(phi), s * std::sin(phi), mu};
                const double bound = mu < 0.2 ? 2e-2 : 1e-2;
                EXPECT_NEAR(every->loss(m, w), exact->loss(own, w), bound) << alpha.x << " " << alpha.y << " " << mu;
                EXPECT_NEAR(every_coating->loss(m, w), exact_coating->loss(own, w), bound)
                    << alpha.x << " " << alpha.y << " " << mu;
            }
    }
}

/// What a polished coating lets pass is what Fresnel's formula leaves, at every angle; and so where a texture makes it
/// so.
TEST(Coating, OfPolishedSurfaces) {
    Roughness textured;
    textured.value = {1, 1}, textured.texture = TextureId{};
    const auto levels = MicrofacetEnergy::coating(textured, 1.5);
    for (const float alpha : {1e-4f, 1e-3f, 4e-3f}) {
        Roughness one;
        one.value = {alpha, alpha}, one.squared = false;
        const auto table = MicrofacetEnergy::coating(one, 1.5);
        for (const double degrees : {0.0, 20.0, 40.0, 55.0, 70.0, 80.0}) {
            const double mu = std::cos(degrees * std::numbers::pi / 180);
            const Vec3d w{std::sqrt(1 - mu * mu), 0, mu};
            const double passed = 1 - fresnel_dielectric(mu, 1.5);
            EXPECT_NEAR(table->loss({alpha, alpha}, w), passed, 1e-3) << alpha << " " << degrees;
            EXPECT_NEAR(levels->loss({alpha, alpha, std::sqrt(alpha)}, w), passed, 3e-3) << alpha << " " << degrees;
        }
    }
}

}  // namespace
}  // namespace steradian
