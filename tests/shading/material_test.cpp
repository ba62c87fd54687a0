// All materials, at parameters and angles chosen to break them: sampling follows the density, weights agree with
// values, nothing is created, nothing is lost where nothing should be, light may travel either way.
#include <gtest/gtest.h>

#include <set>

#include "shading/material_cases.h"
#include "shading/world.h"
#include "support/chi_square.h"
#include "support/support.h"

namespace steradian {
namespace {

using test::Magnifier;
using test::material_scene;
using test::MaterialCase;
using test::Normals;
using test::Random;

/// From normal incidence to grazing, and from behind.
std::vector<Vec3> directions(Vec3 n, Random& random) {
    const Frame frame = Frame::from_z(n);
    std::vector<Vec3> out{n};
    for (const double cosine : {0.95, 0.6, 0.25, 0.05, -0.4}) {
        const double phi = random.between(0, 2 * std::numbers::pi), sine = std::sqrt(1 - cosine * cosine);
        const Vec3d local{sine * std::cos(phi), sine * std::sin(phi), cosine};
        out.push_back(normalize(frame.to_world(static_cast<Vec3>(local))));
    }
    return out;
}

/// Inside over outside of a body; 1 for sheets.
float material_index(const MaterialCase& c) {
    const auto* glass = std::get_if<GlassMaterial>(&c.material);
    if (glass) return glass->eta;
    const auto* layered = std::get_if<OpenPbrMaterial>(&c.material);
    return layered && !layered->geometry_thin_walled ? layered->specular_ior : 1;
}

template <class Check>
void for_all_cases(const Check& check) {
    for (size_t i = 0; i < material_scene().cases().size(); ++i) {
        SCOPED_TRACE(material_scene().cases()[i].name);
        check(material_scene().cases()[i], i);
    }
}

TEST(Materials, EveryKindHasACase) {
    std::set<size_t> kinds;
    for (const MaterialCase& c : material_scene().cases()) kinds.insert(c.material.index());
    EXPECT_EQ(kinds.size(), std::variant_size_v<Material>);
}

/// The magnifier's two directions are inverses and its solid angles right: the sphere keeps its 4π.
TEST(Materials, TheMagnifierOfTheseTestsIsRight) {
    Random random(31);
    const Magnifier magnifier({0.3, -0.5, 0.2}, 0.05);
    double sum = 0;
    const int n = 200000;
    for (int i = 0; i < n; ++i) {
        const Vec3d w = random.direction(), back = magnifier.original(magnifier.magnified(w));
        EXPECT_NEAR(length(back - w), 0, 1e-12);
        const double z = 2 * (i + 0.5) / n - 1;
        sum += magnifier.solid_angle_ratio({std::sqrt(1 - z * z), 0, z}) / n;
    }
    EXPECT_NEAR(sum, 1, 1e-5);
}

/// Chi-square, and for each sample the agreement of sample() with eval().
TEST(Materials, SamplesFollowTheDensity) {
    Random random(32);
    const uint64_t n = test::by_tier<uint64_t>(5000, 400000);
    for_all_cases([&](const MaterialCase& material, size_t index) {
        for (const Normals& normals : test::normal_pairs()) {
            const Bsdf bsdf = material_scene().bsdf(index, normals.ng, normals.ns);
            if (is_specular(bsdf)) continue;
            std::vector<Vec3> from = directions(normals.ns, random);
            if (!test::run_everything()) from = {from[normals.ng == normals.ns ? 4 : 2 + index % 4]};
            for (const Vec3 wo : from) {
                const bool agree = dot(wo, normals.ng) * dot(wo, normals.ns) > 0;
                const Vec3 normal = agree ? normals.ns : normals.ng;
                const Vec3d peak =
                    material.eta == 1 ? test::mirrored(wo, normal) : test::refracted(wo, normal, material.eta);
                // Where the surface hides the peak, its tail is left, as wide as the peak is deep below the surface.
                const double height = dot(peak, Vec3d(normals.ng)) * (dot(wo, normals.ng) > 0 ? 1 : -1);
                const double width = max_of(4.0 * material.peak, material.eta == 1 ? -height : height);
                const Magnifier magnifier(peak, width < 0.8 ? width : 1);
                const auto sampled = [&](uint64_t) -> std::optional<Vec3> {
                    const float uc = random.uniform();
                    const auto s = sample(bsdf, wo, uc, random.uniform2());
                    if (!s) return std::nullopt;
                    const BsdfEval e = eval(bsdf, wo, s->wi);
                    EXPECT_NEAR(s->pdf, e.pdf, 1e-5f * e.pdf);
                    for (int c = 0; c < 3; ++c)
                        EXPECT_NEAR(s->weight[c] * s->pdf, e.f_cos[c], 1e-5f * e.f_cos[c] + 1e-12f);
                    EXPECT_NEAR(length(s->wi), 1, 1e-6);
                    EXPECT_EQ(s->transmitted, dot(s->wi, normals.ng) * dot(wo, normals.ng) < 0);
                    EXPECT_FALSE(s->specular);
                    return static_cast<Vec3>(magnifier.magnified(s->wi));
                };
                const auto density = [&](Vec3 magnified) {
                    const Vec3d m = normalize(Vec3d(magnified));
                    const double pdf = eval(bsdf, wo, static_cast<Vec3>(magnifier.original(m))).pdf;
                    return pdf * magnifier.solid_angle_ratio(m);
                };
                const test::ChiSquare result = test::chi_square_directions(sampled, density, n, 6, 8);
                EXPECT_TRUE(result.passes()) << result << ", cosine " << dot(wo, normals.ns);
            }
        }
    });
}

/// f(a, b) / n_a² = f(b, a) / n_b², with the index n on the side of each direction (Veach 1997, equation 5.14).
TEST(Materials, AreReciprocal) {
    Random random(33);
    for_all_cases([&](const MaterialCase& material, size_t index) {
        if (!material.reciprocal) return;
        for (const Normals& normals : test::normal_pairs()) {
            const Bsdf bsdf = material_scene().bsdf(index, normals.ng, normals.ns);
            if (is_specular(bsdf)) continue;
            const auto index2 = [&](Vec3 w) { return dot(w, normals.ng) > 0 ? 1 : material.eta * material.eta; };
            const auto sides_agree = [&](Vec3 w) { return dot(w, normals.ng) * dot(w, normals.ns) > 0; };
            for (int i = 0; i < 1000; ++i) {
                const Vec3 a = static_cast<Vec3>(random.direction());
                const float uc = random.uniform();
                // Every other pair is of the peak.
                const auto s = sample(bsdf, a, uc, random.uniform2());
                const Vec3 b = i % 2 && s ? s->wi : static_cast<Vec3>(random.direction());
                if (!sides_agree(a) || !sides_agree(b)) continue;
                const float ca = std::fabs(dot(a, normals.ns)), cb = std::fabs(dot(b, normals.ns));
                const Rgb there = eval(bsdf, a, b).f_cos / (cb * index2(a));
                const Rgb back = eval(bsdf, b, a).f_cos / (ca * index2(b));
                // The cosines are rounded to float before they divide.
                const float tolerance = 2e-6f + 4e-7f / ca + 4e-7f / cb;
                for (int c = 0; c < 3; ++c) EXPECT_NEAR(there[c], back[c], tolerance * there[c] + 1e-9f);
            }
        }
    });
}

/// ∫ f |cos| L over the sphere by the midpoint rule on magnified spheres, one for each side; L is the square of the
/// index of each side over that of wo's: what the inside of a body in a white furnace shows.
Rgb albedo(const Bsdf& bsdf, Vec3 wo, Vec3 n, const MaterialCase& material, int rings) {
    double sum[3] = {};
    const auto add_side = [&](Vec3d peak, bool same_side, double radiance) {
        const Magnifier magnifier(peak, std::min(1.0, material.peak * 2.0));
        for (int i = 0; i < rings; ++i) {
            // z = cos πt spreads the points evenly in angle.
            const double t = std::numbers::pi * (i + 0.5) / rings, z = std::cos(t), s = std::sin(t);
            for (int j = 0; j < 2 * rings; ++j) {
                const double phi = std::numbers::pi * (j + 0.5) / rings;
                const Vec3d m{s * std::cos(phi), s * std::sin(phi), z};
                const Vec3 wi = static_cast<Vec3>(magnifier.original(m));
                if ((dot(wi, n) * dot(wo, n) > 0) != same_side) continue;
                const double dw = s * std::pow(std::numbers::pi / rings, 2) * magnifier.solid_angle_ratio(m);
                const Rgb f = eval(bsdf, wo, wi).f_cos;
                for (int c = 0; c < 3; ++c) sum[c] += dw * radiance * f[c];
            }
        }
    };
    const double eta2 = material.eta * material.eta;
    add_side(test::mirrored(wo, n), true, 1);
    add_side(test::refracted(wo, n, material.eta), false, dot(wo, n) > 0 ? eta2 : 1 / eta2);
    return {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])};
}

