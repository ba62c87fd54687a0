#include "image/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <new>

#include "image/codec.h"
#include "math/elementary.h"

namespace steradian {
namespace {

/// bad_input unless both have the same size and the same channels, in whatever order; gives b's index of each of a's.
Result<std::vector<size_t>> match_channels(const Image& a, const Image& b) {
    const auto fail = [](std::string message) { return Error{ErrorCode::bad_input, std::move(message), {}, {}, {}}; };
    if (a.width != b.width || a.height != b.height)
        return fail(
            fmt::format("the pictures differ in size: {} × {} and {} × {}", a.width, a.height, b.width, b.height));
    const auto channels = [](const Image& image) { return codec::join(image.channels); };
    if (a.channels.size() != b.channels.size())
        return fail(fmt::format("the pictures differ in their channels: {} and {}", channels(a), channels(b)));
    for (const Image* image : {&a, &b})
        if (image->pixels.size() != size_t(image->width) * image->height * image->channels.size())
            return fail("a picture does not hold as many values as its size says");
    std::vector<size_t> index;
    for (const std::string& name : a.channels) {
        const auto at = std::find(b.channels.begin(), b.channels.end(), name);
        if (at == b.channels.end())
            return fail(fmt::format("the pictures differ in their channels: {} and {}", channels(a), channels(b)));
        index.push_back(static_cast<size_t>(at - b.channels.begin()));
    }
    return index;
}

/// Adds numbers whose sum should not depend on how many came before: Neumaier's compensated sum.
struct Sum {
    double value = 0, rest = 0;
    void add(double x) {
        const double next = value + x;
        rest += std::fabs(value) >= std::fabs(x) ? (value - next) + x : (x - next) + value;
        value = next;
    }
    /// The compensation of a sum that has become infinite is not a number and not needed.
    double total() const { return std::isfinite(value) ? value + rest : value; }
};

}  // namespace

Result<ImageDifference> compare_images(const Image& a, const Image& b) {
    const auto index = match_channels(a, b);
    if (!index) return index.error();
    const size_t channels = a.channels.size();
    const size_t pixels = size_t(a.width) * a.height;
    ImageDifference out;
    Sum squares, relative;
    for (size_t i = 0; i < pixels; ++i) {
        bool different = false;
        for (size_t c = 0; c < channels; ++c) {
            const float x = a.pixels[i * channels + c], y = b.pixels[i * channels + (*index)[c]];
            if (std::bit_cast<uint32_t>(x) == std::bit_cast<uint32_t>(y)) continue;
            different = true;
            // Equal infinities never come here; a NaN on one side only is as far away as can be.
            double distance = std::fabs(static_cast<double>(x) - static_cast<double>(y));
            if (std::isnan(distance))
                distance = std::isnan(x) && std::isnan(y) ? 0 : std::numeric_limits<double>::infinity();
            squares.add(distance * distance);
            relative.add(std::isinf(distance) ? distance : distance * distance / (static_cast<double>(y) * y + 1e-2));
            if (distance > out.max_abs) {
                out.max_abs = distance;
                out.max_x = static_cast<uint32_t>(i % a.width);
                out.max_y = static_cast<uint32_t>(i / a.width);
            }
        }
        out.different_pixels += different;
    }
    const auto count = static_cast<double>(pixels * channels);
    if (count > 0) {
        out.mse = squares.total() / count;
        out.rel_mse = relative.total() / count;
    }
    out.psnr = out.mse > 0 ? -10 * math::log(out.mse) / math::log(10.0) : std::numeric_limits<double>::infinity();
    return out;
}

Result<Image> difference_image(const Image& a, const Image& b) {
    const auto index = match_channels(a, b);
    if (!index) return index.error();
    try {
        Image out;
        out.width = a.width;
        out.height = a.height;
        out.channels = a.channels;
        out.pixels.resize(a.pixels.size());
        const size_t channels = a.channels.size();
        for (size_t i = 0; i < out.pixels.size(); ++i) {
            const float x = a.pixels[i], y = b.pixels[i / channels * channels + (*index)[i % channels]];
            out.pixels[i] = x == y ? 0.0f : std::fabs(x - y);
        }
        return out;
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::resources, "not enough memory for the difference of the pictures", {}, {}, {}};
    }
}

}  // namespace steradian
