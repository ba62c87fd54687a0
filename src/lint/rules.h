// The table of rules. docs/lint.md has a paragraph for each; a test holds the two together.
#pragma once

#include <array>

#include "steradian/lint.h"

namespace steradian::lint_detail {

/// In the order of kRules.
enum class Rule : uint8_t {
    not_honoured,
    input,
    unused,
    no_effect,
    albedo_above_one,
    out_of_range,
    ior_one,
    color_space,
    normal_map,
    missing_uvs,
    missing_colors,
    nan_vertices,
    degenerate_triangles,
    duplicate_triangles,
    coincident_surfaces,
    overlapping_surfaces,
    open_glass,
    inverted_normals,
    no_light,
    dark_light,
    light_in_wall,
    scale,
    precision,
    camera_in_wall,
    empty_view,
};
inline constexpr size_t kRuleCount = 25;

inline constexpr std::array<LintRule, kRuleCount> kRules{{
    {"not-honoured", Severity::warning, "the file asks for what the picture shows differently or not at all"},
    {"input", Severity::warning, "the reader has ignored, replaced or corrected something in a file"},
    {"unused", Severity::note, "nothing uses an element of the scene"},
    {"no-effect", Severity::note, "something that the file says changes nothing"},
    {"albedo-above-one", Severity::warning, "a surface reflects and transmits more than it receives"},
    {"out-of-range", Severity::warning, "texels or factors are outside of the range that they must be in"},
    {"ior-one", Severity::warning, "glass with an index of refraction of 1 cannot be seen"},
    {"color-space", Severity::warning, "colours are read as numbers, or numbers as colours"},
    {"normal-map", Severity::warning, "a normal map whose texels are not normals"},
    {"missing-uvs", Severity::warning, "a textured mesh has no texture coordinates"},
    {"missing-colors", Severity::warning, "a material shows the colours of vertices that have none"},
    {"nan-vertices", Severity::warning, "numbers of a mesh are not finite or too large"},
    {"degenerate-triangles", Severity::note, "triangles without area"},
    {"duplicate-triangles", Severity::note, "a mesh has the same triangle more than once"},
    {"coincident-surfaces", Severity::warning, "surfaces of different objects lie in the same place"},
    {"overlapping-surfaces", Severity::warning, "surfaces of different objects overlap in one plane"},
    {"open-glass", Severity::warning, "the surface of a solid transparent body has holes"},
    {"inverted-normals", Severity::warning, "a surface is inside out, or its normals are"},
    {"no-light", Severity::warning, "nothing shines"},
    {"dark-light", Severity::note, "a light that sends nothing"},
    {"light-in-wall", Severity::warning, "a light is shut in by opaque surfaces"},
    {"scale", Severity::warning,
     "an object is a thousand times as large as all others, all are too small to see, or glass is black"},
    {"precision", Severity::warning, "an object is so far from the origin that its vertices are rounded"},
    {"camera-in-wall", Severity::warning, "a camera is shut in by an opaque surface, in the dark"},
    {"empty-view", Severity::warning, "a camera sees none of the objects"},
}};

constexpr const LintRule& info(Rule rule) { return kRules[static_cast<size_t>(rule)]; }

}  // namespace steradian::lint_detail
