#include "image/colour_space.h"

#include <cmath>

namespace steradian {
namespace {

ColourMatrix product(const ColourMatrix& a, const ColourMatrix& b) {
    ColourMatrix out{};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) out[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
    return out;
}

Vec3d apply(const ColourMatrix& m, Vec3d v) {
    return {m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z, m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
            m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
}

std::optional<ColourMatrix> inverse(const ColourMatrix& m) {
    const Vec3d a{m[0][0], m[1][0], m[2][0]}, b{m[0][1], m[1][1], m[2][1]}, c{m[0][2], m[1][2], m[2][2]};
    const double determinant = dot(a, cross(b, c));
    if (!(std::fabs(determinant) > 1e-9) || !std::isfinite(determinant)) return std::nullopt;
    const Vec3d rows[3] = {cross(b, c), cross(c, a), cross(a, b)};
    ColourMatrix out;
    for (int i = 0; i < 3; ++i) out[i] = {rows[i].x / determinant, rows[i].y / determinant, rows[i].z / determinant};
    return out;
}

ColourMatrix diagonal(Vec3d d) { return {{{d.x, 0, 0}, {0, d.y, 0}, {0, 0, d.z}}}; }

/// XYZ of a chromaticity with Y = 1.
std::optional<Vec3d> xyz_of_white(double x, double y) {
    if (!(std::fabs(y) > 1e-6) || !std::isfinite(x) || !std::isfinite(y)) return std::nullopt;
    return Vec3d{x / y, 1, (1 - x - y) / y};
}

/// SMPTE RP 177: the primaries scaled so that (1, 1, 1) is white.
std::optional<ColourMatrix> xyz_from_rgb(const std::array<float, 8>& xy) {
    for (const float v : xy)
        if (!std::isfinite(v) || std::fabs(v) > 10) return std::nullopt;
    ColourMatrix primaries{};
    for (int i = 0; i < 3; ++i) {
        const double x = xy[2 * i], y = xy[2 * i + 1];
        primaries[0][i] = x;
        primaries[1][i] = y;
        primaries[2][i] = 1 - x - y;
    }
    const auto inverted = inverse(primaries);
    const auto white = xyz_of_white(xy[6], xy[7]);
    if (!inverted || !white) return std::nullopt;
    return product(primaries, diagonal(apply(*inverted, *white)));
}

/// Linear Bradford (Lam 1985; the matrix of the ICC profile specification, annex E).
ColourMatrix bradford(Vec3d from_white, Vec3d to_white) {
    constexpr ColourMatrix kCone = {{{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};
    const Vec3d from = apply(kCone, from_white), to = apply(kCone, to_white);
    return product(*inverse(kCone), product(diagonal({to.x / from.x, to.y / from.y, to.z / from.z}), kCone));
}

bool is_xyz(const std::array<float, 8>& xy) {
    return xy[0] == 1 && xy[1] == 0 && xy[2] == 0 && xy[3] == 1 && xy[4] == 0 && xy[5] == 0;
}

}  // namespace

std::optional<ColourMatrix> rec709_from_primaries(const std::array<float, 8>& xy) {
    const auto from = xyz_from_rgb(xy), to = xyz_from_rgb(kRec709Primaries);
    if (!from || !to) return std::nullopt;
    ColourMatrix xyz = *from;
    if (!is_xyz(xy))
        xyz = product(bradford(*xyz_of_white(xy[6], xy[7]), *xyz_of_white(kRec709Primaries[6], kRec709Primaries[7])),
                      xyz);
    const ColourMatrix out = product(*inverse(*to), xyz);
    for (const auto& row : out)
        for (const double v : row)
            if (!std::isfinite(v)) return std::nullopt;
    return out;
}

std::optional<std::array<double, 3>> luminance_weights(const std::array<float, 8>& xy) {
    const auto xyz = xyz_from_rgb(xy);
    if (!xyz) return std::nullopt;
    return (*xyz)[1];
}

bool is_rec709(const std::array<float, 8>& xy) {
    for (size_t i = 0; i < xy.size(); ++i)
        if (!(std::fabs(xy[i] - kRec709Primaries[i]) <= 1e-3f)) return false;
    return true;
}

}  // namespace steradian
