// Findings say where in which file: line and column, JSON pointer, byte; and what readers say is among them.
#include <algorithm>
#include <fstream>
#include <sstream>

#include "lint_scene.h"
#include "support/support.h"

namespace steradian::test {
namespace {

using Lines = std::vector<std::string>;

class LintFiles : public testing::Test {
protected:
    std::vector<std::string> lines(const std::string& name, const std::string& content, const LintOptions& lint = {}) {
        if (!content.empty()) spit(folder_.file(name), content);
        LoadOptions options;
        options.locations = true;
        const auto loaded = load_scene(folder_.file(name), options);
        if (!loaded) return {loaded.error().str()};
        const auto report = steradian::lint(*loaded, lint);
        if (!report) return {report.error().str()};
        std::vector<std::string> out;
        for (const Finding& f : report->findings) {
            std::string line = f.str();
            const std::string folder = folder_.path().string() + "/";
            if (line.starts_with(folder)) line.erase(0, folder.size());
            out.push_back(line.substr(0, line.find(": ", line.find(": ") + 2)) + " " + std::string(f.rule));
        }
        return out;
    }

    TemporaryFolder folder_;
};

/// The studio of a bare model is as large as the largest object: it is not what that is compared with.
TEST_F(LintFiles, GiantsInAStudio) {
    const auto chairs = [](const std::string& scale) {
        std::string text;
        for (const std::string& s : {std::string("1"), scale})
            text += "v 0 0 0\nv " + s + " 0 0\nv 0 " + s + " 0\nv 0 0 " + s + "\n";
        return "mtllib ab.mtl\n" + text +
               "usemtl a\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\nusemtl b\nf 5 7 6\nf 5 6 8\nf 5 8 7\nf 6 7 8\n";
    };
    const auto of_scale = [](const Lines& lines) {
        return std::count_if(lines.begin(), lines.end(), [](const std::string& l) { return l.ends_with(" scale"); });
    };
    spit(folder_.file("ab.mtl"), "newmtl a\nKd 0.5 0 0\nnewmtl b\nKd 0 0.5 0\n");
    EXPECT_EQ(of_scale(lines("near.obj", chairs("900"))), 0);
    EXPECT_EQ(of_scale(lines("giant.obj", chairs("1100"))), 1);
}

TEST_F(LintFiles, OurOwnFormat) {
    EXPECT_EQ(
        lines("a.json", R"({
  "version": 1, "camera": {"position": [0, 0, 5], "look_at": [0, 0, 9]},
  "textures": {"spare": {"type": "checkerboard"}},
  "materials": {
    "gold/leaf": {"type": "mirror", "reflectance": 2},
    "window": {"type": "glass"}
  },
  "objects": [
    {"type": "sphere", "material": "gold/leaf"},
    {"type": "rectangle", "center": [0, 4, 0], "material": "window"},
    {"type": "sphere", "center": [4, 0, 0], "material": {"type": "glass", "eta": 1}}
  ],
  "lights": [{"type": "environment", "radiance": 1},
             {"type": "point", "position": [0, 0.5, 0], "intensity": 1}]
})"),
        (Lines{"a.json:2:27 (/camera): warning empty-view", "a.json:3:25 (/textures/spare): note unused",
               "a.json:5:18 (/materials/gold~1leaf): warning albedo-above-one",
               "a.json:10:5 (/objects/1): warning open-glass", "a.json:11:57 (/objects/2/material): warning ior-one",
               "a.json:14:14 (/lights/1): warning light-in-wall"}));
}

/// A scene of one ball with this material.
std::string ball_of(const std::string& material) {
    return R"({"version": 1, "camera": {"position": [0, 0, 5], "look_at": [0, 0, 0]},
"textures": {"grain": {"type": "checkerboard"}},
"materials": {"m": {)" +
           material + R"(}},
"objects": [{"type": "sphere", "material": "m"}, {"type": "disk", "center": [3, 0, 0], "material": {"type": "diffuse", "reflectance": "grain"}}],
"lights": [{"type": "environment", "radiance": 1}]})";
}

