// Everything that a query reads, in the form in which the kernels read it.
#pragma once

#include <span>
#include <vector>

#include "accel/accel.h"
#include "accel/instance.h"
#include "accel/triangle_block.h"
#include "accel/wide_node.h"

namespace steradian {

enum class PrimitiveKind : uint32_t { triangles, spheres, rectangles, disks };

/// One geometry: the root is nodes[0], and the leaves hold runs of blocks (triangles) or of entries of `order`.
struct GeometryView {
    const WideNode* nodes = nullptr;
    PrimitiveKind kind = PrimitiveKind::triangles;
    union {
        const TriangleBlock* blocks = nullptr;
        const SphereGeometry* spheres;
        const RectangleGeometry* rectangles;
        const DiskGeometry* disks;
    };
    const uint32_t* order = nullptr;
};

/// Two levels: the leaves of `nodes` hold runs of `order`, whose entries are instances that have something in them.
struct World {
    const WideNode* nodes = nullptr;  ///< nullptr when there is nothing at all
    const uint32_t* order = nullptr;
    const PlacedGeometry* instances = nullptr;
    const GeometryView* geometries = nullptr;
    /// The one instance in use, where there is only one and it is not transformed: rays start in its hierarchy.
    uint32_t only = kNoHit;
};

/// Order of hits along a ray: by t, then instance, then primitive.
inline bool comes_before(const Hit& a, const Hit& b) {
    if (a.t != b.t) return a.t < b.t;
    if (a.instance != b.instance) return a.instance < b.instance;
    return a.prim < b.prim;
}

}  // namespace steradian
