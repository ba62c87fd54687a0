// Choosing among lights: probabilities are those of the choices, to the last of the 2^32 values; nothing that
// contributes is left out; and a hierarchy chooses better than chance.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "scene/emission.h"
#include "shading/area_lights.h"
#include "shading/light_selection.h"
#include "support/chi_square.h"
#include "support/support.h"

namespace steradian {
namespace {

using test::World;

Vec3 point_in(test::Random& random, double half) {
    const double x = random.between(-half, half), y = random.between(-half, half), z = random.between(-half, half);
    return static_cast<Vec3>(Vec3d{x, y, z});
}

Vec3 direction(test::Random& random) { return static_cast<Vec3>(random.direction()); }

LightBounds random_light(test::Random& random) {
    const Vec3d p = point_in(random, 3);
    // From points to what is as large as the scene; some lie on top of each other.
    const double size = random.between(0, 1) < 0.3 ? 0 : std::exp(random.between(-8, 1));
    const Vec3d reach = Vec3d(abs(direction(random))) * size;
    LightBounds out{p - reach, p + reach, {}, std::exp(random.between(-12, 8))};
    out.cone.axis = random.direction();
    out.cone.theta_o = random.between(0, 1) < 0.5 ? 0 : random.between(0, std::numbers::pi);
    out.cone.theta_e = random.between(0, 1) < 0.7 ? std::numbers::pi / 2 : random.between(0, std::numbers::pi);
    out.cone.two_sided = random.between(0, 1) < 0.3;
    return out;
}

std::vector<LightBounds> random_lights(test::Random& random, size_t n) {
    std::vector<LightBounds> out;
    for (size_t i = 0; i < n; ++i)
        out.push_back(random.between(0, 1) < 0.1 && i > 0 ? out.back() : random_light(random));
    return out;
}

LightReceiver random_receiver(test::Random& random) {
    LightReceiver out{point_in(random, 4), direction(random), random.between(0, 1) < 0.3};
    if (random.between(0, 1) < 0.1) out.n = {};
    return out;
}

/// How many nodes that count promise what none of their children keeps.
int promises_broken(const LightTree& tree, const LightReceiver& at, uint32_t node) {
    const LightNode& n = tree.nodes()[node];
    int broken = 0, counting = 0;
    for (int k = 0; k < LightNode::kWidth; ++k) {
        double importance[4];
        light_importance(n.children[k / 4], at, importance);
        if (importance[k % 4] == 0) continue;
        ++counting;
        if (n.lights[k] > 1) broken += promises_broken(tree, at, n.child[k]);
    }
    return counting == 0 ? 1 : broken;
}

TEST(LightTree, ProbabilitiesSumToOneExactlyWhereNothingIsLost) {
    test::Random random(1);
    int exact = 0;
    for (int round = 0; round < 300; ++round) {
        const size_t n = 1 + static_cast<size_t>(random.between(0, round < 290 ? 60 : 3000));
        const LightTree tree(random_lights(random, n));
        const LightReceiver at = random_receiver(random);
        double sum = 0;  // exact: multiples of 2^-32
        for (uint32_t i = 0; i < n; ++i) sum += tree.probability(at, i);
        if (tree.reaches(at) && promises_broken(tree, at, 0) == 0) {
            EXPECT_EQ(sum, 1) << round;
            ++exact;
        } else {
            EXPECT_LT(sum, 1) << round;
        }
    }
    EXPECT_GT(exact, 50);
}

/// A run of values is what it takes to know every choice: its first and its last value choose the light, the ones
/// beyond another.
TEST(LightTree, TheProbabilityOfALightIsTheLengthOfItsRun) {
    test::Random random(2);
    for (int round = 0; round < 200; ++round) {
        const auto n = static_cast<uint32_t>(1 + random.between(0, 40));
        const LightTree tree(random_lights(random, n));
        const LightReceiver at = random_receiver(random);
        const uint64_t values = round % 2 ? kLightValues : kLightValues / 2 + 7;
        std::map<uint32_t, uint64_t> counted;
        for (uint64_t x = 0; x < values;) {
            const auto chosen = tree.choose(at, static_cast<uint32_t>(x), values);
            if (!chosen) break;  // what follows is lost, or not: the test above counts
            const double p = tree.probability(at, chosen->light, values);
            ASSERT_EQ(p, chosen->probability);
            const auto run = static_cast<uint64_t>(p * 0x1p32);
            ASSERT_GT(run, 0u);
            counted[chosen->light] += run;
            const auto last = tree.choose(at, static_cast<uint32_t>(x + run - 1), values);
            ASSERT_TRUE(last && last->light == chosen->light) << round;
            if (x + run < values) {
                const auto next = tree.choose(at, static_cast<uint32_t>(x + run), values);
                ASSERT_TRUE(!next || next->light != chosen->light) << round;
            }
            x += run;
        }
        for (const auto& [light, run] : counted)
            EXPECT_EQ(static_cast<double>(run) * 0x1p-32, tree.probability(at, light, values));
    }
}

TEST(LightTree, FrequenciesFollowProbabilities) {
    test::Random random(3);
    for (int round = 0; round < 20; ++round) {
        const uint32_t n = 100;
        const LightTree tree(random_lights(random, n));
        const LightReceiver at = random_receiver(random);
        const int count = test::by_tier(100000, 2000000);
        std::vector<double> observed(n + 1), expected(n + 1);
        for (int i = 0; i < count; ++i) {
            const auto chosen = tree.choose(at, random.bits32());
            ++observed[chosen ? chosen->light : n];
        }
        double rest = 1;
        for (uint32_t i = 0; i < n; ++i) {
            const double p = tree.probability(at, i);
            expected[i] = p * count;
            rest -= p;
        }
        expected[n] = rest * count;
        const test::ChiSquare result = test::chi_square(observed, expected);
        EXPECT_TRUE(result.passes()) << result;
    }
}

/// Trees from one light to hundreds, one without any, and questions without a tree: however many are asked at once.
TEST(LightTree, AnswersTogetherAreThoseOfEachByItself) {
    test::Random random(9);
    std::vector<LightTree> trees(1);
    for (const size_t n : {1, 2, 8, 9, 40, 700}) trees.emplace_back(random_lights(random, n));
    int chosen = 0, nothing = 0;
    for (size_t count = 0; count < 100; ++count) {
        std::vector<LightQuery> queries(count);
        for (LightQuery& q : queries) {
            q.at = random_receiver(random);
            q.values = random.between(0, 1) < 0.5 ? kLightValues : kLightValues / 2 + 7;
            q.choice = static_cast<uint32_t>(random.between(0, 1) * static_cast<double>(q.values));
            if (random.between(0, 1) < 0.9) q.tree = &trees[random.bits32() % trees.size()];
        }
        LightTree::answer(queries);
        for (const LightQuery& q : queries) {
            const auto alone = q.tree ? q.tree->choose(q.at, q.choice, q.values) : std::nullopt;
            ASSERT_EQ(q.chosen.has_value(), alone.has_value());
            ++(alone ? chosen : nothing);
            if (!alone) continue;
            EXPECT_EQ(q.chosen->light, alone->light);
            EXPECT_EQ(q.chosen->probability, alone->probability);
        }
    }
    EXPECT_GT(chosen, 1000);
    EXPECT_GT(nothing, 500);
}

/// Shares by importance, as documented, worked out without runs: one value for each light below a child that counts,
/// and of the rest its share.
TEST(LightTree, ProbabilitiesAreSharesOfImportance) {
    test::Random random(10);
    for (int round = 0; round < 200; ++round) {
        const auto n = static_cast<uint32_t>(1 + random.between(0, round < 190 ? 70 : 2000));
        const LightTree tree(random_lights(random, n));
        const LightReceiver at = random_receiver(random);
        std::vector<double> expected(n);
        const auto share = [&](const auto& self, uint32_t index, double values) -> void {
            const LightNode& node = tree.nodes()[index];
            double importance[LightNode::kWidth], total = 0, lights = 0;
            for (int k = 0; k < LightNode::kWidth; k += 4) light_importance(node.children[k / 4], at, importance + k);
            for (int k = 0; k < LightNode::kWidth; ++k) {
                total += importance[k];
                if (importance[k] > 0) lights += node.lights[k];
            }
            for (int k = 0; k < LightNode::kWidth; ++k) {
                if (!(importance[k] > 0)) continue;
                const double own = node.lights[k] + (values - lights) * (importance[k] / total);
                if (node.lights[k] == 1)
                    expected[node.child[k]] = own;
                else
                    self(self, node.child[k], own);
            }
        };
        share(share, 0, 0x1p32);
        // Runs begin and end at whole numbers: each level moves an end by one value at most.
        for (uint32_t i = 0; i < n; ++i)
            EXPECT_NEAR(tree.probability(at, i) * 0x1p32, expected[i], 70 + 1e-6 * expected[i]) << round << " " << i;
    }
}

/// The children of a node hold the lights that they are said to hold, each light once, and within the bounds.
TEST(LightTree, NodesHoldWhatTheySay) {
    test::Random random(11);
    for (const size_t n : {1, 5, 8, 9, 63, 900}) {
        const std::vector<LightBounds> lights = random_lights(random, n);
        const LightTree tree(lights);
        std::vector<int> seen(n);
        const auto count = [&](const auto& self, uint32_t index, FourLights around, int lane, bool root) -> uint32_t {
            const LightNode& node = tree.nodes()[index];
            uint32_t all = 0;
            double strength = 0;
            for (int k = 0; k < LightNode::kWidth; ++k) {
                const FourLights& four = node.children[k / 4];
                EXPECT_EQ(node.lights[k] > 0, four.strength[k % 4] > 0);
                if (node.lights[k] == 0) continue;
                strength += four.strength[k % 4];
                all += node.lights[k];
                if (node.lights[k] == 1) {
                    ++seen[node.child[k]];
                    const Vec3d centre = (lights[node.child[k]].lo + lights[node.child[k]].hi) * 0.5;
                    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(four.center[axis][k % 4], centre[axis], 1e-5);
                } else {
                    EXPECT_EQ(self(self, node.child[k], four, k % 4, false), node.lights[k]);
                }
            }
            if (!root) {
                EXPECT_NEAR(strength, around.strength[lane], 1e-5 * strength);
            }
            return all;
        };
        EXPECT_EQ(count(count, 0, {}, 0, true), n);
        EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<long>(n));
    }
}

/// A point of each light and a normal within its cone: where its light arrives, the probability is not 0.
TEST(LightTree, NothingThatContributesIsLeftOut) {
    test::Random random(4);
    int contributing = 0;
    for (int round = 0; round < test::by_tier(1500, 20000); ++round) {
        const auto n = static_cast<uint32_t>(1 + random.between(0, 30));
        const std::vector<LightBounds> lights = random_lights(random, n);
        const LightTree tree(lights);
        for (int k = 0; k < 10; ++k) {
            const auto i = static_cast<uint32_t>(random.between(0, n));
            const LightBounds& b = lights[i];
            const auto within = [&](double lo, double hi) { return lo + (hi - lo) * random.between(0, 1); };
            const Vec3d q{within(b.lo.x, b.hi.x), within(b.lo.y, b.hi.y), within(b.lo.z, b.hi.z)};
            LightReceiver at = random_receiver(random);
            // Also from inside the box, from its corners, and from the plane of the light.
            if (k == 1) at.p = static_cast<Vec3>(q);
            if (k == 2) at.p = static_cast<Vec3>(b.hi);
            if (k == 3) {
                const Vec3d aside = normalize(cross(b.cone.axis, Vec3d{0.3, 0.5, 0.7}));
                at.p = static_cast<Vec3>(q + aside * 2 + b.cone.axis * 1e-6);
            }
            if (k == 4) at.n = static_cast<Vec3>(normalize(cross(q - Vec3d(at.p), Vec3d{0.1, 0.2, 0.3})));
            const Vec3d way = q - Vec3d(at.p);
            const double distance = length(way);
            if (!(distance > 0)) continue;
            const double received = dot(way, Vec3d(at.n)) / distance;
            double from_axis = -dot(way, b.cone.axis) / distance;
            if (b.cone.two_sided) from_axis = std::fabs(from_axis);
            const double angle = std::acos(clamp_to(from_axis, -1.0, 1.0));
            const bool emitted = angle < b.cone.theta_o + b.cone.theta_e;
            const bool arrives = at.n == Vec3{} || (at.both_sides ? received != 0 : received > 0);
            if (!emitted || !arrives) continue;
            ++contributing;
            EXPECT_GT(tree.probability(at, i), 0) << round << " " << k << " " << angle << " " << received;
        }
    }
    EXPECT_GT(contributing, 5000);
}

/// Two equal triangles, of which one is nine times as bright, and a point that sees both alike.
void expect_the_brighter_triangle(bool of_material) {
    Scene scene;
    Mesh mesh;
    mesh.positions = {{-2, 1, -1}, {-1, 1, -1}, {-1, 1, 1}, {2, 1, -1}, {1, 1, 1}, {1, 1, -1}};
    mesh.uvs = {{0, 0}, {0.5f, 0}, {0.5f, 0.5f}, {1, 0}, {1.5f, 0.5f}, {1.5f, 0}};
    mesh.indices = {0, 1, 2, 3, 4, 5};
    const InstanceId instance = test::add_mesh(scene, std::move(mesh));
    const TextureId texture =
        add<TextureId>(scene.textures, Texture{CheckerTexture{{0.9f, 0.9f, 0.9f}, {0.1f, 0.1f, 0.1f}}});
    if (of_material) {
        OpenPbrMaterial shining;
        shining.emission_luminance = 2;
        shining.emission_color = {{1, 1, 1}, texture};
        shining.geometry_thin_walled = true;
        scene.instances[index(instance)].material = add<MaterialId>(scene.materials, Material{shining});
        add_emission(scene);
    } else {
        scene.lights = {AreaLight{instance, {2, 2, 2}, true, 1, true, texture}};
    }
    const World world(std::move(scene));
    const SurfacePoint from = test::receiver({0, 0, 0}, {0, 1, 0});
    const auto density = [&](double x) {
        const Ray ray = test::ray_towards({0, 0, 0}, {x, 1, -0.5});
        const Hit hit = world.accel.intersect(ray);
        EXPECT_TRUE(hit.found());
        const SurfacePoint point = surface_at(world.shading, ray, hit);
        return static_cast<double>(pdf_light(world.shading, 0, from, ray.d, &point));
    };
    // Nothing counts for less than a twentieth of the mean, which is 1/2.
    EXPECT_NEAR(density(-1.4) / density(1.4), (0.95 * 0.9 + 0.025) / (0.95 * 0.1 + 0.025), 1e-4);
    EXPECT_NEAR(world.shading.lights[0].mean_texture, 0.5, 1e-6);
    int bright = 0;
    test::Random random(3);
    constexpr int kCount = 20000;
    for (int i = 0; i < kCount; ++i) {
        const uint32_t choice = random.bits32();
        const auto sample = sample_light(world.shading, 0, from, choice, random.uniform2());
        ASSERT_TRUE(sample);
        bright += sample->wi.x < 0;
        EXPECT_NEAR(sample->radiance.g, sample->wi.x < 0 ? 1.8f : 0.2f, 1e-6);
    }
    EXPECT_NEAR(static_cast<double>(bright) / kCount, 0.88, 4 * std::sqrt(0.88 * 0.12 / kCount));
}
TEST(LightTree, BrighterTrianglesAreChosenMoreOften) { expect_the_brighter_triangle(false); }
TEST(LightTree, TrianglesAreChosenByWhatTheirMaterialEmits) { expect_the_brighter_triangle(true); }

/// The mean of a texture over each shape, for choosing among lights: of a disk only what is on it, of a sphere by area.
TEST(LightTree, TexturesDimLightsByTheirMean) {
    const auto mean_of = [](Shape shape, CheckerTexture checker) {
        Scene scene;
        const InstanceId instance = test::add_shape(scene, std::move(shape));
        const TextureId texture = add<TextureId>(scene.textures, Texture{checker});
        scene.lights = {AreaLight{instance, {1, 2, 3}, false, 1, true, texture}};
        return World(std::move(scene)).shading.lights[0].mean_texture;
    };
    CheckerTexture left{{1, 1, 1}, {0, 0, 0}};
    left.scale = {1, 0};
    left.offset = {0.75f, 0.5f};  // white where u is less than 1/4
    EXPECT_NEAR(mean_of(Rectangle{}, left), 0.25, 1e-6);
    EXPECT_NEAR(mean_of(Disk{}, left), 1.0 / 3 - std::sqrt(3) / (4 * std::numbers::pi), 1e-3);
    EXPECT_NEAR(mean_of(Sphere{}, left), 0.25, 1e-6);
    CheckerTexture top{{1, 1, 1}, {0, 0, 0}};
    top.scale = {0, 1};
    top.offset = {0.5f, 0.75f};
    EXPECT_NEAR(mean_of(Sphere{}, top), (1 - std::sqrt(0.5)) / 2, 1e-3);
    CheckerTexture red{{1, 0, 0}, {1, 0, 0}};
    EXPECT_NEAR(mean_of(Rectangle{}, red), 1.0 / 6, 1e-6);
    // Nothing that could shine is given up.
    EXPECT_EQ(mean_of(Rectangle{}, CheckerTexture{{0, 0, 0}, {-1, -1, -1}}), 1e-3);
}

/// Whatever sample_light finds for a triangle: its probability was not 0, and the density agrees.
TEST(LightTree, OfAMeshWithDegenerateTriangles) {
    test::Random random(5);
    Scene scene;
    Mesh mesh;
    for (int i = 0; i < 300; ++i) mesh.positions.push_back(point_in(random, 1));
    for (uint32_t i = 0; i < 300; ++i) {
        mesh.indices.insert(mesh.indices.end(), {i, (i * 7 + 1) % 300, (i * 13 + 5) % 300});
        mesh.indices.insert(mesh.indices.end(), {i, i, (i + 1) % 300});
    }
    const MeshId id = add<MeshId>(scene.meshes, std::move(mesh));
    const test::AreaLightCase light = [&] {
        test::AreaLightCase out{"", std::move(scene), true};
        const InstanceId instance = test::add_shape(out.scene, id, {});
        add<InstanceId>(out.scene.lights, Light{AreaLight{instance, {1, 1, 1}, true, 1}});
        return out;
    }();
    const World world(light.scene);
    int seen = 0;
    for (int i = 0; i < 20000; ++i) {
        const SurfacePoint from = test::receiver(point_in(random, 2), direction(random));
        const Vec3 wi = direction(random);
        if (dot(wi, from.ns) <= 0) continue;
        const Ray ray = spawn_ray(from, wi);
        const Hit hit = world.accel.intersect(ray);
        if (!hit.found()) continue;
        const SurfacePoint point = surface_at(world.shading, ray, hit);
        ++seen;
        EXPECT_GT(pdf_light(world.shading, 0, from, wi, &point), 0) << i;
    }
    EXPECT_GT(seen, 1000);
}

/// Asking for the triangle first and for the sample with it then is asking for the sample.
TEST(LightTree, AChosenPartGivesTheSampleOfItsChoice) {
    test::Random random(12);
    int with_tree = 0, without = 0;
    for (const test::AreaLightCase& light : test::area_light_cases()) {
        const World world(light.scene);
        for (int i = 0; i < 200; ++i) {
            const SurfacePoint from = test::receiver(point_in(random, 2), direction(random));
            const uint32_t choice = random.bits32();
            const Vec2 u = random.uniform2();
            LightQuery part = part_query(world.shading, 0, from, choice);
            ++(part.tree ? with_tree : without);
            LightTree::answer({&part, 1});
            prefetch_part(world.shading, 0, part, PartMemory::indices);  // of nothing, too
            prefetch_part(world.shading, 0, part, PartMemory::corners);
            const auto density = EnvironmentDensity::complete;
            const auto split = sample_light(world.shading, 0, from, choice, u, density, &part);
            const auto whole = sample_light(world.shading, 0, from, choice, u);
            ASSERT_EQ(split.has_value(), whole.has_value()) << light.name;
            if (!whole) continue;
            EXPECT_EQ(split->wi, whole->wi);
            EXPECT_EQ(split->pdf, whole->pdf);
            EXPECT_EQ(split->radiance, whole->radiance);
        }
    }
    EXPECT_GT(with_tree, 500);
    EXPECT_GT(without, 500);
}

/// The cone around two cones holds the rim of each.
TEST(LightTree, BoundsOfTwoHoldBoth) {
    test::Random random(8);
    int narrower = 0;
    for (int round = 0; round < 2000; ++round) {
        const LightBounds a = random_light(random), b = random_light(random), both = unite(a, b);
        EXPECT_EQ(both.strength, a.strength + b.strength);
        EXPECT_EQ(both.cone.theta_e, max_of(a.cone.theta_e, b.cone.theta_e));
        narrower += both.cone.theta_o < 3;
        for (const LightBounds& one : {a, b}) {
            const Frame3d frame = Frame3d::from_z(one.cone.axis);
            for (int k = 0; k < 16; ++k) {
                const double phi = 2 * std::numbers::pi * k / 16, s = std::sin(one.cone.theta_o);
                const Vec3d rim = frame.to_world({s * std::cos(phi), s * std::sin(phi), std::cos(one.cone.theta_o)});
                const double angle = std::acos(clamp_to(dot(rim, both.cone.axis), -1.0, 1.0));
                EXPECT_LE(angle, both.cone.theta_o + 1e-6) << round;
            }
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_LE(both.lo[axis], one.lo[axis]);
                EXPECT_GE(both.hi[axis], one.hi[axis]);
            }
        }
    }
    EXPECT_GT(narrower, 500);
}

