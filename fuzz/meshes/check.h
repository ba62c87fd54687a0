// What must hold for any input: no crash (the sanitizers' part), and a result that keeps its promises.
#pragma once

#include <cstdlib>

#include "formats/mesh_file.h"

namespace steradian {

inline void require(bool condition) {
    if (!condition) std::abort();
}

inline void check_error(const Error& error) {
    require(!error.message.empty() && !error.where.file.empty());
    require(error.str().size() < 8192);
    require(error.code == ErrorCode::bad_input || error.code == ErrorCode::resources);
}

inline void check(const Result<MeshFile>& file) {
    if (!file) return check_error(file.error());
    for (const MeshPart& part : file->parts) {
        const Mesh& mesh = part.mesh;
        require(!mesh.indices.empty() && mesh.indices.size() % 3 == 0);
        require(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
        require(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size());
        for (const uint32_t i : mesh.indices) require(i < mesh.positions.size());
        for (const Vec3 p : mesh.positions)
            require(__builtin_isfinite(p.x) && __builtin_isfinite(p.y) && __builtin_isfinite(p.z));
        require(part.material >= -1 && part.material < static_cast<int>(file->materials.size()));
    }
    require(file->diagnostics.warnings().size() < 5000);
}

}  // namespace steradian
