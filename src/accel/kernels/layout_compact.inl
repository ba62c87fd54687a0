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

inline uint64_t first_block(uint32_t leaf_ref) { return CompactRef::offset(leaf_ref); }

/// Those of a leaf.
struct Blocks {
    CompactBlock at;
    bool open = true;
    Blocks(const LevelView& level, uint32_t ref)
        : at(static_cast<const uint64_t*>(level.blocks) + CompactRef::offset(ref)) {}
    bool more() const { return open; }
    Block block() const { return Block(at); }
    void next() {
        open = !at.last();
        at = CompactBlock(at.unit + at.units());
    }
};
