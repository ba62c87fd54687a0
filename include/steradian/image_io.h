// Pictures to and from files.
#pragma once

#include <string>

#include "steradian/image.h"
#include "steradian/result.h"

namespace steradian {

enum class ExrPrecision : uint8_t { half, single };

struct ImageWriteOptions {
    ExrPrecision exr = ExrPrecision::single;
    float exposure = 0;         ///< stops; for PNG only
    std::string view = "srgb";  ///< view transform for PNG, see view_names()
};

/// By extension: .exr, .hdr, .pfm, .png. The file appears whole or not at all; an existing one is replaced.
Status write_image(const std::string& path, const Image& image, const ImageWriteOptions& options = {},
                   Diagnostics* diagnostics = nullptr);

/// EXR, HDR, PFM, PNG, JPEG or WebP, told by content whatever the name. PNG and JPEG are linearised from sRGB, whatever
/// gamma they state; EXR is converted to Rec. 709 when it states other primaries. Alpha stays as it is stored.
Result<Image> read_image(const std::string& path, const ImageLimits& limits = {});

}  // namespace steradian
