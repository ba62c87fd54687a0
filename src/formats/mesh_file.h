// Model files (OBJ with MTL, PLY) as meshes and the materials they ask for, before they become part of a Scene.
#pragma once

#include <string>
#include <vector>

#include "steradian/load.h"
#include "steradian/result.h"
#include "steradian/scene.h"

namespace steradian {

/// What an MTL file can say that we use. Paths are resolved against the MTL file's folder.
struct MeshMaterial {
    std::string name;
    SourceLocation where;                    ///< of the name
    Rgb diffuse{0.6f, 0.6f, 0.6f};           ///< Kd, linear
    std::string diffuse_map;                 ///< map_Kd; empty: none
    SourceLocation diffuse_map_where;        ///< of that name, for messages about the file
    Vec2 map_scale{1, 1}, map_offset{0, 0};  ///< uv * scale + offset, for uvs as in Mesh (v downwards)
    bool map_clamp = false;
    Rgb emission{0, 0, 0};      ///< Ke, taken as radiance
    Rgb specular{0, 0, 0};      ///< Ks
    Rgb transmission{1, 1, 1};  ///< Tf
    float ior = 1.5f;           ///< Ni
    float dissolve = 1;         ///< d, or 1 - Tr
    int illum = 2;              ///< 3 mirror; 4, 6, 7, 9 glass
};

/// The faces that share one material.
struct MeshPart {
    Mesh mesh;
    int material = -1;          ///< index into MeshFile::materials, -1: none given
    std::string name;           ///< the material's as the file has it, defined or not; else that of the object or group
    SourceLocation where = {};  ///< of its first face or the name of its material; a file alone: somewhere in it
};

struct MeshFile {
    std::vector<MeshPart> parts;          ///< in order of first use; empty when the file has no faces
    std::vector<MeshMaterial> materials;  ///< those that parts use, in order of first use
    Diagnostics diagnostics;
    std::vector<std::string> libraries;         ///< the MTL files that were read
    ColorSpace color_space = ColorSpace::srgb;  ///< of the vertices' colours, which are as in the file
    uint64_t dropped_faces = 0;                 ///< whose coordinates are not usable (see usable_position)
};

/// Counts faces as dropped and warns about them; nothing when there are none. `where`: the first of their vertices.
void note_dropped(MeshFile& file, SourceLocation where, uint64_t faces);

/// By extension, .obj or .ply. UVs are flipped to Steradian's convention (v downwards).
Result<MeshFile> load_mesh_file(const std::string& path, const LoadOptions& options = {});

/// The same from memory (for tests and fuzzing); `folder` is where an OBJ's mtllib is looked for.
Result<MeshFile> parse_obj(std::string_view text, const std::string& name, const std::string& folder,
                           const LoadOptions& options);
Result<MeshFile> parse_ply(std::string_view data, const std::string& name, const LoadOptions& options);

}  // namespace steradian
