#include "scenes.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "accel/box.h"
#include "math/transform.h"

namespace steradian::test {

void TriangleMesh::add(Vec3 a, Vec3 b, Vec3 c) {
    for (const Vec3 p : {a, b, c}) {
        indices.push_back(static_cast<uint32_t>(positions.size()));
        positions.push_back(p);
    }
}

void TriangleMesh::move(double scale, Vec3 by) {
    for (Vec3& p : positions) p = Vec3(Vec3d(p) * scale + Vec3d(by));
}

TriangleMesh icosphere(int subdivisions) {
    const float g = 1.6180339887f;
    TriangleMesh m;
    m.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    m.indices = {0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4,  11, 10, 2,  10, 7, 6, 7, 1, 8,
                 3, 9,  4, 3, 4, 2, 3, 2, 6, 3, 6, 8,  3, 8,  9,  4, 9, 5, 2, 4,  11, 6,  2,  10, 8,  6, 7, 9, 8, 1};
    for (Vec3& p : m.positions) p = normalize(p);
    for (int s = 0; s < subdivisions; ++s) {
        std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
        const auto middle = [&](uint32_t a, uint32_t b) {
            const auto [found, added] =
                middles.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<uint32_t>(m.positions.size()));
            if (added) m.positions.push_back(normalize(m.positions[a] + m.positions[b]));
            return found->second;
        };
        std::vector<uint32_t> finer;
        for (size_t i = 0; i < m.indices.size(); i += 3) {
            const uint32_t a = m.indices[i], b = m.indices[i + 1], c = m.indices[i + 2];
            const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca});
        }
        m.indices = std::move(finer);
    }
    return m;
}

TriangleMesh cube() {
    TriangleMesh m;
    for (int i = 0; i < 8; ++i) m.positions.push_back({i & 1 ? 1.f : -1.f, i & 2 ? 1.f : -1.f, i & 4 ? 1.f : -1.f});
    m.indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    return m;
}

TriangleMesh needles(int sides) {
    TriangleMesh m;
    m.positions = {{0, 0, 100}, {0, 0, -100}};
    for (int i = 0; i < sides; ++i) {
        const double angle = 2 * 3.14159265358979 * i / sides;
        m.positions.push_back(Vec3(Vec3d{std::cos(angle), std::sin(angle), 1e-3 * (i % 3)}));
    }
    for (int i = 0; i < sides; ++i) {
        const auto a = static_cast<uint32_t>(2 + i), b = static_cast<uint32_t>(2 + (i + 1) % sides);
        m.indices.insert(m.indices.end(), {0, a, b, 1, b, a});
    }
    return m;
}

std::vector<Geometry> TestScene::geometries() const {
    std::vector<Geometry> all;
    for (const auto& m : meshes) all.push_back(m.geometry());
    for (const auto& s : spheres) all.push_back(std::span<const SphereGeometry>(s));
    for (const auto& r : rectangles) all.push_back(std::span<const RectangleGeometry>(r));
    for (const auto& d : disks) all.push_back(std::span<const DiskGeometry>(d));
    return all;
}

namespace {

/// Points worth aiming at, in the space of the geometry.
struct Features {
    std::vector<Vec3> points;
    Random& random;

    void operator()(const TriangleGeometry& mesh) {
        for (size_t i = 0; i < mesh.indices.size(); i += 3) {
            const Vec3 p[3] = {mesh.positions[mesh.indices[i]], mesh.positions[mesh.indices[i + 1]],
                               mesh.positions[mesh.indices[i + 2]]};
            for (int k = 0; k < 3; ++k) {
                points.push_back(p[k]);
                const double s = random.unit();
                points.push_back(Vec3(Vec3d(p[k]) * (1 - s) + Vec3d(p[(k + 1) % 3]) * s));
            }
            points.push_back(Vec3((Vec3d(p[0]) + Vec3d(p[1]) + Vec3d(p[2])) * (1.0 / 3)));
        }
    }
    void operator()(std::span<const SphereGeometry> spheres) {
        for (const auto& s : spheres) {
            points.push_back(s.center);
            points.push_back(s.center + Vec3{s.radius, 0, 0});
            points.push_back(s.center - Vec3{0, s.radius, 0});
            points.push_back(s.center + random.direction() * s.radius);
        }
    }
    void operator()(std::span<const RectangleGeometry> rectangles) {
        for (const auto& r : rectangles) {
            points.push_back(r.center);
            points.push_back(r.center + r.half_u + r.half_v);
            points.push_back(r.center - r.half_u + r.half_v * static_cast<float>(random.uniform(-1, 1)));
        }
    }
    void operator()(std::span<const DiskGeometry> disks) {
        for (const auto& d : disks) {
            const double angle = random.uniform(0, 6.3);
            points.push_back(d.center);
            points.push_back(d.center + d.axis_u);
            points.push_back(d.center + d.axis_u * static_cast<float>(std::cos(angle)) +
                             d.axis_v * static_cast<float>(std::sin(angle)));
        }
    }
};

}  // namespace

