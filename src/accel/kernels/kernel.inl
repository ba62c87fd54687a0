// The kernels: many rays at once through the two levels of hierarchies. Included once for each instruction set and
// layout, inside a namespace of its own and after its vectors (simd_*.inl) and how it reads nodes and blocks
// (layout_*.inl).
//
// What bounds traversal is waiting: for nodes to come from memory, and for the outcome of one test before the next one
// can start. So several rays are on their way at a time, each a small state machine (Flight); whenever one of them
// needs a node or a leaf, its memory is requested and the others go on.
//
// What is on the path of every ray is inlined by force: a call costs all vector registers. What is rare is kept out.

enum class Mode {
    closest,
    any,
    after,
    opaque,  ///< any hit that is not of a cut-out; Flight::after is one that is, if there was one
};
/// Whether one hit is as good as another.
constexpr bool is_any(Mode mode) { return mode == Mode::any || mode == Mode::opaque; }

/// What a ray takes with it from a packet (packet.inl) or a stream (stream.inl), at most, before it has to visit it.
inline constexpr uint32_t kMaxParted = 64;
/// That, siblings left behind on the way down, in both levels, and what marks the way back up.
inline constexpr uint32_t kStackSize = kMaxParted + 2 * (kWidth - 1) * kMaxNodeLevels + 2 * kWidth;
/// Not references of children: the end of an instance, the end of everything, and of the first of two upper levels.
inline constexpr uint32_t kLeaveInstance = 0xffffffffu, kFinished = 0xfffffffeu, kEnterFar = 0xfffffffdu;

/// A ray in the space of a level, what has been found and what is still sought: all that leaves need of it.
struct alignas(64) Query {
    SlabRay slab;
    float start, limit;  ///< boxes outside of it cannot hold what is sought
    float tmin;
    uint32_t instance;         ///< whose level this is; kNoHit on the upper level
    Interval world;            ///< of the instance along the world's ray; the whole line where it is not transformed
    TriangleRay triangle_ray;  ///< where the level has triangles
    Hit best, after;
};

/// A ray on its way.
struct Flight : Query {
    uint64_t near_plane[3], far_plane[3];  ///< where in a node the planes are that come first and last, in bytes
    uint32_t octant_shift;
    uint32_t next;   ///< the child to look at next
    uint32_t depth;  ///< of the stack
    LevelView level;
    const LevelView* upper;  ///< World::upper or far
    uint32_t index;          ///< of the ray in its batch
    Ray ray, world_ray;

    float t_in[kStackSize];
    uint32_t ref[kStackSize];

    void push(uint32_t what) {
        t_in[depth] = -kInfinity;
        ref[depth++] = what;
    }
};

/// Into a level, along a ray in its space.
inline void set_level(Flight& f, const LevelView& level, const Ray& ray) {
    f.level = level;
    f.ray = ray;
    // In place: a copy would have to wait for its parts.
    new (&f.slab) SlabRay(ray);
    f.octant_shift = 0;
    for (int axis = 0; axis < 3; ++axis) {
        f.near_plane[axis] = static_cast<uint32_t>(2 * axis + f.slab.negative[axis]) * kPlaneBytes;
        f.far_plane[axis] = f.near_plane[axis] ^ kPlaneBytes;
        f.octant_shift += f.slab.negative[axis] ? 3u << axis : 0u;
    }
    if (level.blocks != &kNoBlocks) new (&f.triangle_ray) TriangleRay(ray);
}

/// Inside a transformed instance t is clamped once more, and an end of the range that this can reach does not bound the
/// t before it.
template <Mode kMode>
inline void set_range(Flight& f) {
    const float start = kMode == Mode::after && f.after.t > f.tmin ? f.after.t : f.tmin;
    f.start = f.world.in < start ? start : -kInfinity;
    f.limit = f.best.t < f.world.out ? f.best.t : kInfinity;
}

