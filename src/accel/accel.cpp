#include "accel/accel.h"

#include <algorithm>
#include <chrono>
#include <new>
#include <string>

#include "accel/geometry.h"
#include "accel/instance.h"
#include "accel/kernels/kernels.h"
#include "accel/margin.h"
#include "accel/open.h"
#include "base/parallel.h"

namespace steradian {

namespace {

/// What refit() must find again.
struct GeometrySize {
    size_t kind, primitives;
    bool operator==(const GeometrySize&) const = default;
};
GeometrySize size_of(const Geometry& geometry) { return {geometry.index(), primitive_count(geometry)}; }

/// The levels and what they refer to.
struct Built {
    BvhLayout layout = BvhLayout::full;
    std::vector<GeometrySize> sizes;
    std::vector<bool> on_upper_level;  ///< by geometry
    Level upper;
    Level far;  ///< World::far
    std::vector<TrianglePart> parts;
    std::vector<PlacedGeometry> instances;
    Box bounds, near;           ///< of everything; Placement::near
    std::vector<Level> levels;  ///< by geometry; empty for those that are on the upper level, or nowhere
    std::vector<LevelView> views;
    std::vector<ShapesView> shapes;
    std::vector<const uint8_t*> cut_outs;  ///< by instance; empty when everything is opaque

    World world() const {
        World w;
        w.upper = upper.view();
        w.only_instances = std::find(on_upper_level.begin(), on_upper_level.end(), true) == on_upper_level.end();
        w.parts = parts.data(), w.part_count = static_cast<uint32_t>(parts.size());
        w.far = far.view(), w.near = near;
        w.instances = instances.data(), w.levels = views.data(), w.shapes = shapes.data();
        w.cut_outs = cut_outs.empty() ? nullptr : cut_outs.data();
        return w;
    }
};

}  // namespace

struct Accel::Data {
    Built built;
    World world;
    const Kernels* kernels = nullptr;
    AccelStatistics statistics;

