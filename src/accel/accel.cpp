#include "accel/accel.h"

#include <chrono>
#include <new>
#include <string>

#include "accel/geometry.h"
#include "accel/instance.h"
#include "accel/kernels/kernels.h"
#include "base/parallel.h"

namespace steradian {

namespace {

struct Built {
    std::vector<BuiltGeometry> geometries;
    std::vector<GeometryView> views;
    std::vector<PlacedGeometry> instances;
    Bvh bvh;  ///< over the instances that have anything in them

    World world() const {
        World w;
        if (bvh.nodes.empty()) return w;
        w.nodes = bvh.nodes.data(), w.order = bvh.order.data();
        w.instances = instances.data(), w.geometries = views.data();
        if (bvh.order.size() == 1 && instances[bvh.order[0]].identity) w.only = bvh.order[0];
        return w;
    }
};

}  // namespace

struct Accel::Data {
    Built built;
    World world;
    const Kernels* kernels = nullptr;
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
    if (instances.size() >= ChildRef::kMaxItems)
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
                        Built& world) {
    world.geometries.reserve(geometries.size());
    for (size_t i = 0; i < geometries.size(); ++i) {
        Result<std::vector<BuildPrimitive>> boxes = primitive_bounds(geometries[i], i);
        if (!boxes) return boxes.error();
        if (cancelled.poll()) return cancelled_error();
        world.geometries.push_back(build_geometry(geometries[i], *boxes, options, cancelled));
        if (cancelled.poll()) return cancelled_error();
    }
    for (const BuiltGeometry& g : world.geometries) world.views.push_back(view_of(g));
    return Ok{};
}

Status place_instances(std::span<const GeometryInstance> instances, Built& world) {
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
void build_top(const AccelOptions& options, Cancellation& cancelled, Built& world) {
    std::vector<BuildPrimitive> boxes;
    for (size_t i = 0; i < world.instances.size(); ++i) {
        if (world.instances[i].world.empty()) continue;
        boxes.emplace_back(world.instances[i].world, static_cast<uint32_t>(i));
    }
    BvhOptions how;
    how.builder = options.builder;
    how.max_depth = options.max_depth;
    how.item_cost = 8;  // an instance is a transform and a hierarchy of its own: leaves with one are best
    world.bvh = build_bvh(boxes, how, cancelled);
}

template <class Array>
uint64_t bytes_of(const Array& v) {
    return v.capacity() * sizeof(v[0]);
}
uint64_t bytes_of(const Bvh& bvh) { return bytes_of(bvh.nodes) + bytes_of(bvh.order); }

AccelStatistics count(const Built& world) {
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
        if (const auto* blocks = std::get_if<LargeArray<TriangleBlock>>(&g.primitives)) s.bytes += bytes_of(*blocks);
    }
    add(world.bvh);
    s.bytes += bytes_of(world.geometries) + bytes_of(world.instances);
    return s;
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
        const Result<const Kernels*> kernels = select_kernels(options.isa);
        if (!kernels) return kernels.error();
        Cancellation cancelled(options.cancelled);
        auto data = std::make_unique<Data>();
        data->kernels = *kernels;
        if (Status status = build_geometries(geometries, options, cancelled, data->built); !status)
            return status.error();
        if (Status status = place_instances(instances, data->built); !status) return status.error();
        build_top(options, cancelled, data->built);
        if (cancelled.poll()) return cancelled_error();
        data->statistics = count(data->built);
        data->statistics.bytes += sizeof(Data);
        data->world = data->built.world();
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - started;
        data->statistics.build_seconds = took.count();
        return Accel(std::move(data));
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::resources, "not enough memory for the hierarchy", {}, {}, {}};
    }
}

void Accel::intersect(std::span<const Ray> rays, std::span<Hit> hits, RayKind kind) const noexcept {
    const FloatMode mode;
    const Kernels& k = *data_->kernels;
    (kind == RayKind::coherent ? k.intersect_coherent : k.intersect)(data_->world, rays.data(), hits.data(),
                                                                     rays.size());
}

void Accel::occluded(std::span<const Ray> rays, std::span<uint8_t> result, RayKind kind) const noexcept {
    const FloatMode mode;
    const Kernels& k = *data_->kernels;
    (kind == RayKind::coherent ? k.occluded_coherent : k.occluded)(data_->world, rays.data(), result.data(),
                                                                   rays.size());
}

void Accel::next_hit(std::span<const Ray> rays, std::span<const Hit> after, std::span<Hit> hits) const noexcept {
    const FloatMode mode;
    data_->kernels->next_hit(data_->world, rays.data(), after.data(), hits.data(), rays.size());
}

Hit Accel::intersect(const Ray& ray) const noexcept {
    Hit hit;
    intersect({&ray, 1}, {&hit, 1});
    return hit;
}

bool Accel::occluded(const Ray& ray) const noexcept {
    uint8_t result = 0;
    occluded({&ray, 1}, {&result, 1});
    return result != 0;
}

Accel::Bounds Accel::bounds() const noexcept { return {data_->built.bvh.bounds.lo, data_->built.bvh.bounds.hi}; }

const AccelStatistics& Accel::statistics() const noexcept { return data_->statistics; }

}  // namespace steradian
