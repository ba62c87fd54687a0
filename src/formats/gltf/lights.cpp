#include <array>
#include <numbers>

#include "formats/gltf/nodes.h"
#include "math/transform.h"
#include "math/vector.h"

namespace steradian::gltf {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr Vec3 kForward{0, 0, -1};

SpotLight read_spot(Context& context, const Object& light, Rgb intensity) {
    const Object spot(context.source, light.require("spot"), "'spot'");
    constexpr double kRightAngle = std::numbers::pi / 2;
    SpotLight out;
    out.intensity = intensity;
    const double outer = spot.number_or("outerConeAngle", std::numbers::pi / 4, {0, kRightAngle, true});
    const double inner = spot.number_or("innerConeAngle", 0, {0, kRightAngle});
    if (inner > outer) context.warn("the inner cone of a spot is wider than the outer one", spot.offset());
    out.outer_angle = static_cast<float>(outer * kDegrees);
    out.inner_angle = static_cast<float>(min_of(inner, outer) * kDegrees);
    out.falloff = SpotFalloff::squared;
    return out;
}

}  // namespace

Light read_light(Context& context, const Object& light) {
    static constexpr std::array<std::string_view, 3> kTypes{"point", "spot", "directional"};
    const size_t type = json::read_choice(context.source, light.require("type"), "'type'", kTypes);
    const Rgb color = light.color_or("color", {1, 1, 1}, {0, 1e15});
    if (max_component(color) > 1)
        context.warn("'color' of a light must be between 0 and 1; it is taken as it is", light.offset_of("color"),
                     "out-of-range");
    // Candela and lux are taken as W/sr and W/m²; an exporter that had watts has multiplied them.
    constexpr double kLumensPerWatt = 683;
    const double unit = context.options.gltf_light_units == GltfLightUnits::photometric ? 1 / kLumensPerWatt : 1;
    const Rgb intensity = color * static_cast<float>(unit * light.number_or("intensity", 1, {0, 1e15}));
    if (light.has("range"))
        context.not_honoured("the 'range' of lights has no effect: light falls off with the square of the distance",
                             light.offset_of("range"));
    if (type == 0) return PointLight{{0, 0, 0}, intensity};
    if (type == 2) return DirectionalLight{kForward, intensity};
    return read_spot(context, light, intensity);
}

Light placed(Light light, const Affine& world_from_node) {
    const Vec3 position(transform_point(world_from_node, Vec3{0, 0, 0}));
    Vec3 direction(normalize(transform_vector(world_from_node, kForward)));
    if (direction == Vec3{}) direction = kForward;
    if (auto* point = std::get_if<PointLight>(&light)) point->position = position;
    if (auto* sun = std::get_if<DirectionalLight>(&light)) sun->direction = direction;
    if (auto* spot = std::get_if<SpotLight>(&light)) spot->position = position, spot->direction = direction;
    return light;
}

}  // namespace steradian::gltf