    /// Everything but how long the build took.
    void count_again(std::span<const Geometry> geometries);
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
    size_t items = instances.size();
    for (const Geometry& g : geometries) items += primitive_count(g);
    const size_t limit = max_items(options.layout);
    if (items > limit)
        return make_error(
            ErrorCode::resources,
            std::to_string(items) + " primitives and instances, more than the limit of " + std::to_string(limit));
    for (size_t i = 0; i < instances.size(); ++i) {
        if (instances[i].geometry >= geometries.size())
            return Error{ErrorCode::bad_input,
                         "instance " + std::to_string(i) + " is of geometry " + std::to_string(instances[i].geometry) +
                             ", but there are " + std::to_string(geometries.size()),
                         {},
                         {},
                         {}};
        const size_t bytes = instances[i].cut_outs.size();
        const size_t expected = (primitive_count(geometries[instances[i].geometry]) + 7) / 8;
        if (bytes != 0 && bytes != expected)
            return make_error(ErrorCode::bad_input, "instance " + std::to_string(i) + ": " + std::to_string(bytes) +
                                                        " bytes of cut-outs, expected " + std::to_string(expected));
    }
    return Ok{};
}

/// By instance; nothing when there are none, so that everything runs as if there could be none.
std::vector<const uint8_t*> find_cut_outs(std::span<const GeometryInstance> instances) {
    std::vector<const uint8_t*> found;
    for (size_t i = 0; i < instances.size(); ++i) {
        const std::span<const uint8_t> bits = instances[i].cut_outs;
        if (std::all_of(bits.begin(), bits.end(), [](uint8_t byte) { return byte == 0; })) continue;
        found.resize(instances.size());
        found[i] = bits.data();
    }
    return found;
}

/// What a build has to do: every primitive is in one hierarchy, and so is every instance that is not on the upper level
/// itself, or its parts.
uint64_t work_of(const ItemCounts& counts) {
    return std::max<uint64_t>(counts.in_place + counts.elsewhere + counts.most_items(), 1) * kBuildWork;
}

ItemKind kind_of(const Geometry& geometry) {
    return std::holds_alternative<TriangleGeometry>(geometry) ? ItemKind::block : ItemKind::shape;
}

BvhOptions bvh_options(const AccelOptions& options, ItemKind mostly) {
    BvhOptions out;
    out.builder = options.builder, out.max_depth = options.max_depth, out.mostly = mostly;
    out.layout = options.layout;
    return out;
}

/// The hierarchies of the geometries that are not on the upper level; that these are sound is checked as well.
Status build_levels(std::span<const Geometry> geometries, const std::vector<bool>& upper, const AccelOptions& options,
                    BuildMonitor& monitor, Built& built) {
    built.levels.resize(geometries.size());
    for (uint32_t i = 0; i < geometries.size(); ++i) {
        built.shapes.push_back(shapes_of(geometries[i]));
        if (upper[i]) continue;
        LargeArray<BuildPrimitive> primitives;
        if (Status status = append_primitives(geometries[i], i, 0, primitives); !status) return status;
        monitor.advance(primitives.size() * kReadWork);
        if (monitor.poll()) return cancelled_error();
        const LevelPart part{0, kNoHit, i};
        built.levels[i] = build_level(std::move(primitives), geometries, {&part, 1}, {},
                                      bvh_options(options, kind_of(geometries[i])), monitor);
        if (monitor.poll()) return cancelled_error();
    }
    for (const Level& level : built.levels) built.views.push_back(level.view());
    return Ok{};
}

Result<PlacedGeometry> place_instance(size_t index, const GeometryInstance& instance, const Box& bounds) {
    const std::optional<PlacedGeometry> placed = place(instance.geometry, instance.world_from_object, bounds);
    if (!placed)
        return make_error(ErrorCode::bad_input,
                          "instance " + std::to_string(index) +
                              ": the transform is singular, not finite or scales beyond 1e30 or 1e-30");
    // A transformed box may be larger than what is in it, by sqrt(3) at most for rotations.
    const float extent = max_of(max_component(abs(placed->world.lo)), max_component(abs(placed->world.hi)));
    if (!bounds.empty() && !(extent <= 2 * kMaxCoordinate))
        return make_error(ErrorCode::bad_input,
                          "instance " + std::to_string(index) + ": the transform puts it beyond coordinates of 1e15");
    return *placed;
}

constexpr uint32_t kInstancesBetweenPolls = 16384;

/// What is to stand for the instances on the upper level, `limit` of it at most when they are opened, which is done
/// where it pays: built.far is there then.
InstanceParts open_where_it_pays(const Placement& placement, uint64_t limit, const AccelOptions& options,
                                 const Kernels& kernels, BuildMonitor& outer, Built& built) {
    InstanceParts whole = whole_instances(placement);
    if (limit <= whole.size()) return whole;
    BuildMonitor monitor([&] { return outer.poll(); });
    const auto level_over = [&](const InstanceParts& parts) {
        LargeArray<BuildPrimitive> boxes;
        append_boxes(parts, placement, built.levels, 0, boxes);
        return build_level(std::move(boxes), {}, {}, {0, parts}, bvh_options(options, ItemKind::instance), monitor);
    };
    Level far = level_over(whole);
    const auto cost_over = [&](const Level& level) {
        World world = built.world();
        world.upper = level.view(), world.instances = placement.placed.data();
        return sampled_cost(world, kernels, far.bounds);
    };
    InstanceParts opened = open_instances(whole, placement, built.levels, limit);
    if (options.open == OpenInstances::automatic) {
        const Level near = level_over(opened);
        if (monitor.poll()) return whole;  // then the levels are unfinished: no ray may look into them
        if (cost_over(near) > kWorthOpening * cost_over(far)) return whole;
    }
    built.far = std::move(far);
    return opened;
}

/// The upper level, over the primitives that are in place and the instances of everything else.
Status build_upper(std::span<const Geometry> geometries, std::span<const GeometryInstance> instances,
                   const AccelOptions& options, const Kernels& kernels, BuildMonitor& monitor, Built& built) {
    const std::vector<bool>& upper = built.on_upper_level;
    const ItemCounts counts = count_items(geometries, instances, upper, options);
    LargeArray<BuildPrimitive> primitives;
    // With nothing in place, as many as there will be are known before there are any.
    if (counts.in_place > 0) primitives.reserve(counts.in_place + counts.most_items());
    std::vector<LevelPart> parts;
    for (uint32_t i = 0; i < instances.size(); ++i) {
        const uint32_t geometry = instances[i].geometry;
        if (!upper[geometry]) continue;
        const auto first = static_cast<uint32_t>(primitives.size());
        if (Status status = append_primitives(geometries[geometry], geometry, first, primitives); !status)
            return status;
        monitor.advance((primitives.size() - first) * kReadWork);
        if (primitives.size() == first) continue;
        parts.push_back({first, i, geometry});
        built.parts.push_back({first, i});
        if (monitor.poll()) return cancelled_error();
    }
    const auto first_instance = static_cast<uint32_t>(primitives.size());
    ItemKind mostly = parts.empty() ? ItemKind::instance : ItemKind::shape;
    for (const LevelPart& part : parts)
        if (kind_of(geometries[part.geometry]) == ItemKind::block) mostly = ItemKind::block;
    Placement placement{instances, {}, {}, range_bounds(primitives).box.box(), {}};
    placement.placed.reserve(instances.size());
    for (uint32_t i = 0; i < instances.size(); ++i) {
        if (i % kInstancesBetweenPolls == 0 && monitor.poll()) return cancelled_error();
        const Box bounds = built.levels[instances[i].geometry].bounds;
        Result<PlacedGeometry> placed = place_instance(i, instances[i], bounds);
        if (!placed) return placed.error();
        placement.placed.push_back(*placed);
        if (!bounds.empty()) placement.scene.extend(placed->world);
    }
    placement.add_margins();
    built.bounds = placement.scene, built.near = placement.near;
    const InstanceParts items = open_where_it_pays(placement, counts.opened, options, kernels, monitor, built);
    append_boxes(items, placement, built.levels, first_instance, primitives);
    built.instances = std::move(placement.placed);
    std::vector<std::optional<Vec3>>().swap(placement.margins);
    monitor.advance(items.size() * kReadWork + (counts.most_items() - items.size()) * kBuildWork);
    BvhOptions upper_options = bvh_options(options, mostly);
    upper_options.split_boxes = true;
    built.upper =
        build_level(std::move(primitives), geometries, parts, {first_instance, items}, upper_options, monitor);
    return monitor.poll() ? Status(cancelled_error()) : Status(Ok{});
}

template <class Array>
uint64_t bytes_of(const Array& v) {
    return v.capacity() * sizeof(v[0]);
}
double cost_of(const Built& built) {
    std::vector<double> whole;
    for (const Level& level : built.levels) whole.push_back(expected_cost(level, {}));
    std::vector<std::vector<double>> below(built.levels.size());
    for (const LeafEntry& entry : built.upper.entries) {
        if (entry.instance == kNoHit) continue;
        const uint32_t geometry = built.instances[entry.instance].geometry;
        if (built.on_upper_level[geometry] || entry.prim == kWholeInstance || !below[geometry].empty()) continue;
        below[geometry] = costs_below(built.levels[geometry]);
    }
    return expected_cost(built.upper, [&](const LeafEntry& entry) {
        const uint32_t geometry = built.instances[entry.instance].geometry;
        if (entry.prim == kWholeInstance) return whole[geometry];
        const uint32_t ref = child_of(built.levels[geometry], entry.prim / kWidth, entry.prim % kWidth);
        return ChildRef::is_leaf(ref) ? item_count(built.levels[geometry], ref) : below[geometry][ref];
    });
}
AccelStatistics count(std::span<const Geometry> geometries, const Built& built) {
    AccelStatistics s;
    const auto add = [&](const Level& level) {
        s.nodes += level.nodes.size() + level.compact.nodes.size();
        s.leaves += level.leaves;
        s.depth = max_of(s.depth, level.depth);
        s.bytes += bytes_of(level.nodes) + bytes_of(level.blocks) + bytes_of(level.entries) +
                   bytes_of(level.compact.nodes) + bytes_of(level.compact.blocks);
    };
    for (const Geometry& g : geometries) s.primitives += primitive_count(g);
    for (const Level& level : built.levels) add(level);
    add(built.upper), add(built.far);
    for (const LeafEntry& entry : built.upper.entries)
        s.instance_parts +=
            !built.on_upper_level[built.instances[entry.instance].geometry] && entry.prim != kWholeInstance;
    s.cost = cost_of(built);
    s.bytes += bytes_of(built.sizes) + built.on_upper_level.capacity() / 8 + bytes_of(built.levels) +
               bytes_of(built.views) + bytes_of(built.shapes) + bytes_of(built.parts) + bytes_of(built.instances) +
               bytes_of(built.cut_outs);
    return s;
}

Error other_scene(const std::string& what) {
    return {ErrorCode::bad_input, what + " is not what the hierarchy was built over; build it anew", {}, {}, {}};
}

/// That there is the same of everything; not whether it is sound.
Status check_same(std::span<const Geometry> geometries, std::span<const GeometryInstance> instances,
                  const Built& built) {
    if (geometries.size() != built.sizes.size())
        return other_scene("a number of " + std::to_string(geometries.size()) + " geometries");
    if (instances.size() != built.instances.size())
        return other_scene("a number of " + std::to_string(instances.size()) + " instances");
    for (size_t i = 0; i < geometries.size(); ++i)
        if (size_of(geometries[i]) != built.sizes[i])
            return other_scene("geometry " + std::to_string(i) + " with " +
                               std::to_string(primitive_count(geometries[i])) + " primitives or of its kind");
    for (size_t i = 0; i < instances.size(); ++i) {
        const uint32_t geometry = instances[i].geometry;
        if (geometry != built.instances[i].geometry)
            return other_scene("instance " + std::to_string(i) + " of geometry " + std::to_string(geometry));
        if (built.on_upper_level[geometry] && !is_identity(instances[i].world_from_object))
            return other_scene("instance " + std::to_string(i) + ", which had no transform, with one");
    }
    return Ok{};
}

/// All instances in their new places, once everything is checked.
Result<Placement> place_again(std::span<const Geometry> geometries, std::span<const GeometryInstance> instances,
                              const Built& built) {
    std::vector<Box> bounds, whole;
    for (size_t i = 0; i < geometries.size(); ++i) {
        const Result<Box> box = checked_bounds(geometries[i], i);
        if (!box) return box.error();
        whole.push_back(*box);
        bounds.push_back(built.on_upper_level[i] ? Box{} : *box);
    }
    Placement placement;
    placement.instances = instances;
    placement.placed.reserve(instances.size());
    for (size_t i = 0; i < instances.size(); ++i) {
        const Result<PlacedGeometry> one = place_instance(i, instances[i], bounds[instances[i].geometry]);
        if (!one) return one.error();
        placement.placed.push_back(*one);
        placement.scene.extend(built.on_upper_level[instances[i].geometry] ? whole[instances[i].geometry] : one->world);
    }
    placement.add_margins();
    return placement;
}

}  // namespace

