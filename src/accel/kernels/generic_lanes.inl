// For instruction sets that cannot move lanes about: through memory.

/// from[places[i]] in lane i, out of sixteen.
inline Float8 pick(const float* from, const uint32_t* places) {
    alignas(32) float picked[kWidth];
    for (uint32_t i = 0; i < kWidth; ++i) picked[i] = from[places[i]];
    return Float8::load(picked);
}
/// from[lane][offset] in every lane.
inline Float4 gathered(const float* const* from, ptrdiff_t offset) {
    alignas(16) float picked[4];
    for (int i = 0; i < 4; ++i) picked[i] = from[i][offset];
    return Float4::load(picked);
}
/// Where the bit is set a, else b.
inline Float8 select(uint32_t bits, Float8 a, Float8 b) {
    alignas(32) float as[kWidth], bs[kWidth];
    a.store(as), b.store(bs);
    for (uint32_t i = 0; i < kWidth; ++i) bs[i] = bits >> i & 1 ? as[i] : bs[i];
    return Float8::load(bs);
}
/// Writes the value where the bit is set.
inline void set_where(uint32_t bits, uint32_t value, uint32_t* eight) {
    for (uint32_t i = 0; i < kWidth; ++i) eight[i] = bits >> i & 1 ? value : eight[i];
}
/// Sixteen rows of eight floats become eight columns of sixteen, one after the other.
inline void transpose(const float* const* rows, float* columns) {
    for (int row = 0; row < 16; ++row)
        for (int column = 0; column < 8; ++column) columns[16 * column + row] = rows[row][column];
}

/// Eight words.
struct Words8 {
    uint32_t v[kWidth];
    static Words8 none() { return {}; }
    static Words8 load(const uint32_t* p) {
        Words8 a;
        for (uint32_t i = 0; i < kWidth; ++i) a.v[i] = p[i];
        return a;
    }
    /// Sets a bit where a <= b.
    void set_where_at_most(const Float8& a, const Float8& b, uint32_t bit) {
        const uint32_t where = at_most(a, b);
        for (uint32_t i = 0; i < kWidth; ++i) v[i] |= (where >> i & 1) << bit;
    }
    /// Those whose bits are set, 0 in the place of others.
    Words8 only(uint32_t lanes) const {
        Words8 a;
        for (uint32_t i = 0; i < kWidth; ++i) a.v[i] = lanes >> i & 1 ? v[i] : 0;
        return a;
    }
    /// A bit for each that is not 0.
    uint32_t some() const {
        uint32_t bits = 0;
        for (uint32_t i = 0; i < kWidth; ++i) bits |= uint32_t(v[i] != 0) << i;
        return bits;
    }
    /// Those whose bits are set, one after the other. Writes eight.
    void pack(uint32_t lanes, uint32_t* to) const {
        for (uint32_t i = 0, count = 0; i < kWidth; ++i) {
            to[count] = v[i];
            count += lanes >> i & 1;
        }
    }
};
inline Words8 operator|(const Words8& a, const Words8& b) {
    Words8 c;
    for (uint32_t i = 0; i < kWidth; ++i) c.v[i] = a.v[i] | b.v[i];
    return c;
}
/// A bit for each whose highest bit is set.
inline uint32_t top_bits(const Words8& a) {
    uint32_t bits = 0;
    for (uint32_t i = 0; i < kWidth; ++i) bits |= (a.v[i] >> 31) << i;
    return bits;
}

/// at_most(in, out) for the children of a node, each at its place in the order from far to near.
inline uint32_t ordered_at_most(Float8 in, Float8 out, const WideNode& node, uint32_t octant_shift) {
    const uint32_t met = at_most(in, out);
    uint32_t ordered = 0;
    for (uint32_t place = 0; place < kWidth; ++place)
        ordered |= (met >> (node.order[place] >> octant_shift & 7) & 1) << place;
    return ordered;
}

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
