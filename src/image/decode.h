// Image files to texels and pictures.
#pragma once

#include <string>
#include <string_view>

#include "steradian/image.h"
#include "steradian/result.h"

namespace steradian {

enum class ImageFileKind : uint8_t { png, jpeg, exr, hdr, pfm, unknown };

/// By the first bytes, whatever the name.
ImageFileKind image_kind(std::string_view bytes) noexcept;

/// Decodes a texture at the depth of its source (PNG: palette expanded, tRNS as alpha, 16 bit kept; EXR: its data
/// window, half or float). `name` stands for the file in messages. The header is checked against the limits before
/// memory is taken.
Result<RawImage> decode_texels(std::string_view bytes, const std::string& name, const ImageLimits& limits);
Result<RawImage> read_texels(const std::string& path, const ImageLimits& limits);

/// Decodes a picture with its channel names and metadata, as floats; PNG and JPEG are linearised from sRGB. An EXR
/// whose data window differs from its display window is placed in the display window.
Result<Image> decode_image(std::string_view bytes, const std::string& name, const ImageLimits& limits);

}  // namespace steradian
