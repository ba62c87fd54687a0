// The triangles of a leaf against the rays of a packet. Included by packet.inl.
//
// Most of what a packet asks has a clear answer: a ray misses a triangle by far, or hits it well inside and far from
// other triangles. So everything is computed in float first, together with a bound on its error, and only what float
// cannot decide is computed exactly. The nearest triangle of a ray gets its exact t, u and v once, at the end.
//
// The bounds, with u = 2^-24. Let all vertices of the leaf be at most D from the origins in every coordinate, and at
// most m from the ray once it is sheared onto the z axis. A sheared coordinate (a - o) - s z has five roundings, the
// one of s included, and is off by at most 2 u m + 4 u D <= 4 u q, where q = m + D. An edge function of them is off by
//     4 m (4 u q) + 2 (4 u q)^2 + 4 u m^2 <= 20 u q m + 32 u^2 q^2 < 24 u q (m + 4 u q),
// the roundings of the exact test's own doubles included. As for m: a ray that meets the leaf's box as test_child()
// computes it is, at some t, within the box up to 1.5 * 2^-20 D on each axis, so m is at most the sum of two of the
// box's extents and 3 * 2^-20 D.
//
// With all edge functions known to have one sign, and S their sum, a weight is off by at most 6.4 E / S where S > 8 E,
// and both weights move z by at most 16 E / S times the z extent of the box; where S <= 8 E that is more than all of
// it. The remaining roundings of t, those of the exact t and its settling into the triangle's own box move it by less
// than 24 u D / |d.z|.

/// What float may get wrong in a leaf.
struct LeafErrors {
    float edge;         ///< of an edge function
    float t_over_area;  ///< of t * |d.z|: this over |S| ...
    float t_constant;   ///< ... and this
};

inline LeafErrors leaf_errors(const Packet& p, const Node& node, uint32_t child) {
    constexpr float kU = 0x1p-24f;
    float far = 0, extent[3];
    for (int axis = 0; axis < 3; ++axis) {
        const uint64_t plane = static_cast<uint32_t>(2 * axis) * kPlaneBytes;
        const float lo = plane_of(node, axis, plane, child), hi = plane_of(node, axis, plane + kPlaneBytes, child);
        extent[axis] = hi - lo;
        far = max_of(far, max_of(hi - p.o_range[axis][0], p.o_range[axis][1] - lo));
    }
    const float m = (extent[0] + extent[1] + extent[2]) * (1 + 8 * kU) + 0x1p-18f * far;
    const float q = m + far * (1 + 8 * kU);
    LeafErrors e;
    // The constant is far above what underflow can do.
    e.edge = 25 * kU * q * (m + 4 * kU * q) + 0x1p-120f;
    e.t_over_area = 17 * e.edge * extent[p.axis[2]];
    e.t_constant = 32 * kU * far;
    return e;
}

/// A triangle that ray i meets at a settled t within its range.
template <Mode kMode>
inline void take(Packet& p, uint32_t i, float t, uint32_t id, const EdgeFunctions& edges) {
    // Ids of the upper level ascend with (instance, primitive).
    if (t == p.limit[i] && p.best[i] < id) return;
    p.best[i] = id;
    // Nothing is left to do for a ray that is done: no box begins before -infinity.
    p.limit[i] = p.low[i] = kMode == Mode::any ? -kInfinity : t;
    if (kMode != Mode::any) edges.weights(p.u[i], p.v[i]);
}

/// intersect_triangle() for kGroup rays of a packet, each with a triangle of its own: test_block with the parts of rays
/// and triangles exchanged.
struct ExactGroup {
    Doubles u, v, w;     ///< edge functions
    Floats t;            ///< settled
    uint32_t inside;     ///< a bit for every ray that meets its triangle somewhere
    uint32_t undecided;  ///< of those: the sign of a difference that came out as 0 is still open

