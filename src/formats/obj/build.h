// The second half of reading an OBJ file: records to meshes, one for each material.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "formats/mesh_file.h"
#include "formats/obj/records.h"

namespace steradian::obj {

/// One polygon of the file.
struct Face {
    const Corner* corners = nullptr;
    uint32_t size = 0;
    uint32_t smoothing = 0;  ///< group, 0: off

    std::span<const Corner> all() const { return {corners, size}; }
};

/// The faces of one material, in file order.
struct FaceList {
    std::string_view material;  ///< as `usemtl` names it; its data pointer is the place of the first use
    std::string_view group;     ///< of the first face
    bool has_material = false;
    std::vector<Face> faces;
};

/// What the lists leave out or had to bend.
struct BuildCounts {
    uint64_t not_finite = 0;       ///< faces dropped because a coordinate is not usable (see usable_position)
    int32_t first_not_finite = 0;  ///< the first such position of the first of them
    uint64_t fans = 0;             ///< polygons that cross themselves or are too intricate, cut as fans
};

/// Faces by material, in the order of their first use; those that use a position that is not usable are dropped.
std::vector<FaceList> sort_faces(const Records& records, BuildCounts& counts);

/// One mesh for each list. Throws ParseFailure (resources) when indices do not fit into 32 bits.
/// Normals: the file's where a corner has one; in a smoothing group the mean over the group's faces about the vertex,
/// weighted by their angles (Thürmer and Wüthrich 1998); else the face's own. Lists whose corners all are of the last
/// kind get no normals at all. UVs are flipped; corners without one have (0, 0).
std::vector<Mesh> build_meshes(const Records& records, std::span<const FaceList> lists, BuildCounts& counts);

}  // namespace steradian::obj
