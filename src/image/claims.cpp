// What the header of a picture claims, for callers that decide about memory before anything is decoded.
#include <webp/decode.h>

#include "image/decode.h"

namespace steradian {
namespace {

uint64_t big_endian(std::string_view bytes, size_t at, size_t count) {
    uint64_t out = 0;
    for (size_t i = 0; i < count; ++i) out = out << 8 | static_cast<unsigned char>(bytes[at + i]);
    return out;
}

/// Signature, then IHDR: length, type, width, height, depth, colour type (PNG specification, section 11.2.2).
std::optional<TexelClaim> png_claim(std::string_view bytes) {
    constexpr size_t kWidth = 16, kHeight = 20, kDepth = 24, kType = 25;
    if (bytes.size() <= kType || bytes.substr(12, 4) != "IHDR") return std::nullopt;
    const uint64_t type = big_endian(bytes, kType, 1);
    const bool grey = type == 0 || type == 4;
    TexelClaim out;
    out.width = big_endian(bytes, kWidth, 4), out.height = big_endian(bytes, kHeight, 4);
    bool alpha = type == 4 || type == 6;
    // A transparent colour or palette adds it. Around what a chunk holds are 12 bytes; pixels come last.
    for (size_t at = 8; at + 12 <= bytes.size() && bytes.substr(at + 4, 4) != "IDAT";) {
        alpha = alpha || bytes.substr(at + 4, 4) == "tRNS";
        at += 12 + big_endian(bytes, at, 4);
    }
    out.channels = static_cast<uint8_t>((grey ? 1 : 3) + (alpha ? 1 : 0));
    out.value_bytes = bytes[kDepth] == 16 ? 2 : 1;
    return out;
}

/// Markers up to the frame header (ITU-T T.81, sections B.1.1 and B.2.2).
std::optional<TexelClaim> jpeg_claim(std::string_view bytes) {
    for (size_t at = 2; at + 9 < bytes.size();) {
        const uint64_t marker = big_endian(bytes, at + 1, 1);
        if (bytes[at] != '\xff' || marker == 0xff || marker == 0) {  // what decoders skip
            ++at;
            continue;
        }
        const bool frame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
        if (frame)
            return TexelClaim{big_endian(bytes, at + 7, 2), big_endian(bytes, at + 5, 2),
                              static_cast<uint8_t>(big_endian(bytes, at + 9, 1)), 1};
        const bool bare = marker == 0x01 || (marker >= 0xd0 && marker <= 0xd8);
        at += bare ? 2 : 2 + big_endian(bytes, at + 2, 2);
    }
    return std::nullopt;
}

std::optional<TexelClaim> webp_claim(std::string_view bytes) {
    WebPBitstreamFeatures features;
    if (WebPGetFeatures(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size(), &features) != VP8_STATUS_OK)
        return std::nullopt;
    return TexelClaim{static_cast<uint64_t>(features.width), static_cast<uint64_t>(features.height),
                      static_cast<uint8_t>(features.has_alpha ? 4 : 3), 1};
}

}  // namespace

std::optional<TexelClaim> texel_claim(std::string_view bytes) {
    switch (image_kind(bytes)) {
        case ImageFileKind::png:
            return png_claim(bytes);
        case ImageFileKind::jpeg:
            return jpeg_claim(bytes);
        case ImageFileKind::webp:
            return webp_claim(bytes);
        default:
            return std::nullopt;
    }
}

}  // namespace steradian
