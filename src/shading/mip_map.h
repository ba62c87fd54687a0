// MIP maps: an image at half its size, at a quarter, and so on to one texel, in linear light (Williams 1983, "Pyramidal
// Parametrics").
#pragma once

#include <memory>
#include <vector>

#include "steradian/scene.h"

namespace steradian {

/// The levels above the image itself. Texels are half floats where the image has bytes, floats otherwise; one channel
/// or three, as the image's colours.
struct MipMap {
    std::vector<RawImage> levels;

    static MipMap make(const RawImage& image, ColorSpace space);
    /// What one takes. Nothing is looked at but the header of the image.
    static uint64_t bytes(const RawImage& image) noexcept;
};

}  // namespace steradian
