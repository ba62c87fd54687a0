// Writes scene files in Steradian's own format (docs/scene-format.md), piece by piece.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analytic/formulas.h"

namespace steradian::analytic {

/// Shortest text that reads back as the same double.
std::string text_of(double value);
std::string text_of(V3 v);
std::string text_of(Color c);
std::string quoted(std::string_view s);

/// A JSON object, key by key.
class Object {
public:
    Object() = default;
    explicit Object(std::string_view type) { set("type", type); }

    Object& set(std::string_view key, double value) { return raw(key, text_of(value)); }
    Object& set(std::string_view key, int value) { return raw(key, std::to_string(value)); }
    Object& set(std::string_view key, bool value) { return raw(key, value ? "true" : "false"); }
    Object& set(std::string_view key, V3 value) { return raw(key, text_of(value)); }
    Object& set(std::string_view key, Color value) { return raw(key, text_of(value)); }
    Object& set(std::string_view key, const char* value) { return raw(key, quoted(value)); }
    Object& set(std::string_view key, std::string_view value) { return raw(key, quoted(value)); }
    Object& set(std::string_view key, const Object& value) { return raw(key, value.str()); }
    Object& raw(std::string_view key, std::string json);

    bool empty() const { return members_.empty(); }
    std::string str() const;

private:
    std::vector<std::pair<std::string, std::string>> members_;
};

/// A scene file. Without further words: 8 × 8 pixels through a box filter, 16 samples, depth 1.
class SceneText {
public:
    SceneText& look(V3 from, V3 at, double vertical_fov, V3 up = {0, 1, 0});
    /// A camera of another kind.
    SceneText& camera(const Object& value);
    SceneText& size(int width, int height);
    SceneText& depth(int bounces);
    /// `direct` where nothing is said.
    SceneText& integrator(std::string_view name);
    SceneText& light_sampling(std::string_view name);
    SceneText& samples(int per_pixel);
    SceneText& filter(std::string_view type, double radius);
    SceneText& texture(std::string_view name, const Object& value);
    SceneText& material(std::string_view name, const Object& value);
    SceneText& shape(std::string_view name, const Object& value);
    SceneText& object(const Object& value);
    SceneText& light(const Object& value);

    std::string str() const;

private:
    std::string camera_;
    int width_ = 8, height_ = 8, depth_ = 1, samples_ = 16;
    std::string integrator_ = "direct", light_sampling_ = "mis";
    Object filter_ = Object("box").set("radius", 0.5);
    Object textures_, materials_, shapes_;
    std::vector<std::string> objects_, lights_;
};

// --- Pieces that many scenes share -----------------------------------------------------------------------------

Object diffuse(Color reflectance, bool two_sided = false);
Object mirror(Color reflectance = 1.0);
Object glass(double eta);
Object refraction(double eta);
/// For the key "light" of an object.
Object emission(Color radiance, bool two_sided = false);

Object rectangle(V3 center, V3 half_u, V3 half_v, std::string_view material);
/// Parallel to the floor; the normal points down (or up).
Object ceiling(V3 center, double half_x, double half_z, std::string_view material);
Object ground(V3 center, double half_x, double half_z, std::string_view material);
Object sphere(V3 center, double radius, std::string_view material);
Object disk(V3 center, V3 normal, double radius, std::string_view material);
Object mesh(const std::vector<V3>& vertices, const std::vector<std::vector<int>>& triangles, std::string_view material);
/// One convex planar polygon as a fan; the normal follows from the order of the vertices (counter-clockwise outside).
Object polygon(const std::vector<V3>& vertices, std::string_view material);

Object point_light(V3 position, Color intensity);
Object spot_light(V3 position, V3 direction, Color intensity, double inner, double outer);
Object directional_light(V3 direction, Color irradiance);
Object environment(Color radiance);

/// One step of a transform.
Object translate(V3 by);
Object rotate(V3 axis, double angle);
Object scale(V3 by);
/// A list of steps, the first one applied first.
std::string steps(const std::vector<Object>& list);

}  // namespace steradian::analytic
