// Thin films whose weight or thickness is a texture, beside films that are the same everywhere.
#include <gtest/gtest.h>

#include "shading/bsdf.h"
#include "shading/open_pbr_tables.h"
#include "shading/world.h"

namespace steradian {
namespace {

using test::Random;

/// A scene of rectangles, one of each material, with constant textures of these values.
struct Surfaces {
    ShadingScene scene;
    Surfaces(const std::vector<OpenPbrMaterial>& materials, const std::vector<float>& values) {
        Scene s;
        // What is not red must not count.
        for (const float x : values) add<TextureId>(s.textures, Texture{ConstantTexture{{x, 0.3f, 0.9f}}});
        const ShapeId shape = add<ShapeId>(s.shapes, Shape{Rectangle{}});
        for (const OpenPbrMaterial& m : materials) {
            const MaterialId id = add<MaterialId>(s.materials, Material{m});
            add<InstanceId>(s.instances, Instance{shape, id, {}});
        }
        Diagnostics diagnostics;
        scene = std::move(make_shading_scene(std::move(s), diagnostics)).value();
    }
    Bsdf bsdf(size_t i) const {
        SurfacePoint point = test::receiver({}, {0, 0, 1});
        point.instance = static_cast<uint32_t>(i);
        return make_bsdf(scene, point);
    }
};

/// Matte, metallic, glassy, a sheet, and some of everything under a coat.
std::vector<OpenPbrMaterial> bases() {
    OpenPbrMaterial matte, metal, glass, sheet, all;
    metal.base_metalness.value = 1, metal.base_color.value = {0.9f, 0.6f, 0.3f};
    glass.transmission_weight.value = 1;
    sheet.transmission_weight.value = 1, sheet.geometry_thin_walled = true;
    all.base_metalness.value = 0.4f, all.transmission_weight.value = 0.3f, all.coat_weight = 0.7f;
    std::vector<OpenPbrMaterial> out{matte, metal, glass, sheet, all};
    for (OpenPbrMaterial& m : out) m.thin_film_weight.value = 1, m.thin_film_ior = 1.8f;
    return out;
}

Vec3 upper(Random& random) {
    const Vec3d d = random.direction();
    return static_cast<Vec3>(Vec3d{d.x, d.y, std::fabs(d.z)});
}

/// The largest difference between what two surfaces scatter, relative to that, also where their peaks are; 0 if they
/// sample alike as well.
double difference(const Surfaces& surfaces, size_t a, size_t b, int n = 400) {
    Random random(81);
    const Bsdf first = surfaces.bsdf(a), second = surfaces.bsdf(b);
    double most = 0;
    const auto compare = [&](double x, double y) { most = std::max(most, std::fabs(x - y) / (0.1 + std::fabs(y))); };
    for (int i = 0; i < n; ++i) {
        const Vec3 wo = upper(random);
        const float uc = random.uniform();
        const Vec2 u = random.uniform2();
        const auto s = sample(first, wo, uc, u), t = sample(second, wo, uc, u);
        if (s) {
            const BsdfEval e = eval(first, wo, s->wi), f = eval(second, wo, s->wi);
            for (int c = 0; c < 3; ++c) compare(e.f_cos[c], f.f_cos[c]);
            compare(e.pdf, f.pdf);
        }
        if (most > 0) continue;
        EXPECT_EQ(s.has_value(), t.has_value());
        EXPECT_TRUE(!s || !t || (s->wi == t->wi && s->weight == t->weight && s->pdf == t->pdf));
    }
    return most;
}

/// At both ends of the texture and where they are the same, in every bit.
TEST(FilmTextures, OfOneThicknessAtTheEndsAreConstants) {
    for (const OpenPbrMaterial& base : bases()) {
        const auto constant = [&](float thickness) {
            OpenPbrMaterial m = base;
            m.thin_film_thickness = {thickness};
            return m;
        };
        const auto textured = [&](float minimum, float maximum, uint32_t texture) {
            OpenPbrMaterial m = base;
            m.thin_film_thickness = {maximum, TextureId{texture}, minimum};
            return m;
        };
        const Surfaces s(
            {constant(0.1f), constant(0.45f), textured(0.1f, 0.45f, 0), textured(0.1f, 0.45f, 1),
             textured(0.45f, 0.1f, 0), textured(0.45f, 0.1f, 1), textured(0.45f, 0.45f, 2), textured(0.1f, 0.45f, 3)},
            {0, 1, 0.37f, 7});
        EXPECT_EQ(difference(s, 2, 0), 0);
        EXPECT_EQ(difference(s, 3, 1), 0);
        EXPECT_EQ(difference(s, 4, 1), 0);  // the minimum may be the larger one
        EXPECT_EQ(difference(s, 5, 0), 0);
        EXPECT_EQ(difference(s, 6, 1), 0);
        EXPECT_EQ(difference(s, 7, 1), 0);  // clamped
        EXPECT_GT(difference(s, 0, 1), 0.05);
    }
}

/// Between the ends the thickness is mixed, within what interpolation allows.
TEST(FilmTextures, OfOneThicknessAreNearTheConstant) {
    for (const OpenPbrMaterial& base : bases())
        for (const float value : {0.05f, 0.31f, 0.5f, 0.83f}) {
            OpenPbrMaterial textured = base, back = base, constant = base, other = base;
            textured.thin_film_thickness = {0.6f, TextureId{0}, 0.05f};
            back.thin_film_thickness = {0.05f, TextureId{1}, 0.6f};
            constant.thin_film_thickness = {0.05f + 0.55f * value};
            other.thin_film_thickness = {0.05f + 0.55f * value + 0.02f};
            const Surfaces s({textured, back, constant, other}, {value, 1 - value});
            const double error = difference(s, 0, 2);
            EXPECT_LT(error, 0.03) << value;
            EXPECT_LT(difference(s, 1, 2), 0.03) << value;
            EXPECT_GT(difference(s, 3, 2), error) << value;
        }
}

/// The factor times the texture; where that is nothing there is no film.
TEST(FilmTextures, WeightsAreFactors) {
    for (const OpenPbrMaterial& base : bases()) {
        OpenPbrMaterial nothing = base, none = base, half = base, textured = base;
        none.thin_film_weight = {0};
        nothing.thin_film_weight = {0.8f, TextureId{0}};
        half.thin_film_weight = {0.5f};
        textured.thin_film_weight = {1, TextureId{1}};
        const Surfaces s({nothing, none, half, textured, base}, {0, 0.5f});
        EXPECT_EQ(difference(s, 0, 1), 0);
        EXPECT_EQ(difference(s, 3, 2), 0);
        EXPECT_GT(difference(s, 2, 1), 0.01);
        EXPECT_GT(difference(s, 2, 4), 0.01);
    }
}

/// What is reflected and what passes are the mean by the weight of what they are with a film and without. (Roughness is
/// left as it is; samples are drawn with other probabilities, so only values are compared.)
TEST(FilmTextures, WeightsAreMeans) {
    Random random(82);
    for (const OpenPbrMaterial& base : bases()) {
        OpenPbrMaterial none = base, some = base;
        none.thin_film_weight = {0};
        some.thin_film_weight = {0.3f};
        const Surfaces s({none, some, base}, {});
        for (int i = 0; i < 300; ++i) {
            const Vec3 wo = upper(random), wi = static_cast<Vec3>(random.direction());
            const Rgb a = eval(s.bsdf(0), wo, wi).f_cos, b = eval(s.bsdf(2), wo, wi).f_cos,
                      mean = eval(s.bsdf(1), wo, wi).f_cos;
            // What bounces between facets of metal, and within a sheet, is not linear in what one bounce reflects.
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], 0.7f * a[c] + 0.3f * b[c], 0.02f * mean[c] + 1e-5f);
        }
    }
}

