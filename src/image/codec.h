// Shared inside the image layer: what every decoder gets, how they fail, and what the encoders write.
// Decoders and encoders throw Failure (or the exceptions of the libraries below them); read.cpp and write.cpp turn that
// into Result, so that nothing leaves the layer as an exception.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "steradian/image.h"
#include "steradian/image_io.h"
#include "steradian/result.h"

namespace steradian::codec {

/// A file of at most this many decoded bytes is believed; a larger one must be at least 1/kMaxExpansion of them.
inline constexpr uint64_t kFreeBytes = uint64_t(256) << 20;
inline constexpr uint64_t kMaxExpansion = 256;
/// Deflate cannot do better than 1032:1.
inline constexpr uint64_t kMaxDeflateRatio = 1032;

/// EXR attribute: the order of the channels where it is not the usual one (see channel_before), separated by commas.
inline constexpr char kChannelOrder[] = "steradianChannelOrder";

/// The only exception of our own inside the layer.
struct Failure {
    Error error;
};

/// A file in memory with what its decoder may spend. `name` stands for it in messages.
struct Source {
    std::string_view bytes;
    const std::string& name;
    const ImageLimits& limits;

    [[noreturn]] void fail(std::string message, std::optional<uint64_t> byte = {}) const;
    [[noreturn]] void fail_limit(std::string message, std::string hint = {}) const;
    /// Refuses zero sizes, more pixels than the limit, and `decoded_bytes` of memory that this file cannot justify.
    void check_size(uint64_t width, uint64_t height, uint64_t decoded_bytes) const;
};

/// Texels and text attributes.
struct Decoded {
    RawImage raw;
    std::map<std::string, std::string> metadata;
};

Decoded decode_png(const Source& source);
Decoded decode_jpeg(const Source& source);
Decoded decode_hdr(const Source& source);
Decoded decode_pfm(const Source& source);
Decoded decode_webp(const Source& source);
Decoded decode_exr_texels(const Source& source);
Image decode_exr_image(const Source& source);

/// `path` stands for the file in messages only.
std::string encode_exr(const Image& image, ExrPrecision precision, const std::string& path, Diagnostics& diagnostics);
std::string encode_png(const Image& image, const ImageWriteOptions& options, const std::string& path,
                       Diagnostics& diagnostics);
std::string encode_hdr(const Image& image, const std::string& path, Diagnostics& diagnostics);
std::string encode_pfm(const Image& image, const std::string& path, Diagnostics& diagnostics);

/// Where the colour of a picture is among its channels: R, G, B and perhaps A; or one channel of grey.
struct ColourChannels {
    size_t count = 0;  ///< 1 or 3
    size_t index[3] = {0, 0, 0};
    std::optional<size_t> alpha;
};
/// Fails with code usage when there is neither. Warns about the channels that `format` will not hold; alpha is one of
/// them unless `with_alpha`.
ColourChannels colour_channels(const Image& image, std::string_view format, bool with_alpha, const std::string& path,
                               Diagnostics& diagnostics);

/// The order in which pictures list their channels: those without a layer first, R G B A before the rest, then by name.
bool channel_before(std::string_view a, std::string_view b) noexcept;

/// "R, G, B" for messages.
std::string join(const std::vector<std::string>& names);

}  // namespace steradian::codec
