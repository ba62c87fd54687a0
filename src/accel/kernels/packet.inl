// Coherent rays: sixteen at a time down the hierarchy for as long as several of them go the same way. Included after
// kernel.inl.
//
// A node is first tested against intervals that contain all rays of the packet, and its children that survive against
// every ray. A leaf's triangles are tested against several rays at once. Rays that are nearly alone take what is left
// with them, onto stacks of their own, and go on as every other ray does (trace in kernel.inl); and so does everything
// that is not a triangle of the upper level. All of it computes the same operations as there.

inline constexpr uint32_t kPacket = 16;

/// Rays whose directions have the same signs. The arrays over rays are loaded as vectors.
struct alignas(64) Packet {
    float o[3][kPacket], inv_d[3][kPacket];
    float start[kPacket], limit[kPacket];
    // TriangleRay for every ray, where all have the same axes.
    double triangle_o[3][kPacket], shear_x[kPacket], shear_y[kPacket], d_z[kPacket];
    /// The nearest triangle so far, by its id on the upper level; its t is the limit.
    uint32_t best[kPacket];
    float u[kPacket], v[kPacket];

    /// Of all rays: [axis][lower, upper].
    float o_range[3][2];
    float inv_d_range[3][2];  ///< [axis][smaller, larger in magnitude]
    float least_start;
    bool negative[3];
    uint32_t octant_shift;
    uint64_t near_plane[3], far_plane[3];
    bool same_axes;
    int axis[3];
    const WideNode* nodes;

    Ray ray[kPacket];  ///< canonical
    Flight* flights;   ///< one for each ray, set out when a ray needs it
    uint32_t first;    ///< index of the first ray in its batch
    uint32_t set_out;  ///< a bit for each
};
static_assert(offsetof(Packet, triangle_o) % 64 == 0 && offsetof(Packet, best) % 64 == 0);

struct PacketEntry {
    alignas(64) float t_in[kPacket];
    uint32_t ref, rays;
};

/// The constructor of TriangleRay for all rays at once.
inline void prepare_triangles(Packet& p) {
    const int z = dominant_axis(p.ray[0].d);
    p.axis[0] = (z + 1) % 3, p.axis[1] = (z + 2) % 3, p.axis[2] = z;
    p.same_axes = true;
    for (uint32_t i = 0; i < kPacket; ++i) {
        const Ray& ray = p.ray[i];
        p.same_axes = p.same_axes && dominant_axis(ray.d) == z;
        for (int k = 0; k < 3; ++k) p.triangle_o[k][i] = ray.o[p.axis[k]];
        p.shear_x[i] = ray.d[p.axis[0]], p.shear_y[i] = ray.d[p.axis[1]], p.d_z[i] = ray.d[z];
    }
    for (uint32_t i = 0; i < kPacket; i += kGroup) {
        const Doubles d_z = Doubles::load(p.d_z + i);
        (Doubles::load(p.shear_x + i) / d_z).store(p.shear_x + i);
        (Doubles::load(p.shear_y + i) / d_z).store(p.shear_y + i);
    }
}

/// False when a ray hits nothing by definition, or the directions have different signs.
inline bool gather(Packet& p, const World& world, const Ray* rays) {
    uint32_t signs[3] = {};
    for (uint32_t i = 0; i < kPacket; ++i) {
        Ray& ray = p.ray[i];
        if (!canonical(rays[i], ray)) return false;
        for (int axis = 0; axis < 3; ++axis) {
            p.o[axis][i] = ray.o[axis], p.inv_d[axis][i] = ray.d[axis];
            signs[axis] += std::signbit(ray.d[axis]);
        }
        p.start[i] = ray.tmin, p.limit[i] = ray.tmax;
        p.best[i] = kNoHit;
        p.u[i] = p.v[i] = 0;
    }
    p.octant_shift = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (signs[axis] != 0 && signs[axis] != kPacket) return false;
        p.negative[axis] = signs[axis] != 0;
        p.near_plane[axis] = static_cast<uint32_t>(2 * axis + p.negative[axis]) * sizeof(float[kWidth]);
        p.far_plane[axis] = p.near_plane[axis] ^ sizeof(float[kWidth]);
        p.octant_shift += p.negative[axis] ? 3u << axis : 0u;
        const Float16 inv_d = Float16::all(1) / Float16::load(p.inv_d[axis]);
        inv_d.store(p.inv_d[axis]);
        // A product with the larger one may be NaN, and must then be the one that counts as nothing.
        p.inv_d_range[axis][0] = p.negative[axis] ? largest(inv_d) : least(inv_d);
        p.inv_d_range[axis][1] = p.negative[axis] ? least(inv_d) : largest(inv_d);
        const Float16 o = Float16::load(p.o[axis]);
        p.o_range[axis][0] = least(o), p.o_range[axis][1] = largest(o);
    }
    p.least_start = least(Float16::load(p.start));
    p.nodes = world.upper.nodes;
    p.set_out = 0;
    prepare_triangles(p);
    return true;
}

