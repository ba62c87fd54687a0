// Luminance-chroma pictures of EXR: RY = (R - Y) / Y, BY = (B - Y) / Y (OpenEXR, "Technical Introduction").
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "steradian/image.h"

namespace steradian::codec {

/// One channel at every x_sampling-th column and y_sampling-th row.
struct Plane {
    size_t width = 0, height = 0;
    size_t x_sampling = 1, y_sampling = 1;
    std::vector<float> values;

    /// At a pixel of the full picture, linear between the samples and constant beyond the last ones.
    float at(size_t x, size_t y) const;
};

struct LumaChroma {
    Plane y, ry, by;
    std::optional<Plane> alpha;
};

/// R, G, B (and A). `weights`: those of red, green and blue in Y. Chroma is interpolated by our own arithmetic, in
/// double, so that the result is the same on every machine.
Image to_rgb(const LumaChroma& planes, const std::array<double, 3>& weights, uint32_t width, uint32_t height);

}  // namespace steradian::codec
