// Any hit of many rays that go different ways: node by node instead of ray by ray. Included after kernel.inl.
//
// Up to kStream rays of one octant go down the hierarchy together, and each node is read (and in the compact layout
// decoded) once for all of them that come to it. Unlike in a packet (packet.inl) a ray is tested against all children
// of a node at once, so that nothing is lost where few of the rays get to a node. Since one hit is as good as another,
// there is no order to keep: the tests of a node do not wait for each other, and nodes and leaves can wait until they
// have come from memory. After Barringer & Akenine-Möller 2014, "Dynamic Ray Stream Traversal", with bits instead of
// lists.
//
// What rays do not share they visit by themselves (OwnVisits), in flight (kernel.inl): instances, and, where instances
// are opened, everything when they are not near (margin.h). Rays that share too little had better be in flight from the
// start, and the caller is told.

inline constexpr uint32_t kStream = 64;
/// With fewer rays at a node on average a stream is slower than rays in flight.
inline constexpr uint32_t kLeastShared = 3;
/// As how many nodes that only one ray comes to it counts when a ray visits a run of instances by itself.
inline constexpr uint32_t kOwnVisit = 8;
/// Nodes, and leaves, on their way from memory.
inline constexpr uint32_t kAhead = 8;
/// Leaves are visited when there are more.
inline constexpr uint32_t kLeavesAtOnce = 24;
/// Nodes wait for their memory as long as there are no more on the stack. Beyond that it is a stack like any other, to
/// which a subtree adds at most what is left behind on the way down.
inline constexpr uint32_t kSoftDepth = 64;
inline constexpr uint32_t kStreamStack = kSoftDepth + (kWidth - 1) * kMaxNodeLevels + 3 * kWidth;

/// What the slab test wants of a ray: where it starts and the start of its range, the reciprocals of its direction and
/// its limit.
struct alignas(32) StreamRay {
    float parts[8];
    float o(int axis) const { return parts[axis]; }
    float start() const { return parts[3]; }
    float inv_d(int axis) const { return parts[4 + axis]; }
    float limit() const { return parts[7]; }
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

/// How much rays have shared.
struct Sharing {
    uint64_t visits = 0, of_rays = 0;

    void add(uint64_t rays) { ++visits, of_rays += static_cast<uint32_t>(__builtin_popcountll(rays)); }
    /// What each ray has done by itself.
    void add_alone(uint64_t times) { visits += times, of_rays += times; }
    /// Of `count` rays.
    bool pays(uint32_t count) const {
        // Few rays cannot share much.
        return of_rays >= min_of(kLeastShared, count / 4) * visits;
    }
};

/// Rays whose directions have the same signs.
struct Stream {
    StreamRay slab[kStream];  ///< apart from the rest, so that all of them stay in the nearest cache
    Query query[kStream];
    Ray ray[kStream];         ///< canonical
    uint32_t index[kStream];  ///< in their batch
    uint32_t count = 0;
    bool negative[3];
    uint64_t near_plane[3], far_plane[3];
    uint64_t live = 0;  ///< a bit for every ray that is not blocked yet
    uint64_t far = 0;   ///< and for every one that has another upper level as well
    Sharing sharing;

    static uint64_t bit(uint32_t i) { return uint64_t(1) << i; }