void TestScene::finish(uint64_t seed) {
    const std::vector<Geometry> all = geometries();
    if (instances.empty())
        for (uint32_t i = 0; i < all.size(); ++i) instances.push_back({i, {}});
    Random random(seed);
    for (const GeometryInstance& instance : instances) {
        Features features{{}, random};
        std::visit(features, all[instance.geometry]);
        for (const Vec3 p : features.points) points.push_back(Vec3(transform_point(instance.world_from_object, p)));
    }
    Box box;
    for (const Vec3 p : points) box.extend(p);
    if (!points.empty()) size = length(Vec3d(box.hi) - Vec3d(box.lo));
}

namespace {

TestScene soup(const std::string& name, int count, double scale, Vec3 offset, uint64_t seed) {
    TestScene s(name);
    Random random(seed);
    TriangleMesh m;
    for (int i = 0; i < count; ++i) {
        const Vec3 c = random.in_cube(1);
        m.add(c + random.in_cube(0.4), c + random.in_cube(0.4), c + random.in_cube(0.4));
    }
    m.move(scale, offset);
    s.meshes.push_back(std::move(m));
    return s;
}

TestScene nested() {
    TestScene s("nested: sizes from 1e-30 to 1e15");
    Random random(11);
    TriangleMesh m;
    for (int i = 0; i < 180; ++i) {
        const auto size = static_cast<float>(std::pow(10.0, -30 + 45.0 * i / 180));
        m.add(random.in_cube(1) * size, random.in_cube(1) * size, random.in_cube(1) * size);
    }
    s.meshes.push_back(std::move(m));
    return s;
}

TestScene slivers() {
    TestScene s("slivers");
    Random random(12);
    TriangleMesh m;
    for (int i = 0; i < 150; ++i) {
        const Vec3 a = random.in_cube(1), b = random.in_cube(1);
        const double t = random.uniform(0.2, 0.8);
        const Vec3 c =
            Vec3(Vec3d(a) * t + Vec3d(b) * (1 - t)) + random.in_cube(1) * static_cast<float>(random.decades(-9, -3));
        m.add(a, b, c);
    }
    s.meshes.push_back(std::move(m));
    return s;
}

TestScene degenerate() {
    TestScene s("degenerate: points, segments, duplicates");
    Random random(13);
    TriangleMesh m;
    for (int i = 0; i < 30; ++i) {
        const Vec3 a = random.in_cube(1), b = random.in_cube(1), c = random.in_cube(1);
        m.add(a, a, a);
        m.add(a, b, a);
        m.add(a, b, a + (b - a) * 0.5f);
        m.add(a, b, c);
        m.add(a, b, c);
        m.add(c, b, a);
    }
    s.meshes.push_back(std::move(m));
    return s;
}

TestScene coincident() {
    TestScene s("coincident: one triangle many times, in two instances");
    TriangleMesh m;
    for (int i = 0; i < 60; ++i) m.add({0, 0, 0}, {1, 0, 0.5f}, {0.1f, 1, 0});
    s.meshes.push_back(std::move(m));
    s.instances = {{0, {}}, {0, {}}, {0, translation(0, 0, 0)}};
    return s;
}

/// What a renderer usually has: several meshes and shapes in place, each used once and so all of them in one hierarchy,
/// with an empty one between, in an order that is not that of the geometries; beside transformed instances of the same
/// shapes. Much of it coincides, within a mesh, between meshes and between kinds, so that ids decide.
TestScene mixed() {
    TestScene s("mixed: every kind in place, beside instances");
    TriangleMesh twins, square, grid;
    for (int i = 0; i < 20; ++i) twins.add({0, 0, 0}, {1, 0, 0.5f}, {0.1f, 1, 0});
    square.add({-1, -1, 0.25f}, {1, -1, 0.25f}, {1, 1, 0.25f});
    square.add({-1, -1, 0.25f}, {1, 1, 0.25f}, {-1, 1, 0.25f});
    for (int x = -4; x < 4; ++x)
        for (int y = -4; y < 4; ++y) {
            const float a = 0.25f * static_cast<float>(x), b = 0.25f * static_cast<float>(y);
            grid.add({a, b, -0.5f}, {a + 0.25f, b, -0.5f}, {a, b + 0.25f, -0.5f});
        }
    s.meshes = {twins, square, {}, twins, grid, grid};
    std::vector<SphereGeometry> spheres;
    for (int i = 0; i < 30; ++i) spheres.push_back({{0.1f * static_cast<float>(i % 10), 0, 0}, 0.3f});
    s.spheres = {spheres};
    s.rectangles = {{{{0, 0, 0.25f}, {1, 0, 0}, {0, 1, 0}}}, {{{0, 0, -0.5f}, {1, 0, 0}, {0, 1, 0}}}};
    s.disks = {{{{0, 0, 0.25f}, {1, 0, 0}, {0, 1, 0}}}};
    // Geometries: 0 to 5 meshes, 6 spheres, 7 and 8 rectangles, 9 disk.
    s.instances = {{3, {}},
                   {9, {}},
                   {2, {}},
                   {4, translation(0, 0, 0.25)},
                   {1, {}},
                   {6, {}},
                   {8, {}},
                   {0, {}},
                   {4, rotation_degrees(30, {1, 0, 0})},
                   {5, {}},
                   {7, translation(0.5, 0, 0)},
                   {6, scaling(1, -1, 1)}};
    // The spheres are used twice: neither of them is in place.
    return s;
}

TestScene axis_aligned_grid() {
    TestScene s("grid: flat, axis-aligned, shared edges");
    TriangleMesh m;
    const auto at = [](int x, int y, int plane) {
        const auto u = float(x) / 4 - 1, v = float(y) / 4 - 1;
        return plane == 0 ? Vec3{u, v, 0} : plane == 1 ? Vec3{0.5f, u, v} : Vec3{u, -0.25f, v};
    };
    for (int plane = 0; plane < 3; ++plane)
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < 5; ++x) {
                m.add(at(x, y, plane), at(x + 1, y, plane), at(x + 1, y + 1, plane));
                m.add(at(x, y, plane), at(x + 1, y + 1, plane), at(x, y + 1, plane));
            }
    s.meshes.push_back(std::move(m));
    return s;
}