    ExactGroup(const Packet& p, const World& world, const uint32_t* rays, const uint32_t* places) {
        Floats corner[3][3], o[3], d[3], inv_d[3];
        gather_corners(world.upper, places, corner);
        const float* ray[kGroup];
        for (uint32_t k = 0; k < kGroup; ++k) ray[k] = p.o[0] + rays[k];
        for (int axis = 0; axis < 3; ++axis) {
            o[axis] = gathered(ray, p.o[axis] - p.o[0]);
            d[axis] = gathered(ray, p.d[axis] - p.o[0]);
            inv_d[axis] = gathered(ray, p.inv_d[axis] - p.o[0]);
        }
        const int ax = p.axis[0], ay = p.axis[1], az = p.axis[2];
        const Doubles d_z = Doubles::of(d[az]);
        const Doubles shear_x = Doubles::of(d[ax]) / d_z, shear_y = Doubles::of(d[ay]) / d_z;
        Doubles x[3], y[3], z[3];
        for (int i = 0; i < 3; ++i) {
            z[i] = Doubles::of(corner[i][az]) - Doubles::of(o[az]);
            x[i] = (Doubles::of(corner[i][ax]) - Doubles::of(o[ax])) - shear_x * z[i];
            y[i] = (Doubles::of(corner[i][ay]) - Doubles::of(o[ay])) - shear_y * z[i];
        }
        u = x[2] * y[1] - y[2] * x[1];
        v = x[0] * y[2] - y[0] * x[2];
        w = x[1] * y[0] - y[1] * x[0];
        const Doubles low = smaller(smaller(u, v), w), high = larger(larger(u, v), w);
        const uint32_t not_below = not_negative(low), not_above = not_positive(high);
        inside = not_below | not_above;
        undecided = (not_below & not_positive(low)) | (not_above & not_negative(high));
        t = to_floats((u * z[0] + v * z[1] + w * z[2]) / ((u + v + w) * d_z));
        Floats in = Floats::all(-kInfinity), out = Floats::all(kInfinity);
        for (int axis = 0; axis < 3; ++axis) {
            const Floats lo = smaller(smaller(corner[0][axis], corner[1][axis]), corner[2][axis]);
            const Floats hi = larger(larger(corner[0][axis], corner[1][axis]), corner[2][axis]);
            in = larger(((p.negative[axis] ? hi : lo) - o[axis]) * inv_d[axis], in);
            out = smaller(((p.negative[axis] ? lo : hi) - o[axis]) * inv_d[axis], out);
        }
        out = out * Floats::all(kFarScale) + Floats::all(kFarPad);
        // + 0 turns -0 into 0, as in settle().
        t = smaller(larger(t, in), out) + Floats::all(0);
        inside &= at_most(in, out) & at_most(t, Floats::all(std::numeric_limits<float>::max()));
    }
};

/// The exact t, u, v and id of the triangles that are pending.
inline void resolve_all(Packet& p, const World& world) {
    for (uint32_t first = 0; first < kPacket; first += kGroup) {
        const uint32_t pending = p.pending >> first & ((1u << kGroup) - 1);
        if (pending == 0) continue;
        uint32_t ray[kGroup], place[kGroup];
        for (uint32_t k = 0; k < kGroup; ++k) {
            // What does not count gets a ray and a triangle that do.
            ray[k] = first + (pending >> k & 1 ? k : static_cast<uint32_t>(__builtin_ctz(pending)));
            place[k] = p.place[ray[k]];
        }
        const ExactGroup exact(p, world, ray, place);
        alignas(64) float t[kGroup], of_p1[kGroup], of_p2[kGroup];
        const Doubles sum = exact.u + exact.v + exact.w;
        exact.t.store(t), to_floats(exact.v / sum).store(of_p1), to_floats(exact.w / sum).store(of_p2);
        for (uint32_t k = 0; k < kGroup; ++k) {
            const uint32_t i = ray[k];
            limit_weights(of_p1[k], of_p2[k]);
            p.best[i] = block_of(world.upper, place[k]).prim(place[k] % kBlock);
            p.limit[i] = p.low[i] = t[k];
            p.u[i] = of_p1[k], p.v[i] = of_p2[k];
        }
    }
    p.pending = 0;
}

