// Vectors, colours and affine transforms as plain values.
#pragma once

#include <array>

namespace steradian {

struct Vec2 {
    float x = 0, y = 0;
    bool operator==(const Vec2&) const = default;
};

/// A point, direction or normal; metres where it is a length. Right-handed, +Y up.
struct Vec3 {
    float x = 0, y = 0, z = 0;

    constexpr float operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
    constexpr float& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
    bool operator==(const Vec3&) const = default;
};

constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Vec3 operator*(Vec3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
constexpr Vec3 operator*(float s, Vec3 a) { return a * s; }
constexpr Vec3 operator/(Vec3 a, float s) { return {a.x / s, a.y / s, a.z / s}; }
constexpr float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

/// Linear Rec. 709 values: radiance in W/(m² sr), reflectance in [0, 1], or whatever the name says.
struct Rgb {
    float r = 0, g = 0, b = 0;

    constexpr float operator[](int channel) const { return channel == 0 ? r : channel == 1 ? g : b; }
    constexpr float& operator[](int channel) { return channel == 0 ? r : channel == 1 ? g : b; }
    bool operator==(const Rgb&) const = default;
};

constexpr Rgb operator+(Rgb a, Rgb b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
constexpr Rgb operator*(Rgb a, Rgb b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
constexpr Rgb operator*(Rgb a, float s) { return {a.r * s, a.g * s, a.b * s}; }
constexpr Rgb operator*(float s, Rgb a) { return a * s; }
constexpr Rgb operator/(Rgb a, float s) { return {a.r / s, a.g / s, a.b / s}; }
constexpr bool is_black(Rgb c) { return c.r == 0 && c.g == 0 && c.b == 0; }
/// Y of linear Rec. 709.
constexpr float luminance(Rgb c) { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b; }

/// x' = M x + t, stored row by row as 3 × 4, in double so that chains of transforms round once, at their end.
/// Named destination-from-source: `world_from_object`.
struct Affine {
    std::array<std::array<double, 4>, 3> m{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    bool operator==(const Affine&) const = default;
};

/// `a * b` applies b first: world_from_object = world_from_parent * parent_from_object.
Affine operator*(const Affine& a, const Affine& b);
Affine translation(double x, double y, double z);
Affine scaling(double x, double y, double z);
/// Counter-clockwise about `axis` (need not be unit length, must not be zero) seen from its tip.
Affine rotation_degrees(double angle, std::array<double, 3> axis);

}  // namespace steradian
