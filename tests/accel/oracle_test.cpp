// The hierarchy against the loop over everything, to the bit.
#include <gtest/gtest.h>

#include <memory>

#include "accel/kernels/kernels.h"
#include "scenes.h"
#include "support/support.h"

namespace steradian::test {
namespace {

struct Variant {
    BvhBuilder builder;
    uint32_t max_depth;
    Isa isa;
};

/// Every kernel that the machine has on the default hierarchy, and other hierarchies with the kernels in turn.
std::vector<Variant> variants() {
    std::vector<Variant> all;
    const std::vector<Isa> isas = supported_isas();
    for (const Isa isa : isas) all.push_back({BvhBuilder::sah, 64, isa});
    size_t turn = 0;
    for (const auto& [builder, max_depth] :
         {std::pair{BvhBuilder::median, 64u}, {BvhBuilder::sah, 5u}, {BvhBuilder::median, 3u}, {BvhBuilder::sah, 1u}})
        all.push_back({builder, max_depth, isas[turn++ % isas.size()]});
    return all;
}

std::string name_of(const Variant& v) {
    return std::string(v.builder == BvhBuilder::sah ? "sah" : "median") + ", max depth " + std::to_string(v.max_depth) +
           ", instruction set " + std::to_string(int(v.isa));
}

std::vector<Accel> build_all(const TestScene& scene) {
    std::vector<Accel> built;
    const std::vector<Geometry> geometries = scene.geometries();
    for (const Variant& v : variants()) {
        AccelOptions options;
        options.builder = v.builder;
        options.max_depth = v.max_depth;
        options.isa = v.isa;
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
    const size_t total = by_tier<size_t>(400'000, 10'000'000);
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
    const size_t bundles = by_tier<size_t>(200, 10'000);
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

/// Spans of every length around the sizes that the kernels work in.
TEST(Oracle, AnyNumberOfRays) {
    TestScene scene("sphere");
    scene.meshes.push_back(icosphere(3));
    scene.finish(1);
    const Result<Accel> accel = Accel::build(scene.geometries(), scene.instances);
    ASSERT_TRUE(accel);
    const std::vector<Ray> rays = hard_rays(scene, 100, 5);
    for (size_t count = 0; count <= rays.size(); ++count)
        for (const RayKind kind : {RayKind::incoherent, RayKind::coherent}) {
            const Hit untouched{1, 2, 3, 4, 5};
            std::vector<Hit> hits(rays.size() + 1, untouched);
            std::vector<uint8_t> occluded(rays.size() + 1, 7);
            accel->intersect(std::span(rays).first(count), std::span(hits).first(count), kind);
            accel->occluded(std::span(rays).first(count), std::span(occluded).first(count), kind);
            for (size_t i = 0; i < count; ++i) {
                ASSERT_TRUE(same_bits(hits[i], accel->intersect(rays[i]))) << count << " rays, ray " << i;
                ASSERT_EQ(occluded[i], accel->occluded(rays[i]));
            }
            ASSERT_TRUE(same_bits(hits[count], untouched));
            ASSERT_EQ(occluded[count], 7);
        }
}

TEST(Oracle, NextHitEnumeratesAllHitsInOrder) {
    const std::vector<TestScene> scenes = hard_scenes();
    const size_t each = by_tier<size_t>(400, 20'000);
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
