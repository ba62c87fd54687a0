// Helpers of the tests of model files.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "formats/mesh_file.h"

namespace steradian {

/// Folder names in these tests lead nowhere unless said otherwise, so that no material library is found.
inline Result<MeshFile> read_obj(std::string_view text, const std::string& folder = "no-such-folder") {
    return parse_obj(text, "test.obj", folder, {});
}
inline Result<MeshFile> read_ply(std::string_view data) { return parse_ply(data, "test.ply", {}); }

/// The file, or a test failure with the error and an empty one.
inline MeshFile expect_ok(Result<MeshFile> file) {
    EXPECT_TRUE(file.ok()) << (file.ok() ? "" : file.error().str());
    return file.ok() ? std::move(file).value() : MeshFile{};
}

/// The only part's mesh.
inline Mesh only_mesh(Result<MeshFile> result) {
    MeshFile file = expect_ok(std::move(result));
    EXPECT_EQ(file.parts.size(), 1u);
    return file.parts.empty() ? Mesh{} : std::move(file.parts[0].mesh);
}

inline uint64_t warning_count(const Diagnostics& diagnostics, std::string_view part) {
    uint64_t count = 0;
    for (const Warning& w : diagnostics.warnings())
        if (w.message.find(part) != std::string::npos) count += w.count;
    return count;
}
inline std::string all_warnings(const Diagnostics& diagnostics) {
    std::string out;
    for (const Warning& w : diagnostics.warnings()) out += w.str() + "\n";
    return out;
}

inline std::vector<Vec3> corner_positions(const Mesh& mesh) {
    std::vector<Vec3> out;
    for (const uint32_t i : mesh.indices) out.push_back(mesh.positions[i]);
    return out;
}

/// Every array has the length that Mesh promises and every index is in range.
inline void expect_consistent(const MeshFile& file) {
    for (const MeshPart& part : file.parts) {
        const Mesh& mesh = part.mesh;
        EXPECT_EQ(mesh.indices.size() % 3, 0u);
        EXPECT_FALSE(mesh.indices.empty());
        EXPECT_TRUE(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
        EXPECT_TRUE(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size());
        for (const uint32_t i : mesh.indices) ASSERT_LT(i, mesh.positions.size());
        EXPECT_GE(part.material, -1);
        EXPECT_LT(part.material, static_cast<int>(file.materials.size()));
    }
}

/// How often directed edges stay without their opposite, edges being told apart by the bits of their ends.
inline size_t open_edges(const MeshFile& file) {
    using Edge = std::array<float, 6>;
    std::map<Edge, int> balance;
    for (const MeshPart& part : file.parts) {
        const std::vector<Vec3> p = corner_positions(part.mesh);
        for (size_t i = 0; i < p.size(); ++i) {
            const Vec3 a = p[i], b = p[i % 3 == 2 ? i - 2 : i + 1];
            const Edge forward{a.x, a.y, a.z, b.x, b.y, b.z}, back{b.x, b.y, b.z, a.x, a.y, a.z};
            if (forward < back)
                ++balance[forward];
            else
                --balance[back];
        }
    }
    size_t open = 0;
    for (const auto& [edge, count] : balance) open += count != 0;
    return open;
}

}  // namespace steradian