void Accel::Data::count_again(std::span<const Geometry> geometries) {
    const double build_seconds = statistics.build_seconds;
    statistics = count(geometries, built);
    statistics.bytes += sizeof(Data);
    statistics.build_seconds = build_seconds;
}

Accel::Accel(std::unique_ptr<Data> data) : data_(std::move(data)) {}
Accel::Accel(Accel&&) noexcept = default;
Accel& Accel::operator=(Accel&&) noexcept = default;
Accel::~Accel() = default;

Result<Accel> Accel::build(std::span<const Geometry> geometries, std::span<const GeometryInstance> instances,
                           const AccelOptions& options) {
    const FloatMode mode;
    const auto started = std::chrono::steady_clock::now();
    try {
        if (Status status = check(geometries, instances, options); !status) return status.error();
        const Result<const Kernels*> kernels = select_kernels(options.isa, options.layout);
        if (!kernels) return kernels.error();
        auto data = std::make_unique<Data>();
        data->kernels = *kernels;
        const std::vector<bool> upper = upper_geometries(geometries, instances);
        BuildMonitor monitor(options.cancelled, options.progress,
                             work_of(count_items(geometries, instances, upper, options)));
        Built& built = data->built;
        built.layout = options.layout;
        built.on_upper_level = upper;
        for (const Geometry& geometry : geometries) built.sizes.push_back(size_of(geometry));
        if (Status status = build_levels(geometries, upper, options, monitor, built); !status) return status.error();
        if (Status status = build_upper(geometries, instances, options, **kernels, monitor, built); !status)
            return status.error();
        built.cut_outs = find_cut_outs(instances);
        data->count_again(geometries);
        data->world = data->built.world();
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - started;
        data->statistics.build_seconds = took.count();
        if (options.progress) options.progress(1);
        return Accel(std::move(data));
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::resources, "not enough memory for the hierarchy", {}, {}, {}};
    }
}

