// Coherent rays: sixteen at a time down the hierarchy for as long as several of them go the same way. Included after
// kernel.inl.
//
// A node is first tested against intervals that contain all rays of the packet, and its children that survive against
// every ray. A leaf's triangles are tested against several rays at once. Rays that are nearly alone take what is left
// with them, onto stacks of their own, and go on as every other ray does (trace in kernel.inl); and so does everything
// that is not a triangle of the upper level. All of it computes the same operations as there.

inline constexpr uint32_t kPacket = 16;
/// What may be left to be decided exactly before it is.
inline constexpr uint32_t kMaxOpen = 64;

/// Rays whose directions have the same signs and the same largest axis. The arrays over rays are loaded as vectors.
struct alignas(64) Packet {
    // As in Ray, one after the other.
    float o[3][kPacket], start[kPacket], d[3][kPacket], limit[kPacket];
    float inv_d[3][kPacket];
    float shear_x[kPacket], shear_y[kPacket];  ///< rounded; what is exact computes them in double
    /// The nearest triangle so far, by its id on the upper level. Its t lies in [low, limit].
    float low[kPacket];
    uint32_t best[kPacket];
    float u[kPacket], v[kPacket];
    uint32_t place[kPacket];  ///< of a triangle that is pending: see block_of()
    // Pairs of rays and triangles about which float cannot decide.
    uint32_t open_count, open_ray[kMaxOpen], open_place[kMaxOpen];
    uint32_t pending;  ///< a bit for every ray whose nearest triangle has no exact t, u and v, nor an id, yet

    /// Of all rays: [axis][lower, upper].
    float o_range[3][2];
    float inv_d_range[3][2];  ///< [axis][smaller, larger in magnitude]
    float least_start;
    bool negative[3];
    bool one_origin;
    uint32_t octant_shift;
    uint64_t near_plane[3], far_plane[3];
    int axis[3];  ///< as in TriangleRay

    const Ray* ray[kPacket];  ///< canonical
    uint32_t index[kPacket];  ///< in its batch
    Flight* flights;          ///< one for each ray, set out when a ray needs it
    uint32_t started;         ///< a bit for each
};
static_assert(offsetof(Packet, limit) == 7 * sizeof(float[kPacket]));
static_assert(offsetof(Packet, low) % 64 == 0 && offsetof(Packet, place) % 64 == 0);

struct PacketEntry {
    alignas(64) float t_in[kPacket];
    uint32_t ref, rays;
    const Node* parent;
    uint32_t child;  ///< which one of the parent
};

/// Packets are proved for origins and lengths of directions within these; other rays go by themselves.
inline constexpr float kMaxPacketOrigin = 1e16f, kMinPacketDirection = 1e-20f, kMaxPacketDirection = 1e20f;

/// True when every ray is its own canonical form, and within the bounds above.
inline bool all_usual(const Packet& p) {
    const Float16 zero = Float16::all(0);
    uint32_t usual = (1u << kPacket) - 1;
    Float16 longest = zero;
    for (int axis = 0; axis < 3; ++axis) {
        const Float16 size = magnitude(Float16::load(p.d[axis]));
        usual &= at_most(magnitude(Float16::load(p.o[axis])), Float16::all(kMaxPacketOrigin));
        usual &= at_most(size, Float16::all(kMaxPacketDirection));
        usual &= at_most(size, zero) | at_most(Float16::all(kMinDirection), size);
        longest = larger(size, longest);
    }
    const Float16 start = Float16::load(p.start);
    usual &= at_most(Float16::all(kMinPacketDirection), longest);
    usual &= at_most(zero, start) & at_most(start, Float16::all(std::numeric_limits<float>::max()));
    usual &= at_most(start, Float16::load(p.limit));
    return usual == (1u << kPacket) - 1;
}

