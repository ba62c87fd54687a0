// Tangents that are made for meshes without: values that follow from the method by hand, and what hostile meshes do.
#include "formats/mesh/tangent_space.h"

#include <gtest/gtest.h>

#include <cmath>

#include "math/vector.h"

namespace steradian {
namespace {

/// The tangent at a corner after add_tangents.
const Tangent& at(const Mesh& mesh, size_t corner) { return mesh.tangents.at(mesh.indices.at(corner)); }

void expect_tangent(const Tangent& t, Vec3d direction, float side) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(t.direction[i], direction[i], 1e-6);
    EXPECT_EQ(t.side, side);
}

/// A square of two triangles, facing +z; u to the right, v downwards.
Mesh square() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    return mesh;
}

TEST(TangentSpace, ASquare) {
    Mesh mesh = square();
    add_tangents(mesh);
    EXPECT_EQ(mesh.positions.size(), 4u);
    for (size_t corner = 0; corner < 6; ++corner) expect_tangent(at(mesh, corner), {1, 0, 0}, 1);  // up = z × x = -v
    // A texture that is mirrored: u to the left.
    mesh = square();
    for (Vec2& uv : mesh.uvs) uv.x = -uv.x;
    add_tangents(mesh);
    for (size_t corner = 0; corner < 6; ++corner) expect_tangent(at(mesh, corner), {-1, 0, 0}, -1);
    // Turned by 90 degrees: u upwards.
    mesh = square();
    for (Vec2& uv : mesh.uvs) uv = {-uv.y, uv.x};
    add_tangents(mesh);
    for (size_t corner = 0; corner < 6; ++corner) expect_tangent(at(mesh, corner), {0, 1, 0}, 1);
}

