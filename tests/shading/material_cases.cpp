#include "shading/material_cases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "shading/world.h"

namespace steradian::test {
namespace {

Roughness rough(float x, float y) {
    Roughness r;
    r.value = {x, y};
    r.squared = false;
    return r;
}

std::string number(float x) {
    std::string s = std::to_string(x);
    return s.substr(0, s.find_last_not_of('0') + 1);
}

void add_conductors(std::vector<MaterialCase>& out, TextureId white, TextureId orange) {
    const auto conductor = [&](std::string name, TextureId color, Roughness roughness, bool lossless) {
        const float peak = std::min(roughness.value.x, roughness.value.y);
        ConductorMaterial m{SchlickReflectance{color, {1, 1, 1}}, roughness};
        out.push_back({"conductor " + std::move(name), m, lossless, peak > 0 ? peak : 1});
    };
    conductor("white smooth", white, rough(0, 0), true);
    for (const float alpha : {1e-4f, 1e-3f, 0.02f, 0.1f, 0.3f, 0.6f, 1.0f})
        conductor("white alpha " + number(alpha), white, rough(alpha, alpha), true);
    conductor("white alpha 0.05 0.4", white, rough(0.05f, 0.4f), true);
    conductor("white alpha 1 0.1", white, rough(1, 0.1f), true);
    conductor("orange alpha 0.5", orange, rough(0.5f, 0.5f), false);
    out.push_back(
        {"conductor gold alpha 0.2", ConductorMaterial{*metal_index("gold"), rough(0.2f, 0.2f)}, false, 0.2f});
    out.push_back({"conductor tinted gold alpha 0.3",
                   ConductorMaterial{*metal_index("gold"), rough(0.3f, 0.3f), {0.3f, 0.5f, 0.9f}}, false, 0.3f});
    out.push_back({"conductor chromium smooth", ConductorMaterial{*metal_index("chromium"), {}}, false, 1});
}

/// A texture that is 0.7 everywhere times a roughness: the tables over levels.
void add_textured(std::vector<MaterialCase>& out, TextureId white, TextureId level) {
    Roughness r;
    r.value = {1, 1};
    r.texture = level;
    out.push_back({"conductor textured", ConductorMaterial{SchlickReflectance{white, {1, 1, 1}}, r}, true, 0.49f});
    r.value = {0.9f, 0.4f};
    r.squared = false;
    out.push_back(
        {"conductor textured anisotropic", ConductorMaterial{SchlickReflectance{white, {1, 1, 1}}, r}, true, 0.28f});
}

void add_glass(std::vector<MaterialCase>& out) {
    const auto glass = [&](float eta, float x, float y) {
        const std::string name = "glass " + number(eta) + " alpha " + number(x) + " " + number(y);
        // Refraction with an index near 1 bends little: its peak is narrower than the roughness.
        const float peak = std::min(x, y) * std::min(1.0f, std::fabs(eta - 1));
        // Total reflection begins with an edge, which the tables smooth.
        const double error = x == y ? 4e-3 : 1e-2;
        out.push_back({name, GlassMaterial{eta, {1, 1, 1}, {1, 1, 1}, rough(x, y)}, true, peak, eta, error});
    };
    for (const float alpha : {0.1f, 0.4f, 1.0f}) glass(1.5f, alpha, alpha);
    glass(1.5f, 0.1f, 0.4f);
    glass(1.5f, 0.8f, 0.1f);
    glass(0.7f, 0.1f, 0.3f);
    glass(0.7f, 0.3f, 0.3f);
    glass(2.4f, 0.5f, 0.5f);
    glass(1.1f, 0.5f, 0.5f);
    out.push_back({"glass 1.0 rough", GlassMaterial{1, {1, 1, 1}, {1, 1, 1}, rough(0.5f, 0.5f)}, true});
    out.push_back(
        {"glass tinted rough", GlassMaterial{1.5f, {0.9f, 1, 1}, {1, 0.5f, 1}, rough(0.5f, 0.5f)}, false, 0.25f, 1.5f});
    out.push_back({"thin glass", ThinGlassMaterial{1.5f, {1, 1, 1}}, true});
    out.push_back({"thin glass green", ThinGlassMaterial{1.5f, {0.5f, 0.9f, 0.6f}}, false});
}

/// Of a constant thickness, and of one between two that tables are made for.
template <class AddCase>
void add_films(const AddCase& add_case, const OpenPbrMaterial& white, TextureId level) {
    OpenPbrMaterial m = white;
    m.thin_film_weight.value = 1, m.thin_film_thickness = {0.4f}, m.thin_film_ior = 2;
    add_case("white under a film", m, true, 0.25f);
    m.base_metalness.value = 1, m.base_color.value = {0.9f, 0.6f, 0.4f}, m.thin_film_weight.value = 0.7f;
    add_case("metal under a film", m, false, 0.25f);
    m.thin_film_thickness = {0.1f, level, 0.8f}, m.thin_film_weight = {1, level};
    add_case("metal under a textured film", m, false, 0.25f);
    m = white;
    m.thin_film_weight.value = 1, m.transmission_weight.value = 1;
    add_case("glass under a film", m, true, 0.12f);
    m.thin_film_thickness = {0.9f, level, 0.1f}, m.thin_film_weight = {0.8f, level};
    add_case("glass under a textured film", m, true, 0.12f);
    m.transmission_weight.value = 0, m.thin_film_ior = 2;
    add_case("white under a textured film", m, true, 0.25f);
    m.specular_roughness = {1, level}, m.coat_weight = 0.5f, m.coat_roughness.value = 0.3f;
    add_case("white textured under a textured film and a coat", m, true, 0.09f);
    m.specular_roughness_anisotropy = {0.8f, level}, m.specular_grain_shape = GrainShape::gltf;
    add_case("white with a textured grain under a textured film", m, true, 0.15f);
}

void add_open_pbr(std::vector<MaterialCase>& out, TextureId level) {
    const auto add_case = [&](std::string name, const OpenPbrMaterial& m, bool lossless, float peak) {
        const bool transmits = m.transmission_weight.value > 0 && !m.geometry_thin_walled;
        MaterialCase c{"open_pbr " + std::move(name), m, lossless, peak, transmits ? m.specular_ior : 1};
        c.energy_error = transmits ? 1e-2 : 2e-3;
        const bool one_lobe =
            m.base_metalness.value == 1 || (m.geometry_thin_walled && m.transmission_weight.value == 1);
        c.reciprocal = one_lobe && m.coat_weight == 0 && m.fuzz_weight.value == 0;
        out.push_back(c);
    };
    OpenPbrMaterial white;
    white.base_color.value = {1, 1, 1};
    white.specular_roughness.value = 0.5f;
    add_case("default", {}, false, 0.09f);
    add_case("white", white, true, 0.25f);
    OpenPbrMaterial m = white;
    m.specular_roughness_anisotropy.value = 0.7f, m.base_diffuse_roughness = 0.8f;
    add_case("white with a grain", m, true, 0.1f);
    m = white;
    m.specular_roughness_anisotropy = {0.8f, level}, m.specular_roughness = {0.7f, level};
    m.specular_grain_shape = GrainShape::gltf, m.geometry_tangent.rotation = 30;
    add_case("white with a textured grain", m, true, 0.15f);
    m.base_metalness.value = 1;
    add_case("white metal with a textured grain", m, true, 0.15f);
    out.back().energy_error = 1e-2;
    m = white;
    m.base_metalness.value = 1;
    add_case("white metal", m, true, 0.25f);
    m.base_color.value = {0.9f, 0.5f, 0.3f}, m.specular_color.value = {0.5f, 0.9f, 0.4f}, m.specular_weight = 0.7f;
    add_case("tinted metal", m, false, 0.25f);
    m = white;
    m.coat_weight = 1, m.coat_roughness.value = 0.4f;
    add_case("white coated", m, true, 0.16f);
    m.base_color.value = {0.8f, 0.5f, 0.3f}, m.base_metalness.value = 0.5f, m.coat_color.value = {0.9f, 0.7f, 1};
    add_case("coloured coated", m, false, 0.16f);
    m = white;
    m.fuzz_weight.value = 1, m.subsurface_weight.value = 0.5f, m.subsurface_color.value = {1, 1, 1};
    add_case("white fuzzy", m, true, 0.25f);
    m.fuzz_roughness.value = 0.1f, m.fuzz_color.value = {0.2f, 0.5f, 1}, m.coat_weight = 0.7f,
    m.coat_roughness.value = 0.6f;
    add_case("coated and fuzzy", m, false, 0.25f);
    m = white;
    m.transmission_weight.value = 1;
    add_case("glass", m, true, 0.12f);
    m.transmission_weight.value = 0.6f, m.base_metalness = {0.5f, level}, m.transmission_color.value = {1, 0.8f, 0.6f};
    add_case("of everything", m, false, 0.12f);
    m = white;
    m.specular_roughness = {1, level}, m.coat_weight = 0.5f, m.coat_roughness.value = 0.3f;
    add_case("white textured", m, true, 0.09f);
    m = white;
    m.coat_roughness = {1, level}, m.coat_weight = 0.6f, m.fuzz_roughness = {1, level}, m.fuzz_weight.value = 0.5f;
    add_case("white under textured layers", m, true, 0.09f);
    m = white;
    add_films(add_case, white, level);
    m = white;
    m.geometry_thin_walled = true, m.transmission_weight.value = 1;
    add_case("pane", m, true, 0.25f);
    m.transmission_color.value = {0.5f, 0.9f, 0.8f}, m.thin_film_weight.value = 1, m.transmission_weight.value = 0.5f;
    m.subsurface_weight.value = 0.8f, m.subsurface_scatter_anisotropy = 0.4f;
    add_case("petal", m, false, 0.25f);
    m = white;
    m.geometry_thin_walled = true, m.subsurface_weight.value = 0.7f, m.subsurface_color.value = {1, 1, 1};
    add_case("white paper", m, true, 0.25f);
}

/// Of cases that are there already, whose numbers are those of their materials; the last one mixes a mix.
void add_mixes(std::vector<MaterialCase>& out, TextureId level) {
    const auto number = [&](const std::string& name) {
        for (size_t i = 0; i < out.size(); ++i)
            if (out[i].name == name) return MaterialId(static_cast<uint32_t>(i));
        throw std::runtime_error("no case is called " + name);
    };
    const auto mix = [&](const std::string& a, const std::string& b, FloatInput weight) {
        const MaterialCase &first = out[index(number(a))], &second = out[index(number(b))];
        MaterialCase c{"mix of " + a + " and " + b, MixMaterial{number(a), number(b), weight},
                       first.lossless && second.lossless, std::min(first.peak, second.peak)};
        c.energy_error = std::max(first.energy_error, second.energy_error);
        c.reciprocal = first.reciprocal && second.reciprocal;
        out.push_back(c);
    };
    mix("diffuse two-sided white", "conductor white alpha 0.6", {0.3f});
    mix("diffuse", "conductor gold alpha 0.2", {0.8f, level});
    mix("leaf", "diffuse rough white 1.", {0.5f});
    mix("mix of leaf and diffuse rough white 1.", "conductor white alpha 0.3", {0.25f});
}

}  // namespace

MaterialScene::MaterialScene() {
    Scene scene;
    const auto texture = [&](Rgb value) { return add<TextureId>(scene.textures, Texture{ConstantTexture{value}}); };
    const TextureId white = texture({1, 1, 1}), orange = texture({0.8f, 0.5f, 0.2f}), level = texture({0.7f, 0, 0});
    const TextureId black = texture({0, 0, 0}), level_all = texture({0.7f, 0.2f, 0.5f}),
                    level_rest = texture({0.3f, 0.8f, 0.5f}), rest = texture({0.2f, 0.1f, 0.6f});
    cases_.push_back({"diffuse", DiffuseMaterial{orange, false}});
    cases_.push_back({"diffuse two-sided white", DiffuseMaterial{white, true}, true});
    for (const float roughness : {1e-3f, 0.5f, 1.0f})
        cases_.push_back({"diffuse rough white " + number(roughness), DiffuseMaterial{white, true, roughness}, true});
    cases_.push_back({"diffuse rough", DiffuseMaterial{orange, false, 0.7f}});
    cases_.push_back({"leaf", DiffuseTransmissionMaterial{orange, rest}});
    cases_.push_back({"diffuse transmission lossless", DiffuseTransmissionMaterial{level_rest, level_all}, true});
    cases_.push_back({"diffuse transmission only", DiffuseTransmissionMaterial{black, white}, true});
    cases_.push_back({"refraction 1.5", RefractionMaterial{1.5f}});
    cases_.push_back({"refraction 0.6", RefractionMaterial{0.6f}});
    cases_.push_back({"glass 1.5", GlassMaterial{1.5f, {1, 1, 1}, {1, 1, 1}}, true});
    cases_.push_back({"glass 0.7 tinted", GlassMaterial{0.7f, {0.9f, 1, 1}, {1, 0.5f, 1}}});
    cases_.push_back({"mirror", MirrorMaterial{{1, 1, 1}}, true});
    add_conductors(cases_, white, orange);
    add_textured(cases_, white, level);
    add_glass(cases_);
    add_open_pbr(cases_, level);

    add_mixes(cases_, level);

    const ShapeId shape = add<ShapeId>(scene.shapes, Shape{Rectangle{}});
    for (const MaterialCase& c : cases_) {
        const MaterialId id = add<MaterialId>(scene.materials, c.material);
        add<InstanceId>(scene.instances, Instance{shape, id, {}});
    }
    Diagnostics diagnostics;
    scene_ = std::move(make_shading_scene(std::move(scene), diagnostics)).value();
}

Bsdf MaterialScene::bsdf(size_t i, Vec3 ng, Vec3 ns) const {
    SurfacePoint point = receiver({}, ng);
    point.ns = ns;
    point.instance = static_cast<uint32_t>(i);
    return make_bsdf(scene_, point);
}

const MaterialScene& material_scene() {
    static const MaterialScene scene;
    return scene;
}

std::vector<Normals> normal_pairs() {
    const Vec3 up = normalize(Vec3{0.1f, 0.9f, -0.3f});
    return {{up, up}, {up, normalize(up + Vec3{0.5f, 0, 0.2f})}, {{0, 0, -1}, normalize(Vec3{0.9f, 0, -0.5f})}};
}

Magnifier::Magnifier(Vec3d axis, double scale) : frame_(Frame3d::from_z(normalize(axis))), scale_(scale) {}

Vec3d Magnifier::magnified(Vec3d w) const {
    const Vec3d l = frame_.to_local(w);
    const double r = std::sqrt(l.x * l.x + l.y * l.y);
    if (!(r > 0)) return l;
    const double t = (l.z > 0 ? r / (1 + l.z) : (1 - l.z) / r) / scale_, s = 2 * t / (1 + t * t);
    return {l.x / r * s, l.y / r * s, (1 - t) * (1 + t) / (1 + t * t)};
}

Vec3d Magnifier::original(Vec3d m) const {
    const double r = std::sqrt(m.x * m.x + m.y * m.y);
    if (!(r > 0)) return frame_.to_world(m);
    const double t = (m.z > 0 ? r / (1 + m.z) : (1 - m.z) / r) * scale_, s = 2 * t / (1 + t * t);
    return frame_.to_world({m.x / r * s, m.y / r * s, (1 - t) * (1 + t) / (1 + t * t)});
}

double Magnifier::solid_angle_ratio(Vec3d m) const {
    // dω = 4 t dt dφ / (1 + t²)², t' = t / scale; 1 + t'² = 2 / (1 + cos θ').
    const double t2 = (1 - m.z) / max_of(1 + m.z, 1e-300), a = (1 + t2) / (1 + scale_ * scale_ * t2);
    return scale_ * scale_ * a * a;
}

Vec3d mirrored(Vec3 wo, Vec3 n) {
    const Vec3d o = wo, z = n;
    return z * (2 * dot(o, z)) - o;
}

Vec3d refracted(Vec3 wo, Vec3 n, double eta) {
    const Vec3d o = wo;
    const bool outside = dot(o, Vec3d(n)) > 0;
    const Vec3d z = outside ? Vec3d(n) : -Vec3d(n);
    const double ratio = outside ? 1 / eta : eta, cosine = dot(o, z),
                 squared = 1 - ratio * ratio * (1 - cosine * cosine);
    return squared > 0 ? z * (ratio * cosine - std::sqrt(squared)) - o * ratio : -o;
}

std::optional<Vec3> sampled_as_evaluated(const Bsdf& bsdf, Vec3 wo, Random& random) {
    const float uc = random.uniform();
    const auto s = sample(bsdf, wo, uc, random.uniform2());
    if (!s) return std::nullopt;
    const BsdfEval e = eval(bsdf, wo, s->wi);
    EXPECT_EQ(s->pdf, e.pdf);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(s->weight[c] * s->pdf, e.f_cos[c], 1e-5f * e.f_cos[c] + 1e-12f);
    return s->wi;
}

}  // namespace steradian::test
