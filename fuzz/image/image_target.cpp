// Any bytes decode to texels and to a picture that hold what their sizes say, or are refused with a message.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "image/decode.h"

using namespace steradian;

namespace {

constexpr ImageLimits kLimits{1 << 20};

void require(bool good) {
    if (!good) std::abort();
}

size_t value_size(TexelFormat format) {
    switch (format) {
        case TexelFormat::u8:
            return 1;
        case TexelFormat::u16:
        case TexelFormat::f16:
            return 2;
        case TexelFormat::f32:
            return 4;
    }
    std::abort();
}

void check_size(uint64_t width, uint64_t height) {
    require(width > 0 && height > 0 && width * height <= kLimits.max_pixels);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    if (const auto raw = decode_texels(bytes, "input", kLimits)) {
        check_size(raw->width, raw->height);
        require(raw->channels >= 1 && raw->channels <= 4);
        const auto claim = texel_claim(bytes);
        const ImageFileKind kind = image_kind(bytes);
        require(claim.has_value() ==
                (kind == ImageFileKind::png || kind == ImageFileKind::jpeg || kind == ImageFileKind::webp));
        require(!claim || (claim->width == raw->width && claim->height == raw->height));
        require(!claim || (claim->channels >= raw->channels && claim->value_bytes == value_size(raw->format)));
        require(raw->data.size() == size_t(raw->width) * raw->height * raw->channels * value_size(raw->format));
    } else {
        require(!raw.error().message.empty() && !raw.error().str().empty());
    }
    if (const auto image = decode_image(bytes, "input", kLimits)) {
        check_size(image->width, image->height);
        require(!image->channels.empty());
        require(image->pixels.size() == size_t(image->width) * image->height * image->channels.size());
    } else {
        require(!image.error().message.empty());
    }
    return 0;
}