TEST_F(LintFiles, OptionsWithoutEffect) {
    const std::string pbr = R"("type": "open_pbr", )", solid = pbr + R"("transmission_weight": 1, )";
    /// Of its findings the first is at this key.
    const auto expect = [&](const std::string& material, const std::string& key) {
        const size_t column = std::string(R"("materials": {"m": {)").size() + material.find('"' + key + '"') + 1;
        const Lines out = lines("m.json", ball_of(material));
        ASSERT_FALSE(out.empty()) << material;
        EXPECT_EQ(out[0], "m.json:3:" + std::to_string(column) + " (/materials/m/" + key + "): note no-effect");
    };
    for (const char* option : {R"("transmission_depth": 0.5)",
                               R"("transmission_dispersion_scale": 1)",
                               R"("transmission_color": [1, 0.5, 1])",
                               R"("subsurface_color": 0.5)",
                               R"("subsurface_scatter_anisotropy": 0.5)",
                               R"("fuzz_color": 0.5)",
                               R"("fuzz_roughness": 0.1)",
                               R"("coat_color": [1, 0, 0])",
                               R"("coat_roughness": 0.1)",
                               R"("coat_roughness_anisotropy": 0.1)",
                               R"("coat_ior": 1.5)",
                               R"("thin_film_thickness": 0.2)",
                               R"("thin_film_ior": 1.5)",
                               R"("emission_color": 0.5)",
                               R"("geometry_tangent_rotation": 20)",
                               R"("geometry_tangent": "grain")",
                               R"("coat_color": "grain")",
                               R"("geometry_coat_normal": "grain")",
                               R"("transmission_dispersion_abbe_number": 30)",
                               R"("priority": 0)"}) {
        const std::string text(option);
        expect(pbr + text, text.substr(1, text.find('"', 1) - 1));
    }
    // Without a depth, and without what turns.
    expect(solid + R"("transmission_scatter": 0.5)", "transmission_scatter");
    expect(solid + R"("transmission_scatter": 0.5, "transmission_depth": 0)", "transmission_scatter");
    expect(solid + R"("transmission_depth": 1, "transmission_scatter_anisotropy": 0.5)",
           "transmission_scatter_anisotropy");
    expect(pbr + R"("transmission_weight": 0, "transmission_depth": 1)", "transmission_depth");
    // Metals, and what nothing is seen through.
    expect(pbr + R"("base_metalness": 1, "transmission_weight": 0.5)", "transmission_weight");
    expect(pbr + R"("base_metalness": 1, "subsurface_weight": 0.5)", "subsurface_weight");
    expect(pbr + R"("priority": 1, "transmission_weight": 0)", "priority");
    expect(R"("type": "glass", "interior": {"absorption": 1, "anisotropy": 0.5})", "interior");
    // One finding for what lacks one thing.
    EXPECT_EQ(lines("m.json", ball_of(pbr + R"("coat_roughness": 0.1, "coat_color": 0.5)")).size(), 1u);
}

TEST_F(LintFiles, OptionsThatMayStandThere) {
    const std::string pbr = R"("type": "open_pbr", )", solid = pbr + R"("transmission_weight": 1, )";
    for (
        const std::string& fine :
        {pbr + R"("coat_weight": 0, "coat_roughness": 0.1, "coat_color": 0.5)",  // switched off
         pbr + R"("fuzz_weight": 0, "fuzz_color": 0.5)", pbr + R"("emission_luminance": 0, "emission_color": 0.5)",
         pbr + R"("transmission_weight": 0, "transmission_color": 0.5)",
         // What exporters write of layers that are not there.
         pbr +
             R"("coat_roughness": 0, "coat_ior": 1.6, "coat_color": [1, 1, 1], "fuzz_roughness": 0.5, "transmission_depth": 0,
"transmission_scatter": [0, 0, 0], "transmission_scatter_anisotropy": 0, "emission_color": 1, "subsurface_color": 0.8)",
         pbr + R"("coat_weight": 0.5, "coat_roughness": 0.1, "base_metalness": 0.5)",
         pbr + R"("specular_roughness_anisotropy": 0.5, "geometry_tangent_rotation": 20)",
         pbr + R"("transmission_weight": "grain", "transmission_depth": 1)",
         solid + R"("transmission_depth": 1, "transmission_scatter": 0.5, "transmission_scatter_anisotropy": 0.5)",
         solid + R"("transmission_dispersion_scale": 1, "transmission_dispersion_abbe_number": 30)",
         solid + R"("base_metalness": 0.5, "priority": 1)",
         std::string(R"("type": "glass", "priority": 1, "interior": {"scattering": 1, "anisotropy": 0.5})")})
        EXPECT_EQ(lines("m.json", ball_of(fine)), Lines{}) << fine;
}

TEST_F(LintFiles, ManyOptionsWithoutEffectAreCounted) {
    std::string all;
    for (int i = 0; i < 3000; ++i)
        all += (i ? ",\n\"" : "\"") + std::to_string(i) + R"(": {"type": "open_pbr", "coat_roughness": 0.5})";
    const std::string scene =
        R"({"version": 1, "camera": {"position": [0, 0, 5], "look_at": [0, 0, 0]}, "materials": {)" + all +
        R"(}, "lights": [{"type": "environment", "radiance": 1}]})";
    const Lines out = lines("many.json", scene, {{"unused"}, 0});
    EXPECT_EQ(out.size(), 257u);
}