TestScene closed_mesh() {
    TestScene s("icosphere");
    s.meshes.push_back(icosphere(2));
    return s;
}

std::vector<SphereGeometry> some_spheres(int count, Random& random) {
    std::vector<SphereGeometry> spheres;
    for (int i = 0; i < count; ++i) spheres.push_back({random.in_cube(1), static_cast<float>(random.decades(-6, 0))});
    spheres.push_back({{0, 0, 0}, 0});
    spheres.push_back(spheres.front());
    return spheres;
}
std::vector<RectangleGeometry> some_rectangles(int count, Random& random) {
    std::vector<RectangleGeometry> rectangles;
    for (int i = 0; i < count; ++i) rectangles.push_back({random.in_cube(1), random.in_cube(0.5), random.in_cube(0.5)});
    rectangles.push_back({{0, 0.5f, 0}, {0.5f, 0, 0}, {0, 0, 0.5f}});
    rectangles.push_back({{0, 0, 0}, {0.1f, 0.2f, 0.3f}, {0.2f, 0.4f, 0.6f}});
    rectangles.push_back({{0, 0, 0}, {0, 0, 0}, {0, 0, 0.5f}});
    return rectangles;
}
std::vector<DiskGeometry> some_disks(int count, Random& random) {
    std::vector<DiskGeometry> disks;
    for (int i = 0; i < count; ++i) disks.push_back({random.in_cube(1), random.in_cube(0.5), random.in_cube(0.5)});
    disks.push_back({{0, 0.5f, 0}, {0.5f, 0, 0}, {0, 0, 0.5f}});
    disks.push_back(disks.front());
    return disks;
}

TestScene shapes(int which) {
    static const char* const kNames[] = {"spheres", "rectangles", "disks"};
    TestScene s(kNames[which]);
    Random random(20 + static_cast<uint64_t>(which));
    if (which == 0) s.spheres.push_back(some_spheres(80, random));
    if (which == 1) s.rectangles.push_back(some_rectangles(80, random));
    if (which == 2) s.disks.push_back(some_disks(80, random));
    return s;
}