/// What refraction adds to the radiance is not a reason to keep a path (path.cpp), so samples say how much it is.
TEST(Materials, SamplesSayWhatRefractionAdds) {
    Random random(36);
    const Vec3 n{0, 0, 1};
    for_all_cases([&](const MaterialCase& material, size_t index) {
        const Bsdf bsdf = material_scene().bsdf(index, n, n);
        if (std::holds_alternative<RefractionMaterial>(material.material)) return;  // passes radiance on as it is
        const float eta2 = material_index(material) * material_index(material);
        for (int i = 0; i < 200; ++i) {
            const Vec3 wo = static_cast<Vec3>(random.direction());
            const float uc = random.uniform();
            const auto s = sample(bsdf, wo, uc, random.uniform2());
            if (!s) continue;
            const float added = wo.z > 0 ? 1 / eta2 : eta2;
            EXPECT_NEAR(s->radiance_scale, s->transmitted ? added : 1, 1e-6f * (1 + added));
        }
    });
}

/// In a white furnace. The tables are good to 1e-4, the rounding of directions adds as much where peaks are narrow.
TEST(Materials, NeitherGainNorLoseEnergy) {
    const int rings = test::by_tier(200, 600);
    const Vec3 n = normalize(Vec3{0.2f, 0.9f, 0.1f});
    Random random(34);
    for_all_cases([&](const MaterialCase& material, size_t index) {
        const Bsdf bsdf = material_scene().bsdf(index, n, n);
        if (is_specular(bsdf)) return;
        const double bound = material.energy_error;
        for (const double cosine : {1.0, 0.98, 0.8, 0.5, 0.3, 0.1, -0.1, -0.4, -0.7, -1.0}) {
            if (cosine < 0 && material.eta == 1) continue;
            const double phi = random.between(0, 2 * std::numbers::pi), sine = std::sqrt(1 - cosine * cosine);
            const Vec3d local{sine * std::cos(phi), sine * std::sin(phi), cosine};
            const Vec3 wo = normalize(bsdf.frame.to_world(static_cast<Vec3>(local)));
            const Rgb sum = albedo(bsdf, wo, n, material, rings);
            for (int c = 0; c < 3; ++c) {
                EXPECT_LE(sum[c], 1 + bound) << cosine;
                EXPECT_GE(sum[c], material.lossless ? 1 - bound : 0.1) << cosine;
            }
        }
    });
}

