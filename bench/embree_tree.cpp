#include <embree3/rtcore.h>

#include <algorithm>
#include <new>
#include <stdexcept>

#include "accel/triangle.h"
#include "trees.h"

namespace steradian::bench {
namespace {

/// As Embree's callbacks make them, by many threads.
struct TreeNode {
    Box box[2];
    TreeNode* child[2] = {};
    const RTCBuildPrimitive* primitives = nullptr;  ///< of a leaf: a copy of Embree's
    size_t count = 0;
};

Box box_of(const RTCBounds& b) { return {{b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z}}; }

TreeNode* new_node(RTCThreadLocalAllocator allocator) {
    return new (rtcThreadLocalAlloc(allocator, sizeof(TreeNode), alignof(TreeNode))) TreeNode;
}

void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, size_t count, void*) {
    TreeNode* leaf = new_node(allocator);
    auto* own = static_cast<RTCBuildPrimitive*>(rtcThreadLocalAlloc(allocator, count * sizeof(RTCBuildPrimitive), 32));
    std::copy_n(primitives, count, own);
    leaf->primitives = own, leaf->count = count;
    return leaf;
}

void set_children(void* node, void** children, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i) static_cast<TreeNode*>(node)->child[i] = static_cast<TreeNode*>(children[i]);
}

void set_bounds(void* node, const RTCBounds** bounds, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i) static_cast<TreeNode*>(node)->box[i] = box_of(*bounds[i]);
}

/// The bounds of the two parts of a triangle within `primitive`'s box.
void split_primitive(const RTCBuildPrimitive* primitive, unsigned axis, float position, RTCBounds* left,
                     RTCBounds* right, void* user) {
    const auto& mesh = *static_cast<const BenchMesh*>(user);
    Box part[2];
    for (size_t i = 0; i < 3; ++i) {
        const uint32_t* corner = &mesh.indices[3 * size_t(primitive->primID)];
        const Vec3 a = mesh.positions[corner[i]], b = mesh.positions[corner[(i + 1) % 3]];
        const float pa = a[int(axis)], pb = b[int(axis)];
        if (pa <= position) part[0].extend(a);
        if (pa >= position) part[1].extend(a);
        if ((pa < position && position < pb) || (pb < position && position < pa)) {
            Vec3 crossing = a + (b - a) * ((position - pa) / (pb - pa));
            crossing[int(axis)] = position;
            part[0].extend(crossing), part[1].extend(crossing);
        }
    }
    const auto store = [&](const Box& b, RTCBounds& out) {
        out.lower_x = max_of(b.lo.x, primitive->lower_x), out.upper_x = min_of(b.hi.x, primitive->upper_x);
        out.lower_y = max_of(b.lo.y, primitive->lower_y), out.upper_y = min_of(b.hi.y, primitive->upper_y);
        out.lower_z = max_of(b.lo.z, primitive->lower_z), out.upper_z = min_of(b.hi.z, primitive->upper_z);
    };
    store(part[0], *left), store(part[1], *right);
}

std::vector<RTCBuildPrimitive> build_primitives(const BenchMesh& mesh, bool high) {
    std::vector<RTCBuildPrimitive> all;
    all.reserve(mesh.triangles() * (high ? 2 : 1));
    for (size_t i = 0; i < mesh.triangles(); ++i) {
        const auto corner = [&](size_t k) { return mesh.positions[mesh.indices[3 * i + k]]; };
        const Box b = triangle_bounds(corner(0), corner(1), corner(2));
        all.push_back({b.lo.x, b.lo.y, b.lo.z, 0, b.hi.x, b.hi.y, b.hi.z, static_cast<uint32_t>(i)});
    }
    return all;
}

/// Copies Embree's tree, with the primitives in the order of the leaves.
class Copier {
public:
    explicit Copier(BinaryTree& out) : out_(out), source_(*out.nodes) {}

    uint32_t copy(const TreeNode& from, const Box& box) {
        const uint32_t root = source_.next_two();
        copy(from, box, root);
        return root;
    }

private:
    void copy(const TreeNode& from, const Box& box, uint32_t to) {
        const BuildPrimitive bounds(box, 0, ItemKind::block);
        (*out_.nodes)[to].set_box({Float4::load(bounds.lo), Float4::load(bounds.hi)});
        if (from.child[0]) {
            const uint32_t left = source_.next_two(), right = left + 1;
            copy(*from.child[0], from.box[0], left), copy(*from.child[1], from.box[1], right);
            (*out_.nodes)[to].set_children(left, right, false, true);
            return;
        }
        const size_t begin = out_.primitives.size();
        for (size_t i = 0; i < from.count; ++i)
            out_.primitives.emplace_back(box_of(from.primitives[i]), from.primitives[i].primID, ItemKind::block);
        (*out_.nodes)[to].set_leaf(begin, out_.primitives.size(), ItemKind::block);
    }

    static Box box_of(const RTCBuildPrimitive& p) {
        return {{p.lower_x, p.lower_y, p.lower_z}, {p.upper_x, p.upper_y, p.upper_z}};
    }

    BinaryTree& out_;
    BinaryPool::Source source_;
};

}  // namespace

BinaryTree embree_tree(const BenchMesh& mesh, bool high) {
    const std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> device(rtcNewDevice(nullptr), rtcReleaseDevice);
    if (!device) throw std::runtime_error("Embree does not start");
    const std::unique_ptr<RTCBVHTy, decltype(&rtcReleaseBVH)> bvh(rtcNewBVH(device.get()), rtcReleaseBVH);
    std::vector<RTCBuildPrimitive> primitives = build_primitives(mesh, high);
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.buildQuality = high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM;
    // As for its own leaves of blocks of four triangles, with as large ones as ours.
    arguments.maxDepth = kMaxBvhDepth, arguments.sahBlockSize = kBlock;
    arguments.minLeafSize = 1, arguments.maxLeafSize = 2 * kBlock;
    arguments.bvh = bvh.get();
    arguments.primitives = primitives.data();
    arguments.primitiveCount = primitives.size(), arguments.primitiveArrayCapacity = primitives.capacity();
    arguments.createNode = [](RTCThreadLocalAllocator a, unsigned, void*) -> void* { return new_node(a); };
    arguments.setNodeChildren = set_children, arguments.setNodeBounds = set_bounds;
    arguments.createLeaf = create_leaf;
    arguments.splitPrimitive = split_primitive;
    arguments.userPtr = const_cast<BenchMesh*>(&mesh);
    const auto* root = static_cast<const TreeNode*>(rtcBuildBVH(&arguments));
    if (!root || rtcGetDeviceError(device.get()) != RTC_ERROR_NONE) throw std::runtime_error("Embree builds no tree");

    BinaryTree tree;
    tree.nodes = std::make_unique<BinaryPool>(primitives.capacity());
    Box bounds;
    for (const Vec3& p : mesh.positions) bounds.extend(p);
    tree.root = Copier(tree).copy(*root, bounds);
    return tree;
}

}  // namespace steradian::bench
