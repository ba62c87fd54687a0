// BSDFs: sampling follows the density, energy, reciprocity, sides, and the laws of Snell and Fresnel.
#include "shading/bsdf.h"

#include <gtest/gtest.h>

#include "shading/world.h"
#include "support/chi_square.h"
#include "support/support.h"

namespace steradian {
namespace {

using test::Random;

/// One value of every kind of lobe, and more where a flag changes what it does. A new alternative of the variant is
/// tested with its defaults from the start; but OpenPBR's is nothing without its tables, a mix without its parts, see
/// material_cases.cpp.
template <size_t I = 0>
std::vector<Bsdf> all_bsdfs(Vec3 ng, Vec3 ns) {
    using Lobe = decltype(Bsdf::lobe);
    std::vector<Bsdf> out;
    if constexpr (I < std::variant_size_v<Lobe>) {
        using Kind = std::variant_alternative_t<I, Lobe>;
        const auto push = [&](const Kind& kind) { out.push_back({kind, ng, Frame::from_z(ns)}); };
        if constexpr (std::is_same_v<Kind, DiffuseBsdf>) {
            push({{0.8f, 0.5f, 0.2f}, false});
            push({{0.8f, 0.5f, 0.2f}, true});
        } else if constexpr (std::is_same_v<Kind, GlassBsdf>) {
            push({1.5f, {1, 1, 1}, {1, 1, 1}});
            push({0.7f, {0.9f, 1, 1}, {1, 0.5f, 1}});
        } else if constexpr (std::is_same_v<Kind, RefractionBsdf>) {
            push({1.5f});
            push({0.6f});
        } else if constexpr (std::is_same_v<Kind, MirrorBsdf>) {
            push({{1, 1, 1}});
        } else if constexpr (!std::is_same_v<Kind, OpenPbrBsdf> && !std::is_same_v<Kind, MixBsdf> &&
                             !std::is_same_v<Kind, PhaseBsdf>) {
            push({});
        }
        for (Bsdf& more : all_bsdfs<I + 1>(ng, ns)) out.push_back(std::move(more));
    }
    return out;
}

struct Normals {
    Vec3 ng, ns;
};
std::vector<Normals> normal_pairs() {
    const Vec3 up = normalize(Vec3{0.1f, 0.9f, -0.3f});
    return {{up, up}, {up, normalize(up + Vec3{0.5f, 0, 0.2f})}, {{0, 0, -1}, normalize(Vec3{0.9f, 0, -0.5f})}};
}

TEST(Bsdf, SamplesFollowTheDensity) {
    Random random(1);
    const uint64_t n = test::by_tier<uint64_t>(20000, 500000);
    for (const Normals& normals : normal_pairs())
        for (const Bsdf& bsdf : all_bsdfs(normals.ng, normals.ns))
            for (int direction = 0; direction < 4; ++direction) {
                const Vec3 wo = static_cast<Vec3>(random.direction());
                SCOPED_TRACE("lobe " + std::to_string(bsdf.lobe.index()) + ", direction " + std::to_string(direction));
                int specular = 0;
                const auto sampled = [&](uint64_t) -> std::optional<Vec3> {
                    const float uc = random.uniform();
                    const auto s = sample(bsdf, wo, uc, random.uniform2());
                    if (!s) return std::nullopt;
                    if (s->specular) {
                        ++specular;
                        return std::nullopt;
                    }
                    const BsdfEval e = eval(bsdf, wo, s->wi);
                    EXPECT_NEAR(s->pdf, e.pdf, 1e-5f);
                    EXPECT_NEAR(s->weight.g * s->pdf, e.f_cos.g, 1e-5f);
                    const Vec3 ng = normals.ng;
                    EXPECT_EQ(s->transmitted, (dot(s->wi, ng) > 0) != (dot(wo, ng) > 0));
                    return s->wi;
                };
                const auto density = [&](Vec3 wi) { return static_cast<double>(eval(bsdf, wo, wi).pdf); };
                if (is_specular(bsdf)) {
                    for (int i = 0; i < 100; ++i) {
                        EXPECT_FALSE(sampled(0));
                        EXPECT_EQ(density(static_cast<Vec3>(random.direction())), 0);
                        EXPECT_TRUE(is_black(eval(bsdf, wo, static_cast<Vec3>(random.direction())).f_cos));
                    }
                    EXPECT_EQ(specular, 100);
                } else {
                    const test::ChiSquare result = test::chi_square_directions(sampled, density, n, 8, 12);
                    EXPECT_TRUE(result.passes()) << result;
                    EXPECT_EQ(specular, 0);
                }
            }
}

/// Lit by 1 from everywhere, each side of a surface that loses nothing shows 1; where glass scales by the square of the
/// index, the light inside it is 1 / that square of what it is outside.
TEST(Bsdf, Furnace) {
    Random random(2);
    for (const Normals& normals : normal_pairs()) {
        const Bsdf glass{GlassBsdf{1.5f, {1, 1, 1}, {1, 1, 1}}, normals.ng, Frame::from_z(normals.ns)};
        const Bsdf refraction{RefractionBsdf{1.5f}, normals.ng, Frame::from_z(normals.ns)};
        const Bsdf mirror{MirrorBsdf{{1, 1, 1}}, normals.ng, Frame::from_z(normals.ns)};
        for (int i = 0; i < 200; ++i) {
            const Vec3 wo = static_cast<Vec3>(random.direction());
            const bool outside = dot(wo, normals.ng) > 0;
            const double inside_radiance = 1.5 * 1.5;  // radiance over n² is what is the same on both sides
            double sum = 0;
            const int n = 1000;
            for (int k = 0; k < n; ++k) {
                const auto s = sample(glass, wo, (k + 0.5f) / n, {0.5f, 0.5f});
                ASSERT_TRUE(s);
                EXPECT_NEAR(length(s->wi), 1, 1e-6);
                EXPECT_EQ(s->transmitted, (dot(s->wi, normals.ng) > 0) != outside);
                sum += s->weight.r * ((dot(s->wi, normals.ng) > 0) ? 1 : inside_radiance) / n;
            }
            EXPECT_NEAR(sum, outside ? 1 : inside_radiance, 1e-5);
            for (const Bsdf* bsdf : {&refraction, &mirror}) {
                const auto s = sample(*bsdf, wo, 0.4f, {0.5f, 0.5f});
                ASSERT_TRUE(s);
                EXPECT_EQ(s->weight, (Rgb{1, 1, 1}));
                EXPECT_EQ(s->pdf, 0);
                EXPECT_EQ(s->transmitted, (dot(s->wi, normals.ng) > 0) != outside);
                EXPECT_FALSE(bsdf == &mirror && s->transmitted);
            }
        }
    }
    // White diffuse: the weight is the reflectance, whatever is drawn.
    const Bsdf white{DiffuseBsdf{{1, 1, 1}, false}, {0, 1, 0}, Frame::from_z({0, 1, 0})};
    for (int i = 0; i < 1000; ++i) {
        const auto s = sample(white, normalize(Vec3{0.5f, 0.2f, 0}), 0, random.uniform2());
        ASSERT_TRUE(s);
        EXPECT_EQ(s->weight, (Rgb{1, 1, 1}));
        const BsdfEval e = eval(white, {0, 1, 0}, s->wi);
        EXPECT_EQ(e.f_cos.r, e.pdf);
    }
}

/// A direction on which the two normals disagree is treated as if the surface were flat.
TEST(Bsdf, SpecularLobesTakeTheGeometricNormalWhereTheShadingNormalFacesAway) {
    Random random(14);
    int compared = 0;
    for (const Normals& normals : normal_pairs()) {
        const std::vector<Bsdf> bent = all_bsdfs(normals.ng, normals.ns), flat = all_bsdfs(normals.ng, normals.ng);
        for (int i = 0; i < 2000; ++i) {
            const Vec3 wo = static_cast<Vec3>(random.direction());
            if (dot(Vec3d(wo), Vec3d(normals.ng)) * dot(Vec3d(wo), Vec3d(normals.ns)) >= 0) continue;
            for (size_t k = 0; k < bent.size(); ++k) {
                if (!is_specular(bent[k])) continue;
                const float choice = random.uniform2().x;
                const auto a = sample(bent[k], wo, choice, {0.5f, 0.5f}), b = sample(flat[k], wo, choice, {0.5f, 0.5f});
                ASSERT_TRUE(a && b);
                EXPECT_EQ(a->wi, b->wi);
                EXPECT_EQ(a->weight, b->weight);
                ++compared;
            }
        }
    }
    EXPECT_GT(compared, 1000);
}

TEST(Bsdf, DiffuseIsReciprocalAndHasSides) {
    Random random(4);
    for (const Normals& normals : normal_pairs())
        for (const bool two_sided : {false, true}) {
            const Bsdf bsdf{DiffuseBsdf{{0.5f, 0.5f, 0.5f}, two_sided}, normals.ng, Frame::from_z(normals.ns)};
            for (int i = 0; i < 2000; ++i) {
                const Vec3 a = static_cast<Vec3>(random.direction()), b = static_cast<Vec3>(random.direction());
                const BsdfEval there = eval(bsdf, a, b), back = eval(bsdf, b, a);
                const float ca = dot(a, normals.ns), cb = dot(b, normals.ns);
                EXPECT_NEAR(there.f_cos.r * std::fabs(ca), back.f_cos.r * std::fabs(cb), 1e-6);
                const bool front = ca > 0 && cb > 0 && dot(a, normals.ng) > 0 && dot(b, normals.ng) > 0;
                const bool behind = ca < 0 && cb < 0 && dot(a, normals.ng) < 0 && dot(b, normals.ng) < 0;
                EXPECT_EQ(there.pdf > 0, front || (two_sided && behind));
                EXPECT_EQ(there.f_cos.r > 0, there.pdf > 0);
                if (!(there.pdf > 0)) continue;
                EXPECT_NEAR(there.f_cos.r, 0.5 / std::numbers::pi * std::fabs(cb), 1e-6);
            }
        }
}

TEST(Bsdf, Snell) {
    for (const float eta : {1.5f, 0.75f, 2.0f, 1.0f})
        for (const double degrees : {0.0, 10.0, 29.0, 60.0, 85.0})
            for (const bool outside : {true, false}) {
                const double theta = degrees * std::numbers::pi / 180, sign = outside ? 1 : -1;
                const Vec3 wo = static_cast<Vec3>(Vec3d{std::sin(theta), sign * std::cos(theta), 0});
                const Bsdf bsdf{RefractionBsdf{eta}, {0, 1, 0}, Frame::from_z({0, 1, 0})};
                const auto s = sample(bsdf, wo, 0, {});
                ASSERT_TRUE(s);
                const double n = outside ? eta : 1 / static_cast<double>(eta);
                const double sine = std::sin(theta) / n;
                EXPECT_EQ(s->transmitted, sine < 1);
                EXPECT_NEAR(s->wi.x, sine < 1 ? -sine : -std::sin(theta), 1e-6);
                EXPECT_NEAR(s->wi.y, sine < 1 ? -sign * std::sqrt(1 - sine * sine) : sign * std::cos(theta), 2e-6);
                const Bsdf mirror{MirrorBsdf{{1, 1, 1}}, {0, 1, 0}, Frame::from_z({0, 1, 0})};
                const auto m = sample(mirror, wo, 0, {});
                ASSERT_TRUE(m);
                EXPECT_NEAR(m->wi.x, -wo.x, 1e-6);
                EXPECT_NEAR(m->wi.y, wo.y, 1e-6);
            }
}

TEST(Bsdf, Fresnel) {
    for (const double n : {1.5, 1.0 / 1.5, 2.0, 1.1, 0.5, 1.0}) {
        const auto eta = static_cast<float>(n);
        EXPECT_NEAR(fresnel_dielectric(1, eta), (n - 1) / (n + 1) * (n - 1) / (n + 1), 1e-7);
        EXPECT_NEAR(fresnel_dielectric(0, eta), n == 1 ? 0.5 : 1, n == 1 ? 1 : 1e-7);
        // At Brewster's angle, tan θ = n, the part polarised in the plane vanishes; the other has ((n² - 1) / (n² +
        // 1))².
        const double cosine = 1 / std::sqrt(1 + n * n), other = (n * n - 1) / (n * n + 1);
        EXPECT_NEAR(fresnel_dielectric(static_cast<float>(cosine), eta), other * other / 2, 1e-6);
        // The same by way of the refracted angle: R = (sin²(i - t) / sin²(i + t) + tan²(i - t) / tan²(i + t)) / 2.
        for (double i = 0.1; i < 1.5; i += 0.1) {
            const double sine = std::sin(i) / n;
            const float r = fresnel_dielectric(static_cast<float>(std::cos(i)), eta);
            if (sine >= 1) {
                EXPECT_EQ(r, 1);
                continue;
            }
            const double t = std::asin(sine), a = i - t, b = i + t;
            const double s2 = std::pow(std::sin(a) / std::sin(b), 2), t2 = std::pow(std::tan(a) / std::tan(b), 2);
            EXPECT_NEAR(r, (s2 + t2) / 2, 1e-5) << n << " " << i;
        }
    }
}

TEST(Bsdf, GlassChoosesByFresnel) {
    const Bsdf bsdf{GlassBsdf{1.5f, {0.5f, 1, 1}, {1, 0.25f, 1}}, {0, 1, 0}, Frame::from_z({0, 1, 0})};
    for (const bool outside : {true, false}) {
        const Vec3 wo = normalize(Vec3{0.3f, outside ? 0.8f : -0.8f, 0.1f});
        const float reflectance = fresnel_dielectric(std::fabs(wo.y), outside ? 1.5f : 1 / 1.5f);
        const auto reflected = sample(bsdf, wo, reflectance - 1e-3f, {}),
                   transmitted = sample(bsdf, wo, reflectance + 1e-3f, {});
        ASSERT_TRUE(reflected && transmitted);
        EXPECT_FALSE(reflected->transmitted);
        EXPECT_TRUE(transmitted->transmitted);
        EXPECT_EQ(reflected->weight, (Rgb{0.5f, 1, 1}));
        const float scale = outside ? 1 / 2.25f : 2.25f;
        EXPECT_FLOAT_EQ(transmitted->weight.r, scale);
        EXPECT_FLOAT_EQ(transmitted->weight.g, 0.25f * scale);
    }
}

TEST(Bsdf, IsMadeFromMaterialAndTexture) {
    Scene scene;
    const TextureId checker = add<TextureId>(scene.textures, Texture{CheckerTexture{{1, 0, 0}, {0, 1, 0}, {4, 4}, {}}});
    scene.materials = {DiffuseMaterial{checker, true}, RefractionMaterial{1.2f},
                       GlassMaterial{1.7f, {1, 0, 0}, {0, 1, 0}}, MirrorMaterial{{0.5f, 0.6f, 0.7f}}};
    const ShapeId shape = add<ShapeId>(scene.shapes, Shape{Sphere{}});
    for (uint32_t i = 0; i < 4; ++i) add<InstanceId>(scene.instances, Instance{shape, MaterialId(i), {}});
    Diagnostics diagnostics;
    const ShadingScene shading = std::move(make_shading_scene(std::move(scene), diagnostics)).value();
    SurfacePoint point = test::receiver({}, {0, 1, 0});
    point.uv = {0.3f, 0.1f};
    for (uint32_t i = 0; i < 4; ++i) {
        point.instance = i;
        const Bsdf bsdf = make_bsdf(shading, point);
        EXPECT_EQ(bsdf.lobe.index(), i);
        EXPECT_EQ(is_specular(bsdf), i > 0);
        EXPECT_EQ(bsdf.frame.z, point.ns);
        if (i == 0) {
            EXPECT_EQ(std::get<DiffuseBsdf>(bsdf.lobe).reflectance, (Rgb{0, 1, 0}));
            EXPECT_TRUE(std::get<DiffuseBsdf>(bsdf.lobe).two_sided);
        } else if (i == 2) {
            EXPECT_EQ(std::get<GlassBsdf>(bsdf.lobe).eta, 1.7f);
            EXPECT_EQ(std::get<GlassBsdf>(bsdf.lobe).transmittance, (Rgb{0, 1, 0}));
        }
    }
}

/// Pictures that were filtered or came from another gamut have texels a little below zero.
TEST(Bsdf, ReflectsNothingWhereATextureIsNegative) {
    Scene scene;
    const auto texture = [&](Rgb c) { return add<TextureId>(scene.textures, Texture{ConstantTexture{c}}); };
    for (const float green : {-0.01f, 0.0f}) {
        const TextureId color = texture({0.5f, green, 0.3f});
        OpenPbrMaterial matte, metal, glass;
        matte.base_color = {{1, 1, 1}, color};
        metal.base_metalness.value = 1, metal.base_color = {{1, 1, 1}, color};
        glass.transmission_weight.value = 1, glass.specular_color = {{1, 1, 1}, color};
        const Material materials[] = {DiffuseMaterial{color, true},
                                      DiffuseMaterial{color, true, 0.6f},
                                      DiffuseTransmissionMaterial{color, color},
                                      ConductorMaterial{SchlickReflectance{color, {1, 1, 1}}, {0.5f, 0.5f}},
                                      matte,
                                      metal,
                                      glass};
        for (const Material& m : materials) scene.materials.push_back(m);
    }
    const ShapeId shape = add<ShapeId>(scene.shapes, Shape{Rectangle{}});
    const auto count = static_cast<uint32_t>(scene.materials.size());
    for (uint32_t i = 0; i < count; ++i) add<InstanceId>(scene.instances, Instance{shape, MaterialId(i), {}});
    Diagnostics diagnostics;
    const ShadingScene shading = std::move(make_shading_scene(std::move(scene), diagnostics)).value();
    const auto bsdf_of = [&](uint32_t instance) {
        SurfacePoint point = test::receiver({}, {0, 0, 1});
        point.instance = instance;
        return make_bsdf(shading, point);
    };
    Random random(31);
    for (uint32_t i = 0; i < count / 2; ++i) {
        const Bsdf negative = bsdf_of(i), zero = bsdf_of(i + count / 2);
        for (int k = 0; k < 100; ++k) {
            const Vec3 wo = static_cast<Vec3>(random.direction()), wi = static_cast<Vec3>(random.direction());
            EXPECT_EQ(eval(negative, wo, wi).f_cos, eval(zero, wo, wi).f_cos) << i;
            const float choice = random.uniform();
            const Vec2 u = random.uniform2();
            const auto a = sample(negative, wo, choice, u), b = sample(zero, wo, choice, u);
            ASSERT_EQ(a.has_value(), b.has_value()) << i;
            if (!a) continue;
            EXPECT_EQ(a->weight, b->weight) << i;
        }
    }
}

}  // namespace
}  // namespace steradian
