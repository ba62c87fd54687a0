// Morph targets: what is added to the vertices of a primitive, each times its weight.
#pragma once

#include <array>
#include <compare>
#include <vector>

#include "formats/gltf/accessors.h"

namespace steradian::gltf {

/// One that is not without effect: its weight is not 0. The numbers are of accessors with differences, kNone where the
/// target says nothing about an attribute.
struct MorphTarget {
    static constexpr uint32_t kNone = 0xffffffffu;
    double weight = 0;
    uint32_t positions = kNone, normals = kNone, tangents = kNone, colors = kNone;
    std::array<uint32_t, kMaxUvSets> uvs{};
    size_t offset = 0;  ///< for messages
    auto operator<=>(const MorphTarget&) const = default;
};

/// Those of a primitive, as far as its mesh will have what they change. `weights` belong to its targets in order; there
/// may be fewer, the others are 0.
std::vector<MorphTarget> morph_targets(const Context& context, const Object& primitive,
                                       const std::vector<double>& weights);

/// The "weights" of a mesh or a node; empty where it has none.
std::vector<double> read_weights(const Context& context, const Object& object);

/// Section 3.7.2.2 of the specification. Changes what the mesh has; texture coordinates that it lacks are left out, and
/// colours stay within 0 and 1. Normals and tangents become unit vectors.
void morph(Context& context, Accessors& accessors, const std::vector<MorphTarget>& targets, Mesh& mesh);

}  // namespace steradian::gltf
