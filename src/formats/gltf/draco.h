// KHR_draco_mesh_compression: primitives whose vertices and indices are compressed together.
#pragma once

#include <map>
#include <memory>

#include "formats/gltf/buffers.h"

namespace steradian::gltf {

/// What is in a buffer view, decoded when it is first asked for. What is quantised is still as the whole numbers that
/// it was stored as: to turn them into floats is ours, so that they are the same on every machine.
class DracoMeshes {
public:
    DracoMeshes(Context& context, Buffers& buffers) : context_(context), buffers_(buffers) {}

    struct Decoded;
    const Decoded& open(const Object& extension);

private:
    Context& context_;
    Buffers& buffers_;
    std::map<uint32_t, std::shared_ptr<const Decoded>> meshes_;  ///< by buffer view
};

}  // namespace steradian::gltf
