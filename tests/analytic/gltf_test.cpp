// glTF files whose pictures are known, from the bytes of the file to the pixels: the outside catalogue's, where it is
// there, and one for each extension.
#include <gtest/gtest.h>
#include <rapidjson/document.h>

#include <cmath>
#include <cstdio>
#include <functional>

#include "analytic/check.h"
#include "gltf/gltf_builder.h"
#include "support/support.h"

namespace steradian::analytic {
namespace {

using rapidjson::Value;

void expect_as_judged(const Case& c, const PreparedCase& prepared) {
    const Judgement j = judge(c, prepared);
    for (const std::string& failure : j.failures) ADD_FAILURE() << c.id << ": " << failure;
    std::printf("%-44s %2u x %6llu samples, error %8.2g, standard error %8.2g\n", c.id.c_str(), j.pictures,
                static_cast<unsigned long long>(j.samples), j.worst_error, j.worst_standard_error);
}

Color color_of(const std::string& name) {
    if (name == "red") return {1, 0, 0};
    if (name == "green") return {0, 1, 0};
    if (name == "blue") return {0, 0, 1};
    return name == "black" ? Color{0, 0, 0} : Color{1, 1, 1};
}

/// Regions by their names, where the catalogue says more than the mean.
void add_regions(const Value& entry, uint32_t w, uint32_t h, std::vector<Expected>& out) {
    const auto add = [&](uint32_t x0, uint32_t y0, uint32_t x1, uint32_t y1, Color value) {
        out.push_back({x0, y0, x1, y1, value, true});
    };
    if (entry.HasMember("quadrants")) {
        const Value& q = entry["quadrants"];
        add(0, 0, w / 2, h / 2, color_of(q["top-left"].GetString()));
        add(w / 2, 0, w, h / 2, color_of(q["top-right"].GetString()));
        add(0, h / 2, w / 2, h, color_of(q["bottom-left"].GetString()));
        add(w / 2, h / 2, w, h, color_of(q["bottom-right"].GetString()));
    }
    if (entry.HasMember("halves")) {
        add(0, 0, w / 2, h, color_of(entry["halves"]["left"].GetString()));
        add(w / 2, 0, w, h, color_of(entry["halves"]["right"].GetString()));
    }
    if (entry.HasMember("pixels")) {
        const double inside = entry["pixels"]["inside central 32x32"].GetDouble();
        const double outside = entry["pixels"]["elsewhere"].GetDouble();
        const uint32_t x0 = w / 2 - 16, x1 = w / 2 + 16, y0 = h / 2 - 16, y1 = h / 2 + 16;
        add(x0, y0, x1, y1, {inside, inside, inside});
        const Color dark{outside, outside, outside};
        add(0, 0, w, y0, dark), add(0, y1, w, h, dark), add(0, y0, x0, y1, dark), add(x1, y0, w, y1, dark);
    }
}

Case case_of(const Value& entry) {
    Case c;
    c.id = entry["id"].GetString();
    c.tolerance = entry["tol"].GetDouble();
    const Value& expect = entry["expect"];
    const bool every_pixel = entry.HasMember("every_pixel");
    const uint32_t w = entry["cam"]["w"].GetUint(), h = entry["cam"]["h"].GetUint();
    c.expected = {{0, 0, 0, 0, {expect[0].GetDouble(), expect[1].GetDouble(), expect[2].GetDouble()}, every_pixel}};
    add_regions(entry, w, h, c.expected);
    // Where the value holds for every pixel, every sample has it.
    const bool exact = std::string_view(entry["cls"].GetString()) == "exact";
    c.kind = exact || every_pixel ? CaseClass::zero_variance : CaseClass::stochastic;
    // The value is that of the edge's middle: over the picture the light changes by 2e-4 of it, and samples within a
    // rounding error of the edge, which is a border of pixels, may fall on either side.
    if (c.id == "A10_shadow_edge_half") c.kind = CaseClass::zero_variance, c.tolerance = 1e-3;
    return c;
}

RenderSettings settings_of(RenderSettings settings, uint32_t width, uint32_t height, uint32_t max_depth) {
    settings.width = width, settings.height = height;
    settings.integrator = IntegratorKind::path;
    settings.max_depth = max_depth;
    settings.filter = {FilterKind::box, 0.5f};
    settings.samples_per_pixel = 64;
    return settings;
}

TEST(GltfCatalogue, Scenes) {
    const auto shared = test::shared_folder();
    if (!shared || !std::filesystem::exists(*shared / "verify/analytic/cases.json"))
        GTEST_SKIP() << "verify/analytic is not there";
    const std::string text = test::slurp(*shared / "verify/analytic/cases.json");
    rapidjson::Document document;
    document.Parse<rapidjson::kParseFullPrecisionFlag>(text.data(), text.size());
    ASSERT_FALSE(document.HasParseError());
    EXPECT_GE(document.Size(), 35u);
    for (const Value& entry : document.GetArray()) {
        const Case c = case_of(entry);
        LoadOptions options;
        if (entry["env"].IsNull()) {
            options.environment.replace = EnvironmentOptions::None{};
        } else {
            const float radiance = entry["env"].GetFloat();
            options.environment.replace = Rgb{radiance, radiance, radiance};
        }
        auto loaded = load_scene((*shared / "verify/analytic/scenes" / (c.id + ".gltf")).string(), options);
        ASSERT_TRUE(loaded.ok()) << loaded.error().str();
        const Value& camera = entry["cam"];
        loaded->settings =
            settings_of(loaded->settings, camera["w"].GetUint(), camera["h"].GetUint(), entry["max_depth"].GetUint());
        // Where triangles stand for a smooth surface, one sample in a thousand is lost at grazing angles.
        if (entry.HasMember("every_pixel")) loaded->settings.samples_per_pixel = 1024;
        expect_as_judged(c, PreparedCase(std::move(*loaded)));
    }
}

// --- One file for each extension -----------------------------------------------------------------------------------

/// A floor of 4 by 4 m in the plane y = 0, seen from straight above at the origin, with a point light of 10 W/sr at
/// (1.2, 1.6, 0): 2 m away, at a cosine of 0.8. u = (x + 2) / 4, v = (z + 2) / 4.
struct FloorFile {
    std::string material;                                    ///< members of the floor's
    std::string attributes = {}, primitive = {}, node = {};  ///< more members of the floor's
    std::string light = "\"type\": \"point\", \"intensity\": 10";
    std::string light_rotation = "0, 0, 0, 1", light_place = "1.2, 1.6, 0";
    std::string extensions = {}, more = {}, more_materials = {};
    test::GltfBuilder builder = {};
    LoadOptions options = {};
    bool quantized = false;         ///< then as normalised integers; positions are half as large
    std::string approximated = {};  ///< what the reader says that the picture does not show as asked; empty: nothing

