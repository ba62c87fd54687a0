// What a render will take, known before any of it is taken.
#include "render/memory_estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "accel/build_memory.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "render/film.h"
#include "render/integrator.h"
#include "shading/environment.h"
#include "shading/mip_map.h"
#include "shading/shading_scene.h"

namespace steradian {
namespace {

/// Of the hierarchy. Ids may be wrong: nothing has checked the scene yet. Transforms of what is used once will be
/// baked.
BuildMemory hierarchy_memory(const Scene& scene, const Execution& execution) {
    constexpr SphereGeometry kShape;
    std::vector<Geometry> geometries;
    for (const Shape& shape : scene.shapes) {
        const auto* mesh = std::get_if<MeshId>(&shape);
        if (!mesh) {
            geometries.push_back(std::span(&kShape, 1));
        } else if (index(*mesh) < scene.meshes.size()) {
            const Mesh& m = scene.meshes[index(*mesh)];
            geometries.push_back(TriangleGeometry{m.positions, m.indices});
        } else {
            geometries.push_back(TriangleGeometry{});
        }
    }
    std::vector<GeometryInstance> instances;
    for (const Instance& i : scene.instances)
        if (index(i.shape) < geometries.size()) instances.push_back({index(i.shape), {}});
    AccelOptions options;
    options.builder = execution.bvh, options.layout = execution.bvh_layout;
    options.max_depth = execution.bvh_max_depth;
    return expected_build_memory(geometries, instances, options);
}

template <class T>
uint64_t bytes_of(const std::vector<T>& v) {
    return v.size() * sizeof(T);
}

uint64_t name_bytes(const Scene::Names& names) {
    uint64_t bytes = 0;
    for (const auto* list : {&names.images, &names.textures, &names.materials, &names.meshes, &names.shapes,
                             &names.instances, &names.lights, &names.cameras, &names.profiles})
        bytes += bytes_of(*list);
    return bytes;
}

uint64_t scene_bytes(const Scene& scene) {
    uint64_t bytes = bytes_of(scene.images) + bytes_of(scene.textures) + bytes_of(scene.materials) +
                     bytes_of(scene.reliefs) + bytes_of(scene.meshes) + bytes_of(scene.shapes) +
                     bytes_of(scene.instances) + bytes_of(scene.lights) + bytes_of(scene.cameras) +
                     name_bytes(scene.names);
    for (const Mesh& m : scene.meshes) bytes += mesh_bytes(m);
    for (const RawImage& image : scene.images) bytes += image.data.size();
    return bytes;
}

/// What a light adds to the tables. Ids may be wrong: nothing has checked the scene yet.
uint64_t table_bytes(const Scene& scene, const Light& light) {
    if (const auto* area = std::get_if<AreaLight>(&light)) {
        if (index(area->instance) >= scene.instances.size()) return 0;
        const ShapeId shape = scene.instances[index(area->instance)].shape;
        if (index(shape) >= scene.shapes.size()) return 0;
        const auto* mesh = std::get_if<MeshId>(&scene.shapes[index(shape)]);
        if (!mesh || index(*mesh) >= scene.meshes.size()) return 0;
        return LightTree::bytes(scene.meshes[index(*mesh)].indices.size() / 3);
    }
    if (const auto* sky = std::get_if<EnvironmentLight>(&light); sky && sky->image) {
        if (index(*sky->image) >= scene.images.size()) return 0;
        const RawImage& image = scene.images[index(*sky->image)];
        return uint64_t(image.width) * image.height * EnvironmentTable::kBytesPerTexel;
    }
    return 0;
}

/// Of the MIP maps: one for each image and way of reading it that a texture asks for.
uint64_t mip_map_bytes(const Scene& scene) {
    std::set<std::pair<ImageId, ColorSpace>> made;
    uint64_t bytes = 0;
    for (const Texture& texture : scene.textures) {
        const auto* t = std::get_if<ImageTexture>(&texture);
        if (t && t->mip_map && t->bilinear && index(t->image) < scene.images.size() &&
            made.insert({t->image, t->color_space}).second)
            bytes += MipMap::bytes(scene.images[index(t->image)]);
    }
    return bytes;
}

}  // namespace

uint64_t mesh_bytes(const Mesh& m) {
    uint64_t bytes = bytes_of(m.positions) + bytes_of(m.normals) + bytes_of(m.uvs) + bytes_of(m.indices) +
                     bytes_of(m.colors) + bytes_of(m.alphas) + bytes_of(m.tangents) + bytes_of(m.more_uvs);
    for (const std::vector<Vec2>& uvs : m.more_uvs) bytes += bytes_of(uvs);
    return bytes;
}

MemoryEstimate estimate_memory(const Scene& scene, const RenderSettings& settings, const Execution& execution) {
    MemoryEstimate out;
    out.scene = scene_bytes(scene);
    const BuildMemory hierarchy = hierarchy_memory(scene, execution);
    out.hierarchy = hierarchy.result + scene.instances.size() * sizeof(ShadingScene::InstanceData) +
                    scene.lights.size() * (sizeof(ShadingScene::LightData) + sizeof(double)) +
                    LightTree::bytes(scene.lights.size());
    for (const Light& light : scene.lights) out.hierarchy += table_bytes(scene, light);
    out.hierarchy += mip_map_bytes(scene);
    out.build = hierarchy.peak - hierarchy.result;
    out.picture = picture_bytes(settings, execution);
    return out;
}

uint64_t picture_bytes(const RenderSettings& s, const Execution& e) {
    const Crop window = window_of(s);
    const uint64_t width = window.x1 - window.x0, height = window.y1 - window.y0;
    // The sums go before a file's encoder takes its share, which is less. With a time limit a block is open beside
    // them.
    const uint64_t of_pixel =
        s.target_error > 0 ? AdaptiveFilm::bytes_per_pixel(s.aovs) : SumKinds(s.aovs).bytes_per_pixel();
    const uint64_t sums = of_pixel * (e.time_limit > 0 ? 2 : 1);
    return width * height * (sums + PictureChannels(s.aovs).count() * sizeof(float)) +
           Film::tile_bytes() * (width / e.tile_size + 2) * (height / e.tile_size + 2) +
           workers_of(e) * (integrator_bytes(s, largest_tile(s, e)) + of_pixel * largest_tile(s, e));
}

Status check_picture_memory(const RenderSettings& s, const Execution& e) {
    const Crop window = window_of(s);
    const uint64_t needed = picture_bytes(s, e), available = available_memory();
    if (needed <= available) return Ok{};
    return make_error(ErrorCode::resources,
                      fmt::format("{} pixels on {} threads need about {} MB of memory, {} MB are available",
                                  uint64_t(window.x1 - window.x0) * (window.y1 - window.y0), workers_of(e),
                                  needed >> 20, available >> 20),
                      "render it in parts with --crop, or with fewer threads or smaller tiles");
}

Status check_scene_memory(const MemoryEstimate& estimate) {
    const uint64_t needed = estimate.peak() - estimate.scene, available = available_memory();
    if (needed <= available) return Ok{};
    return make_error(
        ErrorCode::resources,
        fmt::format("the scene needs about {} MB of memory to be rendered ({} MB for its hierarchy, {} MB "
                    "more while that is built, {} MB for the picture), {} MB are available",
                    needed >> 20, estimate.hierarchy >> 20, estimate.build >> 20, estimate.picture >> 20,
                    available >> 20));
}

}  // namespace steradian
