// Hierarchies as deep as the kernels are made for, on both levels at once, by hand: what the stacks must hold.
#include <gtest/gtest.h>

#include "accel/compact.h"
#include "accel/kernels/kernels.h"
#include "brute_force.h"
#include "options.h"
#include "support/support.h"

namespace steradian::test {
namespace {

constexpr uint32_t kSiblings = kWidth - 1;

/// A chain of kMaxNodeLevels nodes, each with seven leaves of one triangle and the rest of the chain, which a ray along
/// x meets first. All triangles lie across the x axis, those of node k at x from far_end - 10 k down.
struct Chain {
    TriangleMesh mesh;
    std::vector<WideNode> nodes{kMaxNodeLevels};
    std::vector<TriangleBlock> blocks;

    /// The innermost node ends in a leaf with another triangle, or in `last` with the given box.
    explicit Chain(float far_end, uint32_t last = 0, Box last_box = {}) {
        Box inside = last_box;
        for (uint32_t k = kMaxNodeLevels; k-- > 0;) {
            const bool innermost = k == kMaxNodeLevels - 1;
            WideNode& node = nodes[k];
            if (innermost && last == 0) last = add_triangle(far_end - 10 * static_cast<float>(k) - 8, inside);
            set_child(node, kSiblings, inside, innermost ? last : ChildRef::node(k + 1));
            for (uint32_t i = 0; i < kSiblings; ++i) {
                Box own;
                const uint32_t leaf = add_triangle(far_end - 10 * static_cast<float>(k) - static_cast<float>(i), own);
                set_child(node, i, own, leaf);
                inside.extend(own);
            }
            // From far to near in every octant: as they are.
            for (uint32_t place = 0; place < kWidth; ++place) {
                node.order[place] = 0;
                for (uint32_t octant = 0; octant < 8; ++octant) node.order[place] |= place << (3 * octant);
            }
        }
        bounds = inside;
    }
    LevelView view() const { return {nodes.data(), blocks.data(), nullptr}; }
    CompactLevel compact() const {
        Bvh bvh;
        bvh.nodes.resize(nodes.size());
        std::copy(nodes.begin(), nodes.end(), bvh.nodes.begin());
        for (const TriangleBlock& block : blocks)
            bvh.blocks.insert(bvh.blocks.end(), std::begin(block.prim), std::end(block.prim));
        BuildMonitor never;
        const auto triangle = [&](uint32_t id) -> PackedTriangle {
            const uint32_t* corner = &mesh.indices[3 * size_t(id)];
            return {id, {mesh.positions[corner[0]], mesh.positions[corner[1]], mesh.positions[corner[2]]}};
        };
        return make_compact(bvh, triangle, never, 0);
    }

