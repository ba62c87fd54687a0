// How the kernels read nodes and blocks as they are: planes in float, triangles coordinate by coordinate. Included
// after the vectors of an instruction set.

using Node = WideNode;
inline constexpr uint64_t kPlaneBytes = sizeof(float[kWidth]);  ///< from one plane of a node to the next
inline constexpr uint64_t kBlockBytes = sizeof(TriangleBlock);
inline constexpr size_t kPrefetchBytes = 256;

inline const Node& node_at(const LevelView& level, uint32_t index) {
    return static_cast<const Node*>(level.nodes)[index];
}
inline const TriangleBlock& block_at(const LevelView& level, uint32_t index) {
    return static_cast<const TriangleBlock*>(level.blocks)[index];
}

/// Bits of the children that exist: those of others are never met.
inline uint32_t existing(const Node&) { return ~0u; }

/// The planes of a node along an axis.
struct Planes {
    const char* first;
    Planes(const Node& node, int) : first(reinterpret_cast<const char*>(&node)) {}
    /// `offset` is that of the plane among those of all axes.
    Float8 at(uint64_t offset) const { return Float8::load(reinterpret_cast<const float*>(first + offset)); }
};

/// Four triangles.
struct Block {
    const TriangleBlock* at;
    void corners(int axis, Double4 out[3]) const {
        for (int i = 0; i < 3; ++i) out[i] = Double4::of_floats(at->vertex[i][axis]);
    }
    void corners(int axis, Float4 out[3]) const {
        for (int i = 0; i < 3; ++i) out[i] = Float4::load(at->vertex[i][axis]);
    }
    Vec3 corner(int which, uint32_t lane) const { return at->corner(which, lane); }
    uint32_t prim(uint32_t lane) const { return at->prim[lane]; }
};

inline uint64_t first_block(uint32_t leaf_ref) { return ChildRef::first(leaf_ref); }

/// Those of a leaf.
struct Blocks {
    const TriangleBlock *at, *end;
    Blocks(const LevelView& level, uint32_t ref)
        : at(&block_at(level, ChildRef::first(ref))), end(at + ChildRef::count(ref)) {}
    bool more() const { return at < end; }
    Block block() const { return {at}; }
    void next() { ++at; }
};
