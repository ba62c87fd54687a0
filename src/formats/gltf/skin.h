// Skins: vertices that follow several nodes, the joints.
#pragma once

#include <compare>
#include <map>
#include <vector>

#include "formats/gltf/accessors.h"

namespace steradian::gltf {

/// world_from_bind of each joint: its node's place times its inverse bind matrix (section 3.7.3.3 of the
/// specification).
using Joints = std::vector<Affine>;

class Skins {
public:
    Skins(Context& context, Accessors& accessors) : context_(context), accessors_(accessors) {}

    /// Where the nodes of the scene are; nothing for those that are not in it.
    using Places = std::vector<std::optional<Affine>>;

    /// Read when it is first asked for. Null where it has no effect: without joints, or with some that are not in the
    /// scene.
    const Joints* joints(uint32_t skin, const Places& world_from_node);

private:
    std::optional<Joints> read(const Object& skin, const Places& world_from_node);

    Context& context_;
    Accessors& accessors_;
    std::map<uint32_t, std::optional<Joints>> skins_;
};

/// A set of JOINTS_n and WEIGHTS_n, by their accessors.
struct Influences {
    uint32_t joints = 0, weights = 0;
    auto operator<=>(const Influences&) const = default;
};
/// Those of a primitive, up to kMaxInfluences sets.
inline constexpr uint32_t kMaxInfluences = 8;
std::vector<Influences> influences_of(Context& context, const Object& attributes);

/// Moves the vertices into the world. Weights count as parts of their sum. Normals go by the transposed inverse, and
/// where joints mirror, the corners of triangles change places, so that both sides stay what they are.
void skin(Context& context, Accessors& accessors, const Object& attributes, const std::vector<Influences>& influences,
          const Joints& joints, Mesh& mesh);

}  // namespace steradian::gltf
