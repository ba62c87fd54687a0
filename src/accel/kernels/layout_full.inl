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

/// Which child comes at a place of the order from far to near.
inline uint32_t child_at(const Node& node, uint32_t place, uint32_t octant_shift) {
    return node.order[place] >> octant_shift & 7;
}

/// One plane of one child.
inline float plane_of(const Node& node, int, uint64_t offset, uint32_t child) {
    return *reinterpret_cast<const float*>(reinterpret_cast<const char*>(&node) + offset + child * sizeof(float));
}

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

/// A place is that of a triangle among all of its level.
inline Block block_of(const LevelView& level, uint32_t place) { return {&block_at(level, place / kBlock)}; }

/// The vertices of kGroup triangles, side by side.
inline void gather_corners(const LevelView& level, const uint32_t* places, Floats corner[3][3]) {
    const float* triangle[kGroup];
    for (uint32_t k = 0; k < kGroup; ++k)
        triangle[k] = &block_at(level, places[k] / kBlock).vertex[0][0][places[k] % kBlock];
    for (int c = 0; c < 3; ++c)
        for (int axis = 0; axis < 3; ++axis) corner[c][axis] = gathered(triangle, (3 * c + axis) * kBlock);
}

inline uint64_t first_block(uint32_t leaf_ref) { return ChildRef::first(leaf_ref); }

/// Those of a leaf.
struct Blocks {
    const TriangleBlock *at, *end;
    Blocks(const LevelView& level, uint32_t ref)
        : at(&block_at(level, ChildRef::first(ref))), end(at + ChildRef::count(ref)) {}
    bool more() const { return at < end; }
    Block block() const { return {at}; }
    uint32_t place(const LevelView& level) const { return static_cast<uint32_t>(at - &block_at(level, 0)) * kBlock; }
    void next() { ++at; }
};
