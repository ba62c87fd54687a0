// Pictures and picture files made by the tests.
#pragma once

#include <string>
#include <vector>

#include "steradian/image.h"
#include "steradian/image_io.h"

namespace steradian::test {

/// Values of every size and sign, different in every channel; finite.
Image sample_image(uint32_t width, uint32_t height, std::vector<std::string> channels = {"R", "G", "B"});

/// The bytes that write_image leaves under `name`.
std::string encoded(const Image& image, const std::string& name, const ImageWriteOptions& options = {},
                    Diagnostics* diagnostics = nullptr);

/// A JPEG by libjpeg; components 1 (grey), 3 (YCbCr) or 4 (CMYK).
std::string jpeg_file(uint32_t width, uint32_t height, int components, bool progressive,
                      const std::vector<unsigned char>& pixels);

/// A PNG put together by hand: the chunks and checksums are right, whatever the numbers say. `bit_depth` and
/// `colour_type` as in the specification; `rows` are the filtered rows before deflate.
std::string png_file(uint32_t width, uint32_t height, int bit_depth, int colour_type, const std::string& rows);

/// A WebP by libwebp, of RGB (3 channels) or RGBA (4); without loss, what is transparent included, or with.
std::string webp_file(uint32_t width, uint32_t height, int channels, bool lossless,
                      const std::vector<unsigned char>& pixels);

/// One chunk of a PNG, with its length and checksum.
std::string png_chunk(const std::string& type, const std::string& data);

/// Peak resident memory (bytes) and processor time (seconds) of `body` in a process of its own; body's exit code too.
struct Cost {
    uint64_t peak_bytes = 0;
    double seconds = 0;
    int exit_code = -1;
};
Cost cost_of(int (*body)(const void*), const void* argument);

}  // namespace steradian::test
