#include <fmt/format.h>
#include <webp/decode.h>

#include "image/codec.h"

namespace steradian::codec {
namespace {

const char* status_message(VP8StatusCode status) {
    switch (status) {
        case VP8_STATUS_NOT_ENOUGH_DATA:
            return "the file ends early";
        case VP8_STATUS_OUT_OF_MEMORY:
            throw std::bad_alloc();
        case VP8_STATUS_UNSUPPORTED_FEATURE:
            return "it uses a feature that is not supported";
        default:
            return "its data are damaged";
    }
}

}  // namespace

/// Colours as libwebp makes them of YUV, in integers: the same everywhere.
Decoded decode_webp(const Source& source) {
    const auto* data = reinterpret_cast<const uint8_t*>(source.bytes.data());
    WebPDecoderConfig config;
    if (!WebPInitDecoderConfig(&config)) source.fail("the WebP library is not the one that this program was built for");
    const auto check = [&](VP8StatusCode status) {
        if (status != VP8_STATUS_OK) source.fail(fmt::format("cannot decode the WebP: {}", status_message(status)));
    };
    check(WebPGetFeatures(data, source.bytes.size(), &config.input));
    if (config.input.has_animation) source.fail("an animated WebP is not supported, expected a single picture");
    Decoded out;
    out.raw.width = static_cast<uint32_t>(config.input.width);
    out.raw.height = static_cast<uint32_t>(config.input.height);
    out.raw.channels = config.input.has_alpha ? 4 : 3;
    // As floats in the end; and before that four bytes a pixel, twice, inside of the library.
    const uint64_t pixels = uint64_t(out.raw.width) * out.raw.height;
    source.check_size(out.raw.width, out.raw.height, pixels * (sizeof(float) * out.raw.channels + 8));
    const size_t row_bytes = size_t(out.raw.width) * out.raw.channels;
    out.raw.data.resize(row_bytes * out.raw.height);
    config.output.colorspace = config.input.has_alpha ? MODE_RGBA : MODE_RGB;
    config.output.is_external_memory = 1;
    config.output.u.RGBA.rgba = reinterpret_cast<uint8_t*>(out.raw.data.data());
    config.output.u.RGBA.stride = static_cast<int>(row_bytes);
    config.output.u.RGBA.size = out.raw.data.size();
    check(WebPDecode(data, source.bytes.size(), &config));
    return out;
}

}  // namespace steradian::codec
