// Animations: what their channels say about the nodes at one moment.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "formats/gltf/accessors.h"

namespace steradian::gltf {

/// What an animation puts in the place of a node's own properties.
struct NodePose {
    std::optional<std::array<double, 3>> translation, scale;
    std::optional<std::array<double, 4>> rotation;  ///< x, y, z, w, of unit length
    std::optional<std::vector<double>> weights;     ///< of morph targets, finite
};

/// By node.
using Pose = std::map<uint32_t, NodePose>;

/// At the moment that the options ask for, clamped to the keyframes of each channel; nothing where they ask for none.
/// Fails where the file does not have the animation, or where what is needed of it is damaged.
Pose read_pose(Context& context, Accessors& accessors);

}  // namespace steradian::gltf
