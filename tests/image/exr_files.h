// EXR files of the kinds that our writer does not make, by OpenEXR itself.
#pragma once

#include <OpenEXR/ImfHeader.h>

#include <string>
#include <vector>

namespace steradian::test {

/// A file of float channels; `value(channel, x, y)` in the coordinates of the header's data window. Tiled when the
/// header has a tile description.
std::string exr_file(Imf::Header header, float (*value)(const std::string& channel, int x, int y));

/// Two parts: "depth" with Z, then "beauty" with R, G, B; 4 × 3 pixels of 1 and 2.
std::string two_part_exr();

/// One deep part, 2 × 2, one sample a pixel.
std::string deep_exr();

}  // namespace steradian::test