/// Everything at once, rotated, mirrored, stretched and doubled.
TestScene instanced(const std::string& name, double scale, std::array<double, 3> offset) {
    TestScene s(name);
    Random random(30);
    s.meshes.push_back(soup("", 25, 1, {}, 31).meshes[0]);
    s.meshes.push_back(icosphere(0));
    s.meshes.push_back(TriangleMesh{});  // empty
    s.spheres.push_back(some_spheres(8, random));
    s.rectangles.push_back(some_rectangles(6, random));
    s.disks.push_back(some_disks(6, random));
    const Affine there = translation(offset[0], offset[1], offset[2]) * scaling(scale, scale, scale);
    for (uint32_t i = 0; i < 14; ++i) {
        const auto v = [&] { return random.uniform(-1, 1); };
        const double x = v(), y = v(), z = v(), ax = v(), ay = v(), az = v();
        Affine local = translation(2 * x, 2 * y, 2 * z) * rotation_degrees(random.uniform(0, 360), {ax, ay, az});
        if (i % 3 == 1) local = local * scaling(-1, 1, 0.3);
        if (i % 3 == 2) local = local * scaling(random.decades(-3, 3), 1, random.decades(-3, 0));
        if (i == 6) local = Affine{};
        if (i == 7) local = rotation_degrees(90, {0, 1, 0});
        s.instances.push_back({i % 6, there * local});
    }
    s.instances.push_back(s.instances[0]);
    s.instances.push_back(s.instances[3]);
    return s;
}

/// Instances within each other that are deep enough to be opened: rotated, mirrored, sheared, and some very small or
/// flat.
TestScene pile(double scale, std::array<double, 3> offset) {
    TestScene s("pile of " + std::to_string(scale));
    Random random(40);
    s.meshes.push_back(icosphere(2));
    s.meshes.push_back(soup("", 150, 1, {}, 41).meshes[0]);
    s.spheres.push_back(some_spheres(40, random));
    const Affine there = translation(offset[0], offset[1], offset[2]) * scaling(scale, scale, scale);
    for (uint32_t i = 0; i < 12; ++i) {
        const auto v = [&] { return random.uniform(-1, 1); };
        const double x = v(), y = v(), z = v(), ax = v(), ay = v(), az = v();
        Affine local = translation(x, y, z) * rotation_degrees(random.uniform(0, 360), {ax, ay, az});
        Affine shear;
        shear.m[0][1] = v(), shear.m[1][2] = v();
        if (i % 4 == 1) local = local * shear;
        if (i % 4 == 2) local = local * scaling(-1, 1, random.decades(-3, 0));
        if (i % 4 == 3) local = local * scaling(random.decades(-2, 0), random.decades(-2, 0), random.decades(-2, 0));
        if (i == 8) local = Affine{};
        s.instances.push_back({i % 3, there * local});
    }
    return s;
}

/// Plates near the origin of the world whose vertices are far from that of their own space, where the ray's origin is
/// rounded by more than the distance to them: what their tests find is clamped by the boxes of the instances, again and
/// again.
TestScene far_from_their_own_origin() {
    TestScene s("instances far from their own origin");
    const double away[3] = {3e5, -2e5, 1e5};
    TriangleMesh plates;
    Random random(61);
    for (int i = 0; i < 24; ++i) {
        const auto x = static_cast<float>(away[0] + random.uniform(-1, 1)),
                   y = static_cast<float>(away[1] + random.uniform(-1, 1)),
                   z = static_cast<float>(away[2] + 0.25 * (i % 8));
        plates.add({x, y, z}, {x + 1, y, z}, {x, y + 1, z});
    }
    s.meshes.push_back(std::move(plates));
    s.rectangles.push_back({{{float(away[0]), float(away[1]), float(away[2]) - 1}, {2, 0, 0}, {0, 2, 0}}});
    const Affine back = translation(-away[0], -away[1], -away[2]);
    for (const double angle : {0.0, 90.0, 17.0})
        for (uint32_t geometry = 0; geometry < 2; ++geometry)
            s.instances.push_back({geometry, rotation_degrees(angle, {0, 1, 0}) * back});
    return s;
}

}  // namespace