/// A bit for every child that some ray of the packet may meet. For every ray t = (plane - o) * inv_d lies between the
/// least and the largest of the four products of ends of intervals, and so it does when all of them are rounded.
inline uint32_t test_intervals(const Packet& p, const WideNode& node) {
    const char* planes = reinterpret_cast<const char*>(&node);
    const auto plane = [&](uint64_t offset) { return Float8::load(reinterpret_cast<const float*>(planes + offset)); };
    Float8 in = Float8::all(p.least_start), out = Float8::all(kInfinity);
    for (int axis = 0; axis < 3; ++axis) {
        const Float8 inv_small = Float8::all(p.inv_d_range[axis][0]), inv_large = Float8::all(p.inv_d_range[axis][1]);
        // (near - o) * inv_d is least for the origin farthest along the ray; (far - o) * inv_d is largest for the
        // other.
        const Float8 near = plane(p.near_plane[axis]) - Float8::all(p.o_range[axis][p.negative[axis] ? 0 : 1]);
        const Float8 far = plane(p.far_plane[axis]) - Float8::all(p.o_range[axis][p.negative[axis] ? 1 : 0]);
        in = larger(smaller(near * inv_small, near * inv_large), in);
        out = smaller(larger(far * inv_small, far * inv_large), out);
    }
    return at_most(in, out * Float8::all(kFarScale) + Float8::all(kFarPad));
}

/// The rays, of those given, that meet the child; their t_in.
inline uint32_t test_child(const Packet& p, const WideNode& node, uint32_t child, uint32_t rays, float* t_in) {
    const char* planes = reinterpret_cast<const char*>(&node) + child * sizeof(float);
    Float16 in = Float16::load(p.start), out = Float16::all(kInfinity);
    for (int axis = 0; axis < 3; ++axis) {
        const Float16 o = Float16::load(p.o[axis]), inv_d = Float16::load(p.inv_d[axis]);
        const float near = *reinterpret_cast<const float*>(planes + p.near_plane[axis]);
        const float far = *reinterpret_cast<const float*>(planes + p.far_plane[axis]);
        in = larger((Float16::all(near) - o) * inv_d, in);
        out = smaller((Float16::all(far) - o) * inv_d, out);
    }
    out = out * Float16::all(kFarScale) + Float16::all(kFarPad);
    in.store(t_in);
    return rays & at_most(in, out) & at_most(in, Float16::load(p.limit));
}

/// A triangle that ray i meets at a settled t within its range.
template <Mode kMode>
inline void take(Packet& p, uint32_t i, float t, uint32_t id, const EdgeFunctions& edges) {
    // Ids of the upper level ascend with (instance, primitive).
    if (t == p.limit[i] && p.best[i] < id) return;
    p.best[i] = id;
    // Nothing is left to do for a ray that is done: no box begins before -infinity.
    p.limit[i] = kMode == Mode::any ? -kInfinity : t;
    if (kMode != Mode::any) edges.weights(p.u[i], p.v[i]);
}

/// One ray and one triangle, the long way.
template <Mode kMode>
[[gnu::noinline]] void test_pair(Packet& p, uint32_t i, Vec3 p0, Vec3 p1, Vec3 p2, uint32_t id) {
    const TriangleRay ray(p.ray[i]);
    const EdgeFunctions edges = edge_functions(ray, p0, p1, p2);
    float t = 0;
    if (!edges.inside() ||
        !settle(edges.candidate(ray.d_z).t, slab_interval(triangle_bounds(p0, p1, p2), SlabRay(p.ray[i])), {}, t))
        return;
    if (p.start[i] <= t && t <= p.limit[i]) take<kMode>(p, i, t, id, edges);
}