TEST(LightTree, IsTheSameTreeForTheSameLightsAndLeavesOutTheDark) {
    test::Random random(6);
    std::vector<LightBounds> lights = random_lights(random, 500);
    for (LightBounds& light : lights) light.cone.theta_o = std::numbers::pi;
    for (size_t i = 0; i < lights.size(); i += 3) lights[i].strength = 0;
    const LightTree a(lights), b(lights);
    ASSERT_EQ(a.nodes().size(), b.nodes().size());
    EXPECT_EQ(std::accumulate(std::begin(a.nodes()[0].lights), std::end(a.nodes()[0].lights), 0u), 333u);
    EXPECT_LE(a.bytes(), LightTree::bytes(500));
    uint32_t leaves = 0;
    for (const LightNode& node : a.nodes()) leaves += std::count(std::begin(node.lights), std::end(node.lights), 1u);
    EXPECT_EQ(leaves, 333u);
    const LightReceiver at{{0, 0, 0}, {}, false};
    for (uint32_t i = 0; i < 500; ++i) EXPECT_EQ(a.probability(at, i) > 0, i % 3 != 0) << i;
    // All in one place: halved by count.
    const LightTree heap(std::vector<LightBounds>(1000, lights[1]));
    for (uint32_t i = 0; i < 1000; ++i) EXPECT_NEAR(heap.probability(at, i), 1e-3, 0.3e-3);
}

