// What the lists of scenes for the rules share.
#pragma once

#include <span>

#include "lint_scene.h"

namespace steradian::test {

inline Material glass(float eta = 1.5f) { return GlassMaterial{eta}; }
inline Affine at(double x, double y, double z) { return translation(x, y, z); }
/// Replaces the grey of the sphere, whose material goes away.
inline void wear(LintScene& t, Material m) { t.s.materials[0] = std::move(m), t.s.textures.clear(); }

class Rules : public testing::TestWithParam<Case> {};
inline std::string name_of_case(const testing::TestParamInfo<Case>& info) { return info.param.name; }

/// Those of material_rules_test.cpp.
std::span<const Case> material_cases();

}  // namespace steradian::test
