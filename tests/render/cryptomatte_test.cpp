// Cryptomatte: the published hashes, ranks, what a file says of itself, and mattes picked by name as a compositor does
// it, against samples that are traced and counted one by one.
#include "render/cryptomatte.h"

#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <set>

#include "base/names.h"
#include "render/integrator.h"
#include "render/sums.h"
#include "render_support.h"
#include "steradian/image_io.h"
#include "support/support.h"
#include "test_scenes.h"

namespace steradian {
namespace {

using test::channel;
using test::prepared;
using test::run;

// Values of the test suite of Psyop's reference implementation (cryptomatte_utilities_tests.py, CryptoHashing).
TEST(MatteIds, AreThePublishedOnes) {
    const std::pair<const char*, double> published[] = {
        {"hello", 6.0705627102400005616e-17},    {"cube", -4.08461912519e+15},
        {"sphere", 2.79018604383e+15},           {"plane", 3.66557617593e-11},
        {"равнина", -1.3192631212399999468e-25}, {"mädchen", 6.2361298211599995797e+25}};
    for (const auto& [name, value] : published)
        EXPECT_EQ(std::bit_cast<float>(matte_id(name)), static_cast<float>(value)) << name;
    // The keys under which files of Arnold describe their mattes.
    EXPECT_EQ(matte_id("uCryptoAsset") >> 4, 0xd593dd7u);
    EXPECT_EQ(matte_id("crypto_object") >> 4, 0xf834d0au);
    EXPECT_EQ(matte_id("crypto_material") >> 4, 0xbda530au);
}

TEST(MatteIds, AreNormalNumbersWhateverTheName) {
    std::set<uint32_t> seen;
    for (int i = 0; i < 20000; ++i) {
        const uint32_t id = matte_id("thing " + std::to_string(i));
        EXPECT_TRUE(std::isnormal(std::bit_cast<float>(id))) << i;
        seen.insert(id);
    }
    EXPECT_GT(seen.size(), 19990u);
    EXPECT_TRUE(std::isnormal(std::bit_cast<float>(matte_id(""))));  // its hash is 0
}

TEST(MatteCounts, RankByCoverageThenId) {
    MatteCounts counts;
    const std::pair<uint32_t, int32_t> samples[] = {{7, 3}, {0, 10}, {5, 4}, {9, 3}, {7, 1}, {2, -2}, {1, 1}, {5, 1}};
    for (const auto& [id, n] : samples) counts.add(id, n);
    // In all 21: 5 five times, 7 four times, 9 three times, 1 once; 2 has negative weight.
    const std::pair<uint32_t, double> expected[] = {{5, 5}, {7, 4}, {9, 3}, {1, 1}, {0, 0}, {0, 0}};
    for (uint32_t rank = 0; rank < kMatteRanks; ++rank) {
        EXPECT_EQ(counts.ranking()[rank].id, expected[rank].first) << rank;
        EXPECT_EQ(counts.ranking()[rank].coverage, static_cast<float>(expected[rank].second / 21)) << rank;
    }
    MatteCounts tie;
    for (const uint32_t id : {9u, 4u, 6u}) tie.add(id, 2);
    EXPECT_EQ(tie.ranking()[0].id, 4u);
    EXPECT_EQ(tie.ranking()[1].id, 6u);
    EXPECT_EQ(tie.ranking()[2].id, 9u);
    EXPECT_EQ(MatteCounts().ranking()[0].id, 0u);
    // The sum of two is as if all had been counted in one.
    MatteCounts twice = counts;
    twice += counts;
    EXPECT_EQ(twice.ranking()[1].coverage, counts.ranking()[1].coverage);
}

/// However many there are, in whatever order they come.
TEST(MatteCounts, OfManyThings) {
    MatteCounts counts, backwards;
    const uint32_t things = 20'000;
    for (uint32_t i = 0; i < things; ++i) {
        const uint32_t id = 1 + i * 7919 % things;
        counts.add(id, id == 17 ? 3 : id == 4 ? 2 : 1);
    }
    for (uint32_t id = things; id > 0; --id) backwards.add(id, id == 17 ? 3 : id == 4 ? 2 : 1);
    const uint32_t expected[] = {17, 4, 1, 2, 3, 5};
    for (uint32_t rank = 0; rank < kMatteRanks; ++rank) {
        EXPECT_EQ(counts.ranking()[rank].id, expected[rank]);
        EXPECT_EQ(backwards.ranking()[rank].id, expected[rank]);
        EXPECT_EQ(counts.ranking()[rank].coverage, backwards.ranking()[rank].coverage);
    }
}

TEST(MatteCounts, AreNeverMoreThanAll) {
    MatteCounts counts;  // a filter with negative lobes at an edge
    counts.add(3, 10), counts.add(4, -1);
    EXPECT_EQ(counts.ranking()[0].coverage, 1.0f);
    EXPECT_EQ(counts.ranking()[1].id, 0u);
    MatteCounts one;
    one.add(3, -1);
    EXPECT_EQ(one.ranking()[0].coverage, 1.0f);
}

Scene named_scene() {
    Scene s = test::everything_scene();
    for (size_t i = 0; i < s.instances.size(); ++i) s.names.instances.push_back("thing " + std::to_string(i));
    s.names.instances[2] = "a \"glass\" \\ ball ä";
    s.names.instances[5] = s.names.instances[6] = "pair";  // one matte
    s.names.instances[3] = "";                             // called by its number
    s.names.materials = {"grey", "red", "glass", "mirror"};
    return s;
}

/// As a compositor does it: the attributes lead from a name to an id and to the layers, and the matte is the sum of the
/// coverages beside that id.
std::vector<float> picked(const Image& image, const std::string& type, const std::string& quoted_name) {
    std::vector<float> out;
    for (const auto& [key, layer] : image.metadata) {
        if (!key.starts_with("cryptomatte/") || !key.ends_with("/name") || layer != type) continue;
        const std::string prefix = key.substr(0, key.size() - 4), manifest = image.metadata.at(prefix + "manifest");
        EXPECT_EQ(image.metadata.at(prefix + "hash"), "MurmurHash3_32");
        EXPECT_EQ(image.metadata.at(prefix + "conversion"), "uint32_to_float32");
        EXPECT_EQ(prefix.size(), std::string("cryptomatte/1234567/").size());
        const std::string entry = "\"" + quoted_name + "\":\"";
        const size_t at = manifest.find(entry);
        if (at == manifest.npos) return out;
        uint32_t id = 0;
        const char* hex = manifest.data() + at + entry.size();
        EXPECT_EQ(std::from_chars(hex, hex + 8, id, 16).ptr, hex + 8);
        out.resize(size_t(image.width) * image.height);
        for (const std::string number : {"00", "01", "02"})
            for (const auto& [ids, coverage] : {std::pair(".R", ".G"), {".B", ".A"}}) {
                const auto a = channel(image, layer + number + ids), b = channel(image, layer + number + coverage);
                for (size_t i = 0; i < out.size(); ++i) out[i] += std::bit_cast<uint32_t>(a[i]) == id ? b[i] : 0;
            }
    }
    return out;
}

RenderSettings settings_with(AovSet aovs, FilterKind filter) {
    RenderSettings s;
    s.width = 37;
    s.height = 26;
    s.samples_per_pixel = 80;
    s.aovs = aovs;
    s.filter = {filter, default_filter_radius(filter)};
    return s;
}

/// Which share of each pixel's samples meets one of `instances` first, each traced by itself.
std::vector<float> counted(const RenderScene& scene, const RenderSettings& s, const std::set<uint32_t>& instances) {
    const CameraSampler camera = *camera_of(scene, s);
    const FilterSampler filter(s.filter);
    const Sampler sampler(s.sampler, s.seed);
    std::vector<float> out;
    for (uint32_t y = 0; y < s.height; ++y)
        for (uint32_t x = 0; x < s.width; ++x) {
            double hits = 0, all = 0;
            for (uint64_t i = 0; i < s.samples_per_pixel; ++i) {
                const FilterSample at = filter.sample(sampler.get_2d(sampler.key(x, y, i), 0));
                const Ray ray = camera.generate({float(x) + 0.5f + at.offset.x, float(y) + 0.5f + at.offset.y});
                Hit hit;
                scene.accel.intersect({&ray, 1}, {&hit, 1}, RayKind::coherent);
                all += double(at.weight);
                if (hit.found() && instances.contains(hit.instance)) hits += double(at.weight);
            }
            out.push_back(std::clamp(static_cast<float>(hits / all), 0.0f, 1.0f));
        }
    return out;
}

TEST(Cryptomatte, MattesPickedByNameAreTheSamplesThatSeeTheThing) {
    const auto scene = prepared(named_scene());
    for (const FilterKind filter : {FilterKind::box, FilterKind::gaussian, FilterKind::mitchell}) {
        const RenderSettings settings = settings_with({Aov::crypto_object, Aov::crypto_material}, filter);
        const Image image = run(scene, settings).image;
        const std::tuple<const char*, const char*, std::set<uint32_t>> mattes[] = {
            {"CryptoObject", "thing 0", {0}},      {"CryptoObject", "a \\\"glass\\\" \\\\ ball ä", {2}},
            {"CryptoObject", "object 3", {3}},     {"CryptoObject", "pair", {5, 6}},
            {"CryptoMaterial", "grey", {0, 5, 7}}, {"CryptoMaterial", "red", {1, 4, 6}},
            {"CryptoMaterial", "mirror", {3}}};
        for (const auto& [type, name, instances] : mattes) {
            const auto matte = picked(image, type, name), expected = counted(*scene, settings, instances);
            ASSERT_EQ(matte.size(), expected.size()) << name;
            // 80 samples of one weight: the shares differ by the rounding of the sum of the weights alone.
            double sum = 0;
            for (size_t i = 0; i < matte.size(); ++i) {
                ASSERT_NEAR(matte[i], expected[i], 1e-6f) << name << " " << i;
                sum += double(matte[i]);
            }
            EXPECT_GT(sum, 1) << name;
        }
        EXPECT_TRUE(picked(image, "CryptoObject", "thing 2").empty());
    }
}

TEST(Cryptomatte, CoversWhatAlphaSaysAndInOrder) {
    const Image image = run(prepared(named_scene()), settings_with(AovSet::all(), FilterKind::box)).image;
    const auto alpha = channel(image, "A");
    std::vector<float> before(alpha.size(), 1.0f), sum(alpha.size(), 0.0f);
    for (const char* layer : {"CryptoObject00", "CryptoObject01", "CryptoObject02"})
        for (const char* c : {".G", ".A"}) {
            const auto coverage = channel(image, std::string(layer) + c);
            for (size_t i = 0; i < sum.size(); ++i) {
                EXPECT_LE(coverage[i], before[i]);
                before[i] = coverage[i];
                sum[i] += coverage[i];
            }
        }
    for (size_t i = 0; i < sum.size(); ++i) EXPECT_NEAR(sum[i], alpha[i], 1e-6f);
}

TEST(Cryptomatte, AFileKeepsEveryBitOfItInHalfPrecisionAndWhenItIsWrittenAgain) {
    const test::TemporaryFolder folder;
    const Image image = run(prepared(named_scene()), settings_with(AovSet::all(), FilterKind::gaussian)).image;
    ImageWriteOptions half;
    half.exr = ExrPrecision::half;
    ASSERT_TRUE(write_image(folder.file("a.exr"), image, half).ok());
    const auto once = read_image(folder.file("a.exr"));
    ASSERT_TRUE(once.ok());
    ASSERT_TRUE(write_image(folder.file("b.exr"), *once, half).ok());
    const auto twice = read_image(folder.file("b.exr"));
    ASSERT_TRUE(twice.ok());
    for (const Image* back : {&*once, &*twice}) {
        EXPECT_EQ(back->metadata, image.metadata);
        EXPECT_NE(channel(*back, "R"), channel(image, "R"));
        for (const char* layer : {"CryptoObject00", "CryptoMaterial00", "CryptoObject02"})
            for (const char* c : {".R", ".G", ".B", ".A"})
                EXPECT_EQ(channel(*back, std::string(layer) + c), channel(image, std::string(layer) + c)) << layer << c;
        EXPECT_EQ(picked(*back, "CryptoObject", "pair"), picked(image, "CryptoObject", "pair"));
    }
    EXPECT_EQ(image.metadata.at("cryptomatte/3ae39a5/name"), "CryptoObject");
    EXPECT_EQ(image.metadata.at("cryptomatte/be359d6/name"), "CryptoMaterial");
    for (const auto& [key, text] : color_channels(image).metadata) EXPECT_FALSE(key.starts_with("cryptomatte"));
}

}  // namespace
}  // namespace steradian