    Box bounds;

private:
    uint32_t add_triangle(float x, Box& own) {
        const Vec3 corners[3] = {{x, -4, -4}, {x, 4, -4}, {x, 0, 4}};
        const auto prim = static_cast<uint32_t>(mesh.indices.size() / 3);
        mesh.add(corners[0], corners[1], corners[2]);
        own = {};
        TriangleBlock block;
        for (uint32_t lane = 0; lane < kBlock; ++lane) {
            block.prim[lane] = lane == 0 ? prim : kNoHit;
            for (int which = 0; which < 3; ++which) {
                own.extend(corners[which]);
                for (int axis = 0; axis < 3; ++axis) block.vertex[which][axis][lane] = corners[which][axis];
            }
        }
        blocks.push_back(block);
        return ChildRef::leaf(ItemKind::block, static_cast<uint32_t>(blocks.size() - 1), 1);
    }
    static void set_child(WideNode& node, uint32_t i, const Box& box, uint32_t ref) {
        for (int axis = 0; axis < 3; ++axis)
            node.plane[axis][0][i] = box.lo[axis], node.plane[axis][1][i] = box.hi[axis];
        node.child[i] = ref;
    }
};

TEST(Deepest, StacksHoldBothLevels) {
    const Affine placing = translation(-3000, 0, 0);
    const Chain inner(1000);
    const std::optional<PlacedGeometry> placed = place(1, placing, inner.bounds);
    ASSERT_TRUE(placed);
    const Chain outer(1000, ChildRef::leaf(ItemKind::instance, 0, 1), placed->world);

    // Instance 0 is the outer chain's mesh in place, instance 1 the inner one's.
    PlacedGeometry in_place;
    in_place.world = outer.bounds;
    const PlacedGeometry instances[] = {in_place, *placed};
    const ShapesView shapes[2] = {};
    const TrianglePart part{0, 0};
    const LeafEntry entry{1, kWholeInstance, {}};
    const auto world_of = [&](const LevelView& upper, const LevelView* levels) {
        World world;
        world.upper = upper;
        world.upper.entries = &entry;
        world.parts = &part, world.part_count = 1;
        world.instances = instances, world.levels = levels, world.shapes = shapes;
        return world;
    };
    const CompactLevel compact_inner = inner.compact(), compact_outer = outer.compact();
    const LevelView levels[] = {{}, inner.view()};
    const LevelView compact_levels[] = {{}, {compact_inner.nodes.data(), compact_inner.blocks.data(), nullptr}};
    const World full = world_of(outer.view(), levels);
    const World compact = world_of({compact_outer.nodes.data(), compact_outer.blocks.data(), nullptr}, compact_levels);

    TestScene scene("two chains");
    scene.meshes = {outer.mesh, inner.mesh};
    scene.instances = {{0, {}}, {1, placing}};
    scene.finish(1);
    const BruteForce brute(scene);

    // From the near end, all of them meet everything; from the far end; and some that miss by little, with all boxes
    // met.
    Random random(2);
    std::vector<Ray> rays;
    for (int i = 0; i < 96; ++i) {
        const auto y = static_cast<float>(random.uniform(-1, 1)), z = static_cast<float>(random.uniform(-1, 1));
        const float side = i < 64 ? -1.0f : 1.0f, miss = i % 32 < 16 ? 0.0f : 3.5f;
        rays.push_back({{side * 5000, y - miss, z + miss}, 0, {-side, 1e-6f * y, 1e-6f * z}, kInfinity});
    }
    std::vector<Hit> expected;
    size_t found = 0;
    for (const Ray& ray : rays) expected.push_back(brute.first_hit(ray)), found += expected.back().found();
    ASSERT_EQ(found, rays.size() / 2);
    ASSERT_EQ(brute.all_hits(rays[0]).size(), 2 * (size_t(kSiblings) * kMaxNodeLevels) + 1);

    for (const Isa isa : supported_isas())
        for (const BvhLayout layout : {BvhLayout::full, BvhLayout::compact}) {
            const Kernels& kernels = **select_kernels(isa, layout);
            const World& world = layout == BvhLayout::full ? full : compact;
            std::vector<Hit> hits(rays.size());
            std::vector<uint8_t> occluded(rays.size());
            for (const auto intersect : {kernels.intersect, kernels.intersect_coherent}) {
                intersect(world, rays.data(), hits.data(), rays.size());
                for (size_t i = 0; i < rays.size(); ++i) ASSERT_TRUE(same_bits(hits[i], expected[i])) << i;
            }
            for (const auto any : {kernels.occluded, kernels.occluded_coherent}) {
                any(world, rays.data(), occluded.data(), rays.size());
                for (size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(occluded[i] != 0, expected[i].found()) << i;
            }
            for (size_t i = 0; i < rays.size(); ++i) {
                Hit hit;
                kernels.intersect(world, &rays[i], &hit, 1);
                ASSERT_TRUE(same_bits(hit, expected[i])) << i;
            }
            // All hits in turn.
            const std::vector<Hit> all = brute.all_hits(rays[0]);
            Hit hit = all[0];
            for (size_t k = 1; k <= all.size(); ++k) {
                const Hit after = hit;
                kernels.next_hit(world, rays.data(), &after, &hit, 1);
                ASSERT_TRUE(same_bits(hit, k < all.size() ? all[k] : Hit{})) << k;
            }
        }
}

/// A ray of a stream meets far more references to an instance than it may begin with, when it visits them by itself,
/// and the instance is as deep as there are: both must fit onto its stack, or they end up in the ray beside it.
TEST(Deepest, StacksHoldWhatRaysOfStreamsBeginWith) {
    const Affine placing = translation(-3000, 0, 0);
    const Chain inner(1000);
    const std::optional<PlacedGeometry> placed = place(1, placing, inner.bounds);
    ASSERT_TRUE(placed);
    // Two times 8³ references to the one instance, of which 64 are for both of the rays below, the others for the first
    // alone.
    const uint32_t leaf = ChildRef::leaf(ItemKind::instance, 0, 1);
    const Box both = placed->world;
    Box one = both;
    one.hi.y = -1;
    std::vector<WideNode> nodes(5);
    const auto set = [&](uint32_t node, uint32_t child, const Box& box, uint32_t ref) {
        for (int axis = 0; axis < 3; ++axis) {
            nodes[node].plane[axis][0][child] = box.lo[axis];
            nodes[node].plane[axis][1][child] = box.hi[axis];
        }
        nodes[node].child[child] = ref;
    };
    for (uint32_t child = 0; child < kWidth; ++child) {
        set(0, child, child == 0 ? one : child == 1 ? both : Box{}, ChildRef::node(child == 0 ? 2 : 1));
        set(1, child, child == kSiblings ? both : one, ChildRef::node(3));
        set(2, child, both, ChildRef::node(3));
        set(3, child, both, ChildRef::node(4));
        set(4, child, both, leaf);
    }
    const PlacedGeometry instances[] = {{}, *placed};
    const ShapesView shapes[2] = {};
    const LeafEntry entry{1, kWholeInstance, {}};
    const LevelView levels[] = {{}, inner.view()};
    World world;
    world.upper = {nodes.data(), inner.blocks.data(), &entry};
    world.instances = instances, world.levels = levels, world.shapes = shapes;

    // Of the two of the first octant one misses all triangles by little, with all boxes met.
    std::vector<Ray> rays = {{{-5000, -3.5f, 3.5f}, 0, {1, 1e-7f, 1e-7f}, kInfinity},
                             {{-5000, 0, 0}, 0, {1, 1e-7f, 1e-7f}, kInfinity}};
    for (int i = 0; i < 100; ++i) rays.push_back({{5000, 0, 0}, 0, {-1, 1e-7f, 1e-7f}, kInfinity});
    for (const Isa isa : supported_isas()) {
        std::vector<uint8_t> occluded(rays.size());
        (*select_kernels(isa))->occluded(world, rays.data(), occluded.data(), rays.size());
        for (size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(occluded[i], i > 0) << i;
    }
}

/// Sheets behind each other, between whose corners rays pass: they meet every box, and nothing. More nodes than may
/// wait for their memory, in the streams of any hits, lie on their stacks then.
TEST(Deepest, EverythingIsVisited) {
    TestScene scene("sheets");
    TriangleMesh mesh;
    const int sheets = by_tier(20'000, 200'000);
    for (int i = 0; i < sheets; ++i) {
        const float z = static_cast<float>(i) / static_cast<float>(sheets);
        mesh.add({0, 0, z}, {1, 0, z}, {0, 1, z});
    }
    scene.meshes.push_back(std::move(mesh));
    scene.instances = {{0, {}}};
    // Of each octant that they can come from as many as a stream has, and a few more; every fourth meets the sheets.
    std::vector<Ray> rays;
    std::vector<uint8_t> expected;
    for (int i = 0; i < 300; ++i) {
        const float side = i % 2 ? 1.0f : -1.0f, at = 0.8f + 0.0005f * static_cast<float>(i % 100);
        const bool blocked = i % 4 == 3;
        rays.push_back({{blocked ? 0.1f : at, at, side * 2}, 0, {0, 0, -side}, kInfinity});
        expected.push_back(blocked);
    }
    for (const AccelOptions& options : all_options()) {
        const Result<Accel> accel = Accel::build(scene.geometries(), scene.instances, options);
        ASSERT_TRUE(accel);
        std::vector<uint8_t> occluded(rays.size());
        accel->occluded(rays, occluded);
        EXPECT_EQ(occluded, expected);
    }
}

/// As deep as there are hierarchies, with seven more nodes left behind at every level, and so wide at the root that no
/// node waits for its memory any more: what the stack of a stream must hold. All rays meet all boxes; every fourth
/// meets the one triangle that there is in all leaves.
TEST(Deepest, StreamsHoldWhatIsLeftBehind) {
    const Box box{{-1, -4, -4}, {1, 4, 4}};
    // Below the root of the chain seven nodes with 64 twigs each, below its other nodes seven twigs.
    const uint32_t leaf = ChildRef::leaf(ItemKind::block, 0, 1), twig = kMaxNodeLevels, branch = twig + 1,
                   bough = twig + 2;
    std::vector<WideNode> nodes(bough + 1);
    for (uint32_t k = 0; k < nodes.size(); ++k)
        for (uint32_t child = 0; child < kWidth; ++child) {
            const bool chain = child == kSiblings, exists = k != twig || chain;
            for (int axis = 0; axis < 3; ++axis) {
                nodes[k].plane[axis][0][child] = exists ? box.lo[axis] : kInfinity;
                nodes[k].plane[axis][1][child] = exists ? box.hi[axis] : -kInfinity;
            }
            // The chain is taken from the stack first: it is pushed last.
            nodes[k].child[child] = k == twig               ? leaf
                                    : k > twig              ? ChildRef::node(k - 1 == twig ? twig : branch)
                                    : chain && k + 1 < twig ? ChildRef::node(k + 1)
                                    : k == 0                ? ChildRef::node(bough)
                                                            : ChildRef::node(twig);
        }
    const Vec3 corners[3] = {{0, -4, -4}, {0, 4, -4}, {0, 0, 4}};
    TriangleBlock block;
    for (uint32_t lane = 0; lane < kBlock; ++lane) {
        block.prim[lane] = lane == 0 ? 0 : kNoHit;
        for (int which = 0; which < 3; ++which)
            for (int axis = 0; axis < 3; ++axis) block.vertex[which][axis][lane] = corners[which][axis];
    }
    const TrianglePart part{0, 0};
    World world;
    world.upper = {nodes.data(), &block, nullptr};
    world.parts = &part, world.part_count = 1;

    std::vector<Ray> rays;
    for (int i = 0; i < 200; ++i) {
        const float at = i % 4 == 3 ? 0.001f * static_cast<float>(i) : 3.5f;
        rays.push_back({{-5, at, at}, 0, {1, 0, 0}, kInfinity});
    }
    for (const Isa isa : supported_isas()) {
        std::vector<uint8_t> occluded(rays.size());
        (*select_kernels(isa))->occluded(world, rays.data(), occluded.data(), rays.size());
        for (size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(occluded[i], i % 4 == 3) << i;
    }
}

}  // namespace
}  // namespace steradian::test
