#include "formats/scene_json/native.h"

#include "base/names.h"

namespace steradian::scene_json {

void NativeLoader::load(Value root) {
    // The version comes first: a later one may have keys that this program does not know.
    for (const Member member : root.members())
        if (member.key == "version") read_version(member.value);
    ObjectReader reader(source_, root, kSceneSpec, "the scene");
    reader.require("version");
    reader.string_or("$schema", {});
    reader.string_or("comment", {});
    if (const auto film = reader.find("film")) read_film(*film);
    read_cameras(reader);
    if (const auto render = reader.find("render")) read_render(*render);
    if (const auto textures = reader.find("textures")) read_textures(*textures);
    if (const auto materials = reader.find("materials")) read_materials(*materials);
    if (const auto shapes = reader.find("shapes")) read_shapes(*shapes);
    if (const auto objects = reader.find("objects")) read_objects(*objects);
    if (const auto lights = reader.find("lights")) read_lights(*lights);
    reader.finish();
}

void NativeLoader::read_version(Value version) const {
    if (!version.is(Kind::number))
        source_.fail(version.offset(), "'version' must be the number 1, got " + json::describe(version));
    if (version.number() != 1)
        source_.fail(version.offset(), "scenes of version " + json::describe(version) +
                                           " are not known to this program, which reads version 1");
}

void NativeLoader::read_film(Value value) {
    RenderSettings& settings = context_.loaded.settings;
    ObjectReader film(source_, value, kFilmSpec, "'film'");
    read_resolution(film, settings);
    if (const auto filter = film.find("filter")) settings.filter = read_filter(source_, *filter);
    if (const auto crop = film.find("crop")) {
        static constexpr size_t kFour[] = {4};
        json::expect_array(source_, *crop, "'crop'", kFour);
        uint32_t edges[4];
        int i = 0;
        for (const Value edge : crop->elements()) {
            const uint32_t limit = i % 2 == 0 ? settings.width : settings.height;
            edges[i++] = static_cast<uint32_t>(json::read_integer(source_, edge, "an edge of 'crop'", 0, limit));
        }
        settings.crop = Crop{edges[0], edges[1], edges[2], edges[3]};
        if (edges[0] >= edges[2] || edges[1] >= edges[3])
            source_.fail(crop->offset(), "'crop' has no pixels",
                         "it is [x0, y0, x1, y1] from the top left corner, with x0 < x1 and y0 < y1");
    }
    if (const auto aovs = film.find("aovs")) settings.aovs = read_aovs(*aovs);
    film.finish();
}

/// A list of names, or "all".
AovSet NativeLoader::read_aovs(Value value) const {
    static constexpr std::string_view kAll[] = {"all"};
    if (value.is(Kind::string)) {
        json::read_choice(source_, value, "'aovs'", kAll);
        return AovSet::all();
    }
    json::expect_array(source_, value, "'aovs'", {});
    AovSet out;
    for (const Value name : value.elements())
        out.add(static_cast<Aov>(json::read_choice(source_, name, "an element of 'aovs'", names_of<Aov>())));
    return out;
}

void NativeLoader::read_cameras(ObjectReader& reader) {
    const auto one = reader.find("camera");
    const auto many = reader.find("cameras");
    if (one && many) source_.fail(reader.key_offset("cameras"), "a scene has either 'camera' or 'cameras', not both");
    if (!one && !many)
        source_.fail(reader.offset(), "missing key 'camera' in the scene",
                     "\"camera\": {\"position\": [0, 1, 5], \"look_at\": [0, 1, 0]}");
    if (one) return read_camera(*one, "camera");
    if (!many->is(Kind::object) || many->size() == 0)
        source_.fail(many->offset(),
                     "'cameras' must be an object with a camera for each name, got " + json::describe(*many));
    for (const Member member : many->members()) read_camera(member.value, std::string(member.key));
}

namespace {

void read_kind(ObjectReader& reader, PerspectiveCamera& camera) {
    camera.vertical_fov = reader.number_or("vertical_fov", camera.vertical_fov, kFieldOfView);
    camera.aperture_radius = reader.number_or("aperture_radius", 0, Range{0, json::kMaxLength});
    // What shapes a lens has no effect on a pinhole: asked for only there, so that finish() says so.
    if (!(camera.aperture_radius > 0)) return;
    if (reader.find("focus_distance")) camera.focus_distance = reader.number("focus_distance", json::kLength);
    if (const auto blades = reader.find("aperture_blades"))
        camera.aperture_blades = static_cast<uint32_t>(
            json::read_integer(reader.source(), *blades, "'aperture_blades'", kMinApertureBlades, kMaxApertureBlades));
    if (camera.aperture_blades > 0)
        camera.aperture_rotation = reader.number_or("aperture_rotation", 0, json::kAnyAngle);
}
void read_kind(ObjectReader& reader, OrthographicCamera& camera) {
    camera.height = reader.number_or("height", camera.height, json::kLength);
}
void read_kind(ObjectReader&, PanoramaCamera&) {}
void read_kind(ObjectReader& reader, FisheyeCamera& camera) {
    camera.fov = reader.number_or("fov", camera.fov, Range{0, 360, true, false});
    camera.projection = static_cast<FisheyeProjection>(reader.choice_or("projection", 0, kFisheyeProjections));
}

template <class C>
C read_camera_of(ObjectReader& reader) {
    C camera;
    camera.position = reader.vec3("position");
    camera.look_at = reader.vec3("look_at");
    camera.up = reader.vec3_or("up", camera.up);
    read_kind(reader, camera);
    check_camera(reader, camera.position, camera.look_at, camera.up, "up");
    reader.finish();
    return camera;
}

/// The value of "type" as an index into kCameraTypes, 0 where it is missing.
size_t camera_type(const Source& source, Value camera) {
    if (!camera.is(Kind::object)) return 0;
    for (const Member member : camera.members())
        if (member.key == "type") return json::read_choice(source, member.value, "'type'", kCameraTypes);
    return 0;
}

}  // namespace

void NativeLoader::read_camera(Value value, std::string name) {
    const Assets::Here here(assets_, value.offset());
    const size_t type = camera_type(source_, value);
    ObjectReader reader(source_, value, kCameraSpecs[type], "the camera");
    reader.find("type");
    const auto add = [&](const Camera& camera) { assets_.add_camera(camera, std::move(name)); };
    if (type == 0) return add(read_camera_of<PerspectiveCamera>(reader));
    if (type == 1) return add(read_camera_of<OrthographicCamera>(reader));
    if (type == 2) return add(read_camera_of<PanoramaCamera>(reader));
    add(read_camera_of<FisheyeCamera>(reader));
}

void NativeLoader::read_render(Value value) {
    RenderSettings& settings = context_.loaded.settings;
    ObjectReader render(source_, value, kRenderSpec, "'render'");
    settings.integrator = static_cast<IntegratorKind>(
        render.choice_or("integrator", static_cast<size_t>(settings.integrator), names_of<IntegratorKind>()));
    settings.light_sampling =
        static_cast<LightSampling>(render.choice_or("light_sampling", 0, names_of<LightSampling>()));
    settings.light_choice = static_cast<LightChoice>(render.choice_or("light_choice", 0, names_of<LightChoice>()));
    settings.roulette_depth =
        static_cast<uint32_t>(render.integer_or("roulette_depth", settings.roulette_depth, 0, kMaxDepth));
    settings.clamp = render.number_or("clamp", settings.clamp, Range{0, kMaxClamp});
    settings.ao_distance = render.number_or("ao_distance", settings.ao_distance, Range{0, kMaxAoDistance});
    settings.max_depth = static_cast<uint32_t>(render.integer_or("max_depth", settings.max_depth, 0, kMaxDepth));
    if (render.find("target_error")) {
        settings.target_error = render.number("target_error", Range{kMinTargetError, kMaxTargetError});
        settings.samples_per_pixel = kDefaultMostSamples;
    }
    settings.samples_per_pixel = render.integer_or("spp", settings.samples_per_pixel, 1, kMaxSamplesPerPixel);
    settings.sampler = static_cast<SamplerKind>(render.choice_or("sampler", 0, names_of<SamplerKind>()));
    settings.seed = render.integer_or("seed", settings.seed, 0, UINT64_MAX);
    if (const auto camera = render.find("camera")) {
        const auto& names = scene().names.cameras;
        const std::vector<std::string_view> choices(names.begin(), names.end());
        settings.camera = static_cast<uint32_t>(json::read_choice(source_, *camera, "'camera'", choices));
    }
    render.finish();
}

void load_native(const Context& context, Value root) { NativeLoader(context).load(root); }

}  // namespace steradian::scene_json
