// Every case of the catalogue, rendered through the whole path.
#include <gtest/gtest.h>

#include <cstdio>
#include <ostream>
#include <set>

#include "analytic/check.h"

namespace steradian::analytic {

void PrintTo(const Case& c, std::ostream* out) { *out << c.id << ": " << c.formula; }

namespace {

class ClosedForm : public testing::TestWithParam<Case> {};

TEST_P(ClosedForm, Holds) {
    const Judgement j = judge(GetParam());
    for (const std::string& failure : j.failures)
        ADD_FAILURE() << GetParam().id << " (" << GetParam().formula << "): " << failure;
    std::printf("%s: %u x %llu samples, error %.2g, standard error %.2g, deviation %.2g\n", GetParam().id.c_str(),
                j.pictures, static_cast<unsigned long long>(j.samples), j.worst_error, j.worst_standard_error,
                j.worst_deviation);
}

std::string name_of(const testing::TestParamInfo<Case>& info) {
    std::string out = info.param.id;
    for (char& c : out)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    return out;
}

INSTANTIATE_TEST_SUITE_P(DeltaLights, ClosedForm, testing::ValuesIn(delta_light_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(AreaLights, ClosedForm, testing::ValuesIn(area_light_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(EmitterSides, ClosedForm, testing::ValuesIn(emitter_side_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(Environments, ClosedForm, testing::ValuesIn(environment_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(Specular, ClosedForm, testing::ValuesIn(specular_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(Surfaces, ClosedForm, testing::ValuesIn(surface_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(Camera, ClosedForm, testing::ValuesIn(camera_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(Transforms, ClosedForm, testing::ValuesIn(transform_cases()), name_of);

TEST(Cases, HaveUniqueNames) {
    std::set<std::string> ids;
    for (const Case& c : all_cases()) EXPECT_TRUE(ids.insert(c.id).second) << c.id;
}

}  // namespace
}  // namespace steradian::analytic
