#include "math/transform.h"

#include "math/elementary.h"

namespace steradian {

Affine operator*(const Affine& a, const Affine& b) {
    Affine out;
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 4; ++c)
            out.m[r][c] =
                a.m[r][0] * b.m[0][c] + a.m[r][1] * b.m[1][c] + a.m[r][2] * b.m[2][c] + (c == 3 ? a.m[r][3] : 0.0);
    return out;
}

Affine translation(double x, double y, double z) {
    Affine out;
    out.m[0][3] = x, out.m[1][3] = y, out.m[2][3] = z;
    return out;
}

Affine scaling(double x, double y, double z) {
    Affine out;
    out.m[0][0] = x, out.m[1][1] = y, out.m[2][2] = z;
    return out;
}

Affine rotation_degrees(double angle, std::array<double, 3> axis) {
    const Vec3d n = normalize(Vec3d{axis[0], axis[1], axis[2]});
    // Quarter turns exactly: sin(π) is not 0 in floating point, and such rotations are common.
    double s, c;
    const double turns = angle / 90;
    if (std::fabs(turns) < 0x1p52 && turns == std::floor(turns)) {
        static constexpr double kSin[4] = {0, 1, 0, -1};
        const int quarter = static_cast<int>(turns - 4 * std::floor(turns / 4)) & 3;
        s = kSin[quarter], c = kSin[(quarter + 1) & 3];
    } else {
        const double radians = angle * (std::numbers::pi / 180);
        s = math::sin(radians), c = math::cos(radians);
    }
    const double k = 1 - c;
    Affine out;
    out.m[0] = {c + n.x * n.x * k, n.x * n.y * k - n.z * s, n.x * n.z * k + n.y * s, 0};
    out.m[1] = {n.y * n.x * k + n.z * s, c + n.y * n.y * k, n.y * n.z * k - n.x * s, 0};
    out.m[2] = {n.z * n.x * k - n.y * s, n.z * n.y * k + n.x * s, c + n.z * n.z * k, 0};
    return out;
}

Vec3d transform_point(const Affine& a, Vec3d p) {
    const auto row = [&](int r) { return a.m[r][0] * p.x + a.m[r][1] * p.y + a.m[r][2] * p.z + a.m[r][3]; };
    return {row(0), row(1), row(2)};
}

Vec3d transform_vector(const Affine& a, Vec3d v) {
    const auto row = [&](int r) { return a.m[r][0] * v.x + a.m[r][1] * v.y + a.m[r][2] * v.z; };
    return {row(0), row(1), row(2)};
}

Vec3d transform_normal_by_inverse(const Affine& i, Vec3d n) {
    const auto column = [&](int c) { return i.m[0][c] * n.x + i.m[1][c] * n.y + i.m[2][c] * n.z; };
    return {column(0), column(1), column(2)};
}

double determinant(const Affine& a) {
    const auto& m = a.m;
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

std::optional<Affine> inverse(const Affine& a) {
    const double det = determinant(a);
    const double scale = 1 / det;
    if (det == 0 || !std::isfinite(scale) || !is_finite(a)) return std::nullopt;
    const auto& m = a.m;
    const auto cofactor = [&](int r, int c) {
        const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
        return m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
    };
    Affine out;
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) out.m[r][c] = cofactor(c, r) * scale;
    for (int r = 0; r < 3; ++r) out.m[r][3] = -(out.m[r][0] * m[0][3] + out.m[r][1] * m[1][3] + out.m[r][2] * m[2][3]);
    if (!is_finite(out)) return std::nullopt;
    return out;
}

std::optional<Affine> usable_inverse(const Affine& a) {
    const auto bounded = [](const Affine& matrix) {
        for (const auto& row : matrix.m)
            for (const double x : row)
                if (!(std::fabs(x) <= kMaxTransform)) return false;
        return true;
    };
    std::optional<Affine> inverted = inverse(a);
    if (inverted && !(bounded(a) && bounded(*inverted))) inverted.reset();
    return inverted;
}

bool is_identity(const Affine& a) { return a == Affine{}; }

bool is_finite(const Affine& a) {
    for (const auto& row : a.m)
        for (const double x : row)
            if (!std::isfinite(x)) return false;
    return true;
}

std::optional<double> uniform_scale(const Affine& a) {
    const Vec3d c[3] = {
        {a.m[0][0], a.m[1][0], a.m[2][0]}, {a.m[0][1], a.m[1][1], a.m[2][1]}, {a.m[0][2], a.m[1][2], a.m[2][2]}};
    const double s2 = dot(c[0], c[0]), tolerance = 1e-6 * s2;
    if (!(s2 > 0)) return std::nullopt;
    for (int i = 0; i < 3; ++i)
        if (!(std::fabs(dot(c[i], c[i]) - s2) <= tolerance) || !(std::fabs(dot(c[i], c[(i + 1) % 3])) <= tolerance))
            return std::nullopt;
    return std::sqrt(s2);
}

}  // namespace steradian
