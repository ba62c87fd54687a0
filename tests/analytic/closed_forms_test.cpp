// Every scene whose picture is known, rendered through the whole path. One test for each family, and one line for each
// case.
#include <gtest/gtest.h>

#include <cstdio>
#include <set>

#include "analytic/check.h"
#include "support/support.h"

namespace steradian::analytic {
namespace {

void expect_all(const std::vector<Case>& cases) {
    for (const Case& c : cases) {
        const Judgement j = judge(c);
        for (const std::string& failure : j.failures) ADD_FAILURE() << c.id << " (" << c.formula << "): " << failure;
        std::printf("%-44s %2u x %6llu samples, error %8.2g, standard error %8.2g, %5.2f of them\n", c.id.c_str(),
                    j.pictures, static_cast<unsigned long long>(j.samples), j.worst_error, j.worst_standard_error,
                    j.worst_deviation);
    }
}

TEST(ClosedForms, DeltaLights) { expect_all(delta_light_cases()); }
TEST(ClosedForms, AreaLights) { expect_all(area_light_cases()); }
TEST(ClosedForms, EmitterSides) { expect_all(emitter_side_cases()); }
TEST(ClosedForms, Environments) { expect_all(environment_cases()); }
TEST(ClosedForms, GoniometricLights) { expect_all(goniometric_cases()); }
TEST(ClosedForms, Suns) { expect_all(sun_cases()); }
TEST(ClosedForms, SpecularSurfaces) { expect_all(specular_cases()); }
TEST(ClosedForms, Dispersion) { expect_all(dispersion_cases()); }
TEST(ClosedForms, Paths) { expect_all(path_cases()); }
TEST(ClosedForms, Media) { expect_all(medium_cases()); }
TEST(ClosedForms, Opacity) { expect_all(opacity_cases()); }
TEST(ClosedForms, Emission) { expect_all(emission_cases()); }
TEST(ClosedForms, DiffuseSurfaces) { expect_all(surface_cases()); }
TEST(ClosedForms, CameraAndFilters) { expect_all(camera_cases()); }
TEST(ClosedForms, TransformsAndScales) { expect_all(transform_cases()); }

TEST(ClosedForms, HaveUniqueNames) {
    std::set<std::string> ids;
    for (const Case& c : all_cases()) EXPECT_TRUE(ids.insert(c.id).second) << c.id;
}

/// `analytic_scenes OUT_DIR` writes the table to OUT_DIR/cases.md.
TEST(ClosedForms, AreListedInTheDocumentation) {
    const std::string text = test::slurp(test::source_folder() / "docs/verification.md");
    for (const Case& c : all_cases())
        EXPECT_NE(text.find("\n" + table_row(c) + "\n"), std::string::npos) << "missing: " << table_row(c);
}

}  // namespace
}  // namespace steradian::analytic
