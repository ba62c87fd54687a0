#include "image/exr_luma.h"

#include <algorithm>

namespace steradian::codec {

float Plane::at(size_t x, size_t y) const {
    const size_t x0 = x / x_sampling, y0 = y / y_sampling;
    const size_t x_rest = x % x_sampling, y_rest = y % y_sampling;
    if (x_rest == 0 && y_rest == 0) return values[y0 * width + x0];
    const size_t x1 = std::min(x0 + 1, width - 1), y1 = std::min(y0 + 1, height - 1);
    const double fx = static_cast<double>(x_rest) / static_cast<double>(x_sampling);
    const double fy = static_cast<double>(y_rest) / static_cast<double>(y_sampling);
    const auto row = [&](size_t j) { return values[j * width + x0] * (1 - fx) + values[j * width + x1] * fx; };
    return static_cast<float>(row(y0) * (1 - fy) + row(y1) * fy);
}

Image to_rgb(const LumaChroma& planes, const std::array<double, 3>& weights, uint32_t width, uint32_t height) {
    Image out;
    out.width = width;
    out.height = height;
    out.channels = {"R", "G", "B"};
    if (planes.alpha) out.channels.push_back("A");
    out.pixels.reserve(size_t(width) * height * out.channels.size());
    for (size_t y = 0; y < height; ++y)
        for (size_t x = 0; x < width; ++x) {
            const double luma = planes.y.at(x, y);
            const double r = (1.0 + planes.ry.at(x, y)) * luma, b = (1.0 + planes.by.at(x, y)) * luma;
            const double g = (luma - weights[0] * r - weights[2] * b) / weights[1];
            for (const double v : {r, g, b}) out.pixels.push_back(static_cast<float>(v));
            if (planes.alpha) out.pixels.push_back(planes.alpha->at(x, y));
        }
    return out;
}

}  // namespace steradian::codec
