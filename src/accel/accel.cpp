#include "accel/accel.h"

#include <chrono>
#include <new>
#include <string>

#include "accel/geometry.h"
#include "accel/instance.h"
#include "accel/traverse.h"
#include "base/parallel.h"

namespace steradian {

struct Accel::Data {
    World world;
    AccelStatistics statistics;
};

namespace {

Error cancelled_error() { return {ErrorCode::render_failed, "the build of the hierarchy was cancelled", {}, {}, {}}; }

Status check(std::span<const Geometry> geometries, std::span<const GeometryInstance> instances,
             const AccelOptions& options) {
    if (options.max_depth < 1 || options.max_depth > kMaxBvhDepth)
        return Error{ErrorCode::usage,
                     "the depth of the hierarchy is limited to " + std::to_string(options.max_depth) +
                         ", expected 1 to " + std::to_string(kMaxBvhDepth),
                     {},
                     {},
                     {}};
    if (instances.size() >= 0x7fffffff)
        return Error{ErrorCode::resources, std::to_string(instances.size()) + " instances are too many", {}, {}, {}};
    for (size_t i = 0; i < instances.size(); ++i)
        if (instances[i].geometry >= geometries.size())
            return Error{ErrorCode::bad_input,
                         "instance " + std::to_string(i) + " is of geometry " + std::to_string(instances[i].geometry) +
                             ", but there are " + std::to_string(geometries.size()),
                         {},
                         {},
                         {}};
    return Ok{};
}

Status build_geometries(std::span<const Geometry> geometries, const AccelOptions& options, Cancellation& cancelled,
                        World& world) {
    world.geometries.reserve(geometries.size());
    for (size_t i = 0; i < geometries.size(); ++i) {
        Result<std::vector<Box>> boxes = primitive_bounds(geometries[i], i);
        if (!boxes) return boxes.error();
        if (cancelled.poll()) return cancelled_error();
        world.geometries.push_back(build_geometry(geometries[i], *boxes, options, cancelled));
        if (cancelled.poll()) return cancelled_error();
    }
    return Ok{};
}

Status place_instances(std::span<const GeometryInstance> instances, World& world) {
    world.instances.reserve(instances.size());
    for (size_t i = 0; i < instances.size(); ++i) {
        const auto& [geometry, transform] = instances[i];
        const Box& bounds = world.geometries[geometry].bvh.bounds;
        const std::optional<PlacedGeometry> placed = place(geometry, transform, bounds);
        if (!placed)
            return Error{ErrorCode::bad_input,
                         "instance " + std::to_string(i) +
                             ": the transform is singular, not finite or scales beyond 1e30 or 1e-30",
                         {},
                         {},
                         {}};
        // A transformed box may be larger than what is in it, by sqrt(3) at most for rotations.
        const float extent = max_of(max_component(abs(placed->world.lo)), max_component(abs(placed->world.hi)));
        if (!bounds.empty() && !(extent <= 2 * kMaxCoordinate))
            return Error{ErrorCode::bad_input,
                         "instance " + std::to_string(i) + ": the transform puts it beyond coordinates of 1e15",
                         {},
                         {},
                         {}};
        world.instances.push_back(*placed);
    }
    return Ok{};
}

/// The upper level, over the instances that have something in them.
void build_top(const AccelOptions& options, Cancellation& cancelled, World& world) {
    std::vector<Box> boxes;
    std::vector<uint32_t> ids;
    for (size_t i = 0; i < world.instances.size(); ++i) {
        if (world.instances[i].world.empty()) continue;
        boxes.push_back(world.instances[i].world);
        ids.push_back(static_cast<uint32_t>(i));
    }
    BvhOptions how;
    how.builder = options.builder;
    how.max_depth = options.max_depth;
    how.item_cost = 8;  // an instance is a transform and a hierarchy of its own: leaves with one are best
    world.bvh = build_bvh(boxes, how, cancelled);
    for (uint32_t& i : world.bvh.order) i = ids[i];
}

template <class T>
uint64_t bytes_of(const std::vector<T>& v) {
    return v.capacity() * sizeof(T);
}
uint64_t bytes_of(const Bvh& bvh) { return bytes_of(bvh.nodes) + bytes_of(bvh.order); }

AccelStatistics count(const World& world) {
    AccelStatistics s;
    const auto add = [&](const Bvh& bvh) {
        s.nodes += bvh.nodes.size();
        s.leaves += bvh.leaves;
        s.bytes += bytes_of(bvh);
    };
    for (const BuiltGeometry& g : world.geometries) {
        s.primitives += g.count;
        s.depth = max_of(s.depth, g.bvh.depth);
        add(g.bvh);
        if (const auto* blocks = std::get_if<std::vector<TriangleBlock>>(&g.primitives)) s.bytes += bytes_of(*blocks);
    }
    add(world.bvh);
    s.bytes += bytes_of(world.geometries) + bytes_of(world.instances);
    return s;
}

template <bool kAny, bool kAfter>
Hit query(const World& world, const Ray& in, const Hit& after) {
    Ray ray;
    if (!canonical(in, ray)) return {};
    Query<kAny, kAfter> q(ray.tmin, ray.tmax, after);
    walk_world(world, ray, q);
    return q.result();
}

}  // namespace

Accel::Accel(std::unique_ptr<const Data> data) : data_(std::move(data)) {}
Accel::Accel(Accel&&) noexcept = default;
Accel& Accel::operator=(Accel&&) noexcept = default;
Accel::~Accel() = default;

Result<Accel> Accel::build(std::span<const Geometry> geometries, std::span<const GeometryInstance> instances,
                           const AccelOptions& options) {
    const FloatMode mode;
    const auto started = std::chrono::steady_clock::now();
    try {
        if (Status status = check(geometries, instances, options); !status) return status.error();
        Cancellation cancelled(options.cancelled);
        auto data = std::make_unique<Data>();
        if (Status status = build_geometries(geometries, options, cancelled, data->world); !status)
            return status.error();
        if (Status status = place_instances(instances, data->world); !status) return status.error();
        build_top(options, cancelled, data->world);
        if (cancelled.poll()) return cancelled_error();
        data->statistics = count(data->world);
        data->statistics.bytes += sizeof(Data);
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - started;
        data->statistics.build_seconds = took.count();
        return Accel(std::move(data));
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::resources, "not enough memory for the hierarchy", {}, {}, {}};
    }
}