    LoadedScene load() {
        const std::string_view normalized = ", \"normalized\": true";
        const int p = quantized
                          ? builder.accessor<int16_t>(
                                "VEC3", 5122, 3,
                                {-32767, 0, 32767, 32767, 0, 32767, 32767, 0, -32767, -32767, 0, -32767}, normalized)
                          : builder.floats("VEC3", 3, {-2, 0, 2, 2, 0, 2, 2, 0, -2, -2, 0, -2});
        const int n = quantized ? builder.accessor<int8_t>("VEC3", 5120, 3,
                                                           {0, 127, 0, 0, 127, 0, 0, 127, 0, 0, 127, 0}, normalized)
                                : builder.floats("VEC3", 3, {0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0});
        const int uv =
            quantized ? builder.accessor<int16_t>("VEC2", 5122, 2, {0, 32767, 32767, 32767, 32767, 0, 0, 0}, normalized)
                      : builder.floats("VEC2", 2, {0, 1, 1, 1, 1, 0, 0, 0});
        const int i = builder.accessor<uint16_t>("SCALAR", 5123, 1, {0, 1, 2, 0, 2, 3});
        const auto number = [](int k) { return std::to_string(k); };
        const std::string text = builder.text(
            "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": " + number(p) + ", \"NORMAL\": " +
            number(n) + ", \"TEXCOORD_0\": " + number(uv) + attributes + "}, \"indices\": " + number(i) +
            ", \"material\": 0" + primitive + "}]}], \"materials\": [{" + material + "}" + more_materials +
            "], \"cameras\": [{\"type\": \"perspective\", \"perspective\": {\"yfov\": 0.0008, \"aspectRatio\": 1, "
            "\"znear\": 0.1}}], \"nodes\": [{\"mesh\": 0" +
            node + "}, {\"camera\": 0, \"matrix\": [1,0,0,0, 0,0,-1,0, 0,1,0,0, 0,1,0,1]}, {\"translation\": [" +
            light_place + "], \"rotation\": [" + light_rotation +
            "], \"extensions\": {\"KHR_lights_punctual\": {\"light\": 0}}}], \"extensions\": {\"KHR_lights_punctual\": "
            "{\"lights\": [{" +
            light + "}]}" + extensions + "}" + more);
        return test::good_gltf(text, options);
    }
};

/// Lambert's surface: reflectance ρ, no gloss.
std::string matte(const std::string& color, const std::string& texture = {}) {
    return "\"pbrMetallicRoughness\": {\"metallicFactor\": 0, \"baseColorFactor\": " + color + texture +
           "}, \"extensions\": {\"KHR_materials_specular\": {\"specularFactor\": 0}}";
}

constexpr double kLit = 10 * 0.8 / 4 / std::numbers::pi;  ///< radiance of reflectance 1

void expect_floor(const std::string& id, FloorFile file, Color value, double tolerance = 1e-5,
                  CaseClass kind = CaseClass::zero_variance) {
    SCOPED_TRACE(id);
    Case c;
    c.id = id;
    c.expected = {{0, 0, 0, 0, value}};
    c.tolerance = tolerance;
    c.kind = kind;
    LoadedScene loaded = file.load();
    if (!file.approximated.empty()) {
        ASSERT_EQ(loaded.fidelity.warnings().size(), 1u);
        EXPECT_NE(loaded.fidelity.warnings()[0].str().find(file.approximated), std::string::npos);
        loaded.fidelity = {};
    }
    const auto environment = file.options.environment.replace;
    if (environment)
        if (const auto* radiance = std::get_if<Rgb>(&*environment)) loaded.scene.lights = {EnvironmentLight{*radiance}};
    loaded.settings = settings_of(loaded.settings, 8, 8, 8);
    expect_as_judged(c, PreparedCase(std::move(loaded)));
}
Color lit(double r, double g, double b) { return {kLit * r, kLit * g, kLit * b}; }

TEST(GltfCases, Lights) {
    expect_floor("matte", {.material = matte("[0.25, 0.5, 1, 1]")}, lit(0.25, 0.5, 1));
    expect_floor(
        "point light of a colour",
        {.material = matte("[1, 1, 1, 1]"), .light = "\"type\": \"point\", \"intensity\": 10, \"color\": [0.5, 1, 0]"},
        lit(0.5, 1, 0));
    FloorFile lumens{.material = matte("[1, 1, 1, 1]"), .light = "\"type\": \"point\", \"intensity\": 6830"};
    lumens.options.gltf_light_units = GltfLightUnits::photometric;
    expect_floor("candela of an exporter", lumens, lit(1, 1, 1));
    // Turned by -90 degrees about x, -z points down.
    const std::string down = "-0.7071067811865476, 0, 0, 0.7071067811865476";
    const double sun = 3 / std::numbers::pi;
    expect_floor("directional light along its node",
                 {.material = matte("[1, 1, 1, 1]"),
                  .light = "\"type\": \"directional\", \"intensity\": 3",
                  .light_rotation = down},
                 {sun, sun, sun});
    // 0.8 between the cosines 1 and 0.5 of its cones is 0.6; squared.
    const std::string cones = "\"spot\": {\"outerConeAngle\": 1.0471975511965976}";
    expect_floor("spot between its cones",
                 {.material = matte("[1, 1, 1, 1]"),
                  .light = "\"type\": \"spot\", \"intensity\": 10, " + cones,
                  .light_rotation = down},
                 lit(0.36, 0.36, 0.36));
    expect_floor("spot that looks elsewhere",
                 {.material = matte("[1, 1, 1, 1]"), .light = "\"type\": \"spot\", \"intensity\": 10, " + cones},
                 {0, 0, 0}, 1e-7);
}

TEST(GltfCases, Emission) {
    expect_floor(
        "emissive strength",
        {.material = "\"emissiveFactor\": [1, 0.5, 0.25], \"pbrMetallicRoughness\": {\"metallicFactor\": 0, "
                     "\"baseColorFactor\": [0, 0, 0, 1]}, \"extensions\": {\"KHR_materials_specular\": "
                     "{\"specularFactor\": 0}, \"KHR_materials_emissive_strength\": {\"emissiveStrength\": 8}}"},
        {8, 4, 2});
    expect_floor("unlit",
                 {.material = "\"pbrMetallicRoughness\": {\"baseColorFactor\": [0.25, 0.5, 0.75, 1]}, \"extensions\": "
                              "{\"KHR_materials_unlit\": {}}"},
                 {0.25, 0.5, 0.75});
}

/// A PNG of 2 × 2 RGB texels: black and (51, 102, 255) above, white and grey (128) below.
constexpr std::string_view kTexture =
    ", \"images\": [{\"uri\": \"data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAIAAAD91JpzAAAAFklEQVR42mNgYGAwTvvP8P///4aGBgAfiwYWiKcaPgAAAABJRU5ErkJggg=="
    "\"}], \"samplers\": [{\"magFilter\": 9728, \"wrapS\": "
    "10497, \"wrapT\": 10497}], \"textures\": [{\"source\": 0, \"sampler\": 0}]";

double linear(int code) {
    const double c = code / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

TEST(GltfCases, TexturesAndColoursOfVertices) {
    const auto texture = [](const std::string& transform) {
        return ", \"baseColorTexture\": {\"index\": 0, \"extensions\": {\"KHR_texture_transform\": {" + transform +
               "}}}";
    };
    const Color blue = lit(linear(51), linear(102), 1);
    // The middle of the floor is (0.5, 0.5); texels are half a unit wide.
    expect_floor(
        "texture, moved",
        {.material = matte("[1, 1, 1, 1]", texture("\"offset\": [0.25, -0.25]")), .more = std::string(kTexture)}, blue);
    expect_floor("texture, scaled",
                 {.material = matte("[1, 1, 1, 1]", texture("\"scale\": [1.5, 0.5]")), .more = std::string(kTexture)},
                 blue);
    // (0.5, 0.5) turned by 90 degrees is (0.5, -0.5), moved by (0.25, -0.25): (0.75, -0.75), which is (0.75, 0.25).
    expect_floor(
        "texture, turned",
        {.material = matte("[1, 1, 1, 1]", texture("\"rotation\": 1.5707963267948966, \"offset\": [0.25, -0.25]")),
         .more = std::string(kTexture)},
        blue);
    // By 45 degrees: (√½, 0), moved by (0, 0.25): the texel to the right above, unless it is turned the other way.
    expect_floor(
        "texture, turned by 45 degrees",
        {.material = matte("[1, 1, 1, 1]", texture("\"rotation\": 0.78539816339744831, \"offset\": [0, 0.25]")),
         .more = std::string(kTexture)},
        blue);
    FloorFile painted{.material = matte("[1, 0.5, 1, 1]", texture("\"offset\": [0.25, -0.25]")),
                      .more = std::string(kTexture)};
    // Half way between the corners (0, 0.5, 0.25) and (1, 0.5, 0.75) of the diagonal that both triangles share.
    painted.attributes = ", \"COLOR_0\": " + std::to_string(painted.builder.floats(
                                                 "VEC3", 3, {0, .5f, .25f, 0, 0, 0, 1, .5f, .75f, 1, 1, 1}));
    expect_floor("factor, texture and colours of vertices", painted,
                 lit(linear(51) * 0.5, linear(102) * 0.5 * 0.5, 0.5), 2e-4);
}

TEST(GltfCases, NormalMaps) {
    // One texel, (204, 128, 230) / 255: of the normal (0.6, 0.0039, 0.8039) in tangent space. u is +x, -v is -z.
    const double x = 2 * 204 / 255.0 - 1, y = 2 * 128 / 255.0 - 1, z = 2 * 230 / 255.0 - 1;
    const std::string map =
        ", \"images\": [{\"uri\": \"data:image/png;base64,"
        "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR42mM40/AMAAROAjPJncPXAAAAAElFTkSuQmCC"
        "\"}], \"textures\": "
        "[{\"source\": 0}]";
    for (const double scale : {1.0, 0.5, -0.25}) {
        const double size = std::sqrt(scale * scale * (x * x + y * y) + z * z);
        // The light is at (0.6, 0.8, 0). Its image below the surface is behind all of these normals.
        const double cosine = (0.6 * x * scale + 0.8 * z) / size;
        expect_floor("normal map, scale " + std::to_string(scale),
                     {.material = matte("[1, 1, 1, 1]") +
                                  ", \"normalTexture\": {\"index\": 0, \"scale\": " + std::to_string(scale) + "}",
                      .more = map},
                     lit(cosine / 0.8, cosine / 0.8, cosine / 0.8));
    }
    // Tangents of the file: u along -z, so that the light is along what the map calls down.
    FloorFile given{.material = matte("[1, 1, 1, 1]") + ", \"normalTexture\": {\"index\": 0}", .more = map};
    std::vector<float> tangents;
    for (int i = 0; i < 4; ++i) tangents.insert(tangents.end(), {0, 0, -1, 1});
    given.attributes = ", \"TANGENT\": " + std::to_string(given.builder.floats("VEC4", 4, tangents));
    // up = n × t = y × -z = -x.
    const double cosine = (-0.6 * y + 0.8 * z) / std::sqrt(x * x + y * y + z * z);
    expect_floor("normal map, with tangents", given, lit(cosine / 0.8, cosine / 0.8, cosine / 0.8));
}

/// White surfaces in a white sky show it: what the layers take from each other is nothing but the sky.
TEST(GltfCases, WhiteFurnaces) {
    LoadOptions white;
    white.environment.replace = Rgb{1, 1, 1};
    const auto furnace = [&](const std::string& id, const std::string& pbr, const std::string& extensions) {
        expect_floor("white furnace: " + id,
                     {.material = "\"pbrMetallicRoughness\": {\"baseColorFactor\": [1, 1, 1, 1], " + pbr +
                                  "}, \"extensions\": {" + extensions + "}",
                      .options = white},
                     {1, 1, 1}, 2e-3, CaseClass::stochastic);
    };
    furnace("metal", "\"roughnessFactor\": 0.6", "");
    furnace("dielectric", "\"roughnessFactor\": 0.4, \"metallicFactor\": 0", "");
    furnace("index", "\"roughnessFactor\": 0.4, \"metallicFactor\": 0", "\"KHR_materials_ior\": {\"ior\": 2}");
    furnace("grain", "\"roughnessFactor\": 0.3", "\"KHR_materials_anisotropy\": {\"anisotropyStrength\": 0.5}");
    furnace("clearcoat", "\"roughnessFactor\": 0.5, \"metallicFactor\": 0",
            "\"KHR_materials_clearcoat\": {\"clearcoatFactor\": 1}");
}

/// Of the light that is scattered, that part passes the sheet; from below is what has passed.
TEST(GltfCases, DiffuseTransmission) {
    const std::string material =
        "\"pbrMetallicRoughness\": {\"metallicFactor\": 0, \"baseColorFactor\": [0.8, 0.4, 0.2, "
        "1]}, \"extensions\": {\"KHR_materials_specular\": {\"specularFactor\": 0}, "
        "\"KHR_materials_diffuse_transmission\": {\"diffuseTransmissionFactor\": 0.25, "
        "\"diffuseTransmissionColorFactor\": [0.1, 1, 0.6]}}";
    expect_floor("diffuse transmission, lit from above", {.material = material},
                 lit(0.75 * 0.8, 0.75 * 0.4, 0.75 * 0.2));
    expect_floor("diffuse transmission, lit from below", {.material = material, .light_place = "1.2, -1.6, 0"},
                 lit(0.25 * 0.1, 0.25 * 1, 0.25 * 0.6));
}

/// White sky on both sides, from straight above. Of one boundary of index 1.5 the reflectance is 0.04.
TEST(GltfCases, Transmission) {
    LoadOptions white;
    white.environment.replace = Rgb{1, 1, 1};
    const auto expect = [&](const std::string& id, const std::string& pbr, const std::string& extensions, Color value) {
        expect_floor(id,
                     {.material = "\"pbrMetallicRoughness\": {\"metallicFactor\": 0, " + pbr +
                                  "}, \"extensions\": {\"KHR_materials_transmission\": {\"transmissionFactor\": 1}" +
                                  extensions + "}",
                      .options = white,
                      .approximated = "do not shine through"},
                     value, 2e-3, CaseClass::stochastic);
    };
    const double r = 0.04;
    // A sheet: everything that bounces within it leaves on one of its sides.
    const auto sheet = [&](double t) {
        const double series = (1 - r) * (1 - r) / (1 - r * r * t * t);
        return r + series * r * t * t + series * t;
    };
    const std::string tint = "\"baseColorFactor\": [1, 0.5, 0.25, 1]";
    const Color thin{1, sheet(0.5), sheet(0.25)};
    expect("thin sheet", tint + ", \"roughnessFactor\": 0", "", thin);
    expect("thin sheet, as good as smooth", tint + ", \"roughnessFactor\": 0.02", "", thin);
    expect("rough white sheet", "\"roughnessFactor\": 0.5", "", {1, 1, 1});
    // A body: what is within it appears darker by the square of the index.
    const auto body = [&](double t) { return r + (1 - r) * t / (1.5 * 1.5); };
    expect("solid body", tint + ", \"roughnessFactor\": 0", ", \"KHR_materials_volume\": {\"thicknessFactor\": 1}",
           {body(1), body(0.5), body(0.25)});
}

/// On black: the distribution of the extension, (2 + 1/α) sin(θ_h)^(1/α) / 2π with α the square of the roughness, over
/// 4 (cos θ_i + cos θ_o - cos θ_i cos θ_o).
TEST(GltfCases, Sheen) {
    for (const double roughness : {0.6, 0.8, 1.0}) {
        const double inverse = 1 / (roughness * roughness), sine2 = (1 - 0.8) / 2;
        const double d = (2 + inverse) * std::pow(sine2, inverse / 2) / (2 * std::numbers::pi);
        const double value = d / (4 * (0.8 + 1 - 0.8)) * 0.8 * 10 / 4;
        expect_floor(
            "sheen, roughness " + std::to_string(roughness),
            {.material = "\"pbrMetallicRoughness\": {\"metallicFactor\": 0, \"baseColorFactor\": [0, 0, 0, 1]}, "
                         "\"extensions\": {\"KHR_materials_specular\": {\"specularFactor\": 0}, "
                         "\"KHR_materials_sheen\": {\"sheenColorFactor\": [0.5, 0.25, 1], "
                         "\"sheenRoughnessFactor\": " +
                         std::to_string(roughness) + "}}",
             .approximated = "fuzz"},
            {value * 0.5, value * 0.25, value});
    }
}

/// Positions, normals and texture coordinates as normalised integers.
TEST(GltfCases, Quantization) {
    const std::string moved =
        ", \"baseColorTexture\": {\"index\": 0, \"extensions\": {\"KHR_texture_transform\": {\"offset\": [0.25, "
        "-0.25]}}}";
    FloorFile file{.material = matte("[1, 1, 1, 1]", moved),
                   .node = ", \"scale\": [2, 1, 2]",
                   .more = std::string(kTexture) + ", \"extensionsRequired\": [\"KHR_mesh_quantization\"]"};
    file.quantized = true;
    expect_floor("quantised", file, lit(linear(51), linear(102), 1));
}

TEST(GltfCases, ChoicesOfTheCaller) {
    FloorFile file{.material = matte("[1, 0, 0, 1]"),
                   .primitive =
                       ", \"extensions\": {\"KHR_materials_variants\": {\"mappings\": [{\"material\": 1, "
                       "\"variants\": [0]}]}}",
                   .extensions = ", \"KHR_materials_variants\": {\"variants\": [{\"name\": \"green\"}]}",
                   .more_materials = ", {" + matte("[0, 1, 0, 1]") + "}"};
    expect_floor("no variant", file, lit(1, 0, 0));
    file.options.gltf_variant = "green";
    expect_floor("variant", file, lit(0, 1, 0));
}

/// Two floors, one a metre below the other: what is seen is the upper one.
TEST(GltfCases, Instances) {
    FloorFile file{.material = matte("[0.5, 0.5, 0.5, 1]")};
    const int t = file.builder.floats("VEC3", 3, {0, -6, 0, 0, -5, 0});
    file.node =
        ", \"translation\": [0, 5, 0], \"extensions\": {\"EXT_mesh_gpu_instancing\": {\"attributes\": "
        "{\"TRANSLATION\": " +
        std::to_string(t) + "}}}";
    expect_floor("instances", file, lit(0.5, 0.5, 0.5));
}

}  // namespace
}  // namespace steradian::analytic