/// A candidate whose t is settled and within the ray's range. False when another hit comes first.
template <Mode kMode>
inline bool accept(Query& f, const World& world, const Hit& hit) {
    if (!comes_before(hit, f.best)) return false;
    if (kMode == Mode::after && !comes_before(f.after, hit)) return false;
    if (kMode == Mode::opaque && world.is_cut_out(hit)) {
        f.after = hit;
        return false;
    }
    f.best = hit;
    f.limit = hit.t < f.world.out ? hit.t : kInfinity;
    return true;
}

/// True when the query is done.
template <Mode kMode>
inline bool offer(Query& f, const World& world, Hit hit, Interval own) {
    return settle(hit.t, own, f.world, hit.t) && hit.t >= f.tmin && accept<kMode>(f, world, hit) && is_any(kMode);
}

/// What lies on top of the stack and can still hold what is sought. At the bottom lies kFinished.
template <Mode kMode>
inline uint32_t pop(Flight& f) {
    do --f.depth;
    while (!is_any(kMode) && f.t_in[f.depth] > f.limit);
    return f.ref[f.depth];
}

/// Asks for the memory that a reference leads to. Without a branch, as nobody can guess whether that is a node or a
/// leaf; what is not a place in memory must still lead to one: addresses without memory behind them are slow. (GCC
/// removes calls of functions that do nothing but prefetch, so this one must be inlined before it notices.)
[[gnu::always_inline]] inline void prefetch(const LevelView& level, uint32_t ref) {
    const auto all_if = [](bool yes) { return uintptr_t(0) - uintptr_t(yes); };
    const uintptr_t leaf = all_if(ChildRef::is_leaf(ref)), blocks = all_if(ref < ChildRef::kFirstOther);
    const uintptr_t node = reinterpret_cast<uintptr_t>(level.nodes) + uintptr_t(ref) * sizeof(Node);
    const uintptr_t block = reinterpret_cast<uintptr_t>(level.blocks) + (first_block(ref) & blocks) * kBlockBytes;
    const uintptr_t place = (block & leaf) | (node & ~leaf);
    for (size_t line = 0; line < kPrefetchBytes; line += 64)
        __builtin_prefetch(reinterpret_cast<const char*>(place + line));
}

/// slab_interval() for the children of a node, from the start of the range on.
inline void test_children(const Flight& f, const Node& node, Float8& in, Float8& out) {
    in = Float8::all(f.start), out = Float8::all(kInfinity);
    for (int axis = 0; axis < 3; ++axis) {
        const Planes planes(node, axis);
        const Float8 o = Float8::all(f.slab.o[axis]), inv_d = Float8::all(f.slab.inv_d[axis]);
        in = larger((planes.at(f.near_plane[axis]) - o) * inv_d, in);
        out = smaller((planes.at(f.far_plane[axis]) - o) * inv_d, out);
    }
    out = out * Float8::all(kFarScale) + Float8::all(kFarPad);
}

/// Pushes the children that are met and goes on with what is then on top, for a ray among many: without a branch, in
/// the order that the node has stored.
template <Mode kMode>
inline void visit_node(Flight& f) {
    const Node& node = node_at(f.level, f.next);
    Float8 in, out;
    test_children(f, node, in, out);
    if (is_any(kMode)) {
        // Neither order nor distances matter, and the limit never falls.
        f.depth += push_met(at_most(in, out) & at_most(in, Float8::all(f.limit)), node, &f.ref[f.depth]);
    } else {
        f.depth += push_met(in, out, f.limit, node, f.octant_shift, &f.t_in[f.depth], &f.ref[f.depth]);
    }
    f.next = pop<kMode>(f);
}

