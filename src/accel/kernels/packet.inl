// Coherent rays: sixteen at a time down the hierarchy for as long as several of them go the same way. Included after
// kernel.inl.
//
// A node is first tested against intervals that contain all rays of the packet, and its children that survive against
// every ray. A ray that is nearly alone takes what is left with it, onto its own stack, and goes on as every other
// ray does (trace in kernel.inl). Boxes are tested by the same operations as there, and primitives by the same code, so
// the answers are the same.

inline constexpr uint32_t kPacket = 16;

/// Rays whose directions have the same signs.
struct alignas(64) Packet {
    float o[3][kPacket], inv_d[3][kPacket];
    float start[kPacket], limit[kPacket];
    /// Of all rays: [axis][lower, upper].
    float o_range[3][2], inv_d_range[3][2];
    float least_start;
    bool negative[3];
    uint32_t octant_shift;
    uint64_t near_plane[3], far_plane[3];
    const WideNode* nodes;

    Ray ray[kPacket];   ///< canonical
    uint32_t first;     ///< index of the first ray in its batch
    Flight* flights;    ///< one for each ray, launched when a ray needs it
    uint32_t launched;  ///< a bit for each
};

struct PacketEntry {
    alignas(64) float t_in[kPacket];
    uint32_t ref, rays;
};

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
        p.inv_d_range[axis][0] = least(inv_d), p.inv_d_range[axis][1] = largest(inv_d);
        const Float16 o = Float16::load(p.o[axis]);
        p.o_range[axis][0] = least(o), p.o_range[axis][1] = largest(o);
    }
    p.least_start = least(Float16::load(p.start));
    p.nodes = world.upper.nodes;
    p.launched = 0;
    return true;
}

/// A bit for every child that some ray of the packet may meet. For every ray t = (plane - o) * inv_d lies between the
/// least and the largest of the four products of ends of intervals, and so it does when all of them are rounded.
inline uint32_t test_intervals(const Packet& p, const WideNode& node) {
    const char* planes = reinterpret_cast<const char*>(&node);
    const auto plane = [&](uint64_t offset) { return Float8::load(reinterpret_cast<const float*>(planes + offset)); };
    Float8 in = Float8::all(p.least_start), out = Float8::all(kInfinity);
    for (int axis = 0; axis < 3; ++axis) {
        const Float8 inv_lo = Float8::all(p.inv_d_range[axis][0]), inv_hi = Float8::all(p.inv_d_range[axis][1]);
        // (near - o) * inv_d is least for the origin farthest along the ray; (far - o) * inv_d is largest for the
        // other.
        const Float8 near = plane(p.near_plane[axis]) - Float8::all(p.o_range[axis][p.negative[axis] ? 0 : 1]);
        const Float8 far = plane(p.far_plane[axis]) - Float8::all(p.o_range[axis][p.negative[axis] ? 1 : 0]);
        in = larger(smaller(near * inv_lo, near * inv_hi), in);
        out = smaller(larger(far * inv_lo, far * inv_hi), out);
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

template <Mode kMode>
inline Flight& flight_of(Packet& p, const World& world, uint32_t i) {
    Flight& f = p.flights[i];
    if (p.launched >> i & 1) return f;
    p.launched |= 1u << i;
    set_out<kMode>(f, world, p.ray[i], p.first + i);
    return f;
}

/// The triangles of a leaf against the given rays.
template <Mode kMode>
inline void visit_leaf(Packet& p, const World& world, uint32_t ref, uint32_t rays) {
    for (; rays; rays &= rays - 1) {
        const auto i = static_cast<uint32_t>(__builtin_ctz(rays));
        Flight& f = flight_of<kMode>(p, world, i);
        // Nothing is left to do for a ray that is done: no box begins before -infinity.
        p.limit[i] = visit_blocks<kMode>(f, world, ref) ? -kInfinity : f.limit;
    }
}

/// Every one of the given rays takes the subtree onto its own stack.
template <Mode kMode>
inline void part(Packet& p, const World& world, uint32_t ref, uint32_t rays, const float* t_in) {
    for (; rays; rays &= rays - 1) {
        const auto i = static_cast<uint32_t>(__builtin_ctz(rays));
        Flight& f = flight_of<kMode>(p, world, i);
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
        if (ChildRef::is_leaf(ref) && ChildRef::kind(ref) == ItemKind::block) {
            visit_leaf<kMode>(p, world, ref, rays);
        } else if (ChildRef::is_leaf(ref) || __builtin_popcount(rays) <= kAlone) {
            part<kMode>(p, world, ref, rays, t_in);
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

/// What a ray goes on with after its packet.
template <Mode kMode>
inline void go_on(Flight& f) {
    // What was left behind first is nearest.
    for (uint32_t a = 1, b = f.depth - 1; a < b; ++a, --b) {
        std::swap(f.ref[a], f.ref[b]);
        std::swap(f.t_in[a], f.t_in[b]);
    }
    f.next = kMode == Mode::any && f.best.found() ? kFinished : pop<kMode>(f);
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
            if (whole ? (packet.launched >> i & 1) == 0
                      : !launch<kMode>(f, world, rays[next + i], nullptr, static_cast<uint32_t>(next + i))) {
                sink(next + i, Hit{});
                continue;
            }
            if (whole) go_on<kMode>(f);
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
