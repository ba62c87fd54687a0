// steradian lint: what it prints, its exit codes and options; and what info says of the same.
#include <gtest/gtest.h>

#include "program.h"

namespace steradian::test {
namespace {

constexpr const char* kMistakes = R"({"version": 1,
"camera": {"position": [0, 0, 5], "look_at": [0, 0, 0]},
"materials": {"spare": {"type": "mirror"}},
"objects": [{"type": "sphere", "material": {"type": "glass", "eta": 1}}],
"lights": [{"type": "environment", "radiance": 1}]})";

class LintCommand : public CommandTest {
protected:
    LintCommand() { spit(folder_.file("bad.json"), kMistakes); }
};

TEST_F(LintCommand, PrintsALineForEachFinding) {
    const Outcome o = steradian({"lint", "bad.json"});
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_EQ(o.err, "");
    EXPECT_EQ(o.out,
              "bad.json:3:24 (/materials/spare): note: material 'spare' is not used [unused]\n"
              "bad.json:4:44 (/objects/0/material): warning: material 1 has an index of refraction of 1: it neither "
              "bends nor reflects light [ior-one]\n"
              "  hint: glass has 1.5, water 1.33\n"
              "bad.json: 1 warning, 1 note\n");
    expect_files({"bad.json"});
}

TEST_F(LintCommand, StrictFailsForWarningsThatAreNotDisabled) {
    EXPECT_EQ(steradian({"lint", "bad.json", "--strict"}).code, 1);
    EXPECT_EQ(steradian({"lint", "bad.json", "--strict", "--json"}).code, 1);
    EXPECT_EQ(steradian({"lint", "bad.json", "--strict", "--disable", "ior-one"}).code, 0) << "a note is left";
    EXPECT_EQ(steradian({"lint", "bad.json", "--disable", "ior-one,unused"}).out, "bad.json: 0 warnings, 0 notes\n");
    EXPECT_EQ(steradian({"lint", "bad.json", "--disable", "ior-one", "--disable", "unused"}).out,
              "bad.json: 0 warnings, 0 notes\n");
    EXPECT_EQ(steradian({"lint", "scene.json", "--strict"}).code, 0);
    EXPECT_EQ(steradian({"lint", "scene.json"}).out, "scene.json: 0 warnings, 0 notes\n");
}

TEST_F(LintCommand, Json) {
    const Outcome o = steradian({"lint", "bad.json", "--json"});
    EXPECT_EQ(field(o.out, "rule"), "unused");
    EXPECT_EQ(field(o.out, "pointer"), "/materials/spare");
    EXPECT_EQ(field(o.out, "line"), "3");
    EXPECT_EQ(field(o.out, "element"), "material");
    EXPECT_EQ(field(o.out, "warnings"), "1");
    EXPECT_EQ(field(o.out, "notes"), "1");
}

TEST_F(LintCommand, RepetitionsAreCounted) {
    std::string many = kMistakes;
    const std::string one = many.substr(many.find("{\"type\": \"sphere\""), 59);
    ASSERT_TRUE(one.ends_with("}}")) << one;
    for (int i = 0; i < 4; ++i) many.insert(many.find(one), one + ", ");
    spit(folder_.file("many.json"), many);
    const Outcome o = steradian({"lint", "many.json", "--max-per-rule", "2"});
    EXPECT_NE(o.out.find("warning: and 3 more [ior-one]\nmany.json: 5 warnings, 1 note\n"), std::string::npos) << o.out;
    EXPECT_EQ(steradian({"lint", "many.json", "--max-per-rule", "0"}).out.find(" more ["), std::string::npos);
}

TEST_F(LintCommand, UsageAndBadScenesHaveTheirCodes) {
    EXPECT_EQ(steradian({"lint"}).code, 2);
    EXPECT_EQ(steradian({"lint", "missing.json"}).code, 3);
    EXPECT_EQ(steradian({"lint", "bad.json", "--variant", "red"}).code, 2);
    const Outcome unknown = steradian({"lint", "bad.json", "--disable", "open-gras"});
    EXPECT_EQ(unknown.code, 2);
    EXPECT_NE(unknown.err.find("did you mean 'open-glass'?"), std::string::npos) << unknown.err;
    spit(folder_.file("broken.json"), "{\"version\": 1, ");
    const Outcome broken = steradian({"lint", "broken.json"});
    EXPECT_EQ(broken.code, 3);
    EXPECT_EQ(broken.err.rfind("broken.json:1:", 0), 0u) << broken.err;
}