Status Accel::refit(std::span<const Geometry> geometries, std::span<const GeometryInstance> instances) {
    const FloatMode mode;
    try {
        Built& built = data_->built;
        if (Status status = check_same(geometries, instances, built); !status) return status;
        Result<Placement> placed = place_again(geometries, instances, built);
        if (!placed) return placed.error();
        std::vector<LevelPart> parts;
        for (const TrianglePart& part : built.parts)
            parts.push_back({part.first, part.instance, built.instances[part.instance].geometry});
        const auto whole = [](uint32_t geometry) { return LevelPart{0, kNoHit, geometry}; };
        std::vector<CompactLevel> repacked(geometries.size());
        for (uint32_t i = 0; i < geometries.size(); ++i) {
            const LevelPart part = whole(i);
            repacked[i] = repack_level(built.levels[i], geometries, {&part, 1});
        }
        CompactLevel repacked_upper = repack_level(built.upper, geometries, parts),
                     repacked_far = repack_level(built.far, geometries, {});
        // From here on nothing fails.
        std::copy(placed->placed.begin(), placed->placed.end(), built.instances.begin());
        built.bounds = placed->scene, built.near = placed->near;
        for (uint32_t i = 0; i < geometries.size(); ++i) {
            const LevelPart part = whole(i);
            refit_level(built.levels[i], std::move(repacked[i]), geometries, {&part, 1}, {}, {});
            built.shapes[i] = shapes_of(geometries[i]), built.views[i] = built.levels[i].view();
        }
        const auto box_of = [&](const LeafEntry& entry) {
            if (entry.prim == kWholeInstance) return built.instances[entry.instance].world;
            const Level& level = built.levels[built.instances[entry.instance].geometry];
            return placed->world_box(entry.instance, child_box(level, entry.prim / kWidth, entry.prim % kWidth));
        };
        refit_level(built.upper, std::move(repacked_upper), geometries, parts, built.instances, box_of);
        refit_level(built.far, std::move(repacked_far), geometries, {}, built.instances, box_of);
        data_->world = built.world();
        data_->count_again(geometries);
        return Ok{};
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::resources, "not enough memory to refit the hierarchy", {}, {}, {}};
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
    const auto kernel = data_->world.cut_outs       ? k.occluded_or_cut_out
                        : kind == RayKind::coherent ? k.occluded_coherent
                                                    : k.occluded;
    kernel(data_->world, rays.data(), result.data(), rays.size());
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

Accel::Occlusion Accel::occluded(const Ray& ray) const noexcept {
    uint8_t result = 0;
    occluded({&ray, 1}, {&result, 1});
    return static_cast<Occlusion>(result);
}

RayVisits Accel::visits(const Ray& ray) const noexcept {
    const FloatMode mode;
    uint32_t instances = 0;
    return data_->kernels->visits(data_->world, ray, instances);
}

Accel::Bounds Accel::bounds() const noexcept { return {data_->built.bounds.lo, data_->built.bounds.hi}; }

size_t Accel::object_bytes() noexcept { return sizeof(Data); }

const AccelStatistics& Accel::statistics() const noexcept { return data_->statistics; }

}  // namespace steradian
