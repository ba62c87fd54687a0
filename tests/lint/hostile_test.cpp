// Damaged files of every format that scenes come in: what can still be read is looked through for mistakes; never a
// crash, and findings have a place and one line. What such files may cost is tests/cli/hostile_models_test.cpp.
#include <algorithm>
#include <filesystem>

#include "lint_scene.h"
#include "support/random.h"
#include "support/support.h"

namespace steradian::test {
namespace {

struct Tally {
    size_t read = 0, refused = 0, findings = 0;
};

class LintHostile : public testing::TestWithParam<const char*> {
protected:
    void look(const std::string& name, const std::string& bytes, Tally& tally) {
        const std::string path = folder_.file(name);
        spit(path, bytes);
        LoadOptions options;
        options.locations = true;
        options.images.max_pixels = 1 << 16;
        options.gltf_free_bytes = 1 << 20;
        const auto loaded = load_scene(path, options);
        const auto report = loaded ? lint(*loaded) : Result<LintReport>(loaded.error());
        if (!report) {
            ++tally.refused;
            EXPECT_FALSE(report.error().message.empty());
            return;
        }
        ++tally.read;
        for (const Finding& f : report->findings) {
            ++tally.findings;
            EXPECT_FALSE(f.where.file.empty()) << f.message;
            for (const char c : f.message + f.hint) EXPECT_GE(static_cast<unsigned char>(c), 0x20) << f.message;
        }
    }

    TemporaryFolder folder_;
};

TEST_P(LintHostile, DamageDoesNoHarm) {
    Random random(11);
    Tally tally;
    const std::filesystem::path corpus = source_folder() / "fuzz/corpus" / GetParam();
    std::vector<std::filesystem::path> seeds;
    for (const auto& entry : std::filesystem::directory_iterator(corpus)) seeds.push_back(entry.path());
    std::sort(seeds.begin(), seeds.end());
    for (const auto& seed : seeds) {
        const std::string bytes = slurp(seed), name = "seed" + seed.extension().string();
        look(name, bytes, tally);
        for (int round = by_tier(40, 2000); round > 0; --round) {
            std::string damaged = bytes;
            for (uint64_t k = random.next() % 4 + 1; k > 0; --k) {
                const size_t at = random.next() % damaged.size();
                // Half of the files have other numbers only, which more of them outlive.
                const size_t digit = round % 2 ? at : damaged.find_first_of("0123456789", at);
                if (digit == damaged.npos) continue;
                if (round % 2)
                    damaged[at] = static_cast<char>(damaged[at] ^ (1u << random.next() % 8));
                else
                    damaged[digit] = static_cast<char>('0' + random.next() % 10);
            }
            look(name, damaged, tally);
        }
    }
    EXPECT_GT(tally.read, 10u);
    EXPECT_GT(tally.refused, 0u);
    EXPECT_GT(tally.findings, 0u);
}
INSTANTIATE_TEST_SUITE_P(Formats, LintHostile, testing::Values("gltf", "scene_json", "obj", "ply"));

}  // namespace
}  // namespace steradian::test
