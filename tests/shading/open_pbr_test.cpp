// What the general tests of materials do not ask of OpenPBR Surface: formulas of its parts, and random parameters.
#include <gtest/gtest.h>

#include "math/warp.h"
#include "shading/bsdf.h"
#include "shading/open_pbr_tables.h"
#include "shading/world.h"
#include "support/support.h"

namespace steradian {
namespace {

using test::Random;

/// A scene of one material; a Bsdf refers to its tables.
struct OneMaterial {
    ShadingScene scene;
    explicit OneMaterial(const OpenPbrMaterial& m) {
        Scene s;
        s.materials = {m};
        const ShapeId shape = add<ShapeId>(s.shapes, Shape{Rectangle{}});
        add<InstanceId>(s.instances, Instance{shape, MaterialId{0}, {}});
        Diagnostics diagnostics;
        scene = std::move(make_shading_scene(std::move(s), diagnostics)).value();
    }
    Bsdf bsdf() const {
        SurfacePoint point = test::receiver({}, {0, 0, 1});
        point.instance = 0;
        return make_bsdf(scene, point);
    }
};

Vec3 at_cosine(double cosine) { return static_cast<Vec3>(Vec3d{std::sqrt(1 - cosine * cosine), 0, cosine}); }

/// The mean of the weights of n samples, and its standard error: the albedo.
struct Mean {
    double value = 0, error = 0;
};
Mean mean_weight(const Bsdf& bsdf, Vec3 wo, int channel, int n, Random& random) {
    double sum = 0, squares = 0;
    for (int i = 0; i < n; ++i) {
        const float uc = random.uniform();
        const auto s = sample(bsdf, wo, uc, random.uniform2());
        const double w = s ? s->weight[channel] / s->radiance_scale : 0;
        sum += w, squares += w * w;
    }
    const double mean = sum / n;
    return {mean, std::sqrt(max_of(squares / n - mean * mean, 0.0) / n)};
}

/// Weights, colours and roughnesses at random: never more light than arrives.
TEST(OpenPbr, RandomMaterialsGainNothing) {
    Random random(61);
    const int cases = test::by_tier(12, 100), n = test::by_tier(20000, 200000);
    for (int i = 0; i < cases; ++i) {
        OpenPbrMaterial m;
        const auto some = [&](float& x) { x = static_cast<float>(random.between(0, 1)); };
        for (float* x : {&m.base_weight, &m.base_metalness.value, &m.base_diffuse_roughness, &m.specular_weight,
                         &m.specular_roughness.value, &m.specular_roughness_anisotropy, &m.subsurface_weight.value,
                         &m.fuzz_weight.value, &m.fuzz_roughness, &m.coat_weight, &m.coat_roughness,
                         &m.coat_roughness_anisotropy, &m.coat_darkening, &m.geometry_opacity.value})
            some(*x);
        if (i % 3 == 0) some(m.transmission_weight.value);
        for (Rgb* c : {&m.base_color.value, &m.specular_color, &m.subsurface_color.value, &m.fuzz_color.value,
                       &m.coat_color.value, &m.transmission_color.value})
            some(c->r), some(c->g), some(c->b);
        m.specular_ior = static_cast<float>(random.between(1.05, 2.5));
        m.coat_ior = static_cast<float>(random.between(1.05, 2));
        const OneMaterial material(m);
        const Bsdf bsdf = material.bsdf();
        for (const double cosine : {1.0, 0.5, 0.08, -0.3}) {
            const Mean mean = mean_weight(bsdf, at_cosine(cosine), i % 3, n, random);
            EXPECT_LE(mean.value, 1 + 5 * mean.error + 1e-2) << i << ", cosine " << cosine;
            EXPECT_GT(mean.value, 0);
        }
    }
}

/// Of the metal alone, smooth: Schlick towards the edge, and at 82 degrees the specular colour times that.
TEST(OpenPbr, MetalsHaveTheirColourAt82Degrees) {
    OpenPbrMaterial m;
    m.base_metalness.value = 1, m.base_color.value = {0.9f, 0.5f, 0.1f}, m.specular_color = {1, 0.6f, 0.3f};
    m.specular_roughness.value = 0;
    const OneMaterial material(m);
    Random random(62);
    const auto reflected = [&](double cosine, int channel) {
        return mean_weight(material.bsdf(), at_cosine(cosine), channel, 2000, random).value;
    };
    for (int c = 0; c < 3; ++c) {
        const double base = m.base_color.value[c], at_82 = base + (1 - base) * std::pow(6 / 7.0, 5);
        EXPECT_NEAR(reflected(1, c), base, 2e-3);
        EXPECT_NEAR(reflected(1 / 7.0, c), at_82 * m.specular_color[c], 2e-3);
    }
}

/// A smooth dielectric over black: Fresnel; specular_weight scales it at normal incidence.
TEST(OpenPbr, SpecularWeightScalesTheReflectance) {
    Random random(63);
    for (const float weight : {1.0f, 0.5f, 0.25f}) {
        OpenPbrMaterial m;
        m.base_weight = 0, m.specular_roughness.value = 0, m.specular_weight = weight;
        const OneMaterial material(m);
        EXPECT_NEAR(mean_weight(material.bsdf(), {0, 0, 1}, 0, 1000, random).value, 0.04 * weight, 1e-3);
    }
}

/// At normal incidence light passes the coat's colour once, and a grey base under it is darker by what stays inside.
TEST(OpenPbr, CoatsTintAndDarken) {
    OpenPbrMaterial m;
    m.specular_weight = 0, m.base_color.value = {0.5f, 0.5f, 0.5f};
    m.coat_weight = 1, m.coat_color.value = {1, 0.5f, 0.25f}, m.coat_darkening = 0;
    const Vec3 wo{0, 0, 1}, wi = at_cosine(0.999999);
    const auto seen = [&](const OpenPbrMaterial& material) {
        // Beside the highlight, which is narrow.
        return eval(OneMaterial(material).bsdf(), normalize(wo + Vec3{0.1f, 0, 0}), wi).f_cos;
    };
    const Rgb tinted = seen(m);
    EXPECT_NEAR(tinted.g / tinted.r, 0.5, 2e-3);
    EXPECT_NEAR(tinted.b / tinted.r, 0.25, 2e-3);
    m.coat_darkening = 1;
    const Rgb dark = seen(m);
    // K = 1 - (1 - F̄) / η²; F̄ of 1.6 is 0.1114 (Walsh's formula for the diffuse reflectance).
    const double k = 1 - (1 - 0.1114) / (1.6 * 1.6);
    EXPECT_NEAR(dark.r / tinted.r, (1 - k) / (1 - 0.5 * k), 5e-3);
}

/// What is not there lets pass as much as the opacity leaves.
TEST(OpenPbr, OpacityLetsPass) {
    OpenPbrMaterial m;
    m.geometry_opacity.value = 0.25f;
    const OneMaterial material(m);
    const Bsdf bsdf = material.bsdf();
    OpenPbrMaterial opaque;
    const OneMaterial solid(opaque);
    const Vec3 wo = at_cosine(0.7), wi = at_cosine(0.5);
    EXPECT_NEAR(eval(bsdf, wo, wi).f_cos.g, 0.25 * eval(solid.bsdf(), wo, wi).f_cos.g, 1e-7);
    Random random(64);
    int passed = 0;
    const int n = 10000;
    for (int i = 0; i < n; ++i) {
        const float uc = random.uniform();
        const auto s = sample(bsdf, wo, uc, random.uniform2());
        if (!s || !s->specular) continue;
        ++passed;
        EXPECT_EQ(s->wi, -wo);
        EXPECT_EQ(s->weight, (Rgb{1, 1, 1}));
        EXPECT_TRUE(s->transmitted);
    }
    EXPECT_NEAR(passed, 0.75 * n, 5 * std::sqrt(n * 0.75 * 0.25));
    // A cut-out is there or not: an opacity at the cutoff is, one below it is not.
    m.geometry_opacity_cutoff = 0.25f;
    EXPECT_EQ(eval(OneMaterial(m).bsdf(), wo, wi).f_cos.g, eval(solid.bsdf(), wo, wi).f_cos.g);
    m.geometry_opacity_cutoff = 0.26f;
    EXPECT_TRUE(is_specular(OneMaterial(m).bsdf()));
    m.geometry_opacity_cutoff = 0;
    m.geometry_opacity.value = 0;
    const OneMaterial nothing(m);
    EXPECT_TRUE(is_specular(nothing.bsdf()));
}

/// The table against sampling, and its limit.
TEST(OpenPbr, FuzzReflectsWhatItsTableSays) {
    Random random(65);
    for (const float roughness : {0.0f, 0.1f, 0.5f, 1.0f}) {
        const FuzzTable fuzz(roughness);
        for (const double mu : {0.9, 0.4, 0.1, 0.02}) {
            const Vec3d wo{std::sqrt(1 - mu * mu), 0, mu};
            double sum = 0, squares = 0;
            const int n = 40000;
            for (int i = 0; i < n; ++i) {
                const Vec3d wi = warp::hemisphere(random.uniform2());
                const double w = fuzz.eval(wo, wi).r / warp::kHemispherePdf;
                sum += w, squares += w * w;
            }
            const double mean = sum / n, error = std::sqrt((squares / n - mean * mean) / n);
            EXPECT_NEAR(fuzz.albedo(mu), mean, 5 * error + 2e-3) << roughness << " " << mu;
            EXPECT_LE(fuzz.albedo(mu), 1);
        }
    }
}

}  // namespace
}  // namespace steradian
