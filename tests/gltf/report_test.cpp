// What is said of a file beside its picture: what cannot be honoured, what is ignored, misspelt or out of range.
#include <algorithm>

#include "gltf_builder.h"

namespace steradian {
namespace {

using namespace test;

using Lines = std::vector<std::string>;
Lines lines(const Diagnostics& list) {
    Lines out;
    for (const Warning& w : list.warnings())
        out.push_back(w.where.pointer + " " + w.message + (w.count > 1 ? " x" + std::to_string(w.count) : "") +
                      (w.rule.empty() ? "" : " [" + w.rule + "]"));
    return out;
}

LoadedScene load(const std::string& text, bool locations = true) {
    LoadOptions options;
    options.locations = locations;
    return good_gltf(text, options);
}

constexpr const char* kLamp =
    R"("extensions": {"KHR_lights_punctual": {"lights": [{"type": "point"}]}}, "extensionsUsed": [])";

/// A triangle with a material, and further top-level members; a node beside it.
std::string with_material(const std::string& material, const std::string& more = {}, const std::string& node = "{}") {
    GltfBuilder b;
    const int p = b.floats("VEC3", 3, kTriangle);
    return b.text("\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": " + std::to_string(p) +
                  "}, \"material\": 0}]}], \"nodes\": [{\"mesh\": 0}, " + node + "], \"materials\": [{" + material +
                  "}]" + (more.empty() ? "" : ", " + more));
}

std::string extension(const std::string& name, const std::string& members) {
    return "\"" + name + "\": {" + members + "}";
}

TEST(GltfReport, SheenAndEmissionBelowACoat) {
    const auto fidelity = [](const std::string& members) { return lines(load(with_material(members)).fidelity); };
    const std::string coat =
        "\"extensions\": {" + extension("KHR_materials_clearcoat", "\"clearcoatFactor\": 0.5") + "}";
    const std::string glow = "\"emissiveFactor\": [1, 0, 0]";
    EXPECT_EQ(fidelity(coat), Lines{});
    EXPECT_EQ(fidelity(glow), Lines{});
    EXPECT_EQ(fidelity(glow + ", " + coat),
              (Lines{"/materials/0/extensions/KHR_materials_clearcoat a clearcoat does not darken what the surface "
                     "below it emits"}));
    EXPECT_EQ(fidelity(glow + ", \"extensions\": {" + extension("KHR_materials_clearcoat", "") + "}"), Lines{});
    const auto sheen = [&](const std::string& color) {
        return fidelity("\"extensions\": {" + extension("KHR_materials_sheen", "\"sheenColorFactor\": " + color) + "}");
    };
    EXPECT_EQ(sheen("[0, 0, 0]"), Lines{});
    ASSERT_EQ(sheen("[0, 0.5, 0]").size(), 1u);
    EXPECT_TRUE(
        sheen("[0, 0.5, 0]")[0].starts_with("/materials/0/extensions/KHR_materials_sheen sheen is approximated by "));
}

/// Panes let the sky through, but not the lights that only shadow rays find.
TEST(GltfReport, LightsBehindGlass) {
    const std::string glass =
        "\"extensions\": {" + extension("KHR_materials_transmission", "\"transmissionFactor\": 1") + "}";
    const std::string plastic = "\"pbrMetallicRoughness\": {\"metallicFactor\": 0}",
                      dielectric = plastic + ", " + glass;
    const std::string lamp = R"({"extensions": {"KHR_lights_punctual": {"light": 0}}})";
    const auto fidelity = [&](const std::string& material, const std::string& node) {
        return lines(load(with_material(material, kLamp, node)).fidelity);
    };
    EXPECT_EQ(fidelity(dielectric, "{}"), Lines{});
    EXPECT_EQ(fidelity(plastic, lamp), Lines{});
    EXPECT_EQ(fidelity(glass, lamp), Lines{});  // metal
    EXPECT_EQ(fidelity("\"emissiveFactor\": [1, 1, 1], " + dielectric, "{}"), Lines{});
    EXPECT_EQ(
        fidelity(dielectric, lamp),
        (Lines{"/materials/0/extensions/KHR_materials_transmission the lights of KHR_lights_punctual do not shine "
               "through what transmits light: behind it there is shadow"}));
}

TEST(GltfReport, MisspeltProperties) {
    const std::string text = with_material(
        R"("pbrMetallicRoughness": {"metalicFactor": 0, "baseColourFactor": [1, 1, 1, 1], "extras": {"metalicFactor": 1}},
           "doublesided": true, "roughnessFactor": 1, "extensions": {"X_y": {"metalicFactor": 0}})",
        R"("scenee": 0)", R"({"name": "a", "translatoin": [1, 2, 3]}, {"translatoin": [1, 2, 3]})");
    const Lines expected{
        "/nodes/1/translatoin 'translatoin' is no property of a node and is ignored: did you mean 'translation'? x2",
        "/materials/0/pbrMetallicRoughness/metalicFactor 'metalicFactor' is no property of 'pbrMetallicRoughness' and "
        "is ignored: did you mean 'metallicFactor'?",
        "/materials/0/pbrMetallicRoughness/baseColourFactor 'baseColourFactor' is no property of "
        "'pbrMetallicRoughness' and is ignored: did you mean 'baseColorFactor'?",
        "/materials/0/doublesided 'doublesided' is no property of a material and is ignored: did you mean "
        "'doubleSided'?",
        "/materials/0/roughnessFactor 'roughnessFactor' is no property of a material and is ignored: it belongs into "
        "'pbrMetallicRoughness'",
        "/scenee 'scenee' is no property of the file's root and is ignored: did you mean 'scene'?"};
    // A render says so too.
    for (const bool locations : {false, true}) {
        const LoadedScene loaded = load(text, locations);
        EXPECT_EQ(lines(loaded.diagnostics), expected);
        EXPECT_EQ(lines(loaded.unused), Lines{});
    }
}

TEST(GltfReport, UnknownProperties) {
    const std::string text = with_material(
        R"("shader": "toon", "index": 0, "extras": {"x": [{"y": 1}]})",
        R"("VENDOR": {"nodes": []}, "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "lens": 3}}],
                         "asset2": [[{"z": 1}]])",
        R"({"camera": 0, "index": 3, "uuid": "4-2"}, {"uuid": "4-3"})");
    EXPECT_EQ(lines(load(text).unused),
              (Lines{"/nodes/1/index 'index' is no property of a node and is ignored [no-effect]",
                     "/nodes/1/uuid 'uuid' is no property of a node and is ignored x2 [no-effect]",
                     "/materials/0/shader 'shader' is no property of a material and is ignored [no-effect]",
                     "/materials/0/index 'index' is no property of a material and is ignored [no-effect]",
                     "/VENDOR 'VENDOR' is no property of the file's root and is ignored [no-effect]",
                     "/cameras/0/perspective/lens 'lens' is no property of 'perspective' and is ignored [no-effect]"}));
    const LoadedScene loaded = load(text, false);
    EXPECT_EQ(lines(loaded.unused), Lines{});
    EXPECT_EQ(lines(loaded.diagnostics),
              (Lines{"/asset2 'asset2' is no property of the file's root and is ignored: did you mean 'asset'?"}));
}

