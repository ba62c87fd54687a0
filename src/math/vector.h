// What computing needs beyond the public vector types.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "math/fp_contract.h"
#include "steradian/vec.h"

namespace steradian {

inline constexpr float kPi = 3.14159265358979323846f;
inline constexpr float kInvPi = 0.31830988618379067154f;
/// The largest float below 1.
inline constexpr float kOneMinusEpsilon = 0x1.fffffep-1f;
inline constexpr float kInfinity = __builtin_huge_valf();

/// Unlike std::min and std::fmin, the same on every machine when an argument is NaN: b unless a is smaller (larger).
template <class T>
constexpr T min_of(T a, T b) {
    return a < b ? a : b;
}
template <class T>
constexpr T max_of(T a, T b) {
    return a > b ? a : b;
}
/// NaN gives lo.
template <class T>
constexpr T clamp_to(T x, T lo, T hi) {
    return !(x > lo) ? lo : x > hi ? hi : x;
}

inline bool is_finite(float x) { return std::isfinite(x); }
inline bool is_finite(Vec3 v) { return is_finite(v.x) && is_finite(v.y) && is_finite(v.z); }
inline bool is_finite(Rgb c) { return is_finite(c.r) && is_finite(c.g) && is_finite(c.b); }

inline float length_squared(Vec3 v) { return dot(v, v); }
inline float length(Vec3 v) { return std::sqrt(dot(v, v)); }
inline float distance(Vec3 a, Vec3 b) { return length(a - b); }
/// In double inside, so that neither huge nor tiny vectors overflow or vanish. Zero stays zero.
inline Vec3 normalize(Vec3 v) {
    const double x = v.x, y = v.y, z = v.z;
    const double l = std::sqrt(x * x + y * y + z * z);
    if (!(l > 0)) return {0, 0, 0};
    return {static_cast<float>(x / l), static_cast<float>(y / l), static_cast<float>(z / l)};
}
inline Vec3 abs(Vec3 v) { return {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}; }
inline float max_component(Vec3 v) { return max_of(v.x, max_of(v.y, v.z)); }
inline float max_component(Rgb c) { return max_of(c.r, max_of(c.g, c.b)); }

/// Double precision vectors, for the few places where a float result needs a better intermediate.
struct Vec3d {
    double x = 0, y = 0, z = 0;
    constexpr Vec3d() = default;
    constexpr Vec3d(double x_, double y_, double z_) : x(x_), y(y_), z(z_) {}
    constexpr Vec3d(Vec3 v) : x(v.x), y(v.y), z(v.z) {}
    constexpr double operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
    explicit operator Vec3() const { return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)}; }
};
constexpr Vec3d operator-(Vec3d a) { return {-a.x, -a.y, -a.z}; }
constexpr Vec3d operator+(Vec3d a, Vec3d b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Vec3d operator-(Vec3d a, Vec3d b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Vec3d operator*(Vec3d a, double s) { return {a.x * s, a.y * s, a.z * s}; }
constexpr double dot(Vec3d a, Vec3d b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3d cross(Vec3d a, Vec3d b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vec3d v) { return std::sqrt(dot(v, v)); }
inline Vec3d normalize(Vec3d v) {
    const double l = length(v);
    return l > 0 ? v * (1 / l) : Vec3d{};
}

/// An orthonormal basis whose z is a given unit vector (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
struct Frame {
    Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

    static Frame from_z(Vec3 n) {
        const float sign = std::copysign(1.0f, n.z);
        const float a = -1.0f / (sign + n.z);
        const float b = n.x * n.y * a;
        return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
    }
    /// With x as near to `towards` as can be; any basis where that is along n, zero or not finite.
    static Frame from_zx(Vec3 n, Vec3 towards) {
        const Vec3 x = normalize(towards - n * dot(towards, n));
        const Vec3 y = cross(n, x);
        return is_finite(x) && length_squared(y) > 0.5f ? Frame{x, y, n} : from_z(n);
    }
    Vec3 to_local(Vec3 v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
    Vec3 to_world(Vec3 v) const { return x * v.x + y * v.y + z * v.z; }
};

/// The same in double.
struct Frame3d {
    Vec3d x, y, z;

    static Frame3d from_z(Vec3d n) {
        const double sign = std::copysign(1.0, n.z);
        const double a = -1 / (sign + n.z);
        const double b = n.x * n.y * a;
        return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
    }
    Vec3d to_local(Vec3d v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
    Vec3d to_world(Vec3d v) const { return x * v.x + y * v.y + z * v.z; }
};

}  // namespace steradian