/// One ray and one triangle, the long way.
template <Mode kMode>
[[gnu::noinline]] void test_pair(Packet& p, const World& world, uint32_t i, uint32_t place) {
    const Ray& ray = *p.ray[i];
    const auto block = block_of(world.upper, place);
    const uint32_t lane = place % kBlock;
    const Vec3 p0 = block.corner(0, lane), p1 = block.corner(1, lane), p2 = block.corner(2, lane);
    const TriangleRay triangle_ray(ray);
    const EdgeFunctions edges = edge_functions(triangle_ray, p0, p1, p2);
    float t = 0;
    if (!edges.inside() ||
        !settle(edges.candidate(triangle_ray.d_z).t, slab_interval(triangle_bounds(p0, p1, p2), SlabRay(ray)), {}, t))
        return;
    if (p.start[i] <= t && t <= p.limit[i]) take<kMode>(p, i, t, block.prim(lane), edges);
}

/// Decides what was left open.
template <Mode kMode>
[[gnu::noinline]] void decide(Packet& p, const World& world) {
    if (kMode != Mode::any) resolve_all(p, world);
    for (uint32_t first = 0; first < p.open_count; first += kGroup) {
        const uint32_t count = min_of(p.open_count - first, kGroup);
        for (uint32_t k = count; k < kGroup; ++k)
            p.open_ray[first + k] = p.open_ray[first], p.open_place[first + k] = p.open_place[first];
        const uint32_t *ray = p.open_ray + first, *place = p.open_place + first;
        const ExactGroup exact(p, world, ray, place);
        alignas(64) float ts[kGroup];
        alignas(64) double us[kGroup], vs[kGroup], ws[kGroup];
        exact.t.store(ts), exact.u.store(us), exact.v.store(vs), exact.w.store(ws);
        for (uint32_t rest = exact.inside & ((1u << count) - 1); rest; rest &= rest - 1) {
            const auto k = static_cast<uint32_t>(__builtin_ctz(rest));
            const uint32_t i = ray[k];
            if (exact.undecided >> k & 1) {
                test_pair<kMode>(p, world, i, place[k]);
            } else if (p.start[i] <= ts[k] && ts[k] <= p.limit[i]) {
                const uint32_t id = block_of(world.upper, place[k]).prim(place[k] % kBlock);
                take<kMode>(p, i, ts[k], id, {us[k], vs[k], ws[k], {}});
            }
        }
    }
    p.open_count = 0;
}

/// Up to eight rays of the packet, side by side.
struct alignas(64) RayGroup {
    float o[3][kWidth], shear_x[kWidth], shear_y[kWidth], inv_d_z[kWidth];  ///< o: as in TriangleRay
    float start[kWidth], limit[kWidth], low[kWidth];
    uint32_t place[kWidth];  ///< of the triangle that is pending since this leaf
    uint32_t ray[kWidth];    ///< which one of the packet
    uint32_t used;           ///< a bit for each that counts
    uint32_t met;            ///< those that have hit something in this leaf

    void set(const Packet& p, const uint32_t* rays, uint32_t count) {
        for (uint32_t k = 0; k < kWidth; ++k) ray[k] = rays[k < count ? k : 0];
        for (int k = 0; k < 3; ++k) pick(p.o[p.axis[k]], ray).store(o[k]);
        pick(p.shear_x, ray).store(shear_x), pick(p.shear_y, ray).store(shear_y);
        pick(p.inv_d[p.axis[2]], ray).store(inv_d_z);
        pick(p.start, ray).store(start), pick(p.limit, ray).store(limit), pick(p.low, ray).store(low);
        used = (1u << count) - 1, met = 0;
    }
};

/// Tells the packet what the rays of a group have hit in a leaf.
template <Mode kMode>
inline void put_back(Packet& p, RayGroup& g) {
    for (; g.met; g.met &= g.met - 1) {
        const auto k = static_cast<uint32_t>(__builtin_ctz(g.met));
        const uint32_t i = g.ray[k];
        if (kMode == Mode::any) {
            p.best[i] = 0;  // which triangle it was does not matter
            p.limit[i] = p.low[i] = -kInfinity;
        } else {
            p.limit[i] = g.limit[k], p.low[i] = g.low[k];
            p.place[i] = g.place[k];
            p.pending |= 1u << i;
        }
    }
}

