// The hierarchy against the loop over everything, to the bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "accel/kernels/kernels.h"
#include "base/names.h"
#include "brute_force.h"
#include "support/support.h"

namespace steradian::test {
namespace {

struct Variant {
    BvhBuilder builder;
    uint32_t max_depth;
    Isa isa;
    BvhLayout layout = BvhLayout::full;
    OpenInstances open = OpenInstances::never;
};

/// Every kernel that the machine has on the default hierarchy, in both layouts, with opened instances and without, and
/// on the one with split boxes, and other hierarchies with the kernels in turn.
std::vector<Variant> variants() {
    std::vector<Variant> all;
    const std::vector<Isa> isas = supported_isas();
    for (const Isa isa : isas)
        for (const BvhBuilder builder : {BvhBuilder::sah, BvhBuilder::high_quality}) all.push_back({builder, 64, isa});
    for (const Isa isa : isas)
        for (const OpenInstances open : {OpenInstances::never, OpenInstances::always}) {
            all.push_back({BvhBuilder::sah, 64, isa, BvhLayout::compact, open});
            if (open == OpenInstances::always) all.push_back({BvhBuilder::sah, 64, isa, BvhLayout::full, open});
        }
    size_t turn = 0;
    for (const auto& [builder, max_depth] : {std::pair{BvhBuilder::fast, 64u},
                                             {BvhBuilder::median, 64u},
                                             {BvhBuilder::sah, 5u},
                                             {BvhBuilder::high_quality, 5u},
                                             {BvhBuilder::median, 3u},
                                             {BvhBuilder::sah, 1u},
                                             {BvhBuilder::high_quality, 1u},
                                             {BvhBuilder::fast, 17u},
                                             {BvhBuilder::fast, 2u}})
        all.push_back({builder, max_depth, isas[turn++ % isas.size()], BvhLayout::full, OpenInstances::always});
    for (const auto& [builder, max_depth] : {std::pair{BvhBuilder::high_quality, 64u},
                                             {BvhBuilder::fast, 64u},
                                             {BvhBuilder::median, 3u},
                                             {BvhBuilder::high_quality, 1u}})
        all.push_back({builder, max_depth, isas[turn++ % isas.size()], BvhLayout::compact, OpenInstances::always});
    return all;
}

std::string name_of(const Variant& v) {
    return std::string(steradian::name_of(v.builder)) + ", max depth " + std::to_string(v.max_depth) +
           ", instruction set " + std::to_string(int(v.isa)) + ", " + std::string(steradian::name_of(v.layout)) +
           (v.open == OpenInstances::always ? ", opened" : "");
}

std::vector<Accel> build_all(const TestScene& scene) {
    std::vector<Accel> built;
    const std::vector<Geometry> geometries = scene.geometries();
    for (const Variant& v : variants()) {
        AccelOptions options;
        options.builder = v.builder;
        options.max_depth = v.max_depth;
        options.isa = v.isa;
        options.layout = v.layout;
        options.open = v.open;
        Result<Accel> accel = Accel::build(geometries, scene.instances, options);
        if (!accel) throw std::runtime_error(scene.name + ": " + accel.error().message);
        EXPECT_LE(accel->statistics().depth, v.max_depth) << scene.name << ": " << name_of(v);
        built.push_back(std::move(*accel));
    }
    return built;
}

/// Compares all answers of one variant; at most a few failures are written out.
void compare(const TestScene& scene, const Variant& variant, const Accel& accel, const std::vector<Ray>& rays,
             const std::vector<Hit>& expected, RayKind kind = RayKind::incoherent) {
    std::vector<Hit> hits(rays.size());
    std::vector<uint8_t> occluded(rays.size());
    accel.intersect(rays, hits, kind);
    accel.occluded(rays, occluded, kind);
    size_t different = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        if (same_bits(hits[i], expected[i]) && (occluded[i] != 0) == expected[i].found()) continue;
        if (++different > 3) continue;
        ADD_FAILURE() << scene.name << ", " << name_of(variant) << "\nray      " << describe(rays[i]) << "\nexpected "
                      << describe(expected[i]) << "\ngot      " << describe(hits[i]) << ", occluded "
                      << int(occluded[i]);
    }
    EXPECT_EQ(different, 0u) << scene.name << ", " << name_of(variant) << ": of " << rays.size() << " rays";
}

/// Shortens some ranges to end, or begin, exactly at a hit: both ends are inclusive.
void cut_at_hits(std::vector<Ray>& rays, std::vector<Hit>& hits, const BruteForce& brute) {
    for (size_t i = 0; i < rays.size(); i += 5) {
        if (!hits[i].found()) continue;
        (i % 2 ? rays[i].tmin : rays[i].tmax) = hits[i].t;
        hits[i] = brute.first_hit(rays[i]);
        EXPECT_TRUE(hits[i].found());
    }
}

TEST(Oracle, EveryBitOfEveryHit) {
    const std::vector<TestScene> scenes = hard_scenes();
    const size_t total = by_tier<size_t>(60'000, 10'000'000);
    size_t hit = 0, shot = 0;
    for (size_t s = 0; s < scenes.size(); ++s) {
        const BruteForce brute(scenes[s]);
        const std::vector<Accel> built = build_all(scenes[s]);
        const size_t share = total / scenes.size() + 1, batch = 50'000;
        for (size_t done = 0; done < share; done += batch) {
            std::vector<Ray> rays = hard_rays(scenes[s], std::min(batch, share - done), 1000 * s + done);
            std::vector<Hit> expected(rays.size());
            for (size_t i = 0; i < rays.size(); ++i) expected[i] = brute.first_hit(rays[i]);
            cut_at_hits(rays, expected, brute);
            for (size_t v = 0; v < built.size(); ++v) compare(scenes[s], variants()[v], built[v], rays, expected);
            for (const Hit& h : expected) hit += h.found();
            shot += rays.size();
        }
    }
    // The rays are not all misses.
    EXPECT_GT(hit, shot / 4);
    std::printf("%zu rays, %zu of them hit\n", shot, hit);
}

/// Bundles of rays that follow each other: from one point or from near each other, in nearly the same direction; with
/// zeros of either sign, ranges cut short, and now and then a ray that belongs to no bundle or hits nothing by
/// definition.
std::vector<Ray> coherent_rays(const TestScene& scene, size_t bundles, uint64_t seed) {
    constexpr size_t kBundle = 40;  // not a multiple of anything that a kernel likes
    Random random(seed);
    std::vector<Ray> rays;
    for (const Ray& middle : hard_rays(scene, bundles, seed)) {
        const double spread = random.decades(-6, -0.3),
                     apart = random.below(2) ? 0 : scene.size * random.decades(-6, -1);
        for (size_t i = 0; i < kBundle; ++i) {
            Ray ray = middle;
            ray.d = Vec3(Vec3d(middle.d) + Vec3d(random.in_cube(spread)) * length(Vec3d(middle.d)));
            ray.o = Vec3(Vec3d(middle.o) + Vec3d(random.in_cube(1)) * apart);
            if (random.below(20) == 0) ray.tmax = static_cast<float>(scene.size * random.unit());
            if (random.below(100) == 0) ray.d = -ray.d;
            if (random.below(200) == 0) ray.d = {};
            rays.push_back(ray);
        }
    }
    return rays;
}

TEST(Oracle, CoherentRays) {
    const std::vector<TestScene> scenes = hard_scenes();
    const size_t bundles = by_tier<size_t>(80, 10'000);
    size_t hit = 0, shot = 0;
    for (size_t s = 0; s < scenes.size(); ++s) {
        const BruteForce brute(scenes[s]);
        const std::vector<Accel> built = build_all(scenes[s]);
        const std::vector<Ray> rays = coherent_rays(scenes[s], bundles, 31 + s);
        std::vector<Hit> expected(rays.size());
        for (size_t i = 0; i < rays.size(); ++i) expected[i] = brute.first_hit(rays[i]);
        for (size_t v = 0; v < built.size(); ++v)
            compare(scenes[s], variants()[v], built[v], rays, expected, RayKind::coherent);
        for (const Hit& h : expected) hit += h.found();
        shot += rays.size();
    }
    EXPECT_GT(hit, shot / 4);
}

/// Rays that run exactly along an axis in one component, -0 and 0, in one packet with rays that do not; in the planes
/// of the faces of boxes, where plane - origin is 0 and its product with the infinite reciprocal is not a number.
TEST(Oracle, PacketsWithZerosInThePlanesOfBoxes) {
    TestScene scene("grid");
    TriangleMesh mesh;
    for (int x = 0; x < 12; ++x)
        for (int y = 0; y < 12; ++y) {
            const auto a = static_cast<float>(x), b = static_cast<float>(y),
                       c = static_cast<float>((x * 7 + y * 5) % 4);
            mesh.add({a, b, c}, {a + 1, b, c}, {a, b + 1, c});
        }
    scene.meshes.push_back(std::move(mesh));
    scene.finish(1);
    const BruteForce brute(scene);
    const std::vector<Accel> built = build_all(scene);
    Random random(9);
    std::vector<Ray> rays;
    for (size_t packet = 0; packet < by_tier<size_t>(2'000, 100'000); ++packet) {
        const float sign_x = random.below(2) ? 1.0f : -1.0f, sign_y = random.below(2) ? 1.0f : -1.0f;
        const auto x = static_cast<float>(random.below(13)), y = static_cast<float>(random.below(13));
        for (int i = 0; i < 16; ++i) {
            Ray ray{{x, y, 9}, 0, {0, 0, -1}, kInfinity};
            ray.d.x = sign_x * (random.below(2) ? 0.0f : static_cast<float>(random.decades(-6, 0)));
            ray.d.y = sign_y * (random.below(2) ? 0.0f : static_cast<float>(random.decades(-6, 0)));
            if (random.below(4) == 0) ray.o.x = static_cast<float>(random.below(13));
            rays.push_back(ray);
        }
    }
    std::vector<Hit> expected(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) expected[i] = brute.first_hit(rays[i]);
    for (size_t v = 0; v < built.size(); ++v)
        compare(scene, variants()[v], built[v], rays, expected, RayKind::coherent);
}

/// Rows of thousands of shapes and instances, each of them a leaf that all rays of a packet meet: what a ray takes with
/// it from its packet is more than any stack holds.
TEST(Oracle, PacketsAlongLongRows) {
    TestScene scene("rows");
    TriangleMesh triangle;
    triangle.add({-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
    scene.meshes.push_back(std::move(triangle));
    for (int kind = 0; kind < 3; ++kind) {
        std::vector<SphereGeometry> row;
        // The rays of one packet pass beside these, but within their boxes.
        for (int i = 0; i < 1500; ++i)
            row.push_back({{0.9f, 0.9f, static_cast<float>(-4 * i - kind)}, kind == 0 ? 1.0f : 1.05f});
        scene.spheres.push_back(std::move(row));
    }
    for (uint32_t g = 1; g <= 3; ++g) scene.instances.push_back({g, {}});
    for (int i = 0; i < 1500; ++i) scene.instances.push_back({0, translation(0, 0, -4.0 * i - 3)});
    scene.finish(2);
    const BruteForce brute(scene);
    const std::vector<Accel> built = build_all(scene);
    Random random(4);
    std::vector<Ray> rays;
    for (size_t packet = 0; packet < by_tier<size_t>(4, 40); ++packet)
        for (int i = 0; i < 16; ++i) {
            // Off to a corner of the boxes, where most packets hit nothing at all, or something far down the row.
            const double corner = packet % 2 ? 0.05 : 0.3;
            Ray ray{
                {static_cast<float>(corner + 0.01 * random.unit()), static_cast<float>(1.7 + 0.05 * random.unit()), 9},
                0,
                {static_cast<float>(1e-6 * random.unit()), static_cast<float>(1e-6 * random.unit()), -1},
                kInfinity};
            rays.push_back(ray);
        }
    std::vector<Hit> expected(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) expected[i] = brute.first_hit(rays[i]);
    for (size_t v = 0; v < built.size(); ++v)
        compare(scene, variants()[v], built[v], rays, expected, RayKind::coherent);
}

/// Sheets that are a few floats of t apart, seen in packets from far away, in no order of their ids: which comes first
/// is less than what a float computation of t is off by. The sheets lie along an axis, where the slope adds nothing to
/// that.
TEST(Oracle, PacketsTellSheetsApart) {
    TestScene scene("sheets");
    TriangleMesh mesh;
    constexpr int kSheets = 24;
    for (int i = 0; i < kSheets; ++i) {
        // A float at 100 is 2^-17 wide. The nearest sheet has not the smallest id, which would win a tie of t.
        const float z = -100 - static_cast<float>((i * 7 + 11) % kSheets) * 0x1p-17f;
        mesh.add({-9, -9, z}, {9, -9, z}, {9, 9, z});
        mesh.add({-9, -9, z}, {9, 9, z}, {-9, 9, z});
    }
    scene.meshes.push_back(std::move(mesh));
    scene.finish(3);
    const BruteForce brute(scene);
    const std::vector<Accel> built = build_all(scene);
    Random random(6);
    std::vector<Ray> rays;
    for (size_t packet = 0; packet < by_tier<size_t>(100, 4000); ++packet) {
        const Vec3 to{static_cast<float>(8 * random.unit()), static_cast<float>(8 * random.unit()), -100};
        for (int i = 0; i < 16; ++i) {
            Ray ray{{0.25f, 0.5f, 0}, 0, to + random.in_cube(0.2), kInfinity};
            // Some of them end within the sheets.
            if (packet % 3 == 0) ray.tmax = 1 + static_cast<float>(i) * 0x1p-23f;
            if (packet % 3 == 1) ray.tmin = 1 + static_cast<float>(i) * 0x1p-23f;
            rays.push_back(ray);
        }
    }
    std::vector<Hit> expected(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) expected[i] = brute.first_hit(rays[i]);
    for (size_t v = 0; v < built.size(); ++v)
        compare(scene, variants()[v], built[v], rays, expected, RayKind::coherent);
}

/// A rectangle and, coincident with it, a triangle that is found last, because its box reaches far; in between, what a
/// ray takes from its packet is visited, and so the rectangle is hit first. At the same t the smaller instance wins.
TEST(Oracle, PacketsKeepWhatWasHitOnTheWay) {
    TestScene scene("rectangle before a triangle");
    TriangleMesh triangle;
    triangle.add({-1, -1, -20}, {4000, -1, -20}, {-1, 4000, -20});
    scene.meshes.push_back(std::move(triangle));
    std::vector<SphereGeometry> row;
    // The rays pass beside these, but within their boxes.
    for (int i = 0; i < 400; ++i) row.push_back({{0.9f, 0.9f, -22.5f - 2.2f * static_cast<float>(i)}, 1.05f});
    scene.spheres.push_back(std::move(row));
    scene.rectangles.push_back({{{0, 0, -20}, {2, 0, 0}, {0, 2, 0}}});
    // Geometries: 0 mesh, 1 spheres, 2 rectangle. Once the rectangle comes first in the order of instances, once last.
    for (const bool rectangle_first : {true, false}) {
        scene.instances = rectangle_first ? std::vector<GeometryInstance>{{2, {}}, {1, {}}, {0, {}}}
                                          : std::vector<GeometryInstance>{{0, {}}, {1, {}}, {2, {}}};
        const BruteForce brute(scene);
        const std::vector<Accel> built = build_all(scene);
        std::vector<Ray> rays;
        Random random(3);
        for (int i = 0; i < 16; ++i)
            rays.push_back(
                {{static_cast<float>(0.05 + 0.01 * random.unit()), static_cast<float>(1.7 + 0.05 * random.unit()), 0},
                 0,
                 {static_cast<float>(1e-7 * random.unit()), static_cast<float>(1e-7 * random.unit()), -1},
                 kInfinity});
        std::vector<Hit> expected(rays.size());
        for (size_t i = 0; i < rays.size(); ++i) {
            expected[i] = brute.first_hit(rays[i]);
            ASSERT_EQ(expected[i].t, 20);
            ASSERT_EQ(expected[i].instance, 0u);
        }
        for (size_t v = 0; v < built.size(); ++v)
            compare(scene, variants()[v], built[v], rays, expected, RayKind::coherent);
    }
}

/// Spans of rays in the ordered continuation, on every kernel: all hits in turn, of all rays at once.
TEST(Oracle, NextHitsOfManyRays) {
    const std::vector<TestScene> scenes = hard_scenes();
    for (size_t s = 0; s < scenes.size(); ++s) {
        const BruteForce brute(scenes[s]);
        const std::vector<Accel> built = build_all(scenes[s]);
        const std::vector<Ray> rays = hard_rays(scenes[s], by_tier<size_t>(100, 2'000), 500 + s);
        std::vector<std::vector<Hit>> expected;
        size_t most = 0;
        for (const Ray& ray : rays)
            expected.push_back(brute.all_hits(ray)), most = std::max(most, expected.back().size());
        for (size_t v = 0; v < built.size(); ++v) {
            std::vector<Hit> hits(rays.size()), after;
            built[v].intersect(rays, hits);
            for (size_t k = 0; k <= std::min<size_t>(most, 20); ++k) {
                for (size_t i = 0; i < rays.size(); ++i)
                    ASSERT_TRUE(same_bits(hits[i], k < expected[i].size() ? expected[i][k] : Hit{}))
                        << scenes[s].name << ", " << name_of(variants()[v]) << ", hit " << k << ", "
                        << describe(rays[i]);
                after = hits;
                built[v].next_hit(rays, after, hits);
            }
        }
    }
}

/// Spans of every length around the sizes that the kernels work in.
TEST(Oracle, AnyNumberOfRays) {
    TestScene scene("sphere");
    scene.meshes.push_back(icosphere(3));
    scene.finish(1);
    const std::vector<Ray> rays = hard_rays(scene, 4100, 5);
    std::vector<size_t> counts;
    for (size_t count = 0; count <= 200; ++count) counts.push_back(count);
    for (size_t count = 4090; count <= rays.size(); ++count) counts.push_back(count);
    for (const BvhLayout layout : {BvhLayout::full, BvhLayout::compact}) {
        AccelOptions options;
        options.layout = layout;
        const Result<Accel> accel = Accel::build(scene.geometries(), scene.instances, options);
        ASSERT_TRUE(accel);
        std::vector<Hit> alone(rays.size());
        std::vector<uint8_t> occluded_alone(rays.size());
        for (size_t i = 0; i < rays.size(); ++i)
            alone[i] = accel->intersect(rays[i]), occluded_alone[i] = accel->occluded(rays[i]);
        for (const size_t count : counts)
            for (const RayKind kind : {RayKind::incoherent, RayKind::coherent}) {
                const Hit untouched{1, 2, 3, 4, 5};
                std::vector<Hit> hits(rays.size() + 1, untouched);
                std::vector<uint8_t> occluded(rays.size() + 1, 7);
                accel->intersect(std::span(rays).first(count), std::span(hits).first(count), kind);
                accel->occluded(std::span(rays).first(count), std::span(occluded).first(count), kind);
                for (size_t i = 0; i < count; ++i) {
                    ASSERT_TRUE(same_bits(hits[i], alone[i])) << count << " rays, ray " << i;
                    ASSERT_EQ(occluded[i], occluded_alone[i]) << count << " rays, ray " << i;
                }
                ASSERT_TRUE(same_bits(hits[count], untouched));
                ASSERT_EQ(occluded[count], 7);
            }
    }
}

TEST(Oracle, NextHitEnumeratesAllHitsInOrder) {
    const std::vector<TestScene> scenes = hard_scenes();
    const size_t each = by_tier<size_t>(120, 20'000);
    for (size_t s = 0; s < scenes.size(); ++s) {
        const BruteForce brute(scenes[s]);
        const std::vector<Accel> built = build_all(scenes[s]);
        const std::vector<Ray> rays = hard_rays(scenes[s], each, 77 + s);
        for (const Ray& ray : rays) {
            const std::vector<Hit> expected = brute.all_hits(ray);
            for (size_t v = 0; v < built.size(); ++v) {
                Hit hit = built[v].intersect(ray);
                for (size_t k = 0; k <= expected.size(); ++k) {
                    const Hit& wanted = k < expected.size() ? expected[k] : Hit{};
                    ASSERT_TRUE(same_bits(hit, wanted))
                        << scenes[s].name << ", " << name_of(variants()[v]) << ", hit " << k << " of "
                        << expected.size() << "\nray      " << describe(ray) << "\nexpected " << describe(wanted)
                        << "\ngot      " << describe(hit);
                    const Hit after = hit;
                    built[v].next_hit({&ray, 1}, {&after, 1}, {&hit, 1});
                }
                EXPECT_FALSE(hit.found());
            }
        }
    }
}

}  // namespace
}  // namespace steradian::test
