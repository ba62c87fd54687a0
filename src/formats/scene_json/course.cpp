// The vocabulary of a university course's ray tracing framework: scenes without a "version". Its point light lives in
// the integrator, its environment in "environment_map".
#include <numbers>

#include "formats/scene_json/common.h"
#include "math/elementary.h"
#include "math/transform.h"

namespace steradian::scene_json {
namespace {

using Key = std::string_view;
constexpr Key kSceneKeys[] = {"integrator", "film", "camera", "textures", "materials", "environment_map", "objects"};
constexpr Key kIntegratorKeys[] = {
    "type", "profile", "spp", "rr_threshold", "max_depth", "point_light_position", "point_light_flux"};
constexpr Key kFilmKeys[] = {"resolution", "filter"};
constexpr Key kCameraKeys[] = {"position", "look_at", "ref_up", "fov", "focal_length"};
constexpr Key kConstantKeys[] = {"type", "color"};
constexpr Key kImageKeys[] = {"type", "path", "tex_coordinate_generator"};
constexpr Key kCheckerboardKeys[] = {"type", "color0", "color1", "tex_coordinate_generator"};
constexpr Key kGeneratorKeys[] = {"type", "scale", "delta"};
constexpr Key kDiffuseKeys[] = {"type", "texture_name", "color", "twosided"};
constexpr Key kRefractionKeys[] = {"type", "eta"};
constexpr Key kGlassKeys[] = {"type", "eta", "R", "T"};
constexpr Key kConductorKeys[] = {"type", "alpha_x", "alpha_y", "etaI", "etaT", "k", "R", "texture_name"};
constexpr Key kEnvironmentKeys[] = {"texture_name", "scale", "transform"};
constexpr Key kMeshKeys[] = {"type", "path", "translate", "transform", "material_name", "light"};
constexpr Key kSphereKeys[] = {"type", "path", "center", "radius", "translate", "transform", "material_name", "light"};
constexpr Key kLightKeys[] = {"type", "radiance"};

constexpr json::ObjectSpec kTextureKinds[] = {
    {"constant", kConstantKeys}, {"image", kImageKeys}, {"checkerboard", kCheckerboardKeys}};
constexpr json::ObjectSpec kMaterialKinds[] = {{"diffuse", kDiffuseKeys},
                                               {"refraction", kRefractionKeys},
                                               {"glass", kGlassKeys},
                                               {"roughconductor", kConductorKeys}};
constexpr json::ObjectSpec kObjectKinds[] = {{"mesh", kMeshKeys}, {"sphere", kSphereKeys}};

constexpr Key kIntegratorTypes[] = {"intersection_test", "path", "bdpt", "photon"};
constexpr Key kProfiles[] = {"RandomWalk", "NextEventEstimation", "MIS"};
constexpr LightSampling kSamplingOfProfile[] = {LightSampling::bsdf, LightSampling::light, LightSampling::mis};
constexpr Key kMaterialTypesOfCourse[] = {"diffuse", "refraction", "glass", "roughconductor"};
constexpr Key kObjectTypesOfCourse[] = {"mesh", "sphere"};
constexpr Range kTextureScale{-1e6, 1e6};

class CourseLoader {
public:
    explicit CourseLoader(const Context& context)
        : context_(context), source_(context.source), assets_(context.assets) {}
    void load(Value root);

private:
    void read_integrator(Value value);
    void read_film(Value value);
    void read_camera(Value value);
    TextureId read_texture(Value value, const std::string& name);
    ConductorMaterial read_conductor(ObjectReader& reader, const std::string& what);
    MaterialId read_material(Value value, const std::string& name);
    void read_object(Value value);
    void read_environment(Value value);