TEST(LightTree, PrefersWhatIsNearAndFacesThePoint) {
    const auto square = [](Vec3d p, Vec3d normal) {
        return LightBounds{p - Vec3d{0.1, 0, 0.1}, p + Vec3d{0.1, 0, 0.1}, {normal, 0, std::numbers::pi / 2}, 1};
    };
    const LightReceiver at{{0, 0, 0}, {0, 1, 0}, false};
    const LightTree tree(std::vector<LightBounds>{square({0, 1, 0}, {0, -1, 0}), square({0, 3, 0}, {0, -1, 0}),
                                                  square({1, 1, 0}, {0, 1, 0}), square({0, -1, 0}, {0, 1, 0})});
    EXPECT_GT(tree.probability(at, 0), 0.85);
    EXPECT_GT(tree.probability(at, 1), 0.05);
    EXPECT_EQ(tree.probability(at, 2), 0);  // shines away
    EXPECT_EQ(tree.probability(at, 3), 0);  // is below
    EXPECT_GT(tree.probability({{0, 0, 0}, {0, 1, 0}, true}, 3), 0.3);
}

Scene mixed_lights(test::Random& random, bool distant) {
    Scene scene;
    for (int i = 0; i < 5; ++i) {
        scene.lights.push_back(PointLight{point_in(random, 3), {1, 2, 3}});
        scene.lights.push_back(SpotLight{point_in(random, 3), direction(random), {3, 2, 3}, 20, 50});
        const Sphere sphere{point_in(random, 3), 0.2f};
        const InstanceId id = test::add_shape(scene, sphere, {});
        scene.lights.push_back(AreaLight{id, {2, 2, 2}, false, 1});
        if (distant) scene.lights.push_back(DirectionalLight{direction(random), {1, 1, 1}});
    }
    if (distant) scene.lights.push_back(EnvironmentLight{{1, 1, 1}});
    return scene;
}