/// Around vertex 0 there are two triangles with angles of 90 and 45 degrees whose textures are turned against each
/// other: the mean is weighed by the angles.
TEST(TangentSpace, CornersAreWeighedByTheirAngles) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 1, 0}};
    mesh.normals.assign(4, {0, 0, 1});
    // Triangle (0, 1, 2): u = x, v = -y. Triangle (0, 2, 3): u = -x, v = -y: mirrored, so the two share nothing.
    mesh.uvs = {{0, 0}, {1, 0}, {0, -1}, {1, -1}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    add_tangents(mesh);
    EXPECT_EQ(mesh.positions.size(), 6u);
    expect_tangent(at(mesh, 0), {1, 0, 0}, 1);
    expect_tangent(at(mesh, 3), {-1, 0, 0}, -1);
    // Now u = 2x, v = -y - x in the second triangle: u grows along (1, -1), at constant v.
    mesh.positions.resize(4), mesh.normals.resize(4), mesh.tangents.clear();
    mesh.uvs = {{0, 0}, {1, 0}, {0, -1}, {-2, 0}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    add_tangents(mesh);
    const double a = std::numbers::pi / 2, b = std::numbers::pi / 4;
    const Vec3d first{1, 0, 0}, second = normalize(Vec3d{1, -1, 0});
    EXPECT_EQ(mesh.positions.size(), 4u);
    expect_tangent(at(mesh, 0), normalize(first * a + second * b), 1);
    expect_tangent(at(mesh, 1), first, 1);
    expect_tangent(at(mesh, 2), normalize(first * (std::numbers::pi / 4) + second * (std::numbers::pi / 2)), 1);
    expect_tangent(at(mesh, 5), second, 1);
}

/// On a sphere the tangents are those of the formula, as near as the triangles are to it; the seam's vertices are two
/// of each, as u is.
TEST(TangentSpace, ASphere) {
    constexpr uint32_t kAround = 96, kDown = 48;
    Mesh mesh;
    for (uint32_t j = 0; j <= kDown; ++j)
        for (uint32_t i = 0; i <= kAround; ++i) {
            const double phi = 2 * std::numbers::pi * i / kAround, theta = std::numbers::pi * j / kDown;
            const Vec3 p{float(std::sin(theta) * std::cos(phi)), float(std::cos(theta)),
                         float(-std::sin(theta) * std::sin(phi))};
            mesh.positions.push_back(p), mesh.normals.push_back(p);
            mesh.uvs.push_back({float(i) / kAround, float(j) / kDown});
        }
    for (uint32_t j = 0; j < kDown; ++j)
        for (uint32_t i = 0; i < kAround; ++i) {
            const uint32_t a = j * (kAround + 1) + i, b = a + kAround + 1;
            if (j > 0) mesh.indices.insert(mesh.indices.end(), {a, b, a + 1});
            if (j + 1 < kDown) mesh.indices.insert(mesh.indices.end(), {a + 1, b, b + 1});
        }
    add_tangents(mesh);
    for (uint32_t v = kAround + 1; v < kDown * (kAround + 1); ++v) {
        const Vec3d n = mesh.normals[v], t = mesh.tangents[v].direction;
        const Vec3d along = normalize(Vec3d{n.z, 0, -n.x});
        EXPECT_NEAR(dot(t, n), 0, 1e-6);
        EXPECT_GT(dot(t, along), 1 - 2e-3) << v;
        EXPECT_EQ(mesh.tangents[v].side, 1);
    }
}

TEST(TangentSpace, TheSetOfCoordinatesIsChosen) {
    Mesh mesh = square();
    mesh.more_uvs = {mesh.uvs};
    for (Vec2& uv : mesh.more_uvs[0]) uv = {-uv.y, uv.x};
    mesh.colors.assign(4, {1, 1, 1});
    add_tangents(mesh, 1);
    expect_tangent(at(mesh, 0), {0, 1, 0}, 1);
    mesh = square();
    add_tangents(mesh, 1);
    EXPECT_TRUE(mesh.tangents.empty());
    mesh.normals.clear();
    add_tangents(mesh);
    EXPECT_TRUE(mesh.tangents.empty());
}

TEST(TangentSpace, TrianglesThatSayNothing) {
    // The second triangle's texture coordinates are one point: its corners follow their neighbours where they have one.
    Mesh mesh = square();
    mesh.positions.push_back({2, 2, 0}), mesh.normals.push_back({0, 0, 1}), mesh.uvs.push_back({1, 0});
    mesh.indices.insert(mesh.indices.end(), {2, 4, 4, 1, 4, 2});
    mesh.uvs[4] = mesh.uvs[2];
    add_tangents(mesh);
    expect_tangent(at(mesh, 6), {1, 0, 0}, 1);  // without area: borrowed of vertex 2
    expect_tangent(at(mesh, 9), {1, 0, 0}, 1);  // with area, without coordinates: of its neighbour over the edge
    expect_tangent(at(mesh, 11), {1, 0, 0}, 1);
    EXPECT_EQ(at(mesh, 10).direction, (Vec3{0, 0, 0}));
}

/// All attributes of a vertex go with its copies.
TEST(TangentSpace, CopiesOfVerticesKeepEverything) {
    Mesh mesh = square();
    mesh.positions.push_back({2, 0, 0}), mesh.positions.push_back({2, 1, 0});
    mesh.normals.resize(6, {0, 0, 1});
    mesh.uvs.push_back({0, 1}), mesh.uvs.push_back({0, 0});  // mirrored at x = 1
    mesh.indices.insert(mesh.indices.end(), {1, 4, 5, 1, 5, 2});
    mesh.more_uvs = {{}, {{0, 0}, {1, 2}, {3, 4}, {0, 0}, {0, 0}, {0, 0}}};
    mesh.colors = {{0, 0, 0}, {0.1f, 0, 0}, {0.2f, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    mesh.alphas = {0, 0.3f, 0.4f, 0, 0, 0};
    const Mesh before = mesh;
    add_tangents(mesh);
    ASSERT_EQ(mesh.positions.size(), 8u);
    for (size_t c = 0; c < mesh.indices.size(); ++c) {
        const uint32_t now = mesh.indices[c], then = before.indices[c];
        EXPECT_EQ(mesh.positions[now], before.positions[then]);
        EXPECT_EQ(mesh.normals[now], before.normals[then]);
        EXPECT_EQ(mesh.uvs[now], before.uvs[then]);
        EXPECT_EQ(mesh.more_uvs[1].at(now), before.more_uvs[1][then]);
        EXPECT_EQ(mesh.colors.at(now), before.colors[then]);
        EXPECT_EQ(mesh.alphas.at(now), before.alphas[then]);
        expect_tangent(at(mesh, c), {c < 6 ? 1.0 : -1.0, 0, 0}, c < 6 ? 1.0f : -1.0f);
    }
    EXPECT_TRUE(mesh.more_uvs[0].empty());
}

/// Hundreds of thousands of triangles around one vertex or at one edge, with a normal that is no number.
TEST(TangentSpace, NoMeshIsSplitFurtherThanItsCorners) {
    constexpr uint32_t kMany = 200000;
    Mesh fan;  // every triangle by itself, each with a tangent of its own, at vertex 0
    fan.positions = {{0, 0, 0}};
    fan.uvs = {{0, 0}};
    Mesh book;  // all pages at one edge
    book.positions = {{0, 0, 0}, {0, 1, 0}};
    book.uvs = {{0, 0}, {0, 1}};
    for (uint32_t i = 0; i < kMany; ++i) {
        const float x = float(i) / kMany;
        const auto at = static_cast<uint32_t>(fan.positions.size()),
                   page = static_cast<uint32_t>(book.positions.size());
        fan.positions.insert(fan.positions.end(), {{1, x, 0}, {x, 1, 0}});
        fan.uvs.insert(fan.uvs.end(), {{1, -x * x}, {x, -1 - x}});
        fan.indices.insert(fan.indices.end(), {0, at, at + 1});
        book.positions.push_back({1 + x, x, 0});
        book.uvs.push_back({1, x});
        book.indices.insert(book.indices.end(), {0, 1, page});
    }
    for (Mesh* mesh : {&fan, &book}) {
        mesh->normals.assign(mesh->positions.size(), {0, 0, 1});
        // Tangents that are not numbers are not equal to themselves.
        mesh->normals[0] = {std::nanf(""), 0, 1};
        const size_t vertices = mesh->positions.size();
        add_tangents(*mesh);
        EXPECT_EQ(mesh->tangents.size(), mesh->positions.size());
        EXPECT_LE(mesh->positions.size(), vertices + 3 * kMany);
    }
}

}  // namespace
}  // namespace steradian
