// From the primaries of a file to Rec. 709.
#pragma once

#include <array>
#include <optional>

#include "math/vector.h"

namespace steradian {

/// Row-major 3 × 3, in double.
using ColourMatrix = std::array<std::array<double, 3>, 3>;

inline Rgb operator*(const ColourMatrix& m, Rgb c) {
    const auto row = [&](int i) { return static_cast<float>(m[i][0] * c.r + m[i][1] * c.g + m[i][2] * c.b); };
    return {row(0), row(1), row(2)};
}

/// xy: chromaticities of red, green, blue and white, in pairs (the order of EXR's attribute).
/// The white point is adapted by linear Bradford, so that white stays white; when the "primaries" are X, Y and Z
/// themselves the values are colorimetric already and nothing is adapted.
/// Nothing when the primaries do not span a space or a value is not finite.
std::optional<ColourMatrix> rec709_from_primaries(const std::array<float, 8>& xy);

/// The weights of red, green and blue in Y; same conditions.
std::optional<std::array<double, 3>> luminance_weights(const std::array<float, 8>& xy);

/// Rec. 709 with D65, as EXR's default states it.
inline constexpr std::array<float, 8> kRec709Primaries = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};

/// Within the three digits to which such figures are printed.
bool is_rec709(const std::array<float, 8>& xy);

}  // namespace steradian
