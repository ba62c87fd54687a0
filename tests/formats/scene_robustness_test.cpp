// Damaged scenes are refused with a place or still make sense; the documentation's scenes are good.
#include <algorithm>
#include <random>
#include <set>
#include <vector>

#include "formats/scene_test.h"

namespace steradian::test {
namespace {

std::vector<std::string> sample_scenes() {
    std::set<std::filesystem::path> paths;
    for (const auto& entry : std::filesystem::directory_iterator(source_folder() / "fuzz" / "corpus" / "scene_json"))
        paths.insert(entry.path());
    std::vector<std::string> texts;
    for (const auto& path : paths) texts.push_back(slurp(path));
    return texts;
}

/// True when it was accepted.
bool check(std::string_view text) {
    LoadOptions confined;
    confined.allow_outside_paths = false;
    const auto loaded = load_scene_json(text, "test.json", "/nonexistent", confined);
    if (loaded) return true;
    EXPECT_EQ(loaded.error().where.file, "test.json");
    EXPECT_GE(loaded.error().where.line, 1u) << loaded.error().str();
    EXPECT_GE(loaded.error().where.column, 1u) << loaded.error().str();
    EXPECT_FALSE(loaded.error().message.empty());
    return false;
}

TEST(SceneRobustness, TruncatedScenesAreRefused) {
    for (const std::string& text : sample_scenes()) {
        const size_t end = text.find_last_of('}');
        for (size_t i = 0; i <= 256; ++i) {
            const size_t length = i * end / 256;
            EXPECT_FALSE(check(std::string_view(text).substr(0, length))) << length;
        }
    }
}

TEST(SceneRobustness, FlippedBitsDoNoHarm) {
    std::mt19937 random(20240607);
    const int flips = by_tier(300, 10'000);
    for (const std::string& text : sample_scenes()) {
        for (int i = 0; i < flips; ++i) {
            std::string damaged = text;
            for (uint32_t k = random() % 4 + 1; k > 0; --k)
                damaged[random() % damaged.size()] ^= static_cast<char>(1u << random() % 8);
            check(damaged);
        }
    }
}

TEST(SceneRobustness, DeepNestingIsRefusedInScenesToo) {
    const std::string deep(1'000'000, '[');
    EXPECT_FALSE(check(scene_with("\"objects\": " + deep)));
    EXPECT_FALSE(check("{\"version\": 1, \"x\": " + deep + std::string(deep.size(), ']') + "}"));
    LoadOptions unlimited;
    unlimited.max_depth = 2'000'000;
    EXPECT_FALSE(
        load_scene_json(scene_with("\"objects\": " + deep + std::string(deep.size(), ']')), "test.json", "", unlimited)
            .ok());
}

TEST(SceneRobustness, ManyLightsAndWarningsTakeLinearTime) {
    std::string lights = "\"lights\": [", materials = "\"materials\": {";
    const int count = by_tier(20'000, 1'000'000);
    for (int i = 0; i < count; ++i) {
        lights += std::string(i ? ",\n" : "") + "{\"type\": \"point\", \"position\": [0, 0, 0], \"intensity\": 1}";
        materials +=
            std::string(i ? ",\n" : "") + "\"m" + std::to_string(i) + "\": {\"type\": \"mirror\", \"reflectance\": 2}";
    }
    const LoadedScene loaded = load_good(scene_with(lights + "],\n" + materials + "}"));
    EXPECT_EQ(loaded.scene.lights.size(), static_cast<size_t>(count));
    ASSERT_EQ(loaded.diagnostics.warnings().size(), 1u);
    EXPECT_EQ(loaded.diagnostics.warnings()[0].count, static_cast<uint64_t>(count));
}

TEST(SceneRobustness, WholeScenesInTheDocumentationLoad) {
    const std::string page = slurp(source_folder() / "docs" / "scene-format.md");
    int found = 0;
    constexpr std::string_view kFence = "```json\n";
    for (size_t at = page.find(kFence); at != page.npos; at = page.find(kFence, at + 1)) {
        const size_t begin = at + kFence.size();
        const std::string block = page.substr(begin, page.find("```", begin) - begin);
        if (!block.starts_with("{\n  \"version\"")) continue;
        const auto loaded = load_text(block);
        EXPECT_TRUE(loaded.ok()) << loaded.error().str();
        ++found;
    }
    EXPECT_GE(found, 1);
}

}  // namespace
}  // namespace steradian::test