std::vector<TestScene> hard_scenes() {
    std::vector<TestScene> scenes;
    scenes.push_back(soup("random", 200, 1, {}, 1));
    scenes.push_back(soup("one triangle", 1, 1, {}, 2));
    scenes.push_back(soup("tiny: 1e-20", 60, 1e-20, {}, 3));
    scenes.push_back(soup("denormal: 1e-41", 60, 1e-41, {}, 4));
    scenes.push_back(soup("huge: 5e14", 60, 5e14, {}, 5));
    scenes.push_back(soup("far away", 100, 2, {148376, 1234, -223423}, 6));
    scenes.push_back(soup("so far away that vertices merge", 100, 2, {3e7f, -1e7f, 2e7f}, 7));
    scenes.push_back(nested());
    scenes.push_back(slivers());
    scenes.push_back(degenerate());
    scenes.push_back(coincident());
    scenes.push_back(mixed());
    scenes.push_back(axis_aligned_grid());
    scenes.push_back(closed_mesh());
    for (int which = 0; which < 3; ++which) scenes.push_back(shapes(which));
    scenes.push_back(instanced("instances", 1, {0, 0, 0}));
    scenes.push_back(instanced("instances far away", 3, {1e5, -3e5, 2e5}));
    scenes.push_back(instanced("instances, small", 1e-12, {1e-10, 0, 0}));
    scenes.push_back(far_from_their_own_origin());
    scenes.push_back(pile(1, {0, 0, 0}));
    scenes.push_back(pile(1e-9, {3e-9, 0, 0}));
    scenes.push_back(pile(300, {0, 0, 600}));
    TestScene empty("nothing");
    empty.meshes.emplace_back();
    scenes.push_back(std::move(empty));
    for (size_t i = 0; i < scenes.size(); ++i) scenes[i].finish(100 + i);
    return scenes;
}

std::vector<Ray> hard_rays(const TestScene& scene, size_t count, uint64_t seed) {
    Random random(seed);
    const auto point = [&]() -> Vec3 {
        if (scene.points.empty()) return random.in_cube(1);
        return scene.points[random.below(static_cast<uint32_t>(scene.points.size()))];
    };
    std::vector<Ray> rays(count);
    for (Ray& ray : rays) {
        const Vec3 target = point();
        const double away = scene.size * (random.below(4) ? random.uniform(0.01, 2) : random.decades(-12, 6));
        switch (random.below(8)) {
            case 0:
            case 1:
            case 2:  // at a vertex, an edge or the middle of something
                ray.o = Vec3(Vec3d(target) + Vec3d(random.direction()) * away);
                ray.d = Vec3(Vec3d(target) - Vec3d(ray.o));
                break;
            case 3:  // anywhere
                ray.o = Vec3(Vec3d(target) + Vec3d(random.direction()) * away);
                ray.d = random.direction();
                break;
            case 4: {  // parallel to an axis, through a point, with zeros of both signs
                const int axis = static_cast<int>(random.below(3));
                const double sign = random.below(2) ? 1 : -1;
                ray.d = {random.below(2) ? 0.0f : -0.0f, random.below(2) ? 0.0f : -0.0f,
                         random.below(2) ? 0.0f : -0.0f};
                ray.d[axis] = static_cast<float>(sign);
                ray.o = target;
                ray.o[axis] = static_cast<float>(target[axis] - sign * away);
                break;
            }
            case 5: {  // in a plane of the axes
                const int axis = static_cast<int>(random.below(3));
                ray.o = Vec3(Vec3d(target) + Vec3d(random.direction()) * away);
                ray.o[axis] = target[axis];
                ray.d = Vec3(Vec3d(target) - Vec3d(ray.o));
                break;
            }
            case 6:  // from a surface
                ray.o = target;
                ray.d = random.direction();
                break;
            default:  // from point to point, along edges and through coplanar things
                ray.o = target;
                ray.d = Vec3(Vec3d(point()) - Vec3d(target));
                break;
        }
        if (random.below(2)) ray.d = normalize(ray.d);
        if (random.below(8) == 0) ray.d = ray.d * static_cast<float>(random.decades(-30, 20));
        if (random.below(6) == 0) ray.tmin = static_cast<float>(away * random.unit());
        if (random.below(6) == 0) ray.tmax = static_cast<float>(away * random.uniform(0.5, 1.5));
    }
    return rays;
}

void TestScene::set_cut_outs(size_t instance, std::vector<uint8_t> bits) {
    cut_outs.push_back(std::move(bits));
    instances[instance].cut_outs = cut_outs.back();
}

}  // namespace steradian::test
