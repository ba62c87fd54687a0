// What is measured: meshes, and rays recorded once so that every engine traces the same ones.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "accel/accel.h"

namespace steradian::bench {

struct BenchMesh {
    std::string name;
    std::vector<Vec3> positions;
    std::vector<uint32_t> indices;

    size_t triangles() const { return indices.size() / 3; }
    TriangleGeometry geometry() const { return {positions, indices}; }
};

/// A sphere of 327,680 triangles and 300,000 small triangles at random: for those who have no mesh at hand.
std::vector<BenchMesh> generated_meshes();
/// An OBJ or PLY file. "model.ply:1" divides every triangle into four, once.
Result<BenchMesh> load_mesh(const std::string& argument);

struct RaySet {
    std::string name;
    bool any_hit = false;
    std::vector<Ray> rays;
};

/// Rays as a renderer makes them, in pixel order:
///   camera:    size² pinhole rays; from the middle of an interior, else from outside with the mesh filling the picture
///   diffuse:   one cosine-distributed ray from every point that the camera sees
///   occlusion: the same once more, shadow rays of at most a tenth of the diagonal
std::vector<RaySet> record_rays(const Accel& accel, const BenchMesh& mesh, uint32_t size);

}  // namespace steradian::bench