/// What TriangleRay does for one ray. False when the largest axis is not the same for all.
inline bool set_shear(Packet& p) {
    const int z = dominant_axis(p.ray[0]->d);
    p.axis[0] = (z + 1) % 3, p.axis[1] = (z + 2) % 3, p.axis[2] = z;
    const Float16 of_z = magnitude(Float16::load(p.d[z]));
    uint32_t other = 0;
    for (int axis = 0; axis < 3; ++axis) {  // of equal components the one that comes first counts
        if (axis == z) continue;
        const Float16 size = magnitude(Float16::load(p.d[axis]));
        other |= axis < z ? at_most(of_z, size) : ~at_most(size, of_z) & ((1u << kPacket) - 1);
    }
    if (other) return false;
    const Float16 d_z = Float16::load(p.d[z]);
    (Float16::load(p.d[p.axis[0]]) / d_z).store(p.shear_x);
    (Float16::load(p.d[p.axis[1]]) / d_z).store(p.shear_y);
    return true;
}

/// Of p.ray. False when these rays cannot go as a packet.
inline bool form(Packet& p) {
    static_assert(sizeof(Ray) == 8 * sizeof(float));
    const float* rows[kPacket];
    for (uint32_t i = 0; i < kPacket; ++i) rows[i] = &p.ray[i]->o.x;
    transpose(rows, p.o[0]);
    if (!all_usual(p) || !set_shear(p)) return false;
    Float16::load(p.limit).store(p.low);
    for (uint32_t& id : p.best) id = kNoHit;
    p.octant_shift = 0;
    p.one_origin = true;
    for (int axis = 0; axis < 3; ++axis) {
        const Float16 inv_d = Float16::all(1) / Float16::load(p.d[axis]);
        inv_d.store(p.inv_d[axis]);
        const uint32_t negative = at_most(inv_d, Float16::all(0));
        if (negative != 0 && negative != (1u << kPacket) - 1) return false;
        p.negative[axis] = negative != 0;
        p.near_plane[axis] = static_cast<uint32_t>(2 * axis + p.negative[axis]) * kPlaneBytes;
        p.far_plane[axis] = p.near_plane[axis] ^ kPlaneBytes;
        p.octant_shift += p.negative[axis] ? 3u << axis : 0u;
        // A product with the larger one may be NaN, and must then be the one that counts as nothing.
        p.inv_d_range[axis][0] = p.negative[axis] ? largest(inv_d) : least(inv_d);
        p.inv_d_range[axis][1] = p.negative[axis] ? least(inv_d) : largest(inv_d);
        const Float16 o = Float16::load(p.o[axis]);
        p.o_range[axis][0] = least(o), p.o_range[axis][1] = largest(o);
        p.one_origin = p.one_origin && p.o_range[axis][0] == p.o_range[axis][1];
    }
    p.least_start = least(Float16::load(p.start));
    p.started = p.pending = p.open_count = 0;
    return true;
}

/// The planes of a node's children, decoded, for looking at single children. Where all rays have one origin, relative
/// to it: that is the same difference for all of them.
struct alignas(64) ChildPlanes {
    float near[3][kWidth], far[3][kWidth];  ///< which rays of the packet meet first and last
};

/// A bit for every child that some ray of the packet may meet, at its place in the order from far to near. For every
/// ray t = (plane - o) * inv_d lies between the least and the largest of the four products of ends of intervals, and so
/// it does when all of them are rounded. What is tested here does not wait for `kept` to come back from memory.
inline uint32_t test_intervals(const Packet& p, const Node& node, ChildPlanes& kept) {
    Float8 in = Float8::all(p.least_start), out = Float8::all(kInfinity);
    for (int axis = 0; axis < 3; ++axis) {
        const Planes planes(node, axis);
        const Float8 near_plane = planes.at(p.near_plane[axis]), far_plane = planes.at(p.far_plane[axis]);
        // (near - o) * inv_d is least for the origin farthest along the ray; (far - o) * inv_d is largest for the
        // other.
        const Float8 near = near_plane - Float8::all(p.o_range[axis][p.negative[axis] ? 0 : 1]);
        const Float8 far = far_plane - Float8::all(p.o_range[axis][p.negative[axis] ? 1 : 0]);
        (p.one_origin ? near : near_plane).store(kept.near[axis]);
        (p.one_origin ? far : far_plane).store(kept.far[axis]);
        const Float8 inv_small = Float8::all(p.inv_d_range[axis][0]), inv_large = Float8::all(p.inv_d_range[axis][1]);
        in = larger(smaller(near * inv_small, near * inv_large), in);
        out = smaller(larger(far * inv_small, far * inv_large), out);
    }
    return ordered_at_most(in, out * Float8::all(kFarScale) + Float8::all(kFarPad), node, p.octant_shift);
}

