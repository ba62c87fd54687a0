// What a glTF file has and nothing in it refers to.
#pragma once

#include "formats/gltf/context.h"

namespace steradian::gltf {

/// Names cameras, images, lights, materials, meshes, nodes, skins and textures that no other element refers to, and
/// nodes that are in no scene. Believes nothing: what is not as it should be refers to nothing.
void find_unused(Context& context);
/// Names what has no effect on purpose, and numbers there that are out of their ranges: nothing reads them.
void find_ineffective(Context& context);

}  // namespace steradian::gltf
