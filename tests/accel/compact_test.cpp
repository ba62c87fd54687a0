// The compact layout by itself: nodes contain what they stand for, blocks give back what was put into them, and both
// are as small as they promise.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

#include "accel/children.h"
#include "accel/compact.h"
#include "accel/kernels/kernels.h"
#include "brute_force.h"
#include "scenes.h"
#include "support/support.h"

namespace steradian::test {
namespace {

/// A coordinate of any size up to 1e15, denormals and zeros of both signs among them.
float hostile_coordinate(Random& random) {
    const float sign = random.below(2) ? 1.0f : -1.0f;
    switch (random.below(8)) {
        case 0:
            return sign * 0.0f;
        case 1:
            return sign * std::bit_cast<float>(random.below(1u << 23));  // denormal
        case 2:
            return sign * 1e15f;
        case 3:
            return sign * std::bit_cast<float>((1 + random.below(176)) << 23 | random.below(1u << 23));
        default:
            return sign * static_cast<float>(random.decades(-3, 3));
    }
}

/// Somewhere between: the same, a few floats away, or a share of a size away.
float near_to(float x, float size, Random& random) {
    switch (random.below(4)) {
        case 0:
            return x;
        case 1: {
            float y = x;
            for (uint32_t i = random.below(6); i > 0; --i) y = std::nextafter(y, random.below(2) ? 1e15f : -1e15f);
            return y;
        }
        default:
            return std::clamp(x + static_cast<float>(random.uniform(-1, 1)) * size, -1e15f, 1e15f);
    }
}

WideNode hostile_node(uint32_t children, Random& random) {
    WideNode node;
    for (int axis = 0; axis < 3; ++axis) {
        const float middle = hostile_coordinate(random);
        float size = std::fabs(hostile_coordinate(random));
        if (random.below(3) == 0) size = std::fabs(middle) * static_cast<float>(random.decades(-9, 0));
        for (uint32_t i = 0; i < kWidth; ++i) {
            const float a = near_to(middle, size, random), b = near_to(a, size, random);
            const bool exists = i < children;
            node.plane[axis][0][i] = exists ? std::min(a, b) : kInfinity;
            node.plane[axis][1][i] = exists ? std::max(a, b) : -kInfinity;
        }
    }
    for (uint32_t i = 0; i < kWidth; ++i) node.child[i] = i < children ? static_cast<uint32_t>(random.bits()) : 0;
    for (uint32_t& order : node.order) order = random.below(1u << 24);
    return node;
}

// Containment is checked in floats as they are, with nothing computed but what the kernels compute.
TEST(CompactNode, DecodedBoxesContainTheirBoxes) {
    Random random(1);
    for (size_t n = 0; n < by_tier<size_t>(300'000, 10'000'000); ++n) {
        const uint32_t children = 1 + random.below(kWidth);
        const WideNode wide = hostile_node(children, random);
        ASSERT_EQ(child_count(wide), children);
        const CompactNode node = quantise(wide, children);
        for (uint32_t i = 0; i < children; ++i)
            for (int axis = 0; axis < 3; ++axis) {
                ASSERT_LE(node.decoded(axis, 0, i), wide.plane[axis][0][i]) << n << ", axis " << axis;
                ASSERT_GE(node.decoded(axis, 1, i), wide.plane[axis][1][i]) << n << ", axis " << axis;
            }
    }
}

// Not a proof of anything by itself, but a node that contained everything would pass the test above: planes are off by
// two steps at most, and the steps are not larger than they need be.
TEST(CompactNode, DecodedBoxesAreTight) {
    Random random(2);
    for (size_t n = 0; n < by_tier<size_t>(100'000, 1'000'000); ++n) {
        const uint32_t children = 1 + random.below(kWidth);
        const WideNode wide = hostile_node(children, random);
        const CompactNode node = quantise(wide, children);
        for (int axis = 0; axis < 3; ++axis) {
            const auto [lower, upper] = wide.plane[axis];
            const double lo = *std::min_element(lower, lower + children);
            const double hi = *std::max_element(upper, upper + children);
            // A float's own step where the box is smaller than that, 2^-126 where the scale cannot be less.
            const double ulp = std::max(std::fabs(lo), std::fabs(hi)) * 0x1p-23;
            const double step = (hi - lo) / 255 * 1.02 + ulp + 0x1p-126;
            for (uint32_t i = 0; i < children; ++i) {
                ASSERT_LE(lower[i] - double(node.decoded(axis, 0, i)), 2 * step) << n;
                ASSERT_LE(double(node.decoded(axis, 1, i)) - upper[i], 2 * step) << n;
            }
        }
    }
}

TEST(CompactNode, KeepsChildrenAndTheirOrder) {
    Random random(3);
    for (int n = 0; n < 1000; ++n) {
        const uint32_t children = 1 + random.below(kWidth);
        const WideNode wide = hostile_node(children, random);
        const CompactNode node = quantise(wide, children);
        for (uint32_t i = 0; i < kWidth; ++i) {
            ASSERT_EQ(node.child[i], wide.child[i]);
            ASSERT_EQ(node.present() >> i & 1, i < children);
            ASSERT_EQ(node.present_in_order() >> i & 1, i >= kWidth - children);
            for (uint32_t octant = 0; octant < 8; ++octant)
                ASSERT_EQ(node.order_of(3 * octant) >> (3 * i) & 7, wide.order[i] >> (3 * octant) & 7);
        }
    }
}

struct Corners {
    Vec3 p[3];
    bool operator==(const Corners& other) const { return std::memcmp(this, &other, sizeof(*this)) == 0; }
};

/// Triangles that share vertices as `pool` has few or many of them; with the same vertex twice now and then, and zeros
/// of both signs, which are different vertices.
std::vector<PackedTriangle> leaf(uint32_t triangles, uint32_t pool, uint32_t id_step, Random& random) {
    std::vector<Vec3> vertices(pool);
    for (Vec3& v : vertices) v = random.in_cube(1);
    vertices[0] = {0.0f, 1, 1}, vertices[1] = {-0.0f, 1, 1};
    std::vector<PackedTriangle> out;
    uint32_t id = random.below(1000);
    for (uint32_t i = 0; i < triangles; ++i, id += 1 + random.below(id_step))
        out.push_back({id, {vertices[random.below(pool)], vertices[random.below(pool)], vertices[random.below(pool)]}});
    for (size_t i = out.size(); i > 1; --i) std::swap(out[i - 1], out[random.below(static_cast<uint32_t>(i))]);
    return out;
}

TEST(CompactBlock, GivesBackEveryTriangle) {
    Random random(4);
    size_t many = 0, long_ids = 0, seen[13] = {};
    for (int n = 0; n < 20'000; ++n) {
        const uint32_t count = 1 + random.below(16);
        std::vector<PackedTriangle> triangles = leaf(count, 3 + random.below(40), random.below(2) ? 5 : 60'000, random);
        // Where boxes were split, a triangle may be in a leaf twice.
        for (uint32_t again = random.below(4); again-- > 1;) {
            const PackedTriangle same = triangles[random.below(count)];
            triangles.insert(triangles.begin() + random.below(count), same);
        }
        std::vector<PackedTriangle> reordered = triangles;
        std::vector<uint64_t> blocks;
        append_compact_blocks(reordered, blocks);
        std::vector<std::pair<uint32_t, Corners>> expected, got;
        for (const PackedTriangle& t : triangles) expected.push_back({t.id, {{t.corner[0], t.corner[1], t.corner[2]}}});
        const uint64_t* at = blocks.data();
        for (bool last = false; !last;) {
            ASSERT_LT(at, blocks.data() + blocks.size());
            const CompactBlock block(at);
            for (uint32_t lane = 0; lane < kBlock; ++lane) {
                const uint32_t id = block.prim(lane);
                const Corners corners{{block.corner(0, lane), block.corner(1, lane), block.corner(2, lane)}};
                if (id != kNoHit) {
                    got.push_back({id, corners});
                } else {
                    ASSERT_GT(lane, 0u);
                    ASSERT_EQ(corners, (Corners{{block.corner(0, 0), block.corner(1, 0), block.corner(2, 0)}}));
                }
            }
            many += block.many(), long_ids += (block.header & CompactBlock::kLongIds) != 0;
            ++seen[block.vertices()];
            last = block.last();
            at += block.units();
        }
        ASSERT_EQ(at, blocks.data() + blocks.size());
        const auto by_id = [](const auto& a, const auto& b) { return a.first < b.first; };
        std::sort(expected.begin(), expected.end(), by_id);
        std::sort(got.begin(), got.end(), by_id);
        for (auto* all : {&expected, &got}) all->erase(std::unique(all->begin(), all->end()), all->end());
        ASSERT_EQ(got, expected);
        ASSERT_LE(blocks.size(), triangles.size() * kMaxUnitsPerTriangle);
    }
    EXPECT_GT(many, 1000u);
    EXPECT_GT(long_ids, 1000u);
    for (const uint32_t vertices : {3, 4, 5, 6, 7, 8, 12}) EXPECT_GT(seen[vertices], 100u) << vertices;
}

/// Two strips, their triangles in turn: six vertices a block when each is by itself, twelve otherwise.
TEST(CompactBlock, BringsTrianglesTogetherThatShareVertices) {
    std::vector<PackedTriangle> triangles;
    for (uint32_t i = 0; i < 4; ++i)
        for (uint32_t strip = 0; strip < 2; ++strip) {
            const auto at = [&](uint32_t k) {
                return Vec3{static_cast<float>(k / 2), static_cast<float>(k % 2), static_cast<float>(strip)};
            };
            triangles.push_back({2 * i + strip, {at(i), at(i + 1), at(i + 2)}});
        }
    std::vector<uint64_t> blocks;
    append_compact_blocks(triangles, blocks);
    EXPECT_EQ(CompactBlock(blocks.data()).vertices(), 6u);
    EXPECT_EQ(blocks.size(), 2 * CompactBlock::units_for(6, false));
}

// 24 bytes a triangle are four triangles with six vertices to a block.
TEST(Compact, TakesAtMost36BytesATriangle) {
    TestScene scene("sphere");
    scene.meshes.push_back(icosphere(6));
    scene.finish(1);
    AccelOptions options;
    const Result<Accel> full = Accel::build(scene.geometries(), scene.instances, options);
    options.layout = BvhLayout::compact;
    const Result<Accel> compact = Accel::build(scene.geometries(), scene.instances, options);
    ASSERT_TRUE(full && compact);
    const double triangles = 20 * 4096;
    EXPECT_LE(double(compact->statistics().bytes) / triangles, 36);
    EXPECT_GE(double(compact->statistics().bytes) / triangles, 20);
    EXPECT_LE(double(compact->statistics().bytes), 0.7 * double(full->statistics().bytes));
    EXPECT_EQ(compact->statistics().nodes, full->statistics().nodes);
    EXPECT_EQ(compact->statistics().leaves, full->statistics().leaves);
    // The same tests in boxes that are a little larger.
    EXPECT_GT(compact->statistics().cost, full->statistics().cost);
    EXPECT_LT(compact->statistics().cost, 1.05 * full->statistics().cost);
}

// Four in each place, for which leaves are merged, and others that are not.
TEST(Compact, GivesTheSameHitsWhereLeavesAreMerged) {
    TestScene scene("along a diagonal");
    TriangleMesh mesh;
    Random random(1);
    std::vector<Ray> rays;
    for (int i = 0; i < 2000; ++i) {
        const auto x = static_cast<float>(i);
        const Vec3 p{x, x, x}, q{x + 0.3f, x, x}, r{x, x + 0.3f, x + 0.1f};
        for (int copy = 0; copy < (i % 100 ? 4 : 1); ++copy) mesh.add(p, q, r);
        const Vec3 from = p + random.in_cube(5);
        rays.push_back({from, 0, p + Vec3{0.1f, 0.1f, 0.1f / 3} - from, kInfinity});
    }
    scene.meshes.push_back(std::move(mesh));
    scene.finish(1);
    for (const BvhBuilder builder : {BvhBuilder::sah, BvhBuilder::median, BvhBuilder::fast, BvhBuilder::high_quality}) {
        std::vector<Hit> hits[2];
        for (const BvhLayout layout : {BvhLayout::full, BvhLayout::compact}) {
            AccelOptions options;
            options.builder = builder, options.layout = layout;
            const Result<Accel> accel = Accel::build(scene.geometries(), scene.instances, options);
            ASSERT_TRUE(accel);
            hits[int(layout)].resize(rays.size());
            accel->intersect(rays, hits[int(layout)], RayKind::incoherent);
        }
        size_t found = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            ASSERT_TRUE(same_bits(hits[1][i], hits[0][i])) << int(builder) << ", ray " << i;
            found += hits[0][i].found();
        }
        EXPECT_GT(found, rays.size() / 2);
    }
}

}  // namespace
}  // namespace steradian::test
