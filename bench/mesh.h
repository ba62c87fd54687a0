// The meshes that are measured: generated ones, the same on every machine, and files.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "accel/accel.h"

namespace steradian::bench {

struct View {
    Vec3 from, forward;  ///< forward is a unit vector
};

struct BenchMesh {
    std::string name;
    std::vector<Vec3> positions;  ///< with capacity to spare: Embree reads 16 bytes of every vertex, the last one too
    std::vector<uint32_t> indices;
    std::optional<View> view;  ///< where the mesh is to be seen from; nothing: rays.h finds a place

    size_t triangles() const { return indices.size() / 3; }
    TriangleGeometry geometry() const { return {positions, indices}; }
};

struct NamedMesh {
    std::string name, description;
    BenchMesh (*generate)();
};
/// sphere, soup, landscape-2m, landscape-10m.
const std::vector<NamedMesh>& generated_meshes();

/// A closed sphere with dents on every scale, of about as many triangles (12 k²); for the study over triangle counts.
BenchMesh bumpy_sphere(size_t triangles);
/// A displaced ground with trees of many small leaves and with rocks, seen from a man's height; about as many
/// triangles. What makes it hard: wide and tiny triangles side by side, long thin ones, boxes that overlap, rays that
/// pass through much before they hit.
BenchMesh landscape(size_t triangles);

/// A name of generated_meshes, or an OBJ or PLY file. "model.ply:1" divides every triangle into four, once.
Result<BenchMesh> make_mesh(const std::string& argument);

/// Divides every triangle into four.
void subdivide(BenchMesh& mesh);

}  // namespace steradian::bench
