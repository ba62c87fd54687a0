#include "trees.h"

#include <fmt/format.h>

#include <algorithm>

#include "accel/geometry.h"
#include "accel/kernels/kernels.h"
#include "accel/triangle.h"
#include "ours.h"

namespace steradian::bench {
namespace {

/// A mesh that is traversed by way of some tree.
class TracedTree {
public:
    TracedTree(const BenchMesh& mesh, std::string name, Bvh bvh)
        : name_(std::move(name)), references_(double(count_ids(bvh)) / double(mesh.triangles())) {
        const Geometry geometry = mesh.geometry();
        const LevelPart part{0, 0, 0};
        level_ = fill_level(std::move(bvh), {&geometry, 1}, {&part, 1}, {});
        world_.upper = level_.view();
        world_.parts = &part_, world_.part_count = 1;
        world_.instances = &placed_, world_.shapes = &shapes_;
    }
    TracedTree(const TracedTree&) = delete;
    TracedTree& operator=(const TracedTree&) = delete;

    const std::string& name() const { return name_; }
    double references() const { return references_; }  ///< per triangle
    size_t nodes() const { return level_.nodes.size(); }
    const World& world() const { return world_; }

private:
    static size_t count_ids(const Bvh& bvh) {
        return bvh.blocks.size() - size_t(std::count(bvh.blocks.begin(), bvh.blocks.end(), kNoHit));
    }

    std::string name_;
    double references_;
    Level level_;
    TrianglePart part_{0, 0};
    PlacedGeometry placed_;
    ShapesView shapes_;
    World world_;
};

class TreeTracer : public Tracer {
public:
    TreeTracer(const TracedTree& tree, const Kernels& kernels, const RaySet& set, size_t chunk)
        : world_(tree.world()), kernels_(kernels), set_(set), rays_(chunk), hits_(chunk), occluded_(chunk) {}
    void load(std::span<const Ray> rays) override {
        count_ = rays.size();
        std::copy(rays.begin(), rays.end(), rays_.begin());
    }
    void trace() override {
        const auto closest = set_.coherent ? kernels_.intersect_coherent : kernels_.intersect;
        const auto any = set_.coherent ? kernels_.occluded_coherent : kernels_.occluded;
        if (set_.any_hit) {
            any(world_, rays_.data(), occluded_.data(), count_);
        } else {
            closest(world_, rays_.data(), hits_.data(), count_);
        }
    }
    void store(std::span<Hit> hits) override { std::copy_n(hits_.begin(), count_, hits.begin()); }
    void store(std::span<uint8_t> occluded) override { std::copy_n(occluded_.begin(), count_, occluded.begin()); }

private:
    const World& world_;
    const Kernels& kernels_;
    const RaySet& set_;
    std::vector<Ray> rays_;
    std::vector<Hit> hits_;
    std::vector<uint8_t> occluded_;
    size_t count_ = 0;
};

/// What a ray by itself looks at, in the stored order of the children.
struct Visits {
    uint64_t nodes = 0, blocks = 0;
};

class Counter {
public:
    Counter(const LevelView& level, const Ray& ray, bool any_hit, Visits& visits)
        : level_(level),
          slab_(ray),
          triangle_ray_(ray),
          tmin_(ray.tmin),
          limit_(ray.tmax),
          any_(any_hit),
          visits_(visits) {
        for (int axis = 0; axis < 3; ++axis) octant_ |= uint32_t(slab_.negative[axis]) << axis;
    }
    /// True when the query is done.
    bool visit(uint32_t ref) {
        if (ChildRef::is_leaf(ref)) return visit_blocks(ref);
        ++visits_.nodes;
        const WideNode& node = static_cast<const WideNode*>(level_.nodes)[ref];
        for (uint32_t place = kWidth; place-- > 0;) {
            const uint32_t child = node.order[place] >> (3 * octant_) & 7;
            Box box;
            for (int axis = 0; axis < 3; ++axis)
                box.lo[axis] = node.plane[axis][0][child], box.hi[axis] = node.plane[axis][1][child];
            if (box.empty()) continue;
            const Interval range = slab_interval(box, slab_);
            if (max_of(range.in, tmin_) > range.out || range.in > limit_) continue;
            if (visit(node.child[child])) return true;
        }
        return false;
    }

private:
    bool visit_blocks(uint32_t ref) {
        for (uint32_t i = 0; i < ChildRef::count(ref); ++i) {
            ++visits_.blocks;
            const TriangleBlock& block = static_cast<const TriangleBlock*>(level_.blocks)[ChildRef::first(ref) + i];
            for (uint32_t lane = 0; lane < kBlock; ++lane) {
                TriangleCandidate c;
                if (!intersect_triangle(triangle_ray_, block.corner(0, lane), block.corner(1, lane),
                                        block.corner(2, lane), c) ||
                    c.t < tmin_ || c.t > limit_)
                    continue;
                limit_ = c.t;
                if (any_) return true;
            }
        }
        return false;
    }