/// Hostile numbers: the ends of the random numbers, directions in the surface and along the normals.
TEST(Materials, AreFiniteEverywhere) {
    Random random(35);
    const float ends[] = {0, 0x1p-24f, 0.25f, 0.5f, 0.75f, kOneMinusEpsilon};
    for_all_cases([&](const MaterialCase&, size_t index) {
        for (const Normals& normals : test::normal_pairs()) {
            const Bsdf bsdf = material_scene().bsdf(index, normals.ng, normals.ns);
            std::vector<Vec3> hostile = {normals.ng, normals.ns, -normals.ng, -normals.ns};
            for (const Vec3 n : {normals.ng, normals.ns})
                for (const float tilt : {0.0f, 1e-7f, -1e-7f, 1e-4f, -1e-4f, 1e-2f}) {
                    const Frame frame = Frame::from_z(n);
                    hostile.push_back(normalize(frame.x + n * tilt));
                    hostile.push_back(normalize(frame.y * -1 + n * tilt));
                    hostile.push_back(normalize(n + frame.x * tilt));
                }
            const auto good = [](Rgb c) { return is_finite(c) && c.r >= 0 && c.g >= 0 && c.b >= 0; };
            for (const Vec3 wo : hostile) {
                for (const Vec3 wi : hostile) {
                    const BsdfEval e = eval(bsdf, wo, wi);
                    EXPECT_TRUE(good(e.f_cos) && is_finite(e.pdf) && e.pdf >= 0) << e.f_cos.r << " " << e.pdf;
                }
                for (const float uc : ends)
                    for (const float x : ends)
                        for (const float y : ends) {
                            const auto s = sample(bsdf, wo, uc, {x, y});
                            if (!s) continue;
                            EXPECT_TRUE(good(s->weight) && is_finite(s->pdf) && is_finite(s->wi));
                            EXPECT_TRUE(s->specular ? s->pdf == 0 : s->pdf > 0);
                            EXPECT_LT(s->weight.r, 30);
                        }
            }
        }
    });
}

}  // namespace
}  // namespace steradian