TEST(LightSelection, FrequenciesFollowProbabilities) {
    test::Random random(7);
    for (const bool distant : {false, true})
        for (const LightChoice by : {LightChoice::bvh, LightChoice::power, LightChoice::uniform}) {
            const World world(mixed_lights(random, distant));
            const LightSelection& lights = world.shading.light_selection;
            const LightReceiver at = random_receiver(random);
            const int count = 200000;
            std::vector<double> observed(lights.lights() + 1), expected(lights.lights() + 1);
            for (int i = 0; i < count; ++i) {
                const auto chosen = lights.choose(by, at, random.bits32());
                if (chosen) {
                    ASSERT_EQ(chosen->probability, lights.probability(by, at, chosen->light));
                }
                ++observed[chosen ? chosen->light : lights.lights()];
            }
            double rest = 1, far = 0;
            for (uint32_t i = 0; i < lights.lights(); ++i) {
                const double p = lights.probability(by, at, i);
                expected[i] = p * count, rest -= p;
                const Light& light = world.shading.scene.lights[i];
                if (std::holds_alternative<DirectionalLight>(light) || std::holds_alternative<EnvironmentLight>(light))
                    far += p;
            }
            expected[lights.lights()] = rest * count;
            EXPECT_TRUE(test::chi_square(observed, expected).passes()) << test::chi_square(observed, expected);
            if (by != LightChoice::bvh) {
                EXPECT_EQ(rest, 0);
            }
            if (by != LightChoice::uniform) {
                EXPECT_NEAR(far, distant ? 0.5 : 0, 1e-8);  // and one value each by power
            }
        }
}