/// The rays, of those given, that meet the child; their t_in.
inline uint32_t test_child(const Packet& p, const ChildPlanes& planes, uint32_t child, uint32_t rays, float* t_in) {
    Float16 in = Float16::load(p.start), out = Float16::all(kInfinity);
    for (int axis = 0; axis < 3; ++axis) {
        Float16 near = Float16::all(planes.near[axis][child]), far = Float16::all(planes.far[axis][child]);
        if (!p.one_origin) {
            const Float16 o = Float16::load(p.o[axis]);
            near = near - o, far = far - o;
        }
        const Float16 inv_d = Float16::load(p.inv_d[axis]);
        in = larger(near * inv_d, in);
        out = smaller(far * inv_d, out);
    }
    out = out * Float16::all(kFarScale) + Float16::all(kFarPad);
    in.store(t_in);
    return rays & at_most(in, out) & at_most(in, Float16::load(p.limit));
}

#include "accel/kernels/packet_leaf.inl"
#include "accel/kernels/packet_order.inl"

/// Packets know the one upper level only.
inline bool any_far(const Packet& p, const World& world) {
    if (world.far.nodes == nullptr) return false;
    for (const Ray* ray : p.ray)
        if (world.is_far(*ray)) return true;
    return false;
}

template <Mode kMode>
inline Flight& flight_of(Packet& p, const World& world, uint32_t i) {
    Flight& f = p.flights[i];
    if (p.started >> i & 1) return f;
    p.started |= 1u << i;
    f.world_ray = *p.ray[i];
    set_out<kMode>(f, world, p.index[i]);
    return f;
}

/// What ray i has hit as part of the packet. Member by member: a Hit that is put together in memory and then copied as
/// a whole makes the processor wait.
[[gnu::always_inline]] inline void get_hit(const Packet& p, const World& world, uint32_t i, Hit& hit) {
    uint32_t prim = p.best[i], instance = kNoHit;
    const bool found = prim != kNoHit;
    if (found) instance = world.identify(prim);
    hit.t = found ? p.limit[i] : kInfinity;
    hit.u = found ? p.u[i] : 0;
    hit.v = found ? p.v[i] : 0;
    hit.prim = prim;
    hit.instance = instance;
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
    decide<kMode>(p, world);
    Hit hit;
    get_hit(p, world, i, hit);
    go_on<kMode>(f, hit);
    walk<kMode>(f, world);
    f.depth = 0;
    f.push(kFinished);
    // From here on the flight keeps what was hit so far; go_on() compares.
    p.best[i] = kNoHit;
    p.limit[i] = p.low[i] = kMode == Mode::any && f.best.found() ? -kInfinity : f.best.t;
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
    constexpr int kAlone = 1;
    uint32_t depth = 0;
    uint32_t ref = ChildRef::node(0), rays = (1u << kPacket) - 1;
    const float* t_in = p.start;
    const PacketEntry* entry_of = nullptr;
    while (true) {
        const bool leaf = ChildRef::is_leaf(ref);
        if (__builtin_popcount(rays) <= kAlone || (leaf && ChildRef::kind(ref) != ItemKind::block)) {
            part<kMode>(p, world, ref, rays, t_in);
        } else if (leaf) {
            visit_leaf<kMode>(p, world, ref, rays, *entry_of->parent, entry_of->child);
        } else {
            const Node& node = node_at(world.upper, ref);
            ChildPlanes planes;
            for (uint32_t maybe = test_intervals(p, node, planes); maybe; maybe &= maybe - 1) {
                const uint32_t child = child_at(node, static_cast<uint32_t>(__builtin_ctz(maybe)), p.octant_shift);
                PacketEntry& entry = stack[depth];
                entry.ref = node.child[child];
                entry.parent = &node, entry.child = child;
                entry.rays = test_child(p, planes, child, rays, entry.t_in);
                // Whether it is met or not: nobody can guess that.
                prefetch(world.upper, entry.ref);
                depth += entry.rays != 0;
            }
        }
        do {
            if (depth == 0) return decide<kMode>(p, world);
            const PacketEntry& top = stack[--depth];
            ref = top.ref, t_in = top.t_in, entry_of = &top;
            rays = top.rays & at_most(Float16::load(top.t_in), Float16::load(p.limit));
        } while (rays == 0);
    }
}