    void start(uint32_t octant) {
        for (int axis = 0; axis < 3; ++axis) {
            negative[axis] = octant >> axis & 1;
            near_plane[axis] = static_cast<uint32_t>(2 * axis + negative[axis]) * kPlaneBytes;
            far_plane[axis] = near_plane[axis] ^ kPlaneBytes;
        }
        count = 0, live = far = 0;
        sharing = {};
    }
    /// False when the ray hits nothing by definition.
    bool add(const World& world, const Ray& in, uint32_t place) {
        Ray& r = ray[count];
        r = in;
        const Float8 size = magnitude(parts_of(r));
        // Nearly every ray is its own canonical form.
        const uint32_t usual = at_most(Float8::load(kLeastUsual), size) & at_most(size, Float8::load(kMostUsual));
        if (usual != 255 || !(0 <= in.tmin && in.tmin <= in.tmax)) [[unlikely]] {
            if (!canonical(in, r)) return false;
        }
        // The same parts but for the direction.
        const Float8 parts = parts_of(r);
        select(0x70, Float8::all(1) / parts, parts).store(slab[count].parts);
        Query& q = query[count];
        for (int axis = 0; axis < 3; ++axis) {
            q.slab.o[axis] = slab[count].o(axis), q.slab.inv_d[axis] = slab[count].inv_d(axis);
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
        if (world.is_far(r)) [[unlikely]]
            far |= bit(count);
        live |= bit(count++);
        return true;
    }

private:
    static Float8 parts_of(const Ray& ray) {
        static_assert(sizeof(Ray) == sizeof(StreamRay));
        alignas(32) float parts[8];
        std::memcpy(parts, &ray, sizeof parts);
        return Float8::load(parts);
    }

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
            Float8 in = Float8::all(ray.start()), out = Float8::all(ray.limit());
            for (int axis = 0; axis < 3; ++axis) {
                const Float8 o = Float8::all(ray.o(axis)), inv_d = Float8::all(ray.inv_d(axis));
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

/// A run of shapes.
template <Mode kMode>
inline void visit_shapes(Stream& s, const World& world, const StreamEntry& leaf) {
    const LeafEntry* entry = world.upper.entries + ChildRef::first(leaf.ref);
    for (const LeafEntry* end = entry + ChildRef::count(leaf.ref); entry < end; ++entry) {
        const uint64_t rays = leaf.rays & s.live;
        s.sharing.add_alone(static_cast<uint32_t>(__builtin_popcountll(rays)));
        for (uint64_t rest = rays; rest; rest &= rest - 1) {
            const auto ray = static_cast<uint32_t>(__builtin_ctzll(rest));
            test_shape<kMode>(s.query[ray], s.ray[ray], world, *entry);
            end_if_blocked(s, ray);
        }
    }
}

/// What rays of a stream visit by themselves.
class OwnVisits {
public:
    /// Of those of the rays that live.
    template <Mode kMode>
    void add(Stream& s, const World& world, uint64_t rays, uint32_t ref) {
        if (count_ > kMost - kStream) make<kMode>(s, world);
        rays &= s.live;
        s.sharing.add_alone(kOwnVisit * static_cast<uint32_t>(__builtin_popcountll(rays)));
        for (; rays; rays &= rays - 1) {
            ray_[count_] = static_cast<uint8_t>(__builtin_ctzll(rays));
            ref_[count_++] = ref;
        }
    }
    /// All that have been added.
    template <Mode kMode>
    [[gnu::noinline]] void make(Stream& s, const World& world) {
        uint32_t ref[kMost], end[kStream];
        order_by_ray(ref, end);
        count_ = 0;
        Flight flights[kInFlight];
        Queues<kInFlight> queues;
        uint32_t ray = 0, next = 0;
        const auto start = [&](Flight& f) {
            for (; ray < kStream; ++ray) {
                if (!(s.live >> ray & 1)) next = end[ray];
                if (next < end[ray]) break;
            }
            if (ray == kStream) return;
            f.world_ray = s.ray[ray];
            if (kMode == Mode::opaque) f.after = {};
            set_out<kMode>(f, world, ray);
            while (next < end[ray] && f.depth < kMaxParted) f.push(ref[next++]);
            f.next = pop<kMode>(f);
            queues.add(f);
        };
        for (Flight& f : flights) start(f);
        queues.template run<kMode>(world, [&](Flight& f) {
            if (f.best.found()) s.live &= ~Stream::bit(f.index);
            if (kMode == Mode::opaque && f.after.instance != kNoHit) s.query[f.index].after = f.after;
            start(f);
        });
    }
    bool none() const { return count_ == 0; }

private:
    static constexpr uint32_t kMost = 1024;

    /// Ray by ray; what ray i visits ends before end[i].
    void order_by_ray(uint32_t* ref, uint32_t* end) const {
        for (uint32_t i = 0; i < kStream; ++i) end[i] = 0;
        for (uint32_t i = 0; i < count_; ++i) ++end[ray_[i]];
        for (uint32_t i = 0, first = 0; i < kStream; ++i) first += std::exchange(end[i], first);
        for (uint32_t i = 0; i < count_; ++i) ref[end[ray_[i]]++] = ref_[i];
    }

    uint32_t ref_[kMost];
    uint8_t ray_[kMost];
    uint32_t count_ = 0;
};

/// Leaves that wait for their memory.
using WaitingLeaves = StreamEntries<kLeavesAtOnce + 2 * kWidth>;

template <Mode kMode>
inline void visit_leaves(Stream& s, const World& world, WaitingLeaves& leaves, OwnVisits& own) {
    for (uint32_t i = 0; i < min_of(leaves.count, kAhead); ++i) prefetch(world.upper, leaves.ref[i]);
    for (uint32_t i = 0; i < leaves.count; ++i) {
        if (i + kAhead < leaves.count) prefetch(world.upper, leaves.ref[i + kAhead]);
        const StreamEntry leaf = leaves.at(i);
        if (ChildRef::kind(leaf.ref) != ItemKind::block) [[unlikely]] {
            if (ChildRef::kind(leaf.ref) == ItemKind::instance) {
                own.add<kMode>(s, world, leaf.rays, leaf.ref);
            } else {
                visit_shapes<kMode>(s, world, leaf);
            }
            continue;
        }
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
    OwnVisits own;
    if (s.far) own.add<kMode>(s, world, s.far, ChildRef::node(0));
    WaitingNodes nodes(s.live & ~s.far);
    WaitingLeaves leaves;
    for (StreamEntry at; nodes.pop(world, s.live, at);) {
        s.sharing.add(at.rays);
        const MetChildren met = test_stream(s, node_at(world.upper, at.ref), at.rays);
        const uint32_t some = (met.rays[0] | met.rays[1]).some(), is_leaf = top_bits(met.ref);
        nodes.push(some & ~is_leaf, met);
        leaves.push(some & is_leaf, met);
        if (leaves.count > kLeavesAtOnce) visit_leaves<kMode>(s, world, leaves, own);
    }
    visit_leaves<kMode>(s, world, leaves, own);
    if (!own.none()) own.make<kMode>(s, world);
}
