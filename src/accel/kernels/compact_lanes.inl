// Reading compact blocks and pushing the children of compact nodes, for instruction sets that cannot move lanes about.

struct CompactLanes : CompactBlock {
    explicit CompactLanes(const CompactBlock& block) : CompactBlock(block) {}

    void corners(int which_axis, Float4 out[3]) const {
        const char* coordinates = axis(which_axis);
        for (uint32_t c = 0; c < 3; ++c) {
            float p[kBlock];
            const char* from = coordinates + (c == 2 && many() ? sizeof(float[kSecondVector]) : 0);
            for (uint32_t lane = 0; lane < kBlock; ++lane)
                std::memcpy(&p[lane], from + sizeof(float) * index(c, lane), sizeof(float));
            out[c] = four(p[0], p[1], p[2], p[3]);
        }
    }
    void corners(int which_axis, Double4 out[3]) const {
        Float4 p[3];
        corners(which_axis, p);
        for (int i = 0; i < 3; ++i) out[i] = Double4::of(p[i]);
    }
};

/// As for other nodes.
inline uint32_t ordered_at_most(Float8 in, Float8 out, const CompactNode& node, uint32_t octant_shift) {
    const uint32_t met = at_most(in, out), order = node.order_of(octant_shift);
    uint32_t ordered = 0;
    for (uint32_t place = 0; place < kWidth; ++place) ordered |= (met >> (order >> (3 * place) & 7) & 1) << place;
    return ordered & node.present_in_order();
}
inline uint32_t push_met(Float8 in, Float8 out, float limit, const CompactNode& node, uint32_t octant_shift,
                         float* t_in, uint32_t* ref) {
    const uint32_t met = at_most(in, out) & at_most(in, Float8::all(limit)) & node.present();
    alignas(32) float t[kWidth];
    in.store(t);
    uint32_t count = 0, order = node.order_of(octant_shift);
    for (uint32_t place = 0; place < kWidth; ++place, order >>= 3) {
        const uint32_t child = order & 7;
        t_in[count] = t[child], ref[count] = node.child[child];
        count += met >> child & 1;
    }
    return count;
}
inline uint32_t push_met(uint32_t met, const CompactNode& node, uint32_t* ref) {
    met &= node.present();
    uint32_t count = 0;
    for (uint32_t child = 0; child < kWidth; ++child) {
        ref[count] = node.child[child];
        count += met >> child & 1;
    }
    return count;
}