/// finish(i, get): ray i of the batch is done, and get(hit) writes its hit. In any order.
template <Mode kMode, class Finish>
inline void trace_coherent(const World& world, const Ray* rays, size_t count, Finish finish) {
    Flight flights[kInFlight];
    // A node leaves at most seven siblings behind.
    PacketEntry stack[(kWidth - 1) * kMaxNodeLevels + kWidth];
    Packet packet;
    Queues<kInFlight> queues;
    const auto land = [&](const Flight& f) { finish(f.index, [&](Hit& hit) { answer<kMode>(f, hit); }); };
    ScanOrder order(rays, count);
    uint32_t used = 0;
    for (size_t done = 0; done < count; done += kPacket) {
        const auto together = static_cast<uint32_t>(min_of<size_t>(count - done, kPacket));
        for (uint32_t i = 0; i < together; ++i) {
            const size_t index = order.next();
            packet.index[i] = static_cast<uint32_t>(index);
            packet.ray[i] = rays + index;
        }
        if (used + kPacket > kInFlight) queues.template run<kMode>(world, land), used = 0;
        packet.flights = flights + used;
        const bool whole = together == kPacket && form(packet) && !any_far(packet, world);
        if (whole) trace_packet<kMode>(packet, world, stack);
        for (uint32_t i = 0; i < together; ++i) {
            Flight& f = flights[used + i];
            if (whole) {
                const bool started = packet.started >> i & 1;
                if (!started || (kMode == Mode::any && packet.best[i] != kNoHit)) {
                    finish(packet.index[i], [&](Hit& hit) { get_hit(packet, world, i, hit); });
                    continue;
                }
                Hit hit;
                get_hit(packet, world, i, hit);
                go_on<kMode>(f, hit);
            } else if (!launch<kMode>(f, world, *packet.ray[i], nullptr, packet.index[i])) {
                finish(packet.index[i], [](Hit& hit) { hit = {}; });
                continue;
            }
            queues.add(f);
        }
        used += kPacket;
    }
    queues.template run<kMode>(world, land);
}

void intersect_coherent(const World& world, const Ray* rays, Hit* hits, size_t count) noexcept {
    if (world.upper.nodes == nullptr) return intersect(world, rays, hits, count);
    trace_coherent<Mode::closest>(world, rays, count, [&](size_t i, auto get) { get(hits[i]); });
}
void occluded_coherent(const World& world, const Ray* rays, uint8_t* result, size_t count) noexcept {
    if (world.upper.nodes == nullptr) return occluded(world, rays, result, count);
    trace_coherent<Mode::any>(world, rays, count, [&](size_t i, auto get) {
        Hit hit;
        get(hit);
        result[i] = hit.found();
    });
}
