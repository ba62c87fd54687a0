// From a Scene to a RenderScene: clean, check, bake, derive the light tables, build the hierarchies.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <new>
#include <stdexcept>

#include "base/parallel.h"
#include "math/transform.h"
#include "render/memory_estimate.h"
#include "render/render_scene.h"
#include "scene/emission.h"
#include "scene/validate.h"
#include "shading/surface.h"

namespace steradian {
namespace {

/// The primitives of the analytic shapes, each array filled once so that spans into it stay valid.
struct AnalyticShapes {
    std::vector<SphereGeometry> spheres;
    std::vector<RectangleGeometry> rectangles;
    std::vector<DiskGeometry> disks;

    explicit AnalyticShapes(const std::vector<Shape>& shapes) {
        for (const Shape& shape : shapes) {
            if (const auto* s = std::get_if<Sphere>(&shape)) spheres.push_back({s->center, s->radius});
            if (const auto* r = std::get_if<Rectangle>(&shape)) rectangles.push_back({r->center, r->half_u, r->half_v});
            if (const auto* d = std::get_if<Disk>(&shape))
                disks.push_back({d->center, disk_axes(*d).u, disk_axes(*d).v});
        }
    }
};

std::vector<Geometry> geometries_of(const Scene& scene, const AnalyticShapes& analytic) {
    std::vector<Geometry> out;
    out.reserve(scene.shapes.size());
    size_t sphere = 0, rectangle = 0, disk = 0;
    for (const Shape& shape : scene.shapes) {
        if (const auto* id = std::get_if<MeshId>(&shape)) {
            const Mesh& mesh = scene.meshes[index(*id)];
            out.push_back(TriangleGeometry{mesh.positions, mesh.indices});
        } else if (std::holds_alternative<Sphere>(shape)) {
            out.push_back(std::span(analytic.spheres).subspan(sphere++, 1));
        } else if (std::holds_alternative<Rectangle>(shape)) {
            out.push_back(std::span(analytic.rectangles).subspan(rectangle++, 1));
        } else {
            out.push_back(std::span(analytic.disks).subspan(disk++, 1));
        }
    }
    return out;
}

/// Of a bit for each primitive.
size_t primitive_bytes(const Scene& scene, const Instance& instance) {
    const auto* mesh = std::get_if<MeshId>(&scene.shapes[index(instance.shape)]);
    return mesh ? (scene.meshes[index(*mesh)].indices.size() / 3 + 7) / 8 : 1;
}

/// Whether rays may go on through what they hit of it: it has holes, or boundaries that are not there.
bool lets_pass(const ShadingScene& shading, uint32_t instance) {
    return shading.is_cut_out(instance) || shading.has_priority(instance);
}

/// As many bits that are 1 as the largest instance has primitives of those that may let rays pass.
std::vector<uint8_t> cut_out_bits(const ShadingScene& shading) {
    size_t bytes = 0;
    for (uint32_t i = 0; i < shading.instances.size(); ++i)
        if (lets_pass(shading, i)) bytes = std::max(bytes, primitive_bytes(shading.scene, shading.scene.instances[i]));
    return std::vector<uint8_t>(bytes, 0xff);
}

/// A scene can be prepared before anybody knows for which pictures.
RenderSettings smallest_picture() {
    RenderSettings settings;
    settings.width = settings.height = 1;
    return settings;
}

Result<std::shared_ptr<const RenderScene>> prepare_checked(Scene scene, const Execution& execution,
                                                           Diagnostics& diagnostics, const PrepareHooks& hooks) {
    const auto cancelled = [&] { return hooks.cancelled && hooks.cancelled(); };
    const auto cancelled_error = [] {
        return make_error(ErrorCode::render_failed, "the preparation of the scene was cancelled");
    };
    if (cancelled()) return cancelled_error();
    std::string hash = scene_hash(scene);
    if (cancelled()) return cancelled_error();
    sanitize(scene, diagnostics);
    if (auto status = validate(scene); !status) return std::move(status).error();
    add_emission(scene);
    if (scene.lights.empty()) diagnostics.warn("the scene has no lights: the picture will be black");
    if (auto status = check_scene_memory(estimate_memory(scene, smallest_picture(), execution)); !status)
        return std::move(status).error();
    bake_transforms(scene);
    sanitize(scene, diagnostics);  // a transform may have moved vertices out of bounds

    auto shading = make_shading_scene(std::move(scene), diagnostics);
    if (!shading) return std::move(shading).error();
    if (cancelled()) return cancelled_error();

    AnalyticShapes analytic(shading->scene.shapes);
    const std::vector<Geometry> geometries = geometries_of(shading->scene, analytic);
    std::vector<uint8_t> cut_outs = cut_out_bits(*shading);
    std::vector<GeometryInstance> instances;
    instances.reserve(shading->scene.instances.size());
    for (const Instance& i : shading->scene.instances) {
        instances.push_back({index(i.shape), i.world_from_object});
        if (lets_pass(*shading, static_cast<uint32_t>(instances.size() - 1)))
            instances.back().cut_outs = std::span(cut_outs).first(primitive_bytes(shading->scene, i));
    }

    AccelOptions options;
    options.builder = execution.bvh;
    options.max_depth = execution.bvh_max_depth;
    options.layout = execution.bvh_layout;
    options.isa = execution.isa;
    options.cancelled = hooks.cancelled;
    options.progress = hooks.progress;
    if (hooks.progress) hooks.progress(0);
    Result<Accel> accel = Error{};
    with_threads(execution.threads, [&] { accel = Accel::build(geometries, instances, options); });
    if (!accel) return std::move(accel).error();
    return std::shared_ptr<const RenderScene>(std::make_shared<RenderScene>(
        std::move(*shading), std::move(analytic.spheres), std::move(analytic.rectangles), std::move(analytic.disks),
        std::move(cut_outs), std::move(*accel), std::move(hash)));
}

}  // namespace

Result<std::shared_ptr<const RenderScene>> prepare(Scene scene, const Execution& execution, Diagnostics& diagnostics,
                                                   const PrepareHooks& hooks) {
    const FloatMode mode;
    try {
        return prepare_checked(std::move(scene), execution, diagnostics, hooks);
    } catch (const std::bad_alloc&) {
        return make_error(ErrorCode::resources, "not enough memory to prepare the scene");
    } catch (const std::exception& e) {
        return make_error(ErrorCode::render_failed, fmt::format("cannot prepare the scene: {}", e.what()));
    }
}

}  // namespace steradian