/// In the midst of a leaf.
template <Mode kMode>
[[gnu::noinline]] void decide_and_reload(Packet& p, const World& world, RayGroup& g) {
    put_back<kMode>(p, g);
    decide<kMode>(p, world);
    for (uint32_t k = 0; k < kWidth; ++k) {
        g.limit[k] = p.limit[g.ray[k]], g.low[k] = p.low[g.ray[k]];
        if (kMode == Mode::any && p.best[g.ray[k]] != kNoHit) g.used &= ~(1u << k);
    }
}

/// A bit for every lane that holds a triangle.
inline uint32_t triangles_of(const Block& block) {
    uint32_t lanes = 0;
    for (uint32_t lane = 0; lane < kBlock; ++lane) lanes |= uint32_t(block.prim(lane) != kNoHit) << lane;
    return lanes;
}

/// The vertices of a block with the axes of TriangleRay, relative to the origin where all rays have the same.
struct alignas(16) MovedBlock {
    float vertex[3][3][kBlock];
    uint32_t place;  ///< of the first triangle
    uint32_t lanes;  ///< a bit for each that holds a triangle

    template <bool kOneOrigin>
    void set(const Packet& p, const Block& block, uint32_t first) {
        for (int k = 0; k < 3; ++k) {
            Float4 at[3];
            block.corners(p.axis[k], at);
            for (int corner = 0; corner < 3; ++corner)
                (kOneOrigin ? at[corner] - Float4::all(p.o_range[p.axis[k]][0]) : at[corner]).store(vertex[corner][k]);
        }
        place = first, lanes = triangles_of(block);
    }
};

/// A triangle in the shear of eight rays.
struct ShearedTriangle {
    Float8 u, v, w;  ///< edge functions

    template <bool kOneOrigin>
    static ShearedTriangle of(const RayGroup& g, const MovedBlock& block, uint32_t lane) {
        const Float8 shear_x = Float8::load(g.shear_x), shear_y = Float8::load(g.shear_y);
        Float8 x[3], y[3];
        for (int i = 0; i < 3; ++i) {
            const Float8 z_i = z<kOneOrigin>(g, block, lane, i);
            x[i] = Float8::all(block.vertex[i][0][lane]), y[i] = Float8::all(block.vertex[i][1][lane]);
            if (!kOneOrigin) x[i] = x[i] - Float8::load(g.o[0]), y[i] = y[i] - Float8::load(g.o[1]);
            x[i] = x[i] - shear_x * z_i;
            y[i] = y[i] - shear_y * z_i;
        }
        return {x[2] * y[1] - y[2] * x[1], x[0] * y[2] - y[0] * x[2], x[1] * y[0] - y[1] * x[0]};
    }
    template <bool kOneOrigin>
    static Float8 z(const RayGroup& g, const MovedBlock& block, uint32_t lane, int corner) {
        const Float8 at = Float8::all(block.vertex[corner][2][lane]);
        return kOneOrigin ? at : at - Float8::load(g.o[2]);
    }
    Float8 low() const { return smaller(smaller(u, v), w); }
    Float8 high() const { return larger(larger(u, v), w); }
};