/// The same for a ray by itself, which has nothing else to do while a wrong guess is repaired: in the exact order of
/// distance, and the nearest child does not go through the stack.
template <Mode kMode>
inline void visit_node_alone(Flight& f) {
    const Node& node = node_at(f.level, f.next);
    Float8 in, out;
    test_children(f, node, in, out);
    uint32_t met = at_most(in, out) & at_most(in, Float8::all(f.limit)) & existing(node);
    if (met == 0) {
        f.next = pop<kMode>(f);
        return;
    }
    auto nearest = static_cast<uint32_t>(__builtin_ctz(met));
    met &= met - 1;
    if (is_any(kMode)) {  // one hit is as good as another
        for (; met; met &= met - 1) {
            const uint32_t ref = node.child[__builtin_ctz(met)];
            prefetch(f.level, ref);
            f.ref[f.depth++] = ref;
        }
        f.next = node.child[nearest];
        return;
    }
    alignas(32) float t_in[kWidth];
    in.store(t_in);
    const uint32_t base = f.depth;
    for (; met; met &= met - 1) {
        auto child = static_cast<uint32_t>(__builtin_ctz(met));
        if (t_in[child] < t_in[nearest]) std::swap(child, nearest);
        uint32_t place = f.depth++;
        for (; place > base && f.t_in[place - 1] < t_in[child]; --place) {
            f.t_in[place] = f.t_in[place - 1];
            f.ref[place] = f.ref[place - 1];
        }
        f.t_in[place] = t_in[child];
        f.ref[place] = node.child[child];
        prefetch(f.level, node.child[child]);
    }
    f.next = node.child[nearest];
}

/// Whose triangle an entry of a block is.
inline void identify(const Query& f, const World& world, uint32_t id, Hit& hit) {
    hit.prim = id;
    hit.instance = f.instance != kNoHit ? f.instance : world.identify(hit.prim);
}

/// One triangle of a block, the long way.
template <Mode kMode>
[[gnu::noinline]] bool test_triangle(Query& f, const World& world, const Block& block, uint32_t lane) {
    const Vec3 p0 = block.corner(0, lane), p1 = block.corner(1, lane), p2 = block.corner(2, lane);
    TriangleCandidate c;
    const uint32_t id = block.prim(lane);
    if (id == kNoHit || !intersect_triangle(f.triangle_ray, p0, p1, p2, c)) return false;
    Hit hit{c.t, c.u, c.v};
    identify(f, world, id, hit);
    return offer<kMode>(f, world, hit, slab_interval(triangle_bounds(p0, p1, p2), f.slab));
}

/// settle() for four candidates. Leaves the bits of those that are hits within [tmin, limit].
inline uint32_t settle_block(const Query& f, const Block& block, Float4 t, uint32_t lanes, float settled[4]) {
    Float4 in = Float4::all(-kInfinity), out = Float4::all(kInfinity);
    for (int axis = 0; axis < 3; ++axis) {
        Float4 p[3];
        block.corners(axis, p);
        const Float4 lo = smaller(smaller(p[0], p[1]), p[2]), hi = larger(larger(p[0], p[1]), p[2]);
        const Float4 o = Float4::all(f.slab.o[axis]), inv_d = Float4::all(f.slab.inv_d[axis]);
        const bool negative = f.slab.negative[axis];
        in = larger(((negative ? hi : lo) - o) * inv_d, in);
        out = smaller(((negative ? lo : hi) - o) * inv_d, out);
    }
    out = out * Float4::all(kFarScale) + Float4::all(kFarPad);
    lanes &= at_most(in, out);
    const Float4 own = smaller(larger(t, in), out);
    const Float4 both = smaller(larger(own, Float4::all(f.world.in)), Float4::all(f.world.out));
    // + 0 turns -0 into 0, as in settle().
    const Float4 result = both + Float4::all(0);
    result.store(settled);
    return lanes & at_most(Float4::all(f.tmin), result) & at_most(result, Float4::all(f.best.t)) &
           at_most(result, Float4::all(std::numeric_limits<float>::max()));
}

/// The edge functions of four triangles, operation by operation as in intersect_triangle().
struct BlockEdges {
    Double4 u, v, w;
    Double4 z[3];
    uint32_t lanes;  ///< a bit for every triangle that is met somewhere
    bool undecided;  ///< the sign of a difference that came out as 0 is still open; only where lanes != 0

