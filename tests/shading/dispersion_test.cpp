// Dispersion: the index by the wavelength, the wavelengths that paths get and their colours, and glass for one of them.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "shading/bsdf.h"
#include "shading/bsdf/specular.h"
#include "shading/dispersion.h"
#include "shading/material_cases.h"
#include "shading/world.h"
#include "support/chi_square.h"
#include "support/support.h"

namespace steradian {
namespace {

using test::Random;

/// Inside over outside of the denser side.
double denser(const GlassIndex& index, double wavelength) {
    const double eta = index.at(wavelength);
    return eta < 1 ? 1 / eta : eta;
}

/// (n_d - 1) / (n_F - n_C), up to what rounding the indices to float does to their difference.
TEST(Dispersion, TheLinesGiveBackTheAbbeNumber) {
    for (const float eta : {1.1f, 1.33f, 1.5168f, 2.417f, 0.66f})
        for (const double abbe : {1.0, 9.0, 20.0, 64.17, 91.0}) {
            const GlassIndex index(eta, abbe);
            ASSERT_TRUE(index.disperses());
            EXPECT_EQ(index.at(0), eta);
            EXPECT_NEAR(index.at(kLineD), eta, 1e-7 * eta);
            const double nd = denser(index, kLineD), difference = denser(index, kLineF) - denser(index, kLineC);
            EXPECT_NEAR((nd - 1) / difference, abbe, abbe * 4e-7 * nd / difference) << eta;
        }
}

/// BK7 by Schott's data sheet: n = 1.5168, V = 64.17, and at 435.8 and 632.8 nm 1.52668 and 1.51509. Two terms come
/// near.
TEST(Dispersion, IsThatOfCrownGlass) {
    const GlassIndex index(1.5168f, 64.17);
    EXPECT_NEAR(index.at(0.4358), 1.52668, 4e-4);
    EXPECT_NEAR(index.at(0.6328), 1.51509, 2e-4);
}

TEST(Dispersion, OfNothingIsNone) {
    for (const double abbe : {0.0, std::numeric_limits<double>::infinity()}) {
        const GlassIndex index(1.5f, abbe);
        EXPECT_FALSE(index.disperses());
        for (const double wavelength : {0.0, 0.4, 0.5, 0.68}) EXPECT_EQ(index.at(wavelength), 1.5f);
    }
    EXPECT_FALSE(GlassIndex(1.0f, 20).disperses());
    EXPECT_FALSE(GlassIndex(1.002f, 20).disperses());
    EXPECT_TRUE(GlassIndex(1.004f, 20).disperses());
}

/// Blue light is bent most, and no wavelength takes a glass for a bubble.
TEST(Dispersion, IsNormalAndStaysOnOneSide) {
    for (const float eta : {0.1f, 0.9f, 1.004f, 1.5f, 10.0f}) {
        const GlassIndex index(eta, 1);
        double last = std::numeric_limits<double>::infinity();
        for (double wavelength = kShortestSample; wavelength <= kLongestSample; wavelength += 0.005) {
            const double n = denser(index, wavelength);
            EXPECT_LT(n, last);
            EXPECT_GT(n, 1.001);
            EXPECT_EQ(index.at(wavelength) < 1, eta < 1);
            last = n;
        }
    }
}

/// By the midpoint rule within the cells, whose ends are kinks.
TEST(Wavelengths, WeightsSumToWhite) {
    const WavelengthSampler sampler;
    constexpr int kSteps = 290 * 64;
    const double step = (kLongestSample - kShortestSample) / kSteps;
    Vec3d sum;
    double density = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double wavelength = kShortestSample + step * (i + 0.5);
        const Vec3d w = sampler.response(wavelength);
        EXPECT_GE(w.x, 0);
        EXPECT_GE(w.y, 0);
        EXPECT_GE(w.z, 0);
        EXPECT_GT(sampler.pdf(wavelength), 0.01);
        sum = sum + w * step;
        density += sampler.pdf(wavelength) * step;
    }
    EXPECT_NEAR(sum.x, 1, 1e-12);
    EXPECT_NEAR(sum.y, 1, 1e-12);
    EXPECT_NEAR(sum.z, 1, 1e-12);
    EXPECT_NEAR(density, 1, 1e-12);
    EXPECT_EQ(sampler.pdf(kShortestSample - 1e-3), 0);
    EXPECT_EQ(sampler.pdf(kLongestSample + 1e-3), 0);
}

/// Both by random numbers, within what their variance lets expect, and by evenly spaced ones, which the samplers'
/// stratification comes near to.
TEST(Wavelengths, SampledWeightsSumToWhite) {
    const WavelengthSampler sampler;
    Random random(71);
    constexpr int kSamples = 1 << 18;
    Vec3d sum, squares, even;
    for (int i = 0; i < kSamples; ++i) {
        const Rgb w = sampler.sample(random.bits32()).weight;
        sum = sum + Vec3d{w.r, w.g, w.b};
        squares = squares + Vec3d{w.r * w.r, w.g * w.g, w.b * w.b};
        const Rgb e = sampler.sample(static_cast<uint32_t>(i) << 14 | 1u << 13).weight;
        even = even + Vec3d{e.r, e.g, e.b};
        EXPECT_NEAR(w.r + w.g + w.b, 3, 1e-6);
    }
    for (double Vec3d::*c : {&Vec3d::x, &Vec3d::y, &Vec3d::z}) {
        const double mean = sum.*c / kSamples, variance = squares.*c / kSamples - mean * mean;
        EXPECT_NEAR(mean, 1, 4.5 * std::sqrt(variance / kSamples));
        EXPECT_LT(variance, 1.75);
        EXPECT_NEAR(even.*c / kSamples, 1, 1e-6);
    }
}

TEST(Wavelengths, FollowTheirDensity) {
    const WavelengthSampler sampler;
    Random random(72);
    constexpr int kBins = 97;  // the cells are 290: every bin cuts some
    constexpr int kSamples = 400000, kSteps = 400;
    std::vector<double> observed(kBins), expected(kBins);
    const double width = (kLongestSample - kShortestSample) / kBins;
    for (int i = 0; i < kSamples; ++i) {
        const WavelengthSample s = sampler.sample(random.bits32());
        const int bin = static_cast<int>((s.wavelength - kShortestSample) / width);
        ASSERT_TRUE(s.wavelength >= float(kShortestSample) && s.wavelength <= float(kLongestSample));
        ++observed[size_t(std::min(std::max(bin, 0), kBins - 1))];
        const Vec3d w = sampler.response(s.wavelength);
        const double p = sampler.pdf(s.wavelength);
        EXPECT_NEAR(s.weight.r, w.x / p, 1e-4);
        EXPECT_NEAR(s.weight.g, w.y / p, 1e-4);
        EXPECT_NEAR(s.weight.b, w.z / p, 1e-4);
    }
    for (int i = 0; i < kBins; ++i)
        for (int k = 0; k < kSteps; ++k)
            expected[size_t(i)] +=
                kSamples * width / kSteps * sampler.pdf(kShortestSample + (i + (k + 0.5) / kSteps) * width);
    double total = 0;
    for (const double e : expected) total += e;
    for (double& e : expected) e *= kSamples / total;
    const test::ChiSquare result = test::chi_square(observed, expected);
    EXPECT_TRUE(result.passes()) << result;
}

TEST(Wavelengths, TheEndsOfTheNumbersAreTheEndsOfTheSpectrum) {
    const WavelengthSampler sampler;
    EXPECT_NEAR(sampler.sample(0).wavelength, kShortestSample, 1e-6);
    EXPECT_NEAR(sampler.sample(0xffffffffu).wavelength, kLongestSample, 1e-6);
    float last = 0;
    for (uint64_t bits = 0; bits <= 0xffffffffu; bits += 0x10000) {
        const WavelengthSample s = sampler.sample(static_cast<uint32_t>(bits));
        EXPECT_GE(s.wavelength, last);
        EXPECT_TRUE(s.weight.r >= 0 && s.weight.g >= 0 && s.weight.b >= 0 && max_component(s.weight) <= 3.00001f);
        last = s.wavelength;
    }
}

/// Degrees on the wheel of red, yellow, green, cyan, blue and magenta.
double hue(Rgb c) {
    const double most = max_component(c), least = std::min({c.r, c.g, c.b}), range = most - least;
    if (most == c.r) return 60 * (c.g - c.b) / range + (c.g < c.b ? 360 : 0);
    return most == c.g ? 60 * (c.b - c.r) / range + 120 : 60 * (c.r - c.g) / range + 240;
}

/// Violet, blue, green, yellow, red: the hue goes one way, but for the violet end, where all is within 12 degrees.
TEST(Wavelengths, HuesAreThoseOfTheRainbow) {
    const WavelengthSampler sampler;
    const auto hue_of = [&](double wavelength) {
        const Vec3d w = sampler.response(wavelength);
        return hue({static_cast<float>(w.x), static_cast<float>(w.y), static_cast<float>(w.z)});
    };
    double last = 252;
    for (double wavelength = 0.45; wavelength < kLongestSample; wavelength += 0.001) {
        EXPECT_LE(hue_of(wavelength), last + 1e-4) << wavelength;
        last = hue_of(wavelength);
    }
    for (double wavelength = kShortestSample; wavelength < 0.45; wavelength += 0.001)
        EXPECT_TRUE(hue_of(wavelength) > 239 && hue_of(wavelength) < 252) << wavelength;
    EXPECT_NEAR(hue_of(0.47), 240, 15);
    EXPECT_NEAR(hue_of(0.49), 190, 20);
    EXPECT_NEAR(hue_of(0.54), 120, 10);
    EXPECT_NEAR(hue_of(0.575), 60, 15);
    EXPECT_NEAR(hue_of(0.65), 0, 5);
}

// --- Glass for one wavelength ----------------------------------------------------------------------------------------

/// Rectangles of these materials, and the Bsdf of each at its point.
struct GlassScene {
    ShadingScene shading;
    explicit GlassScene(std::vector<Material> materials) {
        Scene scene;
        scene.materials = std::move(materials);
        const ShapeId shape = add<ShapeId>(scene.shapes, Shape{Rectangle{}});
        for (uint32_t i = 0; i < scene.materials.size(); ++i)
            add<InstanceId>(scene.instances, Instance{shape, MaterialId(i), {}});
        Diagnostics diagnostics;
        shading = std::move(make_shading_scene(std::move(scene), diagnostics)).value();
    }
    static SurfacePoint point(uint32_t material) {
        SurfacePoint out = test::receiver({}, {0, 0, 1});
        out.instance = material;
        return out;
    }
    Bsdf bsdf(uint32_t material, double wavelength) const {
        return make_bsdf(shading, point(material), static_cast<float>(wavelength));
    }
};

GlassMaterial glass(float eta, float abbe, float roughness = 0) {
    GlassMaterial out;
    out.eta = eta, out.abbe = abbe;
    out.roughness.value = {roughness, roughness};
    return out;
}

OpenPbrMaterial layered_glass(float eta, float abbe, float scale = 1) {
    OpenPbrMaterial out;
    out.specular_ior = eta;
    out.transmission_weight.value = 1;
    out.transmission_dispersion_abbe_number = abbe, out.transmission_dispersion_scale = scale;
    return out;
}

/// What a path through smooth glass does at a wavelength is what glass of that index does, from both sides.
TEST(DispersiveGlass, IsGlassOfTheIndexOfTheWavelength) {
    for (const double wavelength : {0.4, 0.55, 0.66}) {
        const float eta = GlassIndex(1.6f, 25).at(wavelength);
        const GlassScene scene({glass(1.6f, 25), glass(eta, 0), layered_glass(1.6f, 25), layered_glass(eta, 20, 0)});
        Random random(73);
        for (int i = 0; i < 400; ++i) {
            const Vec3 wo = static_cast<Vec3>(random.direction());
            const float uc = random.uniform();
            const Vec2 u = random.uniform2();
            const auto a = sample(scene.bsdf(0, wavelength), wo, uc, u);
            const auto b = sample(scene.bsdf(1, 0), wo, uc, u);
            ASSERT_EQ(a.has_value(), b.has_value());
            if (!a) continue;
            EXPECT_EQ(a->wi, b->wi);
            EXPECT_EQ(a->weight, b->weight);
        }
    }
}

/// Snell's law at the lines, for a ray that enters a prism's face.
TEST(DispersiveGlass, RefractsByTheWavelength) {
    const GlassScene scene({glass(1.5168f, 64.17f)});
    const Vec3 wo = normalize(Vec3{0.8f, 0, 0.6f});
    for (const double line : {kLineF, kLineD, kLineC}) {
        const auto s = sample(scene.bsdf(0, line), wo, 0.999f, {});
        ASSERT_TRUE(s && s->transmitted);
        const double n = 1.5168 + 0.5168 / 64.17 * (1 / (line * line) - 1 / (kLineD * kLineD)) /
                                      (1 / (kLineF * kLineF) - 1 / (kLineC * kLineC));
        EXPECT_NEAR(s->wi.x, -wo.x / n, 2e-7);
    }
}

TEST(DispersiveGlass, KnowsWhereItDisperses) {
    const auto disperses_at = [](const GlassScene& scene, uint32_t i) {
        return disperses(scene.shading, GlassScene::point(i));
    };
    OpenPbrMaterial pane = layered_glass(1.5f, 20), matte = layered_glass(1.5f, 20);
    pane.geometry_thin_walled = true;
    matte.transmission_weight.value = 0;
    const GlassScene scene({glass(1.5f, 30), glass(1.5f, 0), layered_glass(1.5f, 20), layered_glass(1.5f, 20, 0), pane,
                            matte, MixMaterial{MaterialId{1}, MaterialId{0}, {0.5f}},
                            MixMaterial{MaterialId{1}, MaterialId{0}, {0}}, RefractionMaterial{}});
    const bool expected[] = {true, false, true, false, false, false, true, false, false};
    for (uint32_t i = 0; i < std::size(expected); ++i) EXPECT_EQ(disperses_at(scene, i), expected[i]) << i;
    EXPECT_TRUE(scene.shading.wavelengths);
    EXPECT_FALSE(GlassScene({glass(1.5f, 0), pane}).shading.wavelengths);
}

/// Transmission that a texture leaves out somewhere does not cost a wavelength there.
TEST(DispersiveGlass, ATextureDecidesForEachPoint) {
    Scene scene;
    const auto level = [&](float v) { return add<TextureId>(scene.textures, Texture{ConstantTexture{{v, v, v}}}); };
    const TextureId none = level(0), half = level(0.5f);
    for (const TextureId texture : {none, half}) {
        OpenPbrMaterial m = layered_glass(1.5f, 20);
        m.transmission_weight = {1, texture};
        const MaterialId id = add<MaterialId>(scene.materials, Material{m});
        const ShapeId shape = add<ShapeId>(scene.shapes, Shape{Rectangle{}});
        add<InstanceId>(scene.instances, Instance{shape, id, {}});
    }
    Diagnostics diagnostics;
    const ShadingScene shading = std::move(make_shading_scene(std::move(scene), diagnostics)).value();
    EXPECT_FALSE(disperses(shading, GlassScene::point(0)));
    EXPECT_TRUE(disperses(shading, GlassScene::point(1)));
}

/// Densities integrate to what is sampled at every wavelength, between the indices that have tables too.
TEST(DispersiveGlass, SamplesFollowTheDensityOfTheWavelength) {
    const GlassScene scene({glass(1.5f, 10, 0.7f), layered_glass(1.5f, 10), glass(0.7f, 15, 0.6f)});
    Random random(74);
    for (uint32_t material = 0; material < 3; ++material)
        for (const double wavelength : {0.41, 0.5, 0.63})
            for (const Vec3 wo : {normalize(Vec3{0.5f, 0.1f, 0.8f}), normalize(Vec3{0.3f, 0.4f, -0.7f})}) {
                const Bsdf bsdf = scene.bsdf(material, wavelength);
                const auto sampled = [&](uint64_t) -> std::optional<Vec3> {
                    const float uc = random.uniform();
                    const auto s = sample(bsdf, wo, uc, random.uniform2());
                    if (!s) return std::nullopt;
                    EXPECT_NEAR(s->pdf, eval(bsdf, wo, s->wi).pdf, 1e-5f * s->pdf);
                    return s->wi;
                };
                const auto density = [&](Vec3 wi) { return static_cast<double>(eval(bsdf, wo, wi).pdf); };
                const test::ChiSquare result =
                    test::chi_square_directions(sampled, density, test::by_tier<uint64_t>(20000, 400000), 8, 8);
                EXPECT_TRUE(result.passes()) << result << " " << material << " " << wavelength;
            }
}

/// The mean weight of samples, with the square of the index of where they go: what a white furnace shows. Within five
/// standard errors and what the tables are good for.
TEST(DispersiveGlass, NeitherGainsNorLosesEnergyAtAnyWavelength) {
    const float abbe = 4;  // n from 1.43 to 1.73
    const GlassScene scene({glass(1.5f, abbe, 0.3f), glass(1.5f, abbe, 1), layered_glass(1.5f, abbe)});
    Random random(75);
    for (uint32_t material = 0; material < 3; ++material)
        for (const double wavelength : {0.40, 0.43, 0.5, 0.56, 0.67})
            for (const double cosine : {0.9, 0.3, -0.5, -0.9}) {
                const Bsdf bsdf = scene.bsdf(material, wavelength);
                const double eta = GlassIndex(1.5f, static_cast<double>(abbe)).at(wavelength);
                const Vec3 wo{static_cast<float>(std::sqrt(1 - cosine * cosine)), 0, static_cast<float>(cosine)};
                const int n = test::by_tier(40000, 1000000);
                double sum = 0, squares = 0;
                for (int i = 0; i < n; ++i) {
                    const float uc = random.uniform();
                    const auto s = sample(bsdf, wo, uc, random.uniform2());
                    if (!s) continue;
                    const double passed = cosine > 0 ? eta * eta : 1 / (eta * eta);
                    const double w = s->weight.g * (s->transmitted ? passed : 1);
                    sum += w, squares += w * w;
                }
                const double mean = sum / n, error = std::sqrt((squares / n - mean * mean) / n);
                EXPECT_NEAR(mean, 1, 5 * error + 4e-3) << material << " " << wavelength << " " << cosine;
            }
}

}  // namespace
}  // namespace steradian
