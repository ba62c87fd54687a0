// Geometry that is hard on a ray tracer, and rays that look for trouble.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "accel/accel.h"
#include "random.h"

namespace steradian::test {

struct TriangleMesh {
    std::vector<Vec3> positions;
    std::vector<uint32_t> indices;

    TriangleGeometry geometry() const { return {positions, indices}; }
    void add(Vec3 a, Vec3 b, Vec3 c);
    void move(double scale, Vec3 by);
};

TriangleMesh icosphere(int subdivisions);
/// 12 triangles around [-1, 1]³.
TriangleMesh cube();
/// A double cone with `sides` extremely thin triangles on either end.
TriangleMesh needles(int sides);

/// Owns what the spans of an Accel refer to. Not copyable, because spans point into it.
struct TestScene {
    explicit TestScene(std::string scene_name) : name(std::move(scene_name)) {}
    TestScene(TestScene&&) = default;

    std::string name;
    std::vector<TriangleMesh> meshes;
    std::vector<std::vector<SphereGeometry>> spheres;
    std::vector<std::vector<RectangleGeometry>> rectangles;
    std::vector<std::vector<DiskGeometry>> disks;
    std::vector<GeometryInstance> instances;     ///< geometries in the order meshes, spheres, rectangles, disks
    std::vector<std::vector<uint8_t>> cut_outs;  ///< what the instances refer to
    std::vector<Vec3> points;                    ///< in the world: vertices, points on edges, rims and surfaces
    double size = 1;                             ///< how far rays start from what they are aimed at

    std::vector<Geometry> geometries() const;
    /// Fills `points` and, when there are none, one instance without a transform of every geometry.
    void finish(uint64_t seed);
    /// The bits of one instance.
    void set_cut_outs(size_t instance, std::vector<uint8_t> bits);
};

std::vector<TestScene> hard_scenes();

/// Random, aimed at points (vertices, edges), parallel to an axis, from surfaces, with ranges cut short, not
/// normalised.
std::vector<Ray> hard_rays(const TestScene& scene, size_t count, uint64_t seed);

}  // namespace steradian::test
