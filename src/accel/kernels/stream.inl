// Any hit of many rays that go different ways: node by node instead of ray by ray. Included after kernel.inl.
//
// Up to kStream rays of one octant go down the hierarchy together, and each node is read (and in the compact layout
// decoded) once for all of them that come to it. Unlike in a packet (packet.inl) a ray is tested against all children
// of a node at once, so that nothing is lost where few of the rays get to a node. Since one hit is as good as another,
// there is no order to keep: the tests of a node do not wait for each other, and nodes and leaves can wait until they
// have come from memory. After Barringer & Akenine-Möller 2014, "Dynamic Ray Stream Traversal", with bits instead of
// lists.
//
// Only where all there is are triangles of the upper level: where there are shapes or instances as well, or parts of
// them, rays go by themselves (trace in kernel.inl), since what each of them has to do there cannot be shared.

inline constexpr uint32_t kStream = 64;
/// Fewer rays are traced otherwise.
inline constexpr uint32_t kLeastStream = 96;
/// Rays that are put into order together.
inline constexpr uint32_t kMostOrdered = 4096;
/// Nodes, and leaves, on their way from memory.
inline constexpr uint32_t kAhead = 8;
/// Leaves are visited when there are more.
inline constexpr uint32_t kLeavesAtOnce = 24;
/// Nodes wait for their memory as long as there are no more on the stack. Beyond that it is a stack like any other, to
/// which a subtree adds at most what is left behind on the way down.
inline constexpr uint32_t kSoftDepth = 64;
inline constexpr uint32_t kStreamStack = kSoftDepth + (kWidth - 1) * kMaxNodeLevels + 3 * kWidth;

/// What the slab test wants of a ray.
struct alignas(32) StreamRay {
    float o[3], start, inv_d[3], limit;
};

/// What some rays, a bit for each, have to visit.
struct StreamEntry {
    uint64_t rays;
    uint32_t ref;
};

/// For each child of a node the rays that meet it, bits of a first and of a second half, and its reference.
struct MetChildren {
    Words8 rays[2], ref;
};

/// Several entries. There must be room for kWidth more than are in use.
template <uint32_t kCapacity>
struct StreamEntries {
    uint32_t rays[2][kCapacity], ref[kCapacity];
    uint32_t count = 0;

    StreamEntry at(uint32_t i) const { return {rays[0][i] | uint64_t(rays[1][i]) << 32, ref[i]}; }
    /// Those whose bits are set.
    void push(uint32_t children, const MetChildren& met) {
        met.rays[0].pack(children, &rays[0][count]);
        met.rays[1].pack(children, &rays[1][count]);
        met.ref.pack(children, &ref[count]);
        count += static_cast<uint32_t>(__builtin_popcount(children));
    }
};

/// Rays whose directions have the same signs.
struct Stream {
    StreamRay slab[kStream];  ///< apart from the rest, so that all of them stay in the nearest cache
    Query query[kStream];
    uint32_t index[kStream];  ///< in their batch
    uint32_t count = 0;
    bool negative[3];
    uint64_t near_plane[3], far_plane[3];
    uint64_t live = 0;  ///< a bit for every ray that is not blocked yet

    static uint64_t bit(uint32_t i) { return uint64_t(1) << i; }

    void start(uint32_t octant) {
        for (int axis = 0; axis < 3; ++axis) {
            negative[axis] = octant >> axis & 1;
            near_plane[axis] = static_cast<uint32_t>(2 * axis + negative[axis]) * kPlaneBytes;
            far_plane[axis] = near_plane[axis] ^ kPlaneBytes;
        }
        count = 0, live = 0;
    }
    /// False when the ray hits nothing by definition.
    bool add(const Ray& in, uint32_t place) {
        static_assert(sizeof(Ray) == 8 * sizeof(float));
        alignas(32) Ray r = in;  // in its canonical form
        const Float8 size = magnitude(Float8::load(&r.o.x));
        // Nearly every ray is its own canonical form.
        const uint32_t usual = at_most(Float8::load(kLeastUsual), size) & at_most(size, Float8::load(kMostUsual));
        if (usual != 255 || !(0 <= in.tmin && in.tmin <= in.tmax)) [[unlikely]] {
            if (!canonical(in, r)) return false;
        }
        // The same parts but for the direction.
        static_assert(sizeof(StreamRay) == 8 * sizeof(float));
        const Float8 parts = Float8::load(&r.o.x);
        select(0x70, Float8::all(1) / parts, parts).store(slab[count].o);
        Query& q = query[count];
        for (int axis = 0; axis < 3; ++axis) {
            q.slab.o[axis] = slab[count].o[axis], q.slab.inv_d[axis] = slab[count].inv_d[axis];
            q.slab.negative[axis] = negative[axis];
        }
        q.start = q.tmin = r.tmin, q.limit = r.tmax;
        q.instance = kNoHit;
        q.world = {};
        q.best = {};
        q.best.t = r.tmax;
        q.after.instance = kNoHit;
        new (&q.triangle_ray) TriangleRay(r);
        index[count] = place;
        live |= bit(count++);
        return true;
    }

private:
    static constexpr float kMost = std::numeric_limits<float>::max();
    alignas(32) static constexpr float kLeastUsual[8] = {0, 0, 0, 0, kMinDirection, kMinDirection, kMinDirection, 0};
    alignas(32) static constexpr float kMostUsual[8] = {kMost, kMost, kMost, kMost, kMost, kMost, kMost, kInfinity};
};