    [[gnu::always_inline]] BlockEdges(const TriangleRay& ray, const Block& block) {
        const Double4 o[3] = {Double4::all(ray.o[0]), Double4::all(ray.o[1]), Double4::all(ray.o[2])};
        const Double4 shear_x = Double4::all(ray.shear_x), shear_y = Double4::all(ray.shear_y);
        Double4 x[3], y[3];
        block.corners(ray.axis[0], x), block.corners(ray.axis[1], y), block.corners(ray.axis[2], z);
        for (int i = 0; i < 3; ++i) {
            z[i] = z[i] - o[2];
            x[i] = (x[i] - o[0]) - shear_x * z[i];
            y[i] = (y[i] - o[1]) - shear_y * z[i];
        }
        u = x[2] * y[1] - y[2] * x[1];
        v = x[0] * y[2] - y[0] * x[2];
        w = x[1] * y[0] - y[1] * x[0];
        const Double4 least = smaller(smaller(u, v), w), largest = larger(larger(u, v), w);
        const uint32_t not_below = not_negative(least), not_above = not_positive(largest);
        lanes = not_below | not_above;
        undecided = (not_below & not_positive(least)) | (not_above & not_negative(largest));
    }
    /// Of the candidates, before they are settled.
    [[gnu::always_inline]] Float4 t(double d_z) const {
        return to_floats((u * z[0] + v * z[1] + w * z[2]) / ((u + v + w) * Double4::all(d_z)));
    }
};

/// intersect_triangle() for four triangles.
template <Mode kMode>
[[gnu::always_inline]] inline bool test_block(Query& f, const World& world, const Block& block) {
    const BlockEdges edges(f.triangle_ray, block);
    uint32_t lanes = edges.lanes;
    if (lanes == 0) [[likely]]
        return false;
    if (edges.undecided) [[unlikely]] {
        for (; lanes; lanes &= lanes - 1)
            if (test_triangle<kMode>(f, world, block, static_cast<uint32_t>(__builtin_ctz(lanes)))) return true;
        return false;
    }
    alignas(16) float settled[4];
    lanes = settle_block(f, block, edges.t(f.triangle_ray.d_z), lanes, settled);
    if (lanes == 0) return false;
    alignas(32) double us[4], vs[4], ws[4];
    edges.u.store(us), edges.v.store(vs), edges.w.store(ws);
    for (; lanes; lanes &= lanes - 1) {
        const auto lane = static_cast<uint32_t>(__builtin_ctz(lanes));
        const uint32_t id = block.prim(lane);
        if (id == kNoHit) continue;
        Hit hit{settled[lane]};
        identify(f, world, id, hit);
        if (!accept<kMode>(f, world, hit)) continue;
        if (is_any(kMode)) return true;
        const EdgeFunctions found{us[lane], vs[lane], ws[lane], {}};
        found.weights(f.best.u, f.best.v);
    }
    return false;
}

/// `ray` is f's in full. True when the query is done.
template <Mode kMode>
[[gnu::noinline]] bool test_shape(Query& f, const Ray& ray, const World& world, const LeafEntry& entry) {
    const uint32_t instance = f.instance != kNoHit ? f.instance : entry.instance;
    const ShapesView& shapes = world.shapes[world.instances[instance].geometry];
    const uint32_t prim = entry.prim;
    if (shapes.spheres) {
        const SphereCandidates c = intersect_sphere(ray, shapes.spheres[prim]);
        for (int i = 0; i < c.count; ++i)
            if (offer<kMode>(f, world, {c.t[i], 0, 0, prim, instance}, slab_interval(entry.own, f.slab))) return true;
        return false;
    }
    PlanarCandidate c;
    const bool met = shapes.rectangles ? intersect_rectangle(ray, shapes.rectangles[prim], c)
                                       : intersect_disk(ray, shapes.disks[prim], c);
    return met && offer<kMode>(f, world, {c.t, c.a, c.b, prim, instance}, slab_interval(entry.own, f.slab));
}

/// A run of blocks. True when the query is done.
template <Mode kMode>
[[gnu::always_inline]] inline bool visit_blocks(Flight& f, const World& world, uint32_t ref) {
    for (Blocks blocks(f.level, ref); blocks.more(); blocks.next())
        if (test_block<kMode>(f, world, blocks.block())) return true;
    return false;
}

