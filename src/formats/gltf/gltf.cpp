#include "formats/gltf/gltf.h"

#include <algorithm>

#include "formats/gltf/animation.h"
#include "formats/gltf/container.h"
#include "formats/gltf/nodes.h"
#include "formats/gltf/unknown.h"
#include "formats/gltf/unused.h"

namespace steradian::gltf {
namespace {

template <class T>
T value_or_throw(Result<T> result) {
    if (!result) throw json::ReadFailure{std::move(result).error()};
    return std::move(result).value();
}

/// Whatever is there blocks the rays towards lights without an extent, which no other rays find.
void report_shadows_of_glass(Context& context, const Materials& materials) {
    const auto offset = materials.first_transmitting();
    const std::vector<Light>& lights = context.loaded.scene.lights;
    const auto has_no_extent = [](const Light& light) { return !std::holds_alternative<AreaLight>(light); };
    if (offset && std::any_of(lights.begin(), lights.end(), has_no_extent))
        context.not_honoured(
            "the lights of KHR_lights_punctual do not shine through what transmits light: behind it there is shadow",
            *offset);
}

}  // namespace

LoadedScene load(std::string_view bytes, const std::string& name, const std::string& folder, const LoadOptions& given,
                 uint64_t* lookup_steps) {
    LoadedScene loaded;
    LoadOptions options = given;
    if (!options.allow_outside_paths) options.allow_outside_paths = false;
    const Container container = value_or_throw(open_container(bytes, name, loaded.diagnostics));
    const auto document =
        value_or_throw(json::Document::parse(container.json, name, options.max_depth, container.json_begin));
    // Offsets count from behind a byte order mark.
    std::optional<uint64_t> begin = container.json_begin;
    if (begin) *begin += static_cast<uint64_t>(document.text().data() - container.json.data());
    const Source source(document, name, begin);
    if (const auto duplicate = document.duplicate_key())
        source.fail(duplicate->second_offset, "the key " + quoted(duplicate->key) + " stands here for the second time",
                    "the first one is at " + source.where(duplicate->first_offset).str());
    const Object root(source, document.root(), "a glTF file");
    check_asset(root);
    const Tables tables(root);
    Assets assets(loaded, folder, options);
    Context context(source, tables, options, loaded, assets);
    check_extensions(context, root);
    loaded.variants = variant_names(context);
    if (!options.gltf_variant.empty()) context.variant = find_variant(context, options.gltf_variant);
    Buffers buffers(context, container.binary);
    Accessors accessors(context, buffers);
    Images images(context, buffers);
    Materials materials(context, images);
    Meshes meshes(context, accessors, materials);
    place_nodes(context, accessors, meshes, read_pose(context, accessors), root);
    report_shadows_of_glass(context, materials);
    images.decode();
    find_unknown_properties(context, root);
    if (options.locations) {
        find_unused(context);
        find_ineffective(context);
        // What the reader has made for nothing, such as the alpha of a material that is opaque, is not the file's.
        const Scene& scene = loaded.scene;
        const auto consume = [&](ElementKind kind, size_t count) {
            for (uint32_t i = 0; i < count; ++i) loaded.locations.consumed.push_back({kind, i});
        };
        consume(ElementKind::image, scene.images.size()), consume(ElementKind::texture, scene.textures.size());
        consume(ElementKind::material, scene.materials.size());
        consume(ElementKind::mesh, scene.meshes.size()), consume(ElementKind::shape, scene.shapes.size());
    }
    assets.locate(document, source);
    const bool sky_to_see = options.environment.replace.has_value();
    if (loaded.scene.instances.empty() && !sky_to_see) context.warn("the scene has nothing to render", root.offset());
    if (lookup_steps) *lookup_steps = source.lookup_steps();
    return loaded;
}

}  // namespace steradian::gltf
