// A second source for the expected values: a catalogue that was made without this renderer and without these formulas,
// where the folder of outside test files has it (verify/analytic/cases.json).
#include <gtest/gtest.h>
#include <rapidjson/document.h>

#include <map>

#include "analytic/case.h"
#include "support/support.h"

namespace steradian::analytic {
namespace {

TEST(Catalogue, AgreesWithTheFormulas) {
    const auto shared = test::shared_folder();
    if (!shared || !std::filesystem::exists(*shared / "verify/analytic/cases.json"))
        GTEST_SKIP() << "verify/analytic/cases.json is not there";
    const std::string text = test::slurp(*shared / "verify/analytic/cases.json");
    rapidjson::Document document;
    document.Parse<rapidjson::kParseFullPrecisionFlag>(text.data(), text.size());
    ASSERT_FALSE(document.HasParseError());
    std::map<std::string, const rapidjson::Value*> outside;
    for (const auto& entry : document.GetArray()) outside[entry["id"].GetString()] = &entry;

    size_t compared = 0;
    for (const Case& c : all_cases()) {
        if (c.catalogue.empty()) continue;
        const auto found = outside.find(c.catalogue);
        ASSERT_NE(found, outside.end()) << c.catalogue;
        const rapidjson::Value& entry = *found->second;
        // The catalogue's own bound where its scene is not ours to the last digit (a glass sphere without a limit of
        // depth, a disk of triangles); else the digits must agree.
        const bool exact = c.catalogue != "C05_furnace_glass_sphere" && c.catalogue != "A10_shadow_edge_half";
        const double tolerance = exact ? 1e-9 : entry["tol"].GetDouble();
        // Our spot lights have the smoothstep of pbrt's.
        const bool spot = entry["alt"].HasMember("expect_pbrt_v4");
        for (int channel = 0; channel < 3; ++channel) {
            const double want = spot ? entry["alt"]["expect_pbrt_v4"].GetDouble()
                                     : entry["expect"][static_cast<unsigned>(channel)].GetDouble();
            EXPECT_NEAR(c.expected[0].value[channel], want, tolerance * std::max(want, 1e-3)) << c.id;
        }
        ++compared;
    }
    EXPECT_GE(compared, 29u);
    RecordProperty("compared", static_cast<int>(compared));
}

}  // namespace
}  // namespace steradian::analytic
