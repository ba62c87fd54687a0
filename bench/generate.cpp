// The generated scenes that are not a few lines. Deterministic: arithmetic of the project and hashes only.
#include <algorithm>

#include "mesh.h"
#include "random.h"

namespace steradian::bench {
namespace {

float lattice(int64_t x, int64_t y, int64_t z) {
    const uint64_t key = uint64_t(x) * 0x8da6b343u + uint64_t(y) * 0xd8163841u + uint64_t(z) * 0xcb1ab31fu;
    return float(scramble(key + 0x9e3779b97f4a7c15u) >> 40) * 0x1p-23f - 1;
}

/// Value noise in [-1, 1], interpolated smoothly between the points of the integer lattice.
float noise(Vec3 p) {
    const float fx = std::floor(p.x), fy = std::floor(p.y), fz = std::floor(p.z);
    const auto smooth = [](float s) { return s * s * (3 - 2 * s); };
    const auto mix = [](float a, float b, float s) { return a + (b - a) * s; };
    const float sx = smooth(p.x - fx), sy = smooth(p.y - fy), sz = smooth(p.z - fz);
    const auto x = int64_t(fx), y = int64_t(fy), z = int64_t(fz);
    const auto row = [&](int dy, int dz) {
        return mix(lattice(x, y + dy, z + dz), lattice(x + 1, y + dy, z + dz), sx);
    };
    return mix(mix(row(0, 0), row(1, 0), sy), mix(row(0, 1), row(1, 1), sy), sz);
}

/// Octaves of noise, each of half the size and half the height.
float fractal(Vec3 p, int octaves) {
    float sum = 0, weight = 0.5f;
    for (int i = 0; i < octaves; ++i, weight *= 0.5f) {
        sum += weight * noise(p);
        p = p * 2.03f + Vec3{17.1f, 5.7f, 11.3f};
    }
    return sum;
}

/// A grid of k × k squares; `place(u, v)` with u and v in [0, 1] gives its points.
template <class Place>
void add_grid(BenchMesh& mesh, uint32_t k, const Place& place) {
    const auto base = static_cast<uint32_t>(mesh.positions.size());
    for (uint32_t y = 0; y <= k; ++y)
        for (uint32_t x = 0; x <= k; ++x) mesh.positions.push_back(place(float(x) / float(k), float(y) / float(k)));
    for (uint32_t y = 0; y < k; ++y)
        for (uint32_t x = 0; x < k; ++x) {
            const uint32_t a = base + y * (k + 1) + x, b = a + 1, c = a + k + 1, d = c + 1;
            mesh.indices.insert(mesh.indices.end(), {a, b, d, a, d, c});
        }
}

/// Six grids folded into a cube and blown up, so 12 k² triangles; `radius(direction)` is the distance of the surface.
/// The points along the cube's edges coincide exactly: both faces compute them from the same numbers.
template <class Radius>
void add_ball(BenchMesh& mesh, uint32_t k, const Radius& radius) {
    for (int face = 0; face < 6; ++face)
        add_grid(mesh, k, [&](float u, float v) {
            const int axis = face % 3;
            Vec3 p;
            p[axis] = face < 3 ? 1.0f : -1.0f;
            p[(axis + 1) % 3] = 2 * u - 1;
            p[(axis + 2) % 3] = 2 * v - 1;
            const Vec3 d = normalize(p);
            return d * radius(d);
        });
}

BenchMesh rock(uint64_t seed) {
    BenchMesh m;
    const Vec3 offset = Random(seed).in_cube() * 50;
    add_ball(m, 21, [&](Vec3 d) { return 0.6f + 0.5f * fractal(d * 1.7f + offset, 6); });
    return m;
}

/// A cone without its caps: long thin triangles, as branches have them.
void add_branch(BenchMesh& mesh, Vec3 from, Vec3 to, float thickness, uint32_t sides) {
    const auto base = static_cast<uint32_t>(mesh.positions.size());
    const Frame frame = Frame::from_z(normalize(to - from));
    for (uint32_t i = 0; i < sides; ++i) {
        const double angle = 2 * std::numbers::pi * i / sides;
        const Vec3 out = frame.x * float(math::cos(angle)) + frame.y * float(math::sin(angle));
        mesh.positions.push_back(from + out * thickness);
        mesh.positions.push_back(to + out * (0.5f * thickness));
    }
    for (uint32_t i = 0; i < sides; ++i) {
        const uint32_t a = base + 2 * i, b = base + 2 * ((i + 1) % sides);
        mesh.indices.insert(mesh.indices.end(), {a, b, b + 1, a, b + 1, a + 1});
    }
}

void add_leaf(BenchMesh& mesh, Vec3 at, Random& random) {
    const auto base = static_cast<uint32_t>(mesh.positions.size());
    const Frame frame = Frame::from_z(random.cosine_about({0, 1, 0}));
    const float length = random.between(0.02, 0.05), width = 0.4f * length;
    for (const Vec2 corner : {Vec2{0, 0}, Vec2{width, 0.5f * length}, Vec2{-width, 0.5f * length}, Vec2{0, length}})
        mesh.positions.push_back(at + frame.x * corner.x + frame.y * corner.y);
    mesh.indices.insert(mesh.indices.end(), {base, base + 1, base + 2, base + 1, base + 3, base + 2});
}

void grow(BenchMesh& mesh, Vec3 from, Vec3 direction, float length, int levels, Random& random) {
    const Vec3 to = from + direction * length;
    add_branch(mesh, from, to, 0.06f * length, levels > 2 ? 12 : 5);
    if (levels == 0) {
        for (int i = 0; i < 24; ++i) add_leaf(mesh, to + random.in_cube() * (0.6f * length), random);
        return;
    }
    for (int i = 0; i < 3; ++i) {
        const Vec3 bent = normalize(direction + random.in_cube() * 0.8f + Vec3{0, 0.2f, 0});
        grow(mesh, to, bent, length * random.between(0.62, 0.8), levels - 1, random);
    }
}

/// Of height 1, about 18,000 triangles.
BenchMesh tree(uint64_t seed) {
    BenchMesh m;
    Random random(seed);
    grow(m, {0, 0, 0}, normalize(Vec3{random.between(-0.1, 0.1), 1, random.between(-0.1, 0.1)}), 0.32f, 5, random);
    return m;
}

void bake(BenchMesh& mesh, const BenchMesh& object, Vec3 at, double turn, Vec3 scale) {
    const auto base = static_cast<uint32_t>(mesh.positions.size());
    const auto c = static_cast<float>(math::cos(turn)), s = static_cast<float>(math::sin(turn));
    for (const Vec3 p : object.positions) {
        const Vec3 q{p.x * scale.x, p.y * scale.y, p.z * scale.z};
        mesh.positions.push_back(at + Vec3{c * q.x + s * q.z, q.y, c * q.z - s * q.x});
    }
    for (const uint32_t i : object.indices) mesh.indices.push_back(base + i);
}

/// Height of the ground in metres, of a square of 2 × 2 of half-width 1 that stands for `extent` metres.
float ground(float x, float z, float extent) {
    return 0.12f * extent * fractal({3.1f * x, 0.5f, 3.1f * z}, 4) +
           0.6f * fractal({0.4f * extent * x, 7.5f, 0.4f * extent * z}, 4);
}

}  // namespace

BenchMesh bumpy_sphere(size_t triangles) {
    BenchMesh m;
    m.name = "bumpy sphere";
    const auto k = static_cast<uint32_t>(std::max(1.0, std::round(std::sqrt(double(triangles) / 12))));
    add_ball(m, k, [](Vec3 d) { return 1 + 0.4f * fractal(d * 2.3f, 9); });
    m.positions.reserve(m.positions.size() + 2);
    return m;
}

BenchMesh landscape(size_t triangles) {
    constexpr int kKinds = 8;
    std::vector<BenchMesh> trees, rocks;
    for (uint64_t i = 0; i < kKinds; ++i) trees.push_back(tree(100 + i));
    for (uint64_t i = 0; i < kKinds; ++i) rocks.push_back(rock(200 + i));

    BenchMesh m;
    m.positions.reserve(triangles + triangles / 8);
    m.indices.reserve(3 * triangles + triangles / 4);
    const auto k = static_cast<uint32_t>(std::sqrt(0.15 * double(triangles) / 2));
    // As dense whatever the size: 32 m to a side for each million triangles.
    const auto extent = static_cast<float>(16 * std::sqrt(double(triangles) / 1e6));
    add_grid(m, k, [&](float u, float v) {
        const float x = 2 * u - 1, z = 2 * v - 1;
        return Vec3{x * extent, ground(x, z, extent), z * extent};
    });

    Random random(7);
    const Vec3 eye{0.1f * extent, ground(0.1f, 0.9f, extent) + 2.5f, 0.9f * extent};
    while (m.triangles() < triangles) {
        const bool is_tree = random.unit() < 0.55;
        const float x = random.between(-1, 1), z = random.between(-1, 1);
        const BenchMesh& object = (is_tree ? trees : rocks)[size_t(random.unit() * kKinds)];
        const float size = is_tree ? random.between(4, 9) : random.between(0.2, 1.6);
        const Vec3 scale{size * random.between(0.8, 1.2), size, size * random.between(0.8, 1.2)};
        const double turn = 2 * std::numbers::pi * random.unit();
        const Vec3 at{x * extent, ground(x, z, extent), z * extent};
        if (distance(at, eye) > 4) bake(m, object, at, turn, scale);  // no leaf right before the lens
    }
    m.view = View{eye, normalize(Vec3{-0.15f, -0.08f, -1})};
    return m;
}

}  // namespace steradian::bench