/// The rays, of those given, that meet each child.
inline MetChildren test_stream(const Stream& s, const Node& node, uint64_t rays) {
    Float8 near[3], far[3];
    for (int axis = 0; axis < 3; ++axis) {
        const Planes planes(node, axis);
        near[axis] = planes.at(s.near_plane[axis]), far[axis] = planes.at(s.far_plane[axis]);
    }
    MetChildren met;
    for (uint32_t half = 0; half < 2; ++half) {
        Words8 of_child = Words8::none();
        const StreamRay* const first = s.slab + 32 * half;
        for (auto rest = static_cast<uint32_t>(rays >> (32 * half)); rest; rest &= rest - 1) {
            const auto k = static_cast<uint32_t>(__builtin_ctz(rest));
            const StreamRay& ray = first[k];
            // The limit grows with the planes: that is a little more to visit, and one operation less.
            Float8 in = Float8::all(ray.start), out = Float8::all(ray.limit);
            for (int axis = 0; axis < 3; ++axis) {
                const Float8 o = Float8::all(ray.o[axis]), inv_d = Float8::all(ray.inv_d[axis]);
                in = larger((near[axis] - o) * inv_d, in);
                out = smaller((far[axis] - o) * inv_d, out);
            }
            of_child.set_where_at_most(in, out * Float8::all(kFarScale) + Float8::all(kFarPad), k);
        }
        met.rays[half] = existing(node) == ~0u ? of_child : of_child.only(existing(node));
    }
    met.ref = Words8::load(node.child);
    return met;
}

inline void end_if_blocked(Stream& s, uint32_t i) {
    if (s.query[i].best.found()) s.live &= ~Stream::bit(i);
}

/// Leaves that wait for their memory.
using WaitingLeaves = StreamEntries<kLeavesAtOnce + 2 * kWidth>;

template <Mode kMode>
inline void visit_leaves(Stream& s, const World& world, WaitingLeaves& leaves) {
    for (uint32_t i = 0; i < min_of(leaves.count, kAhead); ++i) prefetch(world.upper, leaves.ref[i]);
    for (uint32_t i = 0; i < leaves.count; ++i) {
        if (i + kAhead < leaves.count) prefetch(world.upper, leaves.ref[i + kAhead]);
        const StreamEntry leaf = leaves.at(i);
        for (Blocks blocks(world.upper, leaf.ref); blocks.more(); blocks.next()) {
            const Block block = blocks.block();
            for (uint64_t rest = leaf.rays & s.live; rest; rest &= rest - 1) {
                const auto ray = static_cast<uint32_t>(__builtin_ctzll(rest));
                test_block<kMode>(s.query[ray], world, block);
                end_if_blocked(s, ray);
            }
        }
    }
    leaves.count = 0;
}

/// Nodes to be visited: a stack, of which the top waits for its memory.
class WaitingNodes {
public:
    explicit WaitingNodes(uint64_t rays) { ahead_[0] = {rays, ChildRef::node(0)}; }
    void push(uint32_t children, const MetChildren& met) { stack_.push(children, met); }
    /// The next one, for those of its rays that live. False when there is none.
    bool pop(const World& world, uint64_t live, StreamEntry& next) {
        if (stack_.count > kSoftDepth) [[unlikely]] {
            next = stack_.at(--stack_.count);
        } else {
            while (stack_.count && waiting_ < kAhead) {
                StreamEntry& last = ahead_[(first_ + waiting_) % kAhead];
                last = stack_.at(--stack_.count);
                last.rays &= live;
                prefetch(world.upper, last.ref);
                waiting_ += last.rays != 0;
            }
            if (waiting_ == 0) return false;
            next = ahead_[first_];
            first_ = (first_ + 1) % kAhead, --waiting_;
        }
        next.rays &= live;
        return true;
    }

private:
    StreamEntries<kStreamStack> stack_;
    StreamEntry ahead_[kAhead];
    uint32_t first_ = 0, waiting_ = 1;
};