/// A triangle that some ray of the group comes close to.
template <Mode kMode, bool kOneOrigin>
inline void test_close(Packet& p, RayGroup& g, const MovedBlock& block, uint32_t place, const ShearedTriangle& s,
                       uint32_t close, const LeafErrors& errors) {
    const uint32_t lane = place % kBlock;
    const uint32_t inside =
        close & (at_most(Float8::all(errors.edge), s.low()) | at_most(s.high(), Float8::all(-errors.edge)));
    const Float8 per_area = Float8::all(1) / (s.u + s.v + s.w), inv_d_z = Float8::load(g.inv_d_z);
    const Float8 z0 = ShearedTriangle::z<kOneOrigin>(g, block, lane, 0);
    const Float8 z1 = ShearedTriangle::z<kOneOrigin>(g, block, lane, 1) - z0;
    const Float8 z2 = ShearedTriangle::z<kOneOrigin>(g, block, lane, 2) - z0;
    const Float8 t = (z0 + (s.v * per_area) * z1 + (s.w * per_area) * z2) * inv_d_z;
    const Float8 off =
        (Float8::all(errors.t_over_area) * magnitude(per_area) + Float8::all(errors.t_constant)) * magnitude(inv_d_z);
    const Float8 from = t - off, to = t + off;
    const Float8 start = Float8::load(g.start), limit = Float8::load(g.limit), low = Float8::load(g.low);
    const uint32_t live = inside & at_most(start, to) & at_most(from, limit);
    const uint32_t in_front = live & at_most(start, from);
    const uint32_t clear = in_front & (kMode == Mode::any ? at_most(to, limit) : ~at_most(low, to));
    g.met |= clear;
    if (kMode == Mode::any) {
        g.used &= ~clear;
    } else {
        select(clear, from, low).store(g.low);
        select(clear, to, limit).store(g.limit);
        set_where(clear, place, g.place);
    }
    for (uint32_t open = (close & ~inside) | (live & ~clear); open; open &= open - 1) {
        p.open_ray[p.open_count] = g.ray[__builtin_ctz(open)];
        p.open_place[p.open_count++] = place;
    }
}

/// A run of blocks against the given rays of the packet.
template <Mode kMode, bool kOneOrigin>
inline void test_blocks(Packet& p, const World& world, const MovedBlock* blocks, uint32_t block_count,
                        const uint32_t* rays, uint32_t ray_count, const LeafErrors& errors) {
    const Float8 error = Float8::all(errors.edge), minus_error = Float8::all(-errors.edge);
    for (uint32_t done = 0; done < ray_count; done += kWidth) {
        RayGroup g;
        g.set(p, rays + done, min_of(ray_count - done, kWidth));
        for (const MovedBlock* block = blocks; block < blocks + block_count; ++block) {
            if (p.open_count + kBlock * kWidth > kMaxOpen) decide_and_reload<kMode>(p, world, g);
            // All triangles before any of them is looked at more closely: that is nearly always one or two, and nobody
            // can guess which.
            ShearedTriangle sheared[kBlock];
            uint32_t close[kBlock], some = 0;
            for (uint32_t lane = 0; lane < kBlock; ++lane) {
                sheared[lane] = ShearedTriangle::of<kOneOrigin>(g, *block, lane);
                const uint32_t missed =
                    at_most(sheared[lane].low(), minus_error) & at_most(error, sheared[lane].high());
                close[lane] = ~missed;
                some |= uint32_t((g.used & ~missed) != 0) << lane;
            }
            for (some &= block->lanes; some; some &= some - 1) {
                const auto lane = static_cast<uint32_t>(__builtin_ctz(some));
                test_close<kMode, kOneOrigin>(p, g, *block, block->place + lane, sheared[lane], close[lane] & g.used,
                                              errors);
            }
        }
        put_back<kMode>(p, g);
    }
}

template <Mode kMode, bool kOneOrigin>
inline void test_leaf(Packet& p, const World& world, uint32_t ref, uint32_t rays, const LeafErrors& errors) {
    uint32_t places[kPacket], count = 0;
    for (; rays; rays &= rays - 1) places[count++] = static_cast<uint32_t>(__builtin_ctz(rays));
    Blocks blocks(world.upper, ref);
    while (blocks.more()) {
        MovedBlock moved[ChildRef::kMaxRun];
        uint32_t number = 0;
        for (; number < ChildRef::kMaxRun && blocks.more(); blocks.next())
            moved[number++].set<kOneOrigin>(p, blocks.block(), blocks.place(world.upper));
        test_blocks<kMode, kOneOrigin>(p, world, moved, number, places, count, errors);
    }
}

/// The triangles of a leaf, which is a child of the given node, against the given rays.
template <Mode kMode>
inline void visit_leaf(Packet& p, const World& world, uint32_t ref, uint32_t rays, const Node& node, uint32_t child) {
    const LeafErrors errors = leaf_errors(p, node, child);
    if (p.one_origin) {
        test_leaf<kMode, true>(p, world, ref, rays, errors);
    } else {
        test_leaf<kMode, false>(p, world, ref, rays, errors);
    }
}
