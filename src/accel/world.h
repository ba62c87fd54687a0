// Everything that a query reads, in the form in which the kernels read it.
#pragma once

#include "accel/accel.h"
#include "accel/instance.h"
#include "accel/margin.h"
#include "accel/triangle_block.h"
#include "accel/wide_node.h"

namespace steradian {

/// A shape, an instance or a part of an instance in a leaf. On the upper level `instance` is the index of the instance;
/// within one it means nothing.
struct LeafEntry {
    uint32_t instance;
    uint32_t prim;  ///< of a shape; of an instance kWholeInstance, or where in its hierarchy the part's reference is
    Box own;        ///< of a shape; dear to compute
};
inline constexpr uint32_t kWholeInstance = kNoHit;
/// Child `child` of a node of an instance's hierarchy, as LeafEntry::prim.
constexpr uint32_t part_place(uint32_t node, uint32_t child) { return node * kWidth + child; }

/// A hierarchy: the root is nodes[0], nodes is nullptr when there is nothing in it.
struct LevelView {
    const void* nodes = nullptr;         ///< what they are depends on the layout: kernels/layout_*.inl
    const void* blocks = &kNoBlocks;     ///< the same; that where there are no triangles
    const LeafEntry* entries = nullptr;  ///< nullptr where there are none
};

/// The shapes of one geometry; nothing for triangles, which are in blocks.
struct ShapesView {
    const SphereGeometry* spheres = nullptr;
    const RectangleGeometry* rectangles = nullptr;
    const DiskGeometry* disks = nullptr;
};

/// Triangles of the upper level whose ids begin at `first` belong to this instance.
struct TrianglePart {
    uint32_t first, instance;
};

/// Two levels. The upper one holds the primitives of every instance that is not transformed, all together, and the
/// transformed instances; each of these leads to the hierarchy of its geometry.
struct World {
    LevelView upper;
    bool only_instances = false;          ///< there is nothing else on it
    const TrianglePart* parts = nullptr;  ///< ascending
    uint32_t part_count = 0;
    /// Where instances are opened (open.h): a second upper level with all of them as wholes, for rays that are not
    /// near.
    LevelView far;
    Box near;
    const PlacedGeometry* instances = nullptr;
    const LevelView* levels = nullptr;   ///< by geometry
    const ShapesView* shapes = nullptr;  ///< by geometry
    /// By instance, a bit for each primitive; nullptr where all are opaque, and instead of the array when everything
    /// is.
    const uint8_t* const* cut_outs = nullptr;

    /// Whether parts of instances are not enough for a canonical ray.
    bool is_far(const Ray& ray) const { return far.nodes != nullptr && !is_near(near, ray); }
    bool is_cut_out(const Hit& hit) const {
        const uint8_t* bits = cut_outs[hit.instance];
        return bits && (bits[hit.prim / 8] >> (hit.prim % 8) & 1);
    }
    /// The instance of a triangle of the upper level; `id` becomes its primitive.
    uint32_t identify(uint32_t& id) const {
        uint32_t part = 0;
        for (uint32_t n = part_count; n > 1;) {
            const uint32_t half = n / 2;
            part = parts[part + half].first <= id ? part + half : part;
            n -= half;
        }
        id -= parts[part].first;
        return parts[part].instance;
    }
};

/// Order of hits along a ray: by t, then instance, then primitive.
inline bool comes_before(const Hit& a, const Hit& b) {
    if (a.t != b.t) return a.t < b.t;
    if (a.instance != b.instance) return a.instance < b.instance;
    return a.prim < b.prim;
}

}  // namespace steradian