/// A film without a thickness is none. On metals it leaves the index that comes nearest to their colours. (Below a coat
/// films get light at the angles within it, and surfaces without one as if there were no coat.)
TEST(FilmTextures, OfNoThicknessAreNoFilms) {
    for (OpenPbrMaterial base : bases()) {
        if (base.coat_weight > 0) base.coat_weight = 0, base.base_metalness.value = 0;
        OpenPbrMaterial none = base, thin = base, constant = base;
        none.thin_film_weight = {0};
        thin.thin_film_thickness = {0.4f, TextureId{0}, 0};
        constant.thin_film_thickness = {0};
        const Surfaces s({none, thin, constant}, {0});
        EXPECT_EQ(difference(s, 1, 2), 0);
        EXPECT_LT(difference(s, 1, 0), base.base_metalness.value > 0 ? 0.1 : 1e-3);
    }
}

/// Tables are made for the range of thicknesses, whatever the texture, and shared by all materials with the same.
TEST(FilmTextures, ShareTheirTables) {
    OpenPbrMaterial a = bases()[4];
    a.thin_film_thickness = {0.4f, TextureId{0}, 0.1f};
    OpenPbrMaterial b = a, c = a, d = a;
    b.thin_film_thickness.texture = TextureId{1}, b.thin_film_weight = {0.5f, TextureId{0}};
    std::swap(c.thin_film_thickness.minimum, c.thin_film_thickness.maximum);
    d.thin_film_thickness.minimum = 0.2f;
    const Surfaces s({a, b, c, d}, {0, 1});
    const auto film = [&](size_t i) { return s.scene.materials[i].open_pbr->film; };
    for (const size_t i : {1u, 2u}) {
        EXPECT_EQ(film(i).dielectric, film(0).dielectric);
        EXPECT_EQ(film(i).energy, film(0).energy);
        EXPECT_EQ(film(i).metal, film(0).metal);
        EXPECT_EQ(film(i).glass, film(0).glass);
    }
    EXPECT_NE(film(3).dielectric, film(0).dielectric);
    EXPECT_EQ(film(0).thicknesses.count(), 59u);  // 57.6 steps of 0.45 µm / 24 to the path 2 · 1.8 · 0.3 µm
}

}  // namespace
}  // namespace steradian
