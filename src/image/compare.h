// How far two pictures are apart.
#pragma once

#include "steradian/image.h"
#include "steradian/result.h"

namespace steradian {

/// Over all pixels and the channels that both have, in double.
struct ImageDifference {
    double mse = 0;      ///< mean (a - b)²
    double rel_mse = 0;  ///< mean (a - b)² / (b² + 1e-2); b is the reference
    double psnr = 0;     ///< dB for a peak of 1; infinite when equal
    double max_abs = 0;
    uint32_t max_x = 0, max_y = 0;
    uint64_t different_pixels = 0;  ///< with any bit different
};

/// bad_input when the sizes or the channels differ.
Result<ImageDifference> compare_images(const Image& a, const Image& b);

/// |a - b| per channel.
Result<Image> difference_image(const Image& a, const Image& b);

}  // namespace steradian