/// Files that want to do harm end as they do everywhere: with one line that says which and what.
TEST_F(LintCommand, HostileFilesAreRefused) {
    const std::string triangle =
        "{\"asset\": {\"version\": \"2.0\"}, \"nodes\": [{\"mesh\": 0}], \"meshes\": [{\"primitives\": "
        "[{\"attributes\": {\"POSITION\": 0}}]}], \"accessors\": [{\"componentType\": 5126, \"type\": "
        "\"VEC3\", \"count\": 4000000000}]}";
    const std::pair<const char*, std::string> files[] = {
        {"deep.json", std::string(200000, '[')},
        {"deep.gltf", "{\"a\": " + std::string(200000, '{')},
        {"lies.gltf", triangle},
        {"short.glb", std::string("glTF\2\0\0\0\xff\xff\xff\x7f", 12)},
        {"lies.ply",
         "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\n"
         "property float z\nelement face 4000000000\nproperty list uchar int vertex_indices\nend_header\n"},
        {"zeros.obj", std::string(1000, '\0')},
    };
    for (const auto& [name, content] : files) {
        spit(folder_.file(name), content);
        const Outcome o = steradian({"lint", name});
        EXPECT_TRUE(o.code == 3 || o.code == 4) << name << " " << o.code << " " << o.out;
        EXPECT_EQ(o.err.rfind(name, 0), 0u) << o.err.substr(0, 300);
        EXPECT_EQ(o.out, "") << name;
    }
}

TEST_F(LintCommand, RulesAreListed) {
    const Outcome o = steradian({"lint", "--list-rules"});
    EXPECT_EQ(o.code, 0);
    EXPECT_NE(o.out.find("\nopen-glass            warning  "), std::string::npos) << o.out;
    EXPECT_NE(o.out.find("\nunused                note     "), std::string::npos) << o.out;
}

/// Once each, by the command that it belongs to: a render says what the picture lacks.
TEST_F(LintCommand, ModelsAreToldWhatOfThemHasNoEffect) {
    spit(folder_.file("m.gltf"), R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
"accessors": [{"componentType": 5126, "type": "VEC3", "count": 3, "bufferView": 0}],
"bufferViews": [{"buffer": 0, "byteLength": 36}], "extensionsUsed": ["X_any"],
"buffers": [{"byteLength": 36, "uri": "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
"materials": [{"occlusionTexture": {"index": 0}, "toon": 1, "doubelSided": true,
"extensions": {"KHR_materials_sheen": {"sheenColorFactor": [1, 1, 1]}}}]})");
    const std::string occlusion = "m.gltf:6:36 (/materials/0/occlusionTexture): note: 'occlusionTexture' has no effect",
                      toon = "m.gltf:6:50 (/materials/0/toon): note: 'toon' is no property of a material",
                      named = "m.gltf:4:70 (/extensionsUsed/0): note: the extension 'X_any'",
                      misspelt = "m.gltf:6:61 (/materials/0/doubelSided): warning: 'doubelSided' is no property of",
                      sheen = "(/materials/0/extensions/KHR_materials_sheen)";
    const auto times = [](const std::string& text, const std::string& part) {
        int n = 0;
        for (size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++n;
        return n;
    };
    for (const char* command : {"lint", "info"}) {
        const std::string out = steradian({command, "m.gltf"}).out;
        for (const std::string& line : {occlusion, toon, named, misspelt, sheen}) EXPECT_EQ(times(out, line), 1) << out;
    }
    const std::string err = steradian({"render", "m.gltf", "--size", "8x8", "--spp", "1", "-o", "m.png"}).err;
    for (const std::string& line : {misspelt, sheen}) EXPECT_EQ(times(err, line), 1) << err;
    for (const char* line : {"occlusionTexture", "toon", "X_any"}) EXPECT_EQ(times(err, line), 0) << err;
}

TEST_F(LintCommand, InfoNamesWhatIsUnused) {
    const Outcome text = steradian({"info", "bad.json"}), json = steradian({"info", "bad.json", "--json"});
    EXPECT_EQ(text.code, 0) << text.err;
    EXPECT_NE(text.out.find("\n  bad.json:3:24 (/materials/spare): note: material 'spare' is not used [unused]\n"),
              std::string::npos)
        << text.out;
    EXPECT_EQ(text.out.find("ior-one"), std::string::npos) << "that is for lint";
    EXPECT_EQ(field(json.out, "pointer"), "/materials/spare");
}

}  // namespace
}  // namespace steradian::test
