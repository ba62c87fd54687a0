// How the kernels read compact nodes and blocks (compact_node.h, compact_block.h). Included after the vectors of an
// instruction set and after compact_lanes.inl or compact_avx2.inl.

using Node = CompactNode;
inline constexpr uint64_t kPlaneBytes = sizeof(uint8_t[kWidth]);  ///< from one plane of a node to the next
inline constexpr uint64_t kBlockBytes = sizeof(uint64_t);
inline constexpr size_t kPrefetchBytes = 192;

inline const Node& node_at(const LevelView& level, uint32_t index) {
    return static_cast<const Node*>(level.nodes)[index];
}

/// Bits of the children that exist: decoded boxes of others may be met.
inline uint32_t existing(const Node& node) { return node.present(); }

/// Which child comes at a place of the order from far to near.
inline uint32_t child_at(const Node& node, uint32_t place, uint32_t octant_shift) {
    return node.order_of(octant_shift) >> (3 * place) & 7;
}

/// One plane of one child, decoded in the same way as those of Planes.
inline float plane_of(const Node& node, int axis, uint64_t offset, uint32_t child) {
    return static_cast<float>((&node.plane[0][0][0])[offset + child]) * node.scale[axis] + node.origin[axis];
}

/// The planes of a node along an axis: CompactNode::decoded, operation by operation.
struct Planes {
    const uint8_t* first;
    Float8 scale, origin;
    Planes(const Node& node, int axis)
        : first(&node.plane[0][0][0]), scale(Float8::all(node.scale[axis])), origin(Float8::all(node.origin[axis])) {}
    /// `offset` is that of the plane among those of all axes.
    Float8 at(uint64_t offset) const { return Float8::of_bytes(first + offset) * scale + origin; }
};

/// Four triangles.
using Block = CompactLanes;

/// A place is that of a triangle among all of its level, which leaves some out.
inline CompactBlock block_of(const LevelView& level, uint32_t place) {
    return CompactBlock(static_cast<const uint64_t*>(level.blocks) + place / kBlock);
}

/// The vertices of kGroup triangles, side by side.
inline void gather_corners(const LevelView& level, const uint32_t* places, Floats corner[3][3]) {
    alignas(64) float p[3][3][kGroup];
    for (uint32_t k = 0; k < kGroup; ++k) {
        // CompactBlock::corner, with what is the same for all corners done once.
        const CompactBlock block = block_of(level, places[k]);
        const uint32_t lane = places[k] % kBlock, vertices = block.vertices(),
                       second = block.many() ? CompactBlock::kSecondVector : 0;
        const char* const first = block.at + sizeof(uint32_t);
        for (uint32_t c = 0; c < 3; ++c) {
            const uint32_t vertex = block.index(c, lane) + (c == 2 ? second : 0);
            for (uint32_t axis = 0; axis < 3; ++axis)
                std::memcpy(&p[c][axis][k], first + sizeof(float) * (vertex + axis * vertices), sizeof(float));
        }
    }
    for (int c = 0; c < 3; ++c)
        for (int axis = 0; axis < 3; ++axis) corner[c][axis] = Floats::load(p[c][axis]);
}

inline uint64_t first_block(uint32_t leaf_ref) { return CompactRef::offset(leaf_ref); }

/// Those of a leaf.
struct Blocks {
    CompactBlock at;
    bool open = true;
    Blocks(const LevelView& level, uint32_t ref)
        : at(static_cast<const uint64_t*>(level.blocks) + CompactRef::offset(ref)) {}
    bool more() const { return open; }
    Block block() const { return Block(at); }
    uint32_t place(const LevelView& level) const {
        return static_cast<uint32_t>(at.unit - static_cast<const uint64_t*>(level.blocks)) * kBlock;
    }
    void next() {
        open = !at.last();
        at = CompactBlock(at.unit + at.units());
    }
};
