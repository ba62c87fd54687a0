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
        sheen("[0, 0.5, 0]")[0].starts_with("/materials/0/extensions/KHR_materials_sheen sheen is approximated"));
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

}  // namespace
}  // namespace steradian
