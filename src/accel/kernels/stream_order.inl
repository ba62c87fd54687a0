// Any hits of many rays: which of them go together as streams, and which in flight. Included after stream.inl.

/// Fewer rays are traced otherwise.
inline constexpr uint32_t kLeastStream = 96;
/// Rays that are put into order together.
inline constexpr uint32_t kMostOrdered = 4096;

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

/// Rays of a batch in an order.
struct OrderedRays {
    const Ray* rays;
    const uint16_t* place;
    const Ray& operator[](size_t i) const { return rays[place[i]]; }
};

/// trace() for rays that had better not be a stream. Not inlined, so that its flights lie where those of a stream do.
template <Mode kMode, class Rays, class Sink>
[[gnu::noinline]] void trace_in_flight(const World& world, Rays rays, size_t count, Sink sink) {
    trace<kMode>(world, rays, nullptr, count, sink);
}

/// An Accel::Occlusion for each of at most kMostOrdered rays.
template <Mode kMode>
[[gnu::noinline]] void trace_ordered(const World& world, const Ray* rays, uint8_t* result, uint32_t count) {
    constexpr uint32_t kFirstInFlight = 4 * kStream, kMoreInFlight = 4, kTooFewToTell = 8;
    const StreamOrder order(rays, count);
    Stream s;
    // How many rays go in flight when a stream turns out not to pay, before the next one is tried.
    uint32_t in_flight = kFirstInFlight;
    for (uint32_t next = 0; next < count;) {
        const uint8_t octant = order.octant[next];
        s.start(octant);
        for (; next < count && s.count < kStream && order.octant[next] == octant; ++next) {
            const uint32_t i = order.place[next];
            if (!s.add(world, rays[i], i)) result[i] = Accel::clear;
        }
        if (s.count == 0) continue;
        trace_stream<kMode>(s, world);
        for (uint32_t i = 0; i < s.count; ++i) {
            const bool met_cut_out = kMode == Mode::opaque && s.query[i].after.instance != kNoHit;
            result[s.index[i]] = !(s.live >> i & 1) ? Accel::blocked : met_cut_out ? Accel::cut_out : Accel::clear;
        }
        if (s.count < kTooFewToTell) continue;
        if (s.sharing.pays(s.count)) {
            in_flight = kFirstInFlight;
            continue;
        }
        const OrderedRays others{rays, order.place + next};
        const uint32_t some = min_of(in_flight, count - next);
        trace_in_flight<kMode>(world, others, some,
                               [&](size_t i, const Hit& hit) { result[others.place[i]] = occlusion(hit); });
        next += some, in_flight *= kMoreInFlight;
    }
}

/// The same for any number of rays. Instances are visited by each ray by itself: where there is nothing else, the order
/// would be for nothing.
template <Mode kMode>
inline void trace_any(const World& world, const Ray* rays, uint8_t* result, size_t count) {
    static_assert(is_any(kMode));
    if (count < kLeastStream || world.upper.nodes == nullptr || world.only_instances)
        return trace_in_flight<kMode>(world, rays, count,
                                      [&](size_t i, const Hit& hit) { result[i] = occlusion(hit); });
    for (size_t done = 0; done < count; done += kMostOrdered)
        trace_ordered<kMode>(world, rays + done, result + done,
                             static_cast<uint32_t>(min_of<size_t>(count - done, kMostOrdered)));
}