    const LevelView& level_;
    SlabRay slab_;
    TriangleRay triangle_ray_;
    float tmin_, limit_;
    bool any_;
    uint32_t octant_ = 0;
    Visits& visits_;
};

Visits count_visits(const TracedTree& tree, const RaySet& set) {
    Visits visits;
    for (const Ray& in : set.rays) {
        Ray ray;
        if (canonical(in, ray)) Counter(tree.world().upper, ray, set.any_hit, visits).visit(ChildRef::node(0));
    }
    return visits;
}

Bvh our_tree(const BenchMesh& mesh, BvhBuilder builder) {
    LargeArray<BuildPrimitive> primitives;
    // Sound already: an Accel was built over it.
    (void)append_primitives(mesh.geometry(), 0, 0, primitives);
    BuildMonitor monitor;
    BvhOptions options;
    options.builder = builder;
    options.split_boxes = true;
    return build_bvh(primitives, options, monitor);
}

Bvh gathered(BinaryTree tree) {
    Bvh bvh;
    BuildMonitor monitor;
    LeafPrimitives primitives{tree.primitives};
    gather(*tree.nodes, tree.root, primitives, {}, monitor, bvh);
    return bvh;
}

}  // namespace

std::optional<Error> measure_trees(const BenchMesh& mesh, const Options& options, Report& report) {
    const Result<const Kernels*> kernels = select_kernels(Isa::automatic);
    if (!kernels) return kernels.error();
    const Result<Accel> accel = build_ours(mesh, our_settings()[0]);
    if (!accel) return accel.error();
    std::vector<std::unique_ptr<TracedTree>> trees;
    const auto add = [&](const std::string& name, Bvh bvh) {
        trees.push_back(std::make_unique<TracedTree>(mesh, name, std::move(bvh)));
    };
    for (const OurSetting& setting : our_settings())
        if (setting.options.layout == BvhLayout::full) add(setting.name, our_tree(mesh, setting.options.builder));
    if (!options.only_ours) {
        add("Embree medium", gathered(embree_tree(mesh, false)));
        add("Embree high", gathered(embree_tree(mesh, true)));
    }
    for (const RaySet& set : record_rays(*accel, mesh, options.size, options.rays)) {
        fmt::print(stderr, "{}: trees, {}\n", mesh.name, set.name);
        std::vector<Entrant> entrants;
        for (const auto& tree : trees)
            entrants.push_back({[&tree, &kernels](const RaySet& rays, size_t chunk) {
                return std::make_unique<TreeTracer>(*tree, **kernels, rays, chunk);
            }});
        const std::vector<Lane> lanes = race(set, entrants, {options.repetitions, options.chunk, false});
        for (size_t i = 0; i < trees.size(); ++i) {
            const Visits visits = count_visits(*trees[i], set);
            const double rays = double(set.rays.size());
            report.trees.push_back({mesh.name, set.name, trees[i]->name(), set.rays.size(), lanes[i].seconds,
                                    lanes[0].seconds, double(visits.nodes) / rays, double(visits.blocks) / rays,
                                    double(trees[i]->nodes()) / double(mesh.triangles()), trees[i]->references(),
                                    count_different(lanes[0].answers, lanes[i].answers)});
        }
    }
    return {};
}

}  // namespace steradian::bench