    const Context& context_;
    const Source& source_;
    Assets& assets_;
    NameTable<TextureId> textures_{"texture"};
    NameTable<MaterialId> materials_{"material"};
};

void CourseLoader::load(Value root) {
    RenderSettings& settings = context_.loaded.settings;
    settings.filter = {FilterKind::box, 0.5f};
    ObjectReader reader(source_, root, {"scene", kSceneKeys}, "the scene");
    read_integrator(reader.require("integrator"));
    if (const auto film = reader.find("film")) read_film(*film);
    read_camera(reader.require("camera"));
    if (const auto textures = reader.find("textures")) {
        if (!textures->is(Kind::object))
            source_.fail(textures->offset(), "'textures' must be an object, got " + json::describe(*textures));
        for (const Member member : textures->members())
            textures_.insert(member.key, read_texture(member.value, std::string(member.key)));
    }
    if (const auto materials = reader.find("materials")) {
        if (!materials->is(Kind::object))
            source_.fail(materials->offset(), "'materials' must be an object, got " + json::describe(*materials));
        for (const Member member : materials->members())
            materials_.insert(member.key, read_material(member.value, std::string(member.key)));
    }
    if (const auto environment = reader.find("environment_map")) read_environment(*environment);
    if (const auto objects = reader.find("objects")) {
        json::expect_array(source_, *objects, "'objects'");
        for (const Value object : objects->elements()) read_object(object);
    }
    reader.finish();
}

void CourseLoader::read_integrator(Value value) {
    RenderSettings& settings = context_.loaded.settings;
    const Assets::Here here(assets_, value.offset());
    ObjectReader reader(source_, value, {"integrator", kIntegratorKeys}, "'integrator'");
    const Value type = reader.require("type");
    const bool point_light = json::read_choice(source_, type, "the type of the integrator", kIntegratorTypes) == 0;
    settings.max_depth = static_cast<uint32_t>(reader.integer_or("max_depth", settings.max_depth, 0, kMaxDepth));
    settings.samples_per_pixel = reader.integer_or("spp", settings.samples_per_pixel, 1, kMaxSamplesPerPixel);
    settings.integrator = point_light ? IntegratorKind::direct : IntegratorKind::path;
    settings.light_sampling = kSamplingOfProfile[reader.choice_or("profile", 2, kProfiles)];
    reader.number_or("rr_threshold", 0, Range{0, 1e6});  // when a path may end changes the noise only
    if (point_light) {
        PointLight light;
        light.position = reader.vec3("point_light_position");
        const Rgb flux = reader.color("point_light_flux", json::kEnergy);
        for (int c = 0; c < 3; ++c) light.intensity[c] = static_cast<float>(flux[c] * kInverseSphere);
        assets_.add_light(light, "point_light");
    } else {
        if (type.string() != "path")
            context_.warn("the integrator '" + std::string(type.string()) + "' is not there: rendered with 'path'",
                          type.offset());
        for (const Key key : {Key("point_light_position"), Key("point_light_flux")})
            if (reader.find(key))
                context_.warn(quoted(key) + " is for the integrator 'intersection_test' and is ignored",
                              reader.key_offset(key));
    }
    reader.finish();
}

void CourseLoader::read_film(Value value) {
    RenderSettings& settings = context_.loaded.settings;
    ObjectReader film(source_, value, {"film", kFilmKeys}, "'film'");
    read_resolution(film, settings);
    if (const auto filter = film.find("filter")) settings.filter = read_filter(source_, *filter);
    film.finish();
}

void CourseLoader::read_camera(Value value) {
    const Assets::Here here(assets_, value.offset());
    ObjectReader reader(source_, value, {"camera", kCameraKeys}, "'camera'");
    PerspectiveCamera camera;
    camera.position = reader.vec3("position");
    camera.look_at = reader.vec3("look_at");
    camera.up = reader.vec3_or("ref_up", camera.up);
    camera.vertical_fov = reader.number("fov", kFieldOfView);
    reader.number_or("focal_length", 1, json::kLength);  // does not change a pinhole's picture
    check_camera(reader, camera.position, camera.look_at, camera.up, "ref_up");
    reader.finish();
    assets_.add_camera(camera, "camera");
}

/// The course's v runs upwards: v' = v * scale + delta there is 1 - v' here.
template <class T>
void read_generator(ObjectReader& reader, T& texture) {
    const auto value = reader.find("tex_coordinate_generator");
    if (!value) return;
    static constexpr Key kTypes[] = {"uvmapping2d"};
    ObjectReader generator(reader.source(), *value, {"tex_coordinate_generator", kGeneratorKeys},
                           "'tex_coordinate_generator'");
    generator.choice_or("type", 0, kTypes);
    const Vec2 scale = generator.vec2_or("scale", {1, 1}, kTextureScale),
               delta = generator.vec2_or("delta", {0, 0}, kTextureScale);
    generator.finish();
    texture.scale = scale;
    texture.offset = {delta.x, 1 - scale.y - delta.y};
}

TextureId CourseLoader::read_texture(Value value, const std::string& name) {
    const Assets::Here here(assets_, value.offset());
    const std::string what = "texture " + quoted(name);
    const size_t type = read_type(source_, value, what, kTextureTypes);
    ObjectReader reader(source_, value, kTextureKinds[type], what);
    reader.require("type");
    Texture texture;
    if (type == 0) {
        // Also the radiance of an environment, so a value above 1 says nothing yet.
        texture = ConstantTexture{reader.color("color", json::kReflectance)};
    } else if (type == 1) {
        const NamedPath path = read_path(reader);
        ImageTexture image;
        read_generator(reader, image);
        image.image = source_.take(assets_.image(path.path), path.offset);
        image.color_space = assets_.default_color_space(image.image);
        texture = image;
    } else {
        CheckerTexture checker;
        checker.even = reader.color_or("color0", checker.even, json::kReflectance);
        checker.odd = reader.color_or("color1", checker.odd, json::kReflectance);
        read_generator(reader, checker);
        texture = checker;
    }
    reader.finish();
    return assets_.add_texture(texture, name);
}

/// etaT + i k over etaI, and a tint: R, or a constant texture.
ConductorMaterial CourseLoader::read_conductor(ObjectReader& reader, const std::string& what) {
    static constexpr Range kIndex{1e-3, 1e3}, kExtinction{0, 1e3}, kAlpha{0, 1};
    ConductorMaterial out;
    const Rgb outside = reader.color_or("etaI", {1, 1, 1}, kIndex), n = reader.color("etaT", kIndex),
              k = reader.color("k", kExtinction);
    ComplexIndex relative;
    for (int c = 0; c < 3; ++c) relative.n[c] = n[c] / outside[c], relative.k[c] = k[c] / outside[c];
    out.reflectance = relative;
    out.roughness.value.x = reader.number("alpha_x", kAlpha);
    out.roughness.value.y = reader.number("alpha_y", kAlpha);
    out.roughness.squared = false;
    const auto texture = reader.find("texture_name");
    if (texture && reader.find("R"))
        source_.fail(reader.key_offset("R"), what + " has either 'texture_name' or 'R', not both");
    out.tint = reader.color_or("R", out.tint, json::kReflectance);
    if (texture) {
        const TextureId id =
            textures_.get(source_, json::read_string(source_, *texture, "'texture_name'"), texture->offset());
        const auto* constant = std::get_if<ConstantTexture>(&context_.loaded.scene.textures[index(id)]);
        if (!constant) source_.fail(texture->offset(), "the texture of a rough conductor must be constant");
        out.tint = constant->value;
        context_.loaded.locations.consumed.push_back({ElementKind::texture, index(id)});
    }
    context_.warn_about_reflectance(out.tint, reader.offset());
    return out;
}

MaterialId CourseLoader::read_material(Value value, const std::string& name) {
    const Assets::Here here(assets_, value.offset());
    const std::string what = "material " + quoted(name);
    const size_t type = read_type(source_, value, what, kMaterialTypesOfCourse);
    ObjectReader reader(source_, value, kMaterialKinds[type], what);
    reader.require("type");
    Material material;
    if (type == 0) {
        DiffuseMaterial diffuse;
        const auto texture = reader.find("texture_name");
        if (texture && reader.find("color"))
            source_.fail(reader.key_offset("color"), what + " has either 'texture_name' or 'color', not both");
        if (!texture && !reader.find("color")) source_.fail(reader.offset(), "missing key 'texture_name' in " + what);
        diffuse.reflectance =
            texture ? textures_.get(source_, json::read_string(source_, *texture, "'texture_name'"), texture->offset())
                    : assets_.add_texture(ConstantTexture{reader.color("color", json::kReflectance)}, name);
        if (const auto* constant =
                std::get_if<ConstantTexture>(&context_.loaded.scene.textures[index(diffuse.reflectance)]))
            context_.warn_about_reflectance(constant->value, value.offset());
        diffuse.two_sided = reader.boolean_or("twosided", false);
        material = diffuse;
    } else if (type == 1) {
        material = RefractionMaterial{reader.number_or("eta", 1.5f, kEta)};
    } else if (type == 3) {
        material = read_conductor(reader, what);
    } else {
        GlassMaterial glass;
        glass.eta = reader.number_or("eta", 1.5f, kEta);
        glass.reflectance = reader.color_or("R", {1, 1, 1}, json::kReflectance);
        glass.transmittance = reader.color_or("T", {1, 1, 1}, json::kReflectance);
        context_.warn_about_reflectance(glass.reflectance, value.offset());
        context_.warn_about_reflectance(glass.transmittance, value.offset());
        material = glass;
    }
    reader.finish();
    return assets_.add_material(material, name);
}

/// "transform" first, then "translate".
Affine read_placement(ObjectReader& reader) {
    Affine world_from_object;
    if (const auto transform = reader.find("transform"))
        world_from_object = read_transform(reader.source(), *transform);
    const Vec3 t = reader.vec3_or("translate", {0, 0, 0});
    return translation(t.x, t.y, t.z) * world_from_object;
}

void CourseLoader::read_object(Value value) {
    const Assets::Here here(assets_, value.offset());
    const size_t type = read_type(source_, value, "an object", kObjectTypesOfCourse);
    ObjectReader reader(source_, value, kObjectKinds[type], "this " + std::string(kObjectTypesOfCourse[type]));
    reader.require("type");
    Placement placement;
    placement.world_from_object = read_placement(reader);
    if (const auto name = reader.find("material_name"))
        placement.material =
            materials_.get(source_, json::read_string(source_, *name, "'material_name'"), name->offset());
    Rgb radiance;
    if (const auto light = reader.find("light")) {
        static constexpr Key kArea[] = {"area"};
        ObjectReader light_reader(source_, *light, {"light", kLightKeys}, "'light'");
        light_reader.choice_or("type", 0, kArea);
        radiance = light_reader.color("radiance", json::kEnergy);
        light_reader.finish();
        placement.emitter = true;
    }
    InstanceRange range{static_cast<uint32_t>(context_.loaded.scene.instances.size()), 1};
    if (type == 0) {
        const NamedPath path = read_path(reader);
        range = source_.take(assets_.place(source_.take(assets_.load_model(path.path), path.offset), placement),
                             path.offset);
    } else {
        reader.find("path");  // left over in some scenes; a sphere has no file
        Sphere sphere;
        sphere.center = reader.vec3("center");
        sphere.radius = reader.number("radius", json::kLength);
        const MaterialId material =
            placement.material ? *placement.material : assets_.default_material(placement.emitter);
        assets_.add_instance({assets_.add_shape(sphere, ""), material, placement.world_from_object}, "");
    }
    reader.finish();
    if (!placement.emitter) return;
    if (range.count == 0) source_.fail(reader.key_offset("light"), "a model without faces cannot be a light");
    for (uint32_t i = 0; i < range.count; ++i)
        assets_.add_light(AreaLight{InstanceId(range.first + i), radiance, false, 1}, "");
}

/// The angle of a rotation about +Y in degrees; fails for any other transform.
float rotation_about_y(const Source& source, Value value) {
    const Affine a = read_transform(source, value);
    const double c = a.m[0][0], s = a.m[0][2];
    const Affine wanted{{{{c, 0, s, 0}, {0, 1, 0, 0}, {-s, 0, c, 0}}}};
    bool same = std::fabs(c * c + s * s - 1) <= 1e-6;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            same = same && std::fabs(a.m[row][column] - wanted.m[row][column]) <= 1e-6;
    if (!same)
        source.fail(value.offset(), "the 'transform' of an environment must be a rotation about the y axis",
                    "other rotations, scales and translations are not supported");
    return static_cast<float>(math::atan2(s, c) * (180 / std::numbers::pi));
}

void CourseLoader::read_environment(Value value) {
    const Assets::Here here(assets_, value.offset());
    ObjectReader reader(source_, value, {"environment_map", kEnvironmentKeys}, "'environment_map'");
    const Value name = reader.require("texture_name");
    const TextureId id = textures_.get(source_, json::read_string(source_, name, "'texture_name'"), name.offset());
    context_.loaded.locations.consumed.push_back({ElementKind::texture, index(id)});
    EnvironmentLight light;
    light.radiance = reader.color_or("scale", {1, 1, 1}, Range{0, 1e8});
    if (const auto transform = reader.find("transform")) light.rotation = rotation_about_y(source_, *transform);
    const Texture& texture = context_.loaded.scene.textures[index(id)];
    if (const auto* constant = std::get_if<ConstantTexture>(&texture)) {
        light.radiance = light.radiance * constant->value;
        light.rotation = 0;
    } else if (const auto* image = std::get_if<ImageTexture>(&texture)) {
        if (image->scale != Vec2{1, 1} || image->offset != Vec2{0, 0})
            source_.fail(name.offset(),
                         "the texture of an environment must not have a 'tex_coordinate_generator' that moves it");
        light.image = image->image;
        light.color_space = image->color_space;
    } else {
        source_.fail(name.offset(), "the texture of an environment must be constant or an image");
    }
    reader.finish();
    assets_.add_light(light, "environment_map");
}

}  // namespace

void load_course(const Context& context, Value root) { CourseLoader(context).load(root); }

}  // namespace steradian::scene_json