/// One triangle against kGroup rays from `first` on, of which those with a bit in `rays` count: test_block with the
/// parts of rays and triangles exchanged.
template <Mode kMode>
inline void test_group(Packet& p, const Vec3 corner[3], const Box& own, uint32_t id, uint32_t first, uint32_t rays) {
    const Doubles o[3] = {Doubles::load(p.triangle_o[0] + first), Doubles::load(p.triangle_o[1] + first),
                          Doubles::load(p.triangle_o[2] + first)};
    const Doubles shear_x = Doubles::load(p.shear_x + first), shear_y = Doubles::load(p.shear_y + first);
    Doubles x[3], y[3], z[3];
    for (int i = 0; i < 3; ++i) {
        z[i] = Doubles::all(corner[i][p.axis[2]]) - o[2];
        x[i] = (Doubles::all(corner[i][p.axis[0]]) - o[0]) - shear_x * z[i];
        y[i] = (Doubles::all(corner[i][p.axis[1]]) - o[1]) - shear_y * z[i];
    }
    const Doubles u = x[2] * y[1] - y[2] * x[1];
    const Doubles v = x[0] * y[2] - y[0] * x[2];
    const Doubles w = x[1] * y[0] - y[1] * x[0];
    const Doubles low = smaller(smaller(u, v), w), high = larger(larger(u, v), w);
    const uint32_t not_below = not_negative(low), not_above = not_positive(high);
    rays &= not_below | not_above;
    if (rays == 0) return;
    // The sign of a difference that came out as 0 is still open.
    const uint32_t open = rays & ((not_below & not_positive(low)) | (not_above & not_negative(high)));
    for (uint32_t rest = open; rest; rest &= rest - 1) {
        const uint32_t i = first + static_cast<uint32_t>(__builtin_ctz(rest));
        test_pair<kMode>(p, i, corner[0], corner[1], corner[2], id);
    }
    rays &= ~open;
    const Doubles sum = u + v + w;
    const Floats t = to_floats((u * z[0] + v * z[1] + w * z[2]) / (sum * Doubles::load(p.d_z + first)));
    Floats in = Floats::all(-kInfinity), out = Floats::all(kInfinity);
    for (int axis = 0; axis < 3; ++axis) {
        const Floats origin = Floats::load(p.o[axis] + first), inv_d = Floats::load(p.inv_d[axis] + first);
        in = larger((Floats::all(p.negative[axis] ? own.hi[axis] : own.lo[axis]) - origin) * inv_d, in);
        out = smaller((Floats::all(p.negative[axis] ? own.lo[axis] : own.hi[axis]) - origin) * inv_d, out);
    }
    out = out * Floats::all(kFarScale) + Floats::all(kFarPad);
    const Floats settled = smaller(larger(t, in), out) + Floats::all(0);
    rays &= at_most(in, out) & at_most(Floats::load(p.start + first), settled) &
            at_most(settled, Floats::load(p.limit + first)) &
            at_most(settled, Floats::all(std::numeric_limits<float>::max()));
    if (rays == 0) return;
    alignas(64) float ts[kGroup];
    alignas(64) double us[kGroup], vs[kGroup], ws[kGroup];
    settled.store(ts);
    u.store(us), v.store(vs), w.store(ws);
    for (; rays; rays &= rays - 1) {
        const auto k = static_cast<uint32_t>(__builtin_ctz(rays));
        take<kMode>(p, first + k, ts[k], id, {us[k], vs[k], ws[k], {}});
    }
}

/// The triangles of a leaf against the given rays.
template <Mode kMode>
inline void visit_leaf(Packet& p, const World& world, uint32_t ref, uint32_t rays) {
    const TriangleBlock* block = world.upper.blocks + ChildRef::first(ref);
    for (const TriangleBlock* end = block + ChildRef::count(ref); block < end; ++block)
        for (uint32_t lane = 0; lane < kBlock && block->prim[lane] != kNoHit; ++lane) {
            const Vec3 corner[3] = {block->corner(0, lane), block->corner(1, lane), block->corner(2, lane)};
            const Box own = triangle_bounds(corner[0], corner[1], corner[2]);
            for (uint32_t first = 0; first < kPacket; first += kGroup) {
                const uint32_t group = rays >> first & ((1u << kGroup) - 1);
                if (group) test_group<kMode>(p, corner, own, block->prim[lane], first, group);
            }
        }
}

template <Mode kMode>
inline Flight& flight_of(Packet& p, const World& world, uint32_t i) {
    Flight& f = p.flights[i];
    if (p.set_out >> i & 1) return f;
    p.set_out |= 1u << i;
    set_out<kMode>(f, world, p.ray[i], p.first + i);
    return f;
}

/// What ray i has hit as part of the packet.
inline Hit hit_of(const Packet& p, const World& world, uint32_t i) {
    if (p.best[i] == kNoHit) return {};
    Hit hit{p.limit[i], p.u[i], p.v[i], p.best[i]};
    hit.instance = world.identify(hit.prim);
    return hit;
}

/// What a ray goes on with after its packet.
template <Mode kMode>
inline void go_on(Flight& f, const Hit& hit) {
    if (hit.found() && comes_before(hit, f.best)) f.best = hit, f.limit = hit.t;
    // What was left behind first is nearest.
    for (uint32_t a = 1, b = f.depth - 1; a < b; ++a, --b) {
        std::swap(f.ref[a], f.ref[b]);
        std::swap(f.t_in[a], f.t_in[b]);
    }
    f.next = kMode == Mode::any && f.best.found() ? kFinished : pop<kMode>(f);
}