TEST_F(LintFiles, ElementsWithoutAPlaceOfTheirOwnHaveTheFile) {
    EXPECT_EQ(lines("a.json", R"({"version": 1, "camera": {"position": [0, 0, 5], "look_at": [0, 0, 0]}})"),
              (Lines{"a.json: warning no-light"}));
}

/// Options light a model, whose format has no environment.
TEST_F(LintFiles, WhatToDoAboutTheDarkDependsOnTheFormat) {
    spit(folder_.file("m.gltf"), "{\"asset\": {\"version\": \"2.0\"}}");
    spit(folder_.file("s.json"), R"({"version": 1, "camera": {"position": [0, 0, 5], "look_at": [0, 0, 0]}})");
    const auto hint_for = [&](const std::string& name) -> std::string {
        LoadOptions options;
        options.locations = true;
        options.environment.replace = EnvironmentOptions::None{};
        const auto loaded = load_scene(folder_.file(name), options);
        if (!loaded) return loaded.error().str();
        const auto report = steradian::lint(*loaded);
        if (!report) return report.error().str();
        for (const Finding& f : report->findings)
            if (f.rule == "no-light") return f.hint;
        return "no finding";
    };
    EXPECT_TRUE(hint_for("m.gltf").starts_with("'--env 1,1,1'")) << hint_for("m.gltf");
    EXPECT_TRUE(hint_for("s.json").starts_with("add a light")) << hint_for("s.json");
}

TEST_F(LintFiles, TheVocabularyOfTheCourse) {
    EXPECT_EQ(lines("a.json", R"({
  "integrator": {"type": "path", "point_light_flux": [1, 1, 1]},
  "camera": {"position": [0, 0, 5], "look_at": [0, 0, 0], "fov": 40},
  "textures": {
    "sky": {"type": "constant", "color": [1, 1, 1]}, "tint": {"type": "constant", "color": [1, 1, 1]},
    "spare": {"type": "constant", "color": [1, 1, 1]}
  },
  "materials": {"metal": {"type": "roughconductor", "alpha_x": 0.1, "alpha_y": 0.1, "etaI": [1, 1, 1], "etaT": [1, 1, 1],
                          "k": [3, 3, 3], "texture_name": "tint"}},
  "environment_map": {"texture_name": "sky", "scale": [1, 1, 1]},
  "objects": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material_name": "metal"}]
})"),
              (Lines{"a.json:2:34 (/integrator/point_light_flux): warning input",
                     "a.json:6:14 (/textures/spare): note unused"}));
}

TEST_F(LintFiles, ObjWithMtl) {
    spit(folder_.file("m.mtl"), "newmtl red\nKd 0.5 0 0\nnewmtl bright\nKd 3 0 0\n");
    EXPECT_EQ(lines("a.obj",
                    "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nusemtl red\nf 1 2 3\nf 1 2 4\nusemtl bright\n"
                    "f 1 2 2\n"),
              (Lines{"a.obj:5: warning nan-vertices", "a.obj:9: note degenerate-triangles",
                     "m.mtl:3:8: warning albedo-above-one"}));
}

TEST_F(LintFiles, Ply) {
    EXPECT_EQ(
        lines("a.ply",
              "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
              "element face 2\nproperty list uchar int vertex_indices\nelement wire 1\nproperty int a\nend_header\n"
              "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 1\n7\n"),
        (Lines{"a.ply: note degenerate-triangles", "a.ply:9:9: warning input"}));
}

TEST_F(LintFiles, Gltf) {
    EXPECT_EQ(lines("a.gltf", R"({
  "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_lights_punctual", "EXT_new"],
  "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "range": 5}]}},
  "nodes": [{"mesh": 0}, {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [0, 0, 2]}],
  "materials": [{"name": "unused"},
                {"pbrMetallicRoughness": {"roughnessFactor": 7}, "extensions": {"EXT_new": {}}}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 1},
                             {"attributes": {"POSITION": 0, "NORMAL": 1}}]}],
  "accessors": [{"componentType": 5126, "type": "VEC3", "count": 3, "bufferView": 0},
                {"componentType": 5126, "type": "VEC3", "count": 3, "bufferView": 1}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 36}],
  "buffers": [{"byteLength": 72, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIC/AAAAAAAAAAAAAIC/AAAAAAAAAAAAAIC/"}]
})"),
              (Lines{"a.gltf:3:80 (/extensions/KHR_lights_punctual/lights/0/range): warning not-honoured",
                     "a.gltf:4:13 (/nodes/0): warning coincident-surfaces", "a.gltf:5:17 (/materials/0): note unused",
                     "a.gltf:6:62 (/materials/1/pbrMetallicRoughness/roughnessFactor): warning out-of-range",
                     "a.gltf:6:81 (/materials/1/extensions/EXT_new): warning not-honoured",
                     "a.gltf:8:30 (/meshes/0/primitives/1): warning inverted-normals"}));
}