/// Those of the specification go without a word, in all objects that it has.
TEST(GltfReport, KnownProperties) {
    GltfBuilder b;
    const int p = b.accessor<float>("VEC3", 5126, 3, kTriangle, R"(, "min": [0, 0, 0], "max": [1, 1, 0], "name": "p")");
    const int times = b.floats("SCALAR", 1, {0, 1}), moves = b.floats("VEC3", 3, {0, 0, 0, 1, 0, 0});
    const int sparse = b.raw_accessor(
        R"("componentType": 5126, "count": 3, "type": "VEC3", "normalized": false, "byteOffset": 0, "bufferView": 0,
           "sparse": {"count": 1, "indices": {"bufferView": 0, "byteOffset": 0, "componentType": 5123},
                      "values": {"bufferView": 0, "byteOffset": 0}}, "extensions": {}, "extras": 1)");
    const auto n = [](int i) { return std::to_string(i); };
    const std::string text = b.text(
        R"("scene": 0, "scenes": [{"nodes": [0, 1], "name": "s"}], "extensionsRequired": [], "extensionsUsed": [], "extras": {},
        "extensions": {"KHR_materials_variants": {"variants": []}}, "skins": [{"joints": [1], "skeleton": 1, "name": "k"}],
        "meshes": [{"name": "m", "weights": [0], "primitives": [{"mode": 4, "material": 0, "attributes": {"_ID": )" +
        n(p) + R"(, "POSITION": )" + n(p) + R"(, "COLOR_1": )" + n(p) + R"(}, "targets": [{"POSITION": )" + n(p) +
        R"(}]}]}], "nodes": [{"mesh": 0, "name": "n", "weights": [0], "scale": [1, 1, 1], "rotation": [0, 0, 0, 1]},
        {"camera": 0, "children": [], "translation": [0, 0, 5]}], "cameras": [{"name": "c", "type": "perspective",
        "perspective": {"yfov": 1, "aspectRatio": 1, "znear": 0.1, "zfar": 9}}, {"type": "orthographic",
        "orthographic": {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 9}}], "animations": [{"name": "a", "channels":
        [{"sampler": 0, "target": {"node": 0, "path": "translation"}}], "samplers": [{"input": )" +
        n(times) + R"(, "interpolation": "LINEAR", "output": )" + n(moves) + R"(}]}], "materials": [{"name": "x",
        "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 1], "metallicFactor": 0, "roughnessFactor": 1,
        "baseColorTexture": {"index": 0, "texCoord": 0}, "metallicRoughnessTexture": {"index": 0}},
        "normalTexture": {"index": 0, "scale": 1}, "emissiveTexture": {"index": 0}, "emissiveFactor": [0, 0, 0],
        "alphaMode": "MASK", "alphaCutoff": 0.5, "doubleSided": true}], "textures": [{"sampler": 0, "source": 0,
        "name": "t"}], "samplers": [{"magFilter": 9728, "minFilter": 9984, "wrapS": 33071, "wrapT": 33648}],
        "images": [{"mimeType": "image/png", "name": "i", "uri": "data:image/png;base64,)" +
        std::string("iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR42mNoAAAAggCB2kUIOwAAAABJRU5ErkJggg==") +
        "\"}]");
    (void)sparse;
    const LoadedScene loaded = load(text);
    for (const Diagnostics* list : {&loaded.diagnostics, &loaded.unused})
        for (const Warning& w : list->warnings())
            EXPECT_EQ(w.message.find("no property"), std::string::npos) << w.str();
}

/// Each name is looked at once, and of very many only the first ones are.
TEST(GltfReport, ListsOfUnknownPropertiesAreBounded) {
    std::string nodes;
    for (int i = 0; i < 20000; ++i)
        nodes += (i ? ",{\"" : "{\"") + std::string(50, 'q') + std::to_string(i) + "\": 0, \"matrixx\": 0}";
    const LoadedScene loaded = load(R"({"asset": {"version": "2.0"}, "nodes": [)" + nodes + "]}");
    EXPECT_EQ(loaded.unused.warnings().size(), 101u);
    EXPECT_EQ(loaded.unused.warnings().back().message, "and others of which there are too many to list");
    ASSERT_GE(loaded.diagnostics.warnings().size(), 1u);
    EXPECT_EQ(loaded.diagnostics.warnings()[0].count, 20000u);
}

TEST(GltfReport, ExtensionsThatNothingUses) {
    const auto texts = [](bool locations) {
        return load(with_material(R"("extensions": {"A_used": {}})",
                                  R"("extensionsUsed": ["KHR_materials_sheen", "A_used", "B_only_named"])"),
                    locations);
    };
    EXPECT_EQ(lines(texts(true).unused),
              (Lines{"/extensionsUsed/2 the extension 'B_only_named' of 'extensionsUsed' is not known, and nothing "
                     "uses it"}));
    EXPECT_EQ(lines(texts(true).fidelity),
              (Lines{"/materials/0/extensions/A_used the extension 'A_used' is not supported and has no effect"}));
    EXPECT_EQ(lines(texts(false).unused), Lines{});
}

TEST(GltfReport, OcclusionHasNoEffect) {
    const std::string text = with_material(R"("occlusionTexture": {"index": 0, "strength": 1.5})",
                                           R"("textures": [{"source": 0}], "images": [{"uri": "none.png"}])");
    EXPECT_EQ(
        lines(load(text).unused),
        (Lines{"/materials/0/occlusionTexture 'occlusionTexture' has no effect: how much light comes into corners "
               "is computed [no-effect]",
               "/materials/0/occlusionTexture 'strength' of an 'occlusionTexture' must be between 0 and 1 "
               "[out-of-range]"}));
    const LoadedScene loaded = load(text, false);
    EXPECT_TRUE(loaded.unused.empty() && loaded.fidelity.empty() && loaded.diagnostics.empty());
}

TEST(GltfReport, NumbersOutOfRange) {
    const auto warned = [](const std::string& material, const std::string& more = {}, const std::string& node = "{}") {
        return lines(load(with_material(material, more, node)).diagnostics);
    };
    const auto ior = [&](const std::string& value) {
        return warned("\"extensions\": {" + extension("KHR_materials_ior", "\"ior\": " + value) + "}");
    };
    for (const char* good : {"0", "1", "1.5", "9.7"}) EXPECT_EQ(ior(good), Lines{}) << good;
    EXPECT_EQ(ior("0.5"), (Lines{"/materials/0/extensions/KHR_materials_ior/ior 'ior' of a material must be 0, or at "
                                 "least 1 as which it is taken [out-of-range]"}));
    const std::string lamp = R"({"extensions": {"KHR_lights_punctual": {"light": 0}}})";
    const auto light = [&](const std::string& color) {
        return warned(
            "", R"("extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "color": )" + color + "}]}}",
            lamp);
    };
    EXPECT_EQ(light("[1, 0, 1]"), Lines{});
    EXPECT_EQ(light("[1, 0, 1.01]"),
              (Lines{"/extensions/KHR_lights_punctual/lights/0/color 'color' of a light must be between 0 and 1; it is "
                     "taken as it is [out-of-range]"}));
    const auto camera = [&](const std::string& kind, const std::string& planes) {
        return lines(load(with_material("",
                                        R"("cameras": [{"type": ")" + kind + R"(", ")" + kind +
                                            R"(": {"yfov": 1, "xmag": 1, "ymag": 1, )" + planes + "}}]",
                                        R"({"camera": 0})"))
                         .unused);
    };
    const auto bad = [](const Lines& found) {
        return std::count_if(found.begin(), found.end(),
                             [](const std::string& l) { return l.ends_with("[out-of-range]"); });
    };
    EXPECT_EQ(bad(camera("perspective", R"("znear": 1, "zfar": 2)")), 0);
    EXPECT_EQ(bad(camera("perspective", R"("znear": 1)")), 0);
    EXPECT_EQ(bad(camera("perspective", R"("znear": 0, "zfar": 2)")), 1);
    EXPECT_EQ(bad(camera("perspective", R"("znear": 2, "zfar": 2)")), 1);
    EXPECT_EQ(bad(camera("orthographic", R"("znear": 0, "zfar": 2)")), 0);
    EXPECT_EQ(bad(camera("orthographic", R"("znear": -1, "zfar": 2)")), 1);
}

TEST(GltfReport, UnknownFilters) {
    const auto warned = [](const std::string& filter) {
        return lines(load(with_material(R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0}})",
                                        R"("textures": [{"source": 0, "sampler": 0}], "samplers": [{"magFilter": )" +
                                            filter + R"(}], "images": [{"uri": "data:image/png;base64,)" +
                                            "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR42mNoAAAAggCB2kUIO"
                                            "wAAAABJRU5ErkJggg==\"}]"))
                         .diagnostics);
    };
    const auto said = [](const Lines& found) {
        return std::count_if(found.begin(), found.end(),
                             [](const std::string& l) { return l.find("/samplers/0/magFilter") == 0; });
    };
    EXPECT_EQ(said(warned("9728")) + said(warned("9729")), 0);
    EXPECT_EQ(said(warned("9984")), 1);
}

}  // namespace
}  // namespace steradian
