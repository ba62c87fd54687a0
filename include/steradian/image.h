// Pictures: what a render makes (float channels) and what a texture is made of (texels as the file stores them).
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "steradian/result.h"
#include "steradian/vec.h"

namespace steradian {

/// How a channel is stored where a format leaves a choice (EXR): as the writer's options say, but for what is by its
/// name a measurement, which is 32-bit (docs/aovs.md); always in 32-bit floats; or in whole numbers from 0 to 2³² - 1.
enum class ChannelType : uint8_t { by_options, single, uint32 };

/// A picture with named float channels, row by row from the top left corner, channels interleaved:
/// pixels[(y * width + x) * channels.size() + c]. Values are linear Rec. 709 where the channel is a colour.
struct Image {
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<std::string> channels;  ///< e.g. {"R", "G", "B"}
    std::vector<float> pixels;
    std::map<std::string, std::string>
        metadata;  ///< text attributes, written to EXR and PNG; sorted, so files are equal
    /// Of each channel, or nothing where all go by the options. Whole numbers are exact up to 2²⁴, as floats are.
    std::vector<ChannelType> types = {};
};

/// R, G and B alone, in that order: of a picture with AOVs, the picture without them. Nothing when one is missing.
Image color_channels(const Image& image);

/// XXH3-128 over width, height, channel names and little-endian float32 pixels, as 32 hexadecimal digits.
/// Metadata does not count. This is "the hash of the picture" everywhere in the project.
std::string image_hash(const Image& image);

enum class TexelFormat : uint8_t { u8, u16, f16, f32 };

/// Texels as decoded, at the depth of the source: nothing linearised, premultiplied or filtered.
/// Rows from the top; `data` holds width * height * channels values of the format, native byte order.
struct RawImage {
    uint32_t width = 0;
    uint32_t height = 0;
    uint8_t channels = 3;  ///< 1 grey, 2 grey + alpha, 3 RGB, 4 RGBA (alpha unassociated)
    TexelFormat format = TexelFormat::u8;
    std::vector<std::byte> data;
};

/// What a decoder may spend on one file, checked against the header before memory is taken.
struct ImageLimits {
    uint64_t max_pixels = uint64_t(1) << 27;  ///< 134 million: 16384 × 8192
};

}  // namespace steradian
