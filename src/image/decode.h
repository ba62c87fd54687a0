// Image files to texels and pictures.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "steradian/image.h"
#include "steradian/result.h"

namespace steradian {

enum class ImageFileKind : uint8_t { png, jpeg, exr, hdr, pfm, webp, unknown };

/// By the first bytes, whatever the name.
ImageFileKind image_kind(std::string_view bytes) noexcept;

/// Decodes a texture at the depth of its source. `name` stands for the file in messages.
/// PNG: palette expanded, tRNS as alpha, 16 bit kept. EXR: the data window of the first flat part with colour, half or
/// float; R, G, B (A) of the first layer that has them, else Y (A), else the only channel; luminance-chroma becomes
/// RGB; converted to Rec. 709 (as float) when the file states other primaries; values that are not finite stay. HDR:
/// radiance, that is divided by EXPOSURE=. PFM: times the magnitude of its scale. Errors: bad_input for a malformed or
/// unsupported file (deep EXR, CMYK JPEG), resources beyond a limit. The header's claims are checked against the limits
/// and against the size of the file before memory is taken: a file may expand to 256 MiB, or to 256 times its own size.
Result<RawImage> decode_texels(std::string_view bytes, const std::string& name, const ImageLimits& limits);
/// What decode_texels makes of a PNG, a JPEG or a WebP if it accepts it, by its header alone (`channels` may be one
/// more, where transparency is damaged); nothing for other kinds, and where there is no header. Takes no memory.
struct TexelClaim {
    uint64_t width = 0, height = 0;  ///< below 2^32
    uint8_t channels = 0, value_bytes = 1;
    uint64_t texels() const noexcept { return width * height; }
};
std::optional<TexelClaim> texel_claim(std::string_view bytes);

Result<RawImage> read_texels(const std::string& path, const ImageLimits& limits);

/// Decodes a picture with its channel names and metadata, as floats; PNG and JPEG are linearised from sRGB. An EXR
/// whose data window differs from its display window is placed in the display window; it keeps all channels, in the
/// order that they were written in by us, otherwise those without a layer first, R G B A before others, then by name.
/// Errors as above.
Result<Image> decode_image(std::string_view bytes, const std::string& name, const ImageLimits& limits);

}  // namespace steradian
