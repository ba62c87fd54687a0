#include <numbers>

#include "formats/scene_json/native.h"
#include "math/elementary.h"
#include "scene/intensity_profile.h"

namespace steradian::scene_json {
namespace {

Vec3 read_direction(ObjectReader& reader, std::string_view key) {
    const Vec3 direction = reader.vec3(key);
    if (!(length(Vec3d(direction)) >= json::kMinLength))
        reader.source().fail(reader.find(key)->offset(), quoted(key) + " must not be the zero vector");
    return direction;
}

/// "direction", or "look_at" as seen from the position: one of the two.
Vec3 read_aim(ObjectReader& reader, Vec3 position) {
    const Source& source = reader.source();
    const auto look_at = reader.find("look_at");
    if (look_at && reader.find("direction"))
        source.fail(reader.key_offset("look_at"), "a light has either 'direction' or 'look_at', not both");
    if (!look_at && !reader.find("direction"))
        source.fail(reader.offset(), "missing key 'direction' in the light",
                    "or give 'look_at', the point that it is aimed at");
    if (!look_at) return read_direction(reader, "direction");
    const Vec3d way = Vec3d(reader.vec3("look_at")) - Vec3d(position);
    if (!(length(way) > 0))
        source.fail(look_at->offset(), "'look_at' is equal to 'position': there is no direction to shine in");
    return Vec3(normalize(way));
}

double square(double x) { return x * x; }

}  // namespace

void NativeLoader::read_lights(Value value) {
    json::expect_array(source_, value, "'lights'");
    for (const Value light : value.elements()) {
        const Assets::Here here(assets_, light.offset());
        switch (read_type(source_, light, "a light", kLightTypes)) {
            case 0:
                read_point_light(light);
                break;
            case 1:
                read_spot_light(light);
                break;
            case 2:
                read_directional_light(light);
                break;
            case 3:
                read_area_light(light);
                break;
            case 4:
                read_environment_light(light);
                break;
            default:
                read_goniometric_light(light);
                break;
        }
    }
}

Rgb NativeLoader::read_intensity(ObjectReader& reader, double per_flux) const {
    const bool has_flux = reader.find("flux").has_value();
    if (has_flux && reader.find("intensity"))
        source_.fail(reader.key_offset("flux"), "a light has either 'intensity' or 'flux', not both");
    if (!has_flux && !reader.find("intensity"))
        source_.fail(reader.offset(), "missing key 'intensity' in the light", "or give 'flux', its power in watts");
    if (!has_flux) return reader.color("intensity", json::kEnergy);
    const Rgb flux = reader.color("flux", json::kEnergy);
    const Rgb intensity{static_cast<float>(flux.r * per_flux), static_cast<float>(flux.g * per_flux),
                        static_cast<float>(flux.b * per_flux)};
    if (!is_finite(intensity))
        source_.fail(reader.find("flux")->offset(), "'flux' is too large for a cone this narrow");
    return intensity;
}

void NativeLoader::read_point_light(Value value) {
    ObjectReader reader(source_, value, kLightSpecs[0], "this point light");
    reader.require("type");
    const std::string name(reader.string_or("name", {}));
    PointLight light;
    light.position = reader.vec3("position");
    light.intensity = read_intensity(reader, kInverseSphere);
    reader.finish();
    assets_.add_light(light, name);
}

void NativeLoader::read_spot_light(Value value) {
    static constexpr Range kOuterAngle{1e-3, 180};
    ObjectReader reader(source_, value, kLightSpecs[1], "this spot light");
    reader.require("type");
    const std::string name(reader.string_or("name", {}));
    SpotLight light;
    light.position = reader.vec3("position");
    light.direction = read_aim(reader, light.position);
    light.outer_angle = reader.number_or("outer_angle", light.outer_angle, kOuterAngle);
    light.inner_angle = reader.number_or("inner_angle", light.outer_angle * (2.0f / 3.0f), Range{0, light.outer_angle});
    // The smoothstep between the cosines has mean 1/2, so the flux is 2π I (1 − (cos inner + cos outer) / 2).
    const double half_degree = std::numbers::pi / 360;
    const double cap =
        square(math::sin(light.inner_angle * half_degree)) + square(math::sin(light.outer_angle * half_degree));
    light.intensity = read_intensity(reader, 1 / (2 * std::numbers::pi * cap));
    reader.finish();
    assets_.add_light(light, name);
}

void NativeLoader::read_directional_light(Value value) {
    ObjectReader reader(source_, value, kLightSpecs[2], "this directional light");
    reader.require("type");
    const std::string name(reader.string_or("name", {}));
    DirectionalLight light;
    light.direction = read_direction(reader, "direction");
    light.irradiance = reader.color("irradiance", json::kEnergy);
    if (reader.find("angular_diameter"))
        light.angular_diameter =
            reader.number_or("angular_diameter", 0, Range{kMinAngularDiameter, kMaxAngularDiameter});
    light.visible_to_camera = reader.boolean_or("visible_to_camera", true);
    if (light.angular_diameter == 0 && reader.find("visible_to_camera"))
        source_.fail(reader.key_offset("visible_to_camera"),
                     "'visible_to_camera' is of no use without 'angular_diameter': there is nothing to see");
    reader.finish();
    assets_.add_light(light, name);
}

void NativeLoader::read_area_light(Value value) {
    ObjectReader reader(source_, value, kLightSpecs[3], "this area light");
    reader.require("type");
    const std::string name(reader.string_or("name", {}));
    const Value object = reader.require("object");
    NamedObject target = objects_.get(source_, json::read_string(source_, object, "'object'"), object.offset());
    if (target.emits) source_.fail(object.offset(), "the object " + quoted(object.string()) + " is a light already");
    if (target.instances.count == 0) source_.fail(object.offset(), "a model without faces cannot be a light");
    const Emission emission = read_emission(reader);
    reader.finish();
    make_emitters(target.instances, emission, name);
    target.emits = true;
    objects_.replace(object.string(), target);
}

void NativeLoader::read_environment_light(Value value) {
    ObjectReader reader(source_, value, kLightSpecs[4], "this environment light");
    reader.require("type");
    if (has_environment_) source_.fail(value.offset(), "the scene has an environment already, it can have one");
    has_environment_ = true;
    const std::string name(reader.string_or("name", {}));
    if (!reader.find("radiance") && !reader.find("path"))
        source_.fail(reader.offset(), "missing key 'radiance' in the environment light",
                     "or give the 'path' of an image");
    EnvironmentLight light;
    const Rgb radiance = reader.color_or("radiance", {1, 1, 1}, json::kEnergy);
    light.radiance = radiance * reader.number_or("scale", 1, Range{0, 1e8});
    light.samples = static_cast<uint32_t>(reader.integer_or("light_samples", 1, 1, kMaxLightSamples));
    light.visible_to_camera = reader.boolean_or("visible_to_camera", true);
    if (reader.find("path")) {
        const NamedPath path = read_path(reader);
        light.rotation = reader.number_or("rotation", 0, json::kAnyAngle);
        const auto space = reader.find("color_space");
        const size_t chosen = space ? json::read_choice(source_, *space, "'color_space'", kColorSpaces) : 0;
        light.image = source_.take(assets_.image(path.path), path.offset);
        light.color_space = space ? static_cast<ColorSpace>(chosen) : assets_.default_color_space(*light.image);
    }
    reader.finish();
    assets_.add_light(light, name);
}

void NativeLoader::read_goniometric_light(Value value) {
    ObjectReader reader(source_, value, kLightSpecs[5], "this goniometric light");
    reader.require("type");
    const std::string name(reader.string_or("name", {}));
    GoniometricLight light;
    light.position = reader.vec3("position");
    if (reader.find("direction") || reader.find("look_at")) light.direction = read_aim(reader, light.position);
    light.rotation = reader.number_or("rotation", 0, json::kAnyAngle);
    const NamedPath path = read_path(reader);
    light.profile = source_.take(assets_.profile(path.path), path.offset);
    if (reader.find("flux")) {
        const double total = total_flux(scene().profiles[index(light.profile)]);
        if (!(total > 0)) source_.fail(path.offset, "all values of this file are 0: there is no flux to scale");
        light.intensity = read_intensity(reader, 1 / total);
    } else {
        light.intensity = reader.color_or("intensity", {1, 1, 1}, json::kEnergy);
    }
    reader.finish();
    assets_.add_light(light, name);
}

}  // namespace steradian::scene_json