void Accel::intersect(std::span<const Ray> rays, std::span<Hit> hits) const noexcept {
    const FloatMode mode;
    for (size_t i = 0; i < rays.size(); ++i) hits[i] = query<false, false>(data_->world, rays[i], {});
}

void Accel::occluded(std::span<const Ray> rays, std::span<uint8_t> result) const noexcept {
    const FloatMode mode;
    for (size_t i = 0; i < rays.size(); ++i) result[i] = query<true, false>(data_->world, rays[i], {}).found() ? 1 : 0;
}

void Accel::next_hit(std::span<const Ray> rays, std::span<const Hit> after, std::span<Hit> hits) const noexcept {
    const FloatMode mode;
    for (size_t i = 0; i < rays.size(); ++i)
        hits[i] = after[i].found() ? query<false, true>(data_->world, rays[i], after[i]) : Hit{};
}

Hit Accel::intersect(const Ray& ray) const noexcept {
    const FloatMode mode;
    return query<false, false>(data_->world, ray, {});
}

bool Accel::occluded(const Ray& ray) const noexcept {
    const FloatMode mode;
    return query<true, false>(data_->world, ray, {}).found();
}

Accel::Bounds Accel::bounds() const noexcept { return {data_->world.bvh.bounds.lo, data_->world.bvh.bounds.hi}; }

const AccelStatistics& Accel::statistics() const noexcept { return data_->statistics; }

}  // namespace steradian
