#include "steradian/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <stdexcept>

#include "base/file.h"
#include "base/text.h"
#include "formats/assets.h"
#include "formats/framing.h"
#include "formats/gltf/gltf.h"
#include "formats/json/reader.h"
#include "formats/scene_json/common.h"
#include "formats/studio.h"
#include "image/decode.h"

namespace steradian {
namespace {

Error about_file(const std::string& name, ErrorCode code, std::string message, std::string hint = {}) {
    Error error;
    error.code = code;
    error.message = std::move(message);
    error.where.file = name;
    error.hint = std::move(hint);
    return error;
}

Error out_of_memory(const std::string& name) {
    return about_file(name, ErrorCode::resources, "there is not enough memory to load the scene");
}

std::string folder_of_file(const std::string& path) {
    const size_t slash = path.find_last_of('/');
    return slash == std::string::npos ? std::string() : slash == 0 ? "/" : path.substr(0, slash);
}

bool has_member(json::Value object, std::string_view key) {
    for (const json::Member member : object.members())
        if (member.key == key) return true;
    return false;
}

Result<LoadedScene> read_json(std::string_view text, const std::string& name, const std::string& base_folder,
                              const LoadOptions& options) {
    auto document = json::Document::parse(text, name, options.max_depth);
    if (!document) return std::move(document).error();
    const json::Source source =
        options.locations ? json::Source(*document, name, std::nullopt) : json::Source(document->text(), name);
    if (const auto duplicate = document->duplicate_key())
        source.fail(duplicate->second_offset,
                    "the key " + json::quoted(duplicate->key) + " stands here for the second time",
                    "the first one is at " + source.where(duplicate->first_offset).str());
    LoadedScene loaded;
    Assets assets(loaded, base_folder, options);
    const scene_json::Context context{source, loaded, assets};
    const json::Value root = document->root();
    if (!root.is(json::Kind::object))
        source.fail(root.offset(), "a scene must be an object, got " + json::describe(root));
    // Every course file has an integrator and no version; no file of ours is the other way round.
    if (has_member(root, "version"))
        scene_json::load_native(context, root);
    else if (has_member(root, "integrator"))
        scene_json::load_course(context, root);
    else
        source.fail(root.offset(), "missing key 'version' in the scene", "begin with {\"version\": 1, …");
    loaded.locations.file = name;
    assets.locate(*document, source);
    return loaded;
}

/// Of the picture that is to come: its width over its height.
double aspect(const LoadedScene& loaded, const LoadOptions& options) {
    const RenderSettings& s = loaded.settings;
    return options.aspect.value_or(double(s.width) / max_of(s.height, 1u));
}

Result<LoadedScene> load_json_file(const std::string& path, const LoadOptions& options) {
    auto text = read_file(path, options.max_file_bytes);
    if (!text) return std::move(text).error();
    auto loaded = load_scene_json(*text, path, folder_of_file(path), options);
    if (!loaded) return loaded;
    loaded->files.insert(loaded->files.begin(), path);
    Assets assets(*loaded, {}, options);
    if (options.turn) add_turntable_camera(*loaded, assets, *options.turn, aspect(*loaded, options));
    return loaded;
}

/// Screens and little lamps painted on a model: they shine, but are not there to light it.
bool is_decoration(const Light& light) {
    const auto* area = std::get_if<AreaLight>(&light);
    return area && area->texture;
}

Rgb strength(const PointLight& l) { return l.intensity; }
Rgb strength(const SpotLight& l) { return l.intensity; }
Rgb strength(const GoniometricLight& l) { return l.intensity; }
Rgb strength(const DirectionalLight& l) { return l.irradiance; }
Rgb strength(const AreaLight& l) { return l.radiance; }
Rgb strength(const EnvironmentLight& l) { return l.radiance; }

bool lights_the_model(const Light& light) {
    return !is_decoration(light) && !is_black(std::visit([](const auto& l) { return strength(l); }, light));
}

/// A camera and lamps stand some ten times the model's size away.
void check_room_around(const Scene& scene, const std::string& path) {
    const Extent extent = extent_of(scene);
    const double reach = length(extent.center) + 10 * extent.radius;
    if (reach <= kMaxCoordinate) return;
    throw json::ReadFailure{
        Error{ErrorCode::bad_input,
              fmt::format("the model is {:.3g} m large and {:.3g} m from the origin: there is no room around it, "
                          "coordinates go to {:.0e} m",
                          2 * extent.radius, length(extent.center), kMaxCoordinate),
              {path, 0, 0},
              {},
              "look at the scales and translations of its nodes"}};
}

/// A model without a camera gets one; one that nothing shines on gets the studio, unless the caller chose what is
/// around it. An author's own camera may stand below the model, so then there is no floor.
void complete(LoadedScene& loaded, Assets& assets, const std::string& path, const LoadOptions& options) {
    const std::vector<Light>& lights = loaded.scene.lights;
    const bool dark = std::none_of(lights.begin(), lights.end(), lights_the_model) && !options.environment.replace;
    const bool framed = loaded.scene.cameras.empty() || options.turn;
    if (framed || dark) check_room_around(loaded.scene, path);
    double turn = 0;  // of the camera about +Y
    if (options.turn)
        add_turntable_camera(loaded, assets, *options.turn, aspect(loaded, options)), turn = -*options.turn;
    else if (framed)
        turn = add_framing_camera(loaded, assets, aspect(loaded, options));
    if (!dark) return;
    const Scene& scene = loaded.scene;
    loaded.before_studio = {scene.instances.size(), scene.shapes.size(), scene.materials.size(), scene.textures.size(),
                            scene.lights.size()};
    add_studio(loaded, assets, framed, turn);
}

void remove_environment(Scene& scene) {
    for (size_t i = scene.lights.size(); i-- > 0;) {
        if (!std::holds_alternative<EnvironmentLight>(scene.lights[i])) continue;
        const auto at = static_cast<std::ptrdiff_t>(i);
        scene.lights.erase(scene.lights.begin() + at);
        std::vector<std::string>& names = scene.names.lights;
        if (i < names.size()) names.erase(names.begin() + at);
    }
}

std::string nothing_to_render(const Model& model) {
    const std::string faces = std::to_string(model.dropped_faces);
    if (model.dropped_faces == 0) return "the model has no faces, there is nothing to render";
    return "there is nothing to render: " +
           (model.dropped_faces == 1 ? std::string("the only face has") : "all " + faces + " faces have") +
           " coordinates that are not finite or beyond 1e15";
}

Result<LoadedScene> load_model_file(const std::string& path, const LoadOptions& options) {
    const size_t slash = path.find_last_of('/');
    LoadedScene loaded;
    Assets assets(loaded, folder_of_file(path), options);
    const auto about_the_model = [&](Error error) {
        if (error.where.file.empty()) error.where.file = path;
        return error;
    };
    const auto model = assets.load_model(slash == std::string::npos ? path : path.substr(slash + 1));
    if (!model) return about_the_model(model.error());
    const auto placed = assets.place(*model, {});
    if (!placed) return about_the_model(placed.error());
    if (placed->count == 0) return about_file(path, ErrorCode::bad_input, nothing_to_render(assets.model(*model)));
    complete(loaded, assets, path, options);
    return loaded;
}

Result<LoadedScene> load_gltf_file(const std::string& path, const LoadOptions& options) {
    const auto bytes = read_file(path, options.max_file_bytes);
    if (!bytes) return bytes.error();
    const std::string folder = folder_of_file(path);
    LoadedScene loaded = gltf::load(*bytes, path, folder, options);
    loaded.files.insert(loaded.files.begin(), path);
    Assets assets(loaded, folder, options);
    complete(loaded, assets, path, options);
    return loaded;
}

/// What the caller wants to shine from far away.
Status apply_environment(LoadedScene& loaded, const LoadOptions& options) {
    const EnvironmentOptions& wanted = options.environment;
    Assets assets(loaded, {}, options);
    if (wanted.replace) {
        remove_environment(loaded.scene);
        EnvironmentLight light;
        if (const auto* path = std::get_if<std::string>(&*wanted.replace)) {
            auto texels = read_texels(*path, options.images);
            if (!texels) return std::move(texels).error();
            loaded.files.push_back(*path);
            light.image = assets.add_image(std::move(*texels), *path);
            light.color_space = assets.default_color_space(*light.image);
        } else if (const auto* radiance = std::get_if<Rgb>(&*wanted.replace)) {
            light.radiance = *radiance;
        }
        if (!std::holds_alternative<EnvironmentOptions::None>(*wanted.replace)) assets.add_light(light, "environment");
    }
    for (Light& light : loaded.scene.lights)
        if (auto* environment = std::get_if<EnvironmentLight>(&light)) {
            environment->rotation += wanted.rotation;
            environment->radiance = environment->radiance * wanted.scale;
        }
    if (options.turn) turn_sky(loaded.scene, -*options.turn);
    return Ok{};
}

struct Format {
    std::string_view extension;
    bool animated;  ///< whether files of it can have animations
    Result<LoadedScene> (*load)(const std::string& path, const LoadOptions& options);
};
constexpr Format kFormats[] = {{".json", false, load_json_file},
                               {".gltf", true, load_gltf_file},
                               {".glb", true, load_gltf_file},
                               {".obj", false, load_model_file},
                               {".ply", false, load_model_file}};

/// The one place where what readers throw becomes a value.
template <class Load>
Result<LoadedScene> guarded(const std::string& name, Load load) {
    try {
        return load();
    } catch (json::ReadFailure& failure) {
        return std::move(failure.error);
    } catch (const std::bad_alloc&) {
        return out_of_memory(name);
    } catch (const std::length_error&) {
        return out_of_memory(name);
    } catch (const std::runtime_error& e) {  // of TBB: it cannot start its threads
        return about_file(name, ErrorCode::resources, std::string("cannot load the scene: ") + e.what());
    }
}

}  // namespace

Result<LoadedScene> load_scene(const std::string& path, const LoadOptions& options) {
    const std::string extension = extension_of(path);
    for (const Format& format : kFormats)
        if (format.extension == extension)
            return guarded(path, [&]() -> Result<LoadedScene> {
                if (!format.animated && (options.frame_time || !options.animation.empty()))
                    return about_file(path, ErrorCode::usage, "scenes of this format have no animations",
                                      "those of glTF files (.gltf, .glb) may have");
                auto loaded = format.load(path, options);
                if (loaded) loaded->locations.file = path;
                if (loaded)
                    if (Status status = apply_environment(*loaded, options); !status) return std::move(status).error();
                return loaded;
            });
    std::vector<std::string_view> known;
    for (const Format& format : kFormats) known.push_back(format.extension);
    const std::string message = extension.empty()
                                    ? "a scene file needs an extension that tells its format"
                                    : "unknown kind of scene file '" + escape_for_display(extension) + "'";
    return about_file(path, ErrorCode::bad_input, message, suggestion(extension, known));
}

Result<LoadedScene> load_scene_json(std::string_view text, const std::string& name, const std::string& base_folder,
                                    const LoadOptions& options) {
    return guarded(name, [&] { return read_json(text, name, base_folder, options); });
}

}  // namespace steradian