TEST(LightSelection, ByPowerIsByFlux) {
    Scene scene;
    scene.lights = {PointLight{{0, 0, 0}, {1, 1, 1}}, PointLight{{0, 0, 0}, {3, 3, 3}},
                    PointLight{{0, 0, 0}, {0, 0, 0}}, SpotLight{{0, 0, 0}, {0, 1, 0}, {2, 2, 2}, 90, 90}};
    const InstanceId id = test::add_shape(scene, Rectangle{}, {});
    scene.lights.push_back(AreaLight{id, {1, 1, 1}, true, 1});
    const World world(std::move(scene));
    const LightSelection& lights = world.shading.light_selection;
    const double pi = std::numbers::pi, flux[] = {4 * pi, 12 * pi, 0, 4 * pi, 8 * pi};
    for (uint32_t i = 0; i < 5; ++i)
        EXPECT_NEAR(lights.probability(LightChoice::power, {}, i), flux[i] / (28 * pi), 1e-8) << i;
}

TEST(LightSelection, WhereNothingNearReachesAPointDistantLightHasItAll) {
    Scene scene;
    scene.lights = {SpotLight{{0, 1, 0}, {0, 1, 0}, {1, 1, 1}, 10, 20}, DirectionalLight{{0, -1, 0}, {1, 1, 1}}};
    const World world(std::move(scene));
    const LightReceiver at{{0, 0, 0}, {0, 1, 0}, false};
    EXPECT_EQ(world.shading.light_selection.probability(LightChoice::bvh, at, 1), 1);
    EXPECT_EQ(world.shading.light_selection.probability(LightChoice::bvh, at, 0), 0);
    EXPECT_FALSE(World(Scene{}).shading.light_selection.choose(LightChoice::bvh, at, 5));
}

}  // namespace
}  // namespace steradian