/// A run of shapes. True when the query is done.
template <Mode kMode>
inline bool visit_shapes(Flight& f, const World& world, uint32_t ref) {
    const LeafEntry* entry = f.level.entries + ChildRef::first(ref);
    for (const LeafEntry* end = entry + ChildRef::count(ref); entry < end; ++entry)
        if (test_shape<kMode>(f, f.ray, world, *entry)) return true;
    return false;
}

template <Mode kMode>
inline void to_upper_level(Flight& f) {
    f.instance = kNoHit;
    f.world = {};
    set_level(f, *f.upper, f.world_ray);
    set_range<kMode>(f);
}

/// Into the hierarchy of an instance, or a part of it. False when the ray cannot hit anything there, or will find it on
/// the other upper level.
template <Mode kMode>
bool enter(Flight& f, const World& world, const LeafEntry& entry) {
    if (entry.prim != kWholeInstance && world.is_far(f.world_ray)) return false;
    const PlacedGeometry& placed = world.instances[entry.instance];
    Interval range;
    Ray ray = f.world_ray;
    if (!placed.identity) {
        range = slab_interval(placed.world, f.slab);
        if (range.empty() || !placed.to_object(f.world_ray, ray)) return false;
    }
    f.world = range;
    f.instance = entry.instance;
    set_level(f, world.levels[placed.geometry], ray);
    set_range<kMode>(f);
    f.next = ChildRef::node(0);
    if (entry.prim != kWholeInstance) f.next = node_at(f.level, entry.prim / kWidth).child[entry.prim % kWidth];
    return true;
}

template <Mode kMode>
[[gnu::noinline]] void leave(Flight& f) {
    to_upper_level<kMode>(f);
    f.next = pop<kMode>(f);
}

template <Mode kMode>
[[gnu::noinline]] void enter_far(Flight& f, const World& world) {
    f.upper = &world.far;
    to_upper_level<kMode>(f);
    f.next = ChildRef::node(0);
}

/// The first of a run of instances; the rest is pushed, and so is the way back.
template <Mode kMode>
[[gnu::noinline]] void visit_instances(Flight& f, const World& world) {
    const uint32_t first = ChildRef::first(f.next), count = ChildRef::count(f.next);
    if (count > 1) f.push(ChildRef::leaf(ItemKind::instance, first + 1, count - 1));
    if (enter<kMode>(f, world, f.level.entries[first])) {
        f.push(kLeaveInstance);
    } else {
        f.next = pop<kMode>(f);
    }
}

/// Whatever is not a node. Leaves f.next behind.
template <Mode kMode>
[[gnu::always_inline]] inline void visit_other(Flight& f, const World& world) {
    bool done = false;
    if (ChildRef::kind(f.next) == ItemKind::block) [[likely]] {
        done = visit_blocks<kMode>(f, world, f.next);
    } else if (f.next == kLeaveInstance) {
        return leave<kMode>(f);
    } else if (ChildRef::kind(f.next) == ItemKind::instance) {
        return visit_instances<kMode>(f, world);
    } else if (f.next == kEnterFar) {
        return enter_far<kMode>(f, world);
    } else {
        done = visit_shapes<kMode>(f, world, f.next);
    }
    f.next = done ? kFinished : pop<kMode>(f);
}

/// f.world_ray must be there, and canonical.
template <Mode kMode>
inline void set_out(Flight& f, const World& world, uint32_t index) {
    f.index = index;
    f.tmin = f.world_ray.tmin;
    // Ids that every candidate comes before: one at tmax itself is still a hit.
    f.best = Hit{};
    f.best.t = f.world_ray.tmax;
    f.depth = 0;
    f.push(kFinished);
    if (world.is_far(f.world_ray)) [[unlikely]]
        f.push(kEnterFar);
    f.upper = &world.upper;
    to_upper_level<kMode>(f);
    f.next = ChildRef::node(0);
}

/// False when the ray hits nothing by definition.
template <Mode kMode>
inline bool launch(Flight& f, const World& world, const Ray& in, const Hit* after, uint32_t index) {
    if (world.upper.nodes == nullptr || !canonical(in, f.world_ray)) return false;
    if (kMode == Mode::after) {
        if (!after->found()) return false;
        f.after = *after;
    }
    if (kMode == Mode::opaque) f.after = {};
    set_out<kMode>(f, world, index);
    return true;
}

