// Smooth tangents for normal maps that come without any.
#pragma once

#include "steradian/scene.h"

namespace steradian {

/// The tangent space that glTF prescribes where a mesh has no tangents: MikkTSpace (Mikkelsen 2008, "Simulation of
/// Wrinkled Surfaces Revisited", chapter 3, with the rules of his reference implementation and its angular threshold
/// of 180 degrees), so that maps fit that were baked for it. `uv_set` is the set of texture coordinates that the map
/// is looked up with; v runs downwards.
///
/// Corners that share position, normal and texture coordinates share a tangent where their triangles are connected and
/// none of them is mirrored in the texture; where one vertex needs several tangents, copies of it are appended.
/// Vertices of triangles whose texture coordinates say nothing get a tangent of zero, unless they have one by their
/// neighbours. Nothing changes for meshes without normals or without such coordinates.
void add_tangents(Mesh& mesh, uint32_t uv_set = 0);

}  // namespace steradian
