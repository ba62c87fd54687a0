// What the general tests of materials do not ask of OpenPBR Surface: formulas of its parts, and random parameters.
#include <gtest/gtest.h>

#include "math/warp.h"
#include "shading/bsdf.h"
#include "shading/opacity.h"
#include "shading/open_pbr_tables.h"
#include "shading/world.h"
#include "support/support.h"

namespace steradian {
namespace {

using test::Random;

/// A scene of one surface; a Bsdf refers to its tables.
struct OneMaterial {
    ShadingScene scene;
    explicit OneMaterial(const OpenPbrMaterial& m) : OneMaterial(std::vector<Material>{m}) {}
    /// The last one is what is seen.
    explicit OneMaterial(std::vector<Material> materials) {
        Scene s;
        s.materials = std::move(materials);
        const ShapeId shape = add<ShapeId>(s.shapes, Shape{Rectangle{}});
        add<InstanceId>(s.instances, Instance{shape, MaterialId(static_cast<uint32_t>(s.materials.size() - 1)), {}});
        Diagnostics diagnostics;
        scene = std::move(make_shading_scene(std::move(s), diagnostics)).value();
    }
    SurfacePoint point() const {
        SurfacePoint out = test::receiver({}, {0, 0, 1});
        out.instance = 0;
        return out;
    }
    Bsdf bsdf() const { return make_bsdf(scene, point()); }
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
                         &m.specular_roughness.value, &m.specular_roughness_anisotropy.value,
                         &m.subsurface_weight.value, &m.fuzz_weight.value, &m.fuzz_roughness.value, &m.coat_weight,
                         &m.coat_roughness.value, &m.coat_roughness_anisotropy, &m.coat_darkening})
            some(*x);
        if (i % 3 == 0) some(m.transmission_weight.value);
        m.geometry_thin_walled = i % 6 == 0;
        if (i % 4 == 0) some(m.thin_film_weight.value), some(m.thin_film_thickness.maximum);
        for (Rgb* c : {&m.base_color.value, &m.specular_color.value, &m.subsurface_color.value, &m.fuzz_color.value,
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
    m.base_metalness.value = 1, m.base_color.value = {0.9f, 0.5f, 0.1f}, m.specular_color.value = {1, 0.6f, 0.3f};
    m.specular_roughness.value = 0;
    const OneMaterial material(m);
    Random random(62);
    const auto reflected = [&](double cosine, int channel) {
        return mean_weight(material.bsdf(), at_cosine(cosine), channel, 2000, random).value;
    };
    for (int c = 0; c < 3; ++c) {
        const double base = m.base_color.value[c], at_82 = base + (1 - base) * std::pow(6 / 7.0, 5);
        EXPECT_NEAR(reflected(1, c), base, 2e-3);
        EXPECT_NEAR(reflected(1 / 7.0, c), at_82 * m.specular_color.value[c], 2e-3);
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

/// Of the material, of a cut-out (an opacity at the cutoff is there, one below it is not) and of mixes; what has not
/// let pass scatters as if nothing ever did.
TEST(OpenPbr, OpacitySaysHowMuchIsThere) {
    OpenPbrMaterial m;
    const OneMaterial solid(m);
    EXPECT_FALSE(solid.scene.has_cut_outs);
    EXPECT_EQ(opacity_at(solid.scene, solid.point()), 1);
    m.geometry_opacity.value = 0.25f;
    const OneMaterial quarter(m);
    EXPECT_TRUE(quarter.scene.has_cut_outs);
    EXPECT_EQ(opacity_at(quarter.scene, quarter.point()), 0.25f);
    const Vec3 wo = at_cosine(0.7), wi = at_cosine(0.5);
    EXPECT_EQ(eval(quarter.bsdf(), wo, wi).f_cos, eval(solid.bsdf(), wo, wi).f_cos);
    m.geometry_opacity_cutoff = 0.25f;
    EXPECT_FALSE(OneMaterial(m).scene.has_cut_outs);
    m.geometry_opacity_cutoff = 0.26f;
    const OneMaterial nothing(m);
    EXPECT_TRUE(nothing.scene.has_cut_outs);
    EXPECT_EQ(opacity_at(nothing.scene, nothing.point()), 0);
}

/// A mix of a quarter that is half there and the rest, which is all there: half a quarter lets pass, and what does not
/// is 1/7 of the first material.
TEST(OpenPbr, OpacityOfMixesGoesByTheirShares) {
    OpenPbrMaterial half, whole;
    half.geometry_opacity.value = 0.5f;
    half.base_color.value = {1, 0, 0}, whole.base_color.value = {0, 1, 0};
    half.specular_weight = whole.specular_weight = 0;
    const OneMaterial mix({whole, half, MixMaterial{MaterialId{0}, MaterialId{1}, {0.25f}}});
    EXPECT_NEAR(opacity_at(mix.scene, mix.point()), 0.875, 1e-6);
    const Rgb f = eval(mix.bsdf(), at_cosine(0.7), at_cosine(0.5)).f_cos;
    EXPECT_NEAR(f.r / f.g, (1 / 7.0) / (6 / 7.0), 1e-5);
    EXPECT_NEAR(f.g, 6 / 7.0 * 0.5 / std::numbers::pi, 1e-4);
}

/// A smooth pane: both surfaces together, and light goes straight on through them.
TEST(OpenPbr, ThinWallsAreSheetsOfGlass) {
    OpenPbrMaterial m;
    m.geometry_thin_walled = true, m.transmission_weight.value = 1, m.specular_roughness.value = 0;
    m.transmission_color.value = {1, 0.5f, 0.25f};
    const OneMaterial material(m);
    Random random(66);
    const double r = 0.04, t[] = {1, 0.5, 0.25};
    for (const double side : {1.0, -1.0})
        for (int c = 0; c < 3; ++c) {
            double reflected = 0, passed = 0;
            int beside = 0;  // the distribution has long tails
            const int n = 20000;
            for (int i = 0; i < n; ++i) {
                const float uc = random.uniform();
                const auto s = sample(material.bsdf(), {0, 0, static_cast<float>(side)}, uc, random.uniform2());
                if (!s) continue;
                beside += std::fabs(s->wi.z) < 0.999;
                EXPECT_EQ(s->radiance_scale, 1);
                (s->transmitted ? passed : reflected) += s->weight[c] / n;
            }
            EXPECT_LT(beside, 20);
            const double series = (1 - r) * (1 - r) / (1 - r * r * t[c] * t[c]);
            const double through = series * t[c], back = r + series * r * t[c] * t[c];
            // The choice between the two is binomial: four standard deviations, and the tails.
            const double p = 2 * r / (1 + r), deviation = std::sqrt(p * (1 - p) / n);
            EXPECT_NEAR(passed, through, 4 * deviation * through / (1 - p) + 1e-3);
            EXPECT_NEAR(reflected, back, 4 * deviation * back / p + 1e-3);
        }
}

/// Of what the sheet scatters, (1 - g) / 2 goes back and (1 + g) / 2 through.
TEST(OpenPbr, ThinWallsScatterToBothSides) {
    OpenPbrMaterial m;
    m.geometry_thin_walled = true, m.specular_weight = 0, m.subsurface_weight.value = 1;
    m.subsurface_color.value = {0.8f, 0.4f, 0.2f}, m.subsurface_scatter_anisotropy = 0.5f;
    const OneMaterial material(m);
    EXPECT_FALSE(only_reflects(material.bsdf()));  // lights behind the sheet count
    const Vec3 wo = at_cosine(0.7), up = at_cosine(0.5), down{up.x, up.y, -up.z};
    for (int c = 0; c < 3; ++c) {
        const double lambert = m.subsurface_color.value[c] * 0.5 / std::numbers::pi;
        EXPECT_NEAR(eval(material.bsdf(), wo, up).f_cos[c], 0.25 * lambert, 1e-4);
        EXPECT_NEAR(eval(material.bsdf(), wo, down).f_cos[c], 0.75 * lambert, 1e-4);
    }
}

/// A film without a thickness is none; one with a thickness colours what is reflected as its table says.
TEST(OpenPbr, FilmsColourTheReflection) {
    Random random(67);
    for (const bool metal : {false, true})
        for (const float thickness : {0.0f, 0.35f}) {
            OpenPbrMaterial m;
            m.specular_roughness.value = 0, m.base_metalness.value = metal ? 1.0f : 0.0f;
            m.base_weight = metal ? 1.0f : 0.0f;
            const OneMaterial bare(m);
            m.thin_film_weight.value = 1, m.thin_film_thickness.maximum = thickness;
            const OneMaterial filmed(m);
            const double mu = 0.8;
            const Rgb base = m.base_color.value;
            const FilmThicknesses one(1.4, thickness, thickness);
            const Rgb table = metal ? FilmOnMetal(1, 1.4, one, {1, 1, 1}).reflectance(mu, base)
                                    : FilmOnDielectric({1, 1.4, 1.5, 0}, one, false).reflectance(mu);
            for (int c = 0; c < 3; ++c) {
                const double seen = mean_weight(filmed.bsdf(), at_cosine(mu), c, 4000, random).value;
                EXPECT_NEAR(seen, table[c], 4e-3);
                if (thickness > 0) continue;
                EXPECT_NEAR(seen, mean_weight(bare.bsdf(), at_cosine(mu), c, 4000, random).value, 2e-2);
            }
        }
}

/// Materials that are equally rough share what takes time to make.
TEST(OpenPbr, EqualRoughnessesShareTheirTables) {
    OpenPbrMaterial a, b;
    a.coat_weight = b.coat_weight = 0.5f, a.fuzz_weight.value = b.fuzz_weight.value = 0.5f;
    a.transmission_weight.value = b.transmission_weight.value = 0.5f;
    a.thin_film_weight.value = b.thin_film_weight.value = 1;
    b.base_color.value = {1, 0, 0};
    OpenPbrMaterial c = b, d = b;
    c.specular_roughness.value = 0.7f;
    d.thin_film_thickness.maximum = 0.1f;
    const OneMaterial scene({a, b, c, d});
    const auto tables = [&](size_t i) { return *scene.scene.materials[i].open_pbr; };
    EXPECT_EQ(tables(0).metal, tables(1).metal);
    EXPECT_EQ(tables(0).dielectric, tables(1).dielectric);
    EXPECT_EQ(tables(0).glass, tables(1).glass);
    EXPECT_EQ(tables(0).coat, tables(2).coat);
    EXPECT_EQ(tables(0).fuzz, tables(2).fuzz);
    EXPECT_NE(tables(0).metal, tables(2).metal);
    EXPECT_NE(tables(0).glass, tables(2).glass);
    EXPECT_EQ(tables(0).film.dielectric, tables(1).film.dielectric);
    EXPECT_EQ(tables(0).film.energy, tables(1).film.energy);
    EXPECT_EQ(tables(0).film.glass, tables(1).film.glass);
    EXPECT_NE(tables(0).film.energy, tables(2).film.energy);
    EXPECT_NE(tables(0).film.dielectric, tables(3).film.dielectric);
}

/// The table against sampling, and its limit.
TEST(OpenPbr, FuzzReflectsWhatItsTableSays) {
    Random random(65);
    // The last ones by a table over all roughnesses, between two of its own.
    for (const auto& [roughness, textured] :
         {std::pair(0.0f, false), {0.1f, false}, {0.5f, false}, {1.0f, false}, {0.16f, true}, {0.72f, true}}) {
        const FuzzTable fuzz(textured ? FloatInput{1, TextureId{}} : FloatInput{roughness});
        for (const double mu : {0.9, 0.4, 0.1, 0.02}) {
            const Vec3d wo{std::sqrt(1 - mu * mu), 0, mu};
            double sum = 0, squares = 0;
            const int n = 40000;
            for (int i = 0; i < n; ++i) {
                const Vec3d wi = warp::hemisphere(random.uniform2());
                const double w = fuzz.eval(roughness, wo, wi).r / warp::kHemispherePdf;
                sum += w, squares += w * w;
            }
            const double mean = sum / n, error = std::sqrt((squares / n - mean * mean) / n);
            EXPECT_NEAR(fuzz.albedo(roughness, mu), mean, 5 * error + (textured ? 1e-2 : 2e-3))
                << roughness << " " << mu;
            EXPECT_LE(fuzz.albedo(roughness, mu), 1);
        }
    }
}

}  // namespace
}  // namespace steradian