/// The answer of a ray at its end. Without a hit in Mode::opaque the instance of a cut-out is set, if there was one.
/// Member by member: a Hit that was written in parts and is read as a whole makes the processor wait.
template <Mode kMode>
inline void answer(const Flight& f, Hit& hit) {
    const bool found = f.best.found();
    hit.t = found ? f.best.t : kInfinity;
    hit.u = found ? f.best.u : 0;
    hit.v = found ? f.best.v : 0;
    hit.instance = found ? f.best.instance : kMode == Mode::opaque ? f.after.instance : kNoHit;
    hit.prim = f.best.prim;
}
inline uint8_t occlusion(const Hit& hit) {
    return hit.found() ? Accel::blocked : hit.instance != kNoHit ? Accel::cut_out : Accel::clear;
}

/// Rays on their way, in two queues, because whether a ray is at a node or at a leaf next is the one thing that a
/// processor cannot guess.
template <uint32_t kCapacity>
class Queues {
public:
    void add(Flight& f) {
        prefetch(f.level, f.next);
        const bool node = !ChildRef::is_leaf(f.next);
        at_node_[nodes_] = elsewhere_[others_] = &f;
        nodes_ += node, others_ += !node;
    }
    /// Until nothing is on its way; done(flight) may add another one.
    template <Mode kMode, class Done>
    void run(const World& world, Done done) {
        constexpr uint32_t kOthersAtOnce = kCapacity * 3 / 4;
        while (nodes_ + others_) {
            while (nodes_ && others_ < kOthersAtOnce) {
                const uint32_t waiting = nodes_;
                nodes_ = 0;
                for (uint32_t i = 0; i < waiting; ++i) {
                    Flight& f = *at_node_[i];
                    visit_node<kMode>(f);
                    add(f);
                }
            }
            const uint32_t waiting = others_;
            others_ = 0;
            for (uint32_t i = 0; i < waiting; ++i) {
                Flight& f = *elsewhere_[i];
                if (f.next != kFinished) {
                    visit_other<kMode>(f, world);
                    add(f);
                } else {
                    done(f);
                }
            }
        }
    }

private:
    uint32_t nodes_ = 0, others_ = 0;
    Flight* at_node_[kCapacity + 1];
    Flight* elsewhere_[kCapacity + 1];
};

inline constexpr uint32_t kInFlight = 32;

/// sink(index, hit) for every ray, in any order.
template <Mode kMode, class Rays, class Sink>
inline void trace(const World& world, Rays rays, const Hit* after, size_t count, Sink sink) {
    Flight flights[kInFlight];
    Queues<kInFlight> queues;
    size_t next = 0;
    const auto start = [&](Flight& f) {
        while (next < count) {
            const size_t i = next++;
            if (launch<kMode>(f, world, rays[i], after ? after + i : nullptr, static_cast<uint32_t>(i)))
                return queues.add(f);
            sink(i, Hit{});
        }
    };
    for (Flight& f : flights) start(f);
    queues.template run<kMode>(world, [&](Flight& f) {
        Hit hit;
        answer<kMode>(f, hit);
        sink(f.index, hit);
        start(f);
    });
}

/// One ray by itself, to its end. see(reference) is told of everything before it is visited.
template <Mode kMode, class See>
inline void walk(Flight& f, const World& world, See see) {
    while (f.next != kFinished) {
        see(f.next);
        if (ChildRef::is_leaf(f.next)) {
            visit_other<kMode>(f, world);
        } else {
            visit_node_alone<kMode>(f);
        }
    }
}
template <Mode kMode>
inline void walk(Flight& f, const World& world) {
    walk<kMode>(f, world, [](uint32_t) {});
}

template <Mode kMode>
inline void trace_one(const World& world, const Ray& ray, const Hit* after, Hit& hit) {
    Flight f;
    if (!launch<kMode>(f, world, ray, after, 0)) {
        hit = {};
        return;
    }
    walk<kMode>(f, world);
    answer<kMode>(f, hit);
}