/// All rays of the stream, to their ends.
template <Mode kMode>
inline void trace_stream(Stream& s, const World& world) {
    WaitingNodes nodes(s.live);
    WaitingLeaves leaves;
    for (StreamEntry at; nodes.pop(world, s.live, at);) {
        const MetChildren met = test_stream(s, node_at(world.upper, at.ref), at.rays);
        const uint32_t some = (met.rays[0] | met.rays[1]).some(), is_leaf = top_bits(met.ref);
        nodes.push(some & ~is_leaf, met);
        leaves.push(some & is_leaf, met);
        if (leaves.count > kLeavesAtOnce) visit_leaves<kMode>(s, world, leaves);
    }
    visit_leaves<kMode>(s, world, leaves);
}

/// The order in which the rays of a span come together as streams: by octant, and within one by where they start, as
/// places along a Morton curve.
class StreamOrder {
public:
    uint16_t place[kMostOrdered];
    uint8_t octant[kMostOrdered];  ///< of the ray at that place of the order

    StreamOrder(const Ray* rays, uint32_t count) {
        Box starts;
        for (uint32_t i = 0; i < count; ++i) starts.extend(rays[i].o);
        const float size = max_component(starts.hi - starts.lo);
        const float scale = size > 0 && size < kInfinity ? kCells / size : 0;
        uint16_t key[kMostOrdered];
        uint32_t of_low[256] = {}, of_high[256] = {};
        for (uint32_t i = 0; i < count; ++i) {
            uint32_t k = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const float at = (rays[i].o[axis] - starts.lo[axis]) * scale;
                k |= uint32_t(kSpread[at > 0 ? static_cast<uint32_t>(min_of(at, kCells - 1)) : 0]) << axis;
                k |= uint32_t(std::signbit(rays[i].d[axis])) << (kKeyBits + axis);
            }
            key[i] = static_cast<uint16_t>(k);
            ++of_low[k & 255], ++of_high[k >> 8];
        }
        for (uint32_t b = 0, low = 0, high = 0; b < 256; ++b) {
            low += std::exchange(of_low[b], low);
            high += std::exchange(of_high[b], high);
        }
        uint16_t by_low[kMostOrdered];
        for (uint32_t i = 0; i < count; ++i) by_low[of_low[key[i] & 255]++] = static_cast<uint16_t>(i);
        for (uint32_t i = 0; i < count; ++i) {
            const uint32_t k = key[by_low[i]], to = of_high[k >> 8]++;
            place[to] = by_low[i];
            octant[to] = static_cast<uint8_t>(k >> kKeyBits);
        }
    }

private:
    static constexpr float kCells = 16;
    static constexpr uint32_t kKeyBits = 12;
    /// Four bits, with two zeros between them.
    static constexpr uint16_t kSpread[16] = {0x000, 0x001, 0x008, 0x009, 0x040, 0x041, 0x048, 0x049,
                                             0x200, 0x201, 0x208, 0x209, 0x240, 0x241, 0x248, 0x249};
};

/// An Accel::Occlusion for each of at most kMostOrdered rays.
template <Mode kMode>
[[gnu::noinline]] void trace_ordered(const World& world, const Ray* rays, uint8_t* result, uint32_t count) {
    const StreamOrder order(rays, count);
    Stream s;
    for (uint32_t next = 0; next < count;) {
        const uint8_t octant = order.octant[next];
        s.start(octant);
        for (; next < count && s.count < kStream && order.octant[next] == octant; ++next) {
            const uint32_t i = order.place[next];
            if (!s.add(rays[i], i)) result[i] = Accel::clear;
        }
        if (s.count == 0) continue;
        trace_stream<kMode>(s, world);
        for (uint32_t i = 0; i < s.count; ++i) {
            const bool met_cut_out = kMode == Mode::opaque && s.query[i].after.instance != kNoHit;
            result[s.index[i]] = !(s.live >> i & 1) ? Accel::blocked : met_cut_out ? Accel::cut_out : Accel::clear;
        }
    }
}

/// The same for any number of rays.
template <Mode kMode>
inline void trace_any(const World& world, const Ray* rays, uint8_t* result, size_t count) {
    static_assert(is_any(kMode));
    if (count < kLeastStream || world.upper.nodes == nullptr || world.upper.entries != nullptr)
        return trace<kMode>(world, rays, nullptr, count, [&](size_t i, const Hit& hit) { result[i] = occlusion(hit); });
    for (size_t done = 0; done < count; done += kMostOrdered)
        trace_ordered<kMode>(world, rays + done, result + done,
                             static_cast<uint32_t>(min_of<size_t>(count - done, kMostOrdered)));
}