/// Visits all that a ray has taken from its packet so far, when that is as much as its stack has room for.
template <Mode kMode>
[[gnu::noinline]] void drain(Packet& p, const World& world, Flight& f, uint32_t i) {
    go_on<kMode>(f, hit_of(p, world, i));
    walk<kMode>(f, world);
    f.depth = 0;
    f.push(kFinished);
    // From here on the flight keeps what was hit so far; go_on() compares.
    p.best[i] = kNoHit;
    p.limit[i] = kMode == Mode::any && f.best.found() ? -kInfinity : f.best.t;
}

/// Every one of the given rays takes the subtree onto its own stack.
template <Mode kMode>
inline void part(Packet& p, const World& world, uint32_t ref, uint32_t rays, const float* t_in) {
    for (; rays; rays &= rays - 1) {
        const auto i = static_cast<uint32_t>(__builtin_ctz(rays));
        Flight& f = flight_of<kMode>(p, world, i);
        if (f.depth == kMaxParted) drain<kMode>(p, world, f, i);
        f.t_in[f.depth] = t_in[i];
        f.ref[f.depth++] = ref;
    }
}

/// All rays of the packet, until each of them is nearly alone; what is left lies on their stacks.
template <Mode kMode>
inline void trace_packet(Packet& p, const World& world, PacketEntry* stack) {
    constexpr int kAlone = 2;
    uint32_t depth = 0;
    uint32_t ref = ChildRef::node(0), rays = (1u << kPacket) - 1;
    const float* t_in = p.start;
    while (true) {
        const bool leaf = ChildRef::is_leaf(ref);
        const bool triangles = leaf && ChildRef::kind(ref) == ItemKind::block && p.same_axes;
        if (__builtin_popcount(rays) <= kAlone || (leaf && !triangles)) {
            part<kMode>(p, world, ref, rays, t_in);
        } else if (leaf) {
            visit_leaf<kMode>(p, world, ref, rays);
        } else {
            const WideNode& node = p.nodes[ref];
            const uint32_t maybe = test_intervals(p, node);
            for (const uint32_t order : node.order) {
                const uint32_t child = order >> p.octant_shift & 7;
                if (!(maybe >> child & 1)) continue;
                PacketEntry& entry = stack[depth];
                entry.ref = node.child[child];
                entry.rays = test_child(p, node, child, rays, entry.t_in);
                depth += entry.rays != 0;
            }
        }
        do {
            if (depth == 0) return;
            const PacketEntry& top = stack[--depth];
            ref = top.ref, t_in = top.t_in;
            rays = top.rays & at_most(Float16::load(top.t_in), Float16::load(p.limit));
        } while (rays == 0);
    }
}

/// sink(index, hit) for every ray, in any order.
template <Mode kMode, class Sink>
inline void trace_coherent(const World& world, const Ray* rays, size_t count, Sink sink) {
    if (world.upper.nodes == nullptr) return trace<kMode>(world, rays, nullptr, count, sink);
    Flight flights[kInFlight];
    // A node leaves at most seven siblings behind.
    PacketEntry stack[(kWidth - 1) * kMaxNodeLevels + kWidth];
    Packet packet;
    Queues<kInFlight> queues;
    const auto finish = [&](const Flight& f) { sink(f.index, f.best.found() ? f.best : Hit{}); };
    size_t used = 0;
    for (size_t next = 0; next < count; next += kPacket) {
        if (used + kPacket > kInFlight) queues.template run<kMode>(world, finish), used = 0;
        packet.flights = flights + used;
        packet.first = static_cast<uint32_t>(next);
        const bool whole = next + kPacket <= count && gather(packet, world, rays + next);
        if (whole) trace_packet<kMode>(packet, world, stack);
        for (uint32_t i = 0; i < kPacket && next + i < count; ++i) {
            Flight& f = flights[used + i];
            if (whole) {
                const Hit hit = hit_of(packet, world, i);
                if ((packet.set_out >> i & 1) == 0 || (kMode == Mode::any && hit.found())) {
                    sink(next + i, hit);
                    continue;
                }
                go_on<kMode>(f, hit);
            } else if (!launch<kMode>(f, world, rays[next + i], nullptr, static_cast<uint32_t>(next + i))) {
                sink(next + i, Hit{});
                continue;
            }
            queues.add(f);
        }
        used += kPacket;
    }
    queues.template run<kMode>(world, finish);
}

void intersect_coherent(const World& world, const Ray* rays, Hit* hits, size_t count) noexcept {
    trace_coherent<Mode::closest>(world, rays, count, [&](size_t i, const Hit& hit) { hits[i] = hit; });
}
void occluded_coherent(const World& world, const Ray* rays, uint8_t* result, size_t count) noexcept {
    trace_coherent<Mode::any>(world, rays, count, [&](size_t i, const Hit& hit) { result[i] = hit.found(); });
}