/// A file that has points alone is a floor to look at.
TEST_F(LintFiles, GltfWithoutTriangles) {
    EXPECT_EQ(lines("a.gltf", R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 0}]}],
  "accessors": [{"componentType": 5126, "type": "VEC3", "count": 3}]})"),
              (Lines{"a.gltf:1:1: warning input", "a.gltf:2:30 (/meshes/0/primitives/0): warning not-honoured"}));
}

TEST_F(LintFiles, RulesAreDisabledAndCounted) {
    std::string objects;
    for (int i = 0; i < 25; ++i)
        objects += std::string(i ? ",\n" : "") + R"({"type": "rectangle", "center": [0, 0, )" + std::to_string(-i) +
                   R"(], "material": {"type": "glass", "eta": 1}})";
    const std::string scene = R"({"version": 1, "camera": {"position": [0, 0, 5], "look_at": [0, 0, 0]},
"lights": [{"type": "environment", "radiance": 1}], "objects": [)" +
                              objects + "]}";
    spit(folder_.file("a.json"), scene);
    EXPECT_EQ(lines("a.json", "").size(), 20u);
    EXPECT_EQ(lines("a.json", "", {{}, 3}).size(), 6u);
    EXPECT_EQ(lines("a.json", "", {{"open-glass"}, 0}).size(), 25u);
    EXPECT_EQ(lines("a.json", "", {{"open-glass", "ior-one"}, 0}).size(), 0u);
    EXPECT_NE(lines("a.json", "", {{"open-glas"}, 0})[0].find("did you mean 'open-glass'?"), std::string::npos);

    const auto loaded = load_scene(folder_.file("a.json"));
    ASSERT_TRUE(loaded.ok());
    const auto report = steradian::lint(*loaded, {{}, 3});
    ASSERT_EQ(report->more.size(), 2u);
    EXPECT_EQ(report->more[0].rule, "ior-one");
    EXPECT_EQ(report->more[0].count, 22u);
    EXPECT_EQ(report->count(Severity::warning), 50u);
    EXPECT_EQ(report->findings[0].where.str(), folder_.file("a.json")) << "no place was asked for";
}

TEST(LintScenes, WhatPrepareRefusesIsAnError) {
    LintScene t;
    t.s.instances[0].material = MaterialId{9};
    EXPECT_EQ(steradian::lint(t.s, t.settings).error().code, ErrorCode::bad_input);
    LintScene mesh;
    Mesh m = triangle();
    m.indices[2] = 7;
    mesh.place(m, MaterialId{0});
    EXPECT_EQ(steradian::lint(mesh.s, mesh.settings).error().code, ErrorCode::bad_input);
}

TEST(LintScenes, AMillionTriangles) {
    LintScene t;
    t.place(slab(500), t.material(GlassMaterial{}), translation(2, 0, 0));
    EXPECT_EQ(t.rules(), (std::map<std::string, int>{}));
    LintScene open;
    open.place(without_last_triangles(slab(500), 1), open.material(GlassMaterial{}), translation(2, 0, 0));
    EXPECT_EQ(open.rules(), (std::map<std::string, int>{{"open-glass", 1}}));
    LintScene turned;
    turned.place(inside_out(slab(500)), turned.material(GlassMaterial{}), translation(2, 0, 0));
    EXPECT_EQ(turned.rules(), (std::map<std::string, int>{{"inverted-normals", 1}}));
}

/// docs/lint.md has a row for each rule, in their order, with its severity and summary.
TEST(LintDocumentation, HasARowForEachRule) {
    std::ifstream file(source_folder() / "docs" / "lint.md");
    std::vector<std::string> rows, expected;
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("| `") && !line.starts_with("| `-"))
            rows.push_back(line.substr(0, line.find(" | ", line.find(" | ", line.find(" | ") + 1) + 1)));
    for (const LintRule& rule : lint_rules())
        expected.push_back("| `" + std::string(rule.name) + "` | " +
                           (rule.severity == Severity::warning ? "warning" : "note") + " | " +
                           std::string(rule.summary));
    EXPECT_EQ(rows, expected);
}

}  // namespace
}  // namespace steradian::test
