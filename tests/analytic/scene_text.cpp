#include "analytic/scene_text.h"

#include <array>
#include <charconv>

namespace steradian::analytic {
namespace {

template <class Range, class Text>
std::string joined(const Range& range, std::string_view separator, Text text) {
    std::string out;
    for (const auto& element : range) {
        if (!out.empty()) out += separator;
        out += text(element);
    }
    return out;
}

std::string bracketed(char open, std::string_view content, char close) {
    std::string out(1, open);
    out += content;
    out += close;
    return out;
}

template <class Range, class Text>
std::string array_of(const Range& range, Text text) {
    return bracketed('[', joined(range, ", ", text), ']');
}

/// One element a line.
std::string lines(const std::vector<std::string>& elements) {
    std::string out = "[";
    for (size_t i = 0; i < elements.size(); ++i) {
        out += i == 0 ? "\n    " : ",\n    ";
        out += elements[i];
    }
    out += elements.empty() ? "]" : "\n  ]";
    return out;
}

}  // namespace

std::string text_of(double value) {
    std::array<char, 32> buffer;
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return {buffer.data(), end.ptr};
}

std::string text_of(V3 v) {
    return array_of(std::array{v.x, v.y, v.z}, [](double x) { return text_of(x); });
}
std::string text_of(Color c) { return text_of(V3{c.r, c.g, c.b}); }
std::string quoted(std::string_view s) { return bracketed('"', s, '"'); }

Object& Object::raw(std::string_view key, std::string json) {
    members_.emplace_back(key, std::move(json));
    return *this;
}

std::string Object::str() const {
    return bracketed('{', joined(members_, ", ", [](const auto& m) { return quoted(m.first) + ": " + m.second; }), '}');
}

SceneText& SceneText::look(V3 from, V3 at, double vertical_fov, V3 up) {
    camera_ = Object().set("position", from).set("look_at", at).set("up", up).set("vertical_fov", vertical_fov).str();
    return *this;
}

SceneText& SceneText::camera(const Object& value) {
    camera_ = value.str();
    return *this;
}

SceneText& SceneText::size(int width, int height) {
    width_ = width;
    height_ = height;
    return *this;
}

SceneText& SceneText::depth(int bounces) {
    depth_ = bounces;
    return *this;
}

SceneText& SceneText::integrator(std::string_view name) {
    integrator_ = name;
    return *this;
}

SceneText& SceneText::light_sampling(std::string_view name) {
    light_sampling_ = name;
    return *this;
}

SceneText& SceneText::samples(int per_pixel) {
    samples_ = per_pixel;
    return *this;
}

SceneText& SceneText::filter(std::string_view type, double radius) {
    filter_ = Object(type).set("radius", radius);
    return *this;
}

SceneText& SceneText::texture(std::string_view name, const Object& value) {
    textures_.set(name, value);
    return *this;
}

SceneText& SceneText::material(std::string_view name, const Object& value) {
    materials_.set(name, value);
    return *this;
}

SceneText& SceneText::shape(std::string_view name, const Object& value) {
    shapes_.set(name, value);
    return *this;
}

SceneText& SceneText::object(const Object& value) {
    objects_.push_back(value.str());
    return *this;
}

SceneText& SceneText::light(const Object& value) {
    lights_.push_back(value.str());
    return *this;
}

std::string SceneText::str() const {
    Object render = Object().set("integrator", integrator_).set("max_depth", depth_).set("spp", samples_);
    if (light_sampling_ != "mis") render.set("light_sampling", light_sampling_);
    const Object film =
        Object()
            .raw("resolution", array_of(std::array{width_, height_}, [](int n) { return std::to_string(n); }))
            .set("filter", filter_);
    std::string out = "{\n  \"version\": 1";
    const auto add = [&](std::string_view key, std::string_view value) {
        out += ",\n  ";
        out += quoted(key);
        out += ": ";
        out += value;
    };
    add("render", render.str());
    add("film", film.str());
    add("camera", camera_);
    if (!textures_.empty()) add("textures", textures_.str());
    if (!materials_.empty()) add("materials", materials_.str());
    if (!shapes_.empty()) add("shapes", shapes_.str());
    if (!objects_.empty()) add("objects", lines(objects_));
    if (!lights_.empty()) add("lights", lines(lights_));
    out += "\n}\n";
    return out;
}

Object diffuse(Color reflectance, bool two_sided) {
    return Object("diffuse").set("reflectance", reflectance).set("two_sided", two_sided);
}
Object mirror(Color reflectance) { return Object("mirror").set("reflectance", reflectance); }
Object glass(double eta) { return Object("glass").set("eta", eta); }
Object refraction(double eta) { return Object("refraction").set("eta", eta); }
Object emission(Color radiance, bool two_sided) {
    return Object().set("radiance", radiance).set("two_sided", two_sided);
}

Object rectangle(V3 center, V3 half_u, V3 half_v, std::string_view material) {
    return Object("rectangle")
        .set("center", center)
        .set("half_u", half_u)
        .set("half_v", half_v)
        .set("material", material);
}
Object ceiling(V3 center, double half_x, double half_z, std::string_view material) {
    return rectangle(center, {half_x, 0, 0}, {0, 0, half_z}, material);
}
Object ground(V3 center, double half_x, double half_z, std::string_view material) {
    return rectangle(center, {half_x, 0, 0}, {0, 0, -half_z}, material);
}
Object sphere(V3 center, double radius, std::string_view material) {
    return Object("sphere").set("center", center).set("radius", radius).set("material", material);
}
Object disk(V3 center, V3 normal, double radius, std::string_view material) {
    return Object("disk").set("center", center).set("normal", normal).set("radius", radius).set("material", material);
}
Object mesh(const std::vector<V3>& vertices, const std::vector<std::vector<int>>& triangles,
            std::string_view material) {
    Object out("mesh");
    out.raw("vertices", array_of(vertices, [](V3 v) { return text_of(v); }));
    out.raw("triangles",
            array_of(triangles, [](const auto& t) { return array_of(t, [](int i) { return std::to_string(i); }); }));
    if (!material.empty()) out.set("material", material);
    return out;
}
Object polygon(const std::vector<V3>& vertices, std::string_view material) {
    std::vector<std::vector<int>> fan;
    for (int i = 2; i < static_cast<int>(vertices.size()); ++i) fan.push_back({0, i - 1, i});
    return mesh(vertices, fan, material);
}

Object point_light(V3 position, Color intensity) {
    return Object("point").set("position", position).set("intensity", intensity);
}
Object spot_light(V3 position, V3 direction, Color intensity, double inner, double outer) {
    return Object("spot")
        .set("position", position)
        .set("direction", direction)
        .set("intensity", intensity)
        .set("inner_angle", inner)
        .set("outer_angle", outer);
}
Object directional_light(V3 direction, Color irradiance) {
    return Object("directional").set("direction", direction).set("irradiance", irradiance);
}
Object environment(Color radiance) { return Object("environment").set("radiance", radiance); }

Object translate(V3 by) { return Object().set("translate", by); }
Object rotate(V3 axis, double angle) { return Object().set("rotate", Object().set("axis", axis).set("angle", angle)); }
Object scale(V3 by) { return Object().set("scale", by); }
std::string steps(const std::vector<Object>& list) {
    return array_of(list, [](const Object& o) { return o.str(); });
}

}  // namespace steradian::analytic
