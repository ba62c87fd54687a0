// The node hierarchy: where meshes, lights and cameras are.
#pragma once

#include "formats/gltf/animation.h"
#include "formats/gltf/meshes.h"

namespace steradian::gltf {

/// Places everything that the file's default scene holds: its first one where it does not say; without scenes, all
/// nodes. `pose` wins over what they say themselves. Fails where a node has two parents or is its own ancestor.
void place_nodes(Context& context, Accessors& accessors, Meshes& meshes, const Pose& pose, const Object& root);

/// EXT_mesh_gpu_instancing: node_from_instance of each.
std::vector<Affine> read_instances(Context& context, Accessors& accessors, const Object& extension);

/// A node's own transform: its matrix, or its translation, rotation and scale, those of an animation before others.
Affine node_transform(Context& context, const Object& node, const NodePose& pose);

/// KHR_lights_punctual. The light is at the origin and shines along -z.
Light read_light(Context& context, const Object& light);
/// The same at a node.
Light placed(Light light, const Affine& world_from_node);

/// At no place yet. `aspect`: width over height, where the camera says it.
struct ReadCamera {
    Camera camera;
    std::optional<double> aspect;
};
ReadCamera read_camera(Context& context, const Object& camera);
/// At a node, along whose -z it looks; scale is not the camera's. Nothing where the node is scaled to nothing.
std::optional<Camera> placed(const Camera& camera, const Affine& world_from_node);

}  // namespace steradian::gltf
