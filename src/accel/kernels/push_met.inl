// What to do with the children that a ray meets, for instruction sets that cannot move lanes about.

/// Pushes the children that are met (in <= out, in <= limit) with their t_in, from far to near; returns their number.
/// Writes up to kWidth entries, whatever the number.
inline uint32_t push_met(Float8 in, Float8 out, float limit, const WideNode& node, uint32_t octant_shift, float* t_in,
                         uint32_t* ref) {
    const uint32_t met = at_most(in, out) & at_most(in, Float8::all(limit));
    alignas(32) float t[kWidth];
    in.store(t);
    uint32_t count = 0;
    for (const uint32_t order : node.order) {
        const uint32_t child = order >> octant_shift & 7;
        t_in[count] = t[child], ref[count] = node.child[child];
        count += met >> child & 1;
    }
    return count;
}

/// Pushes the children whose bits are set, in no particular order; returns their number. Writes kWidth entries.
inline uint32_t push_met(uint32_t met, const WideNode& node, uint32_t* ref) {
    uint32_t count = 0;
    for (uint32_t child = 0; child < kWidth; ++child) {
        ref[count] = node.child[child];
        count += met >> child & 1;
    }
    return count;
}
