#include <fmt/format.h>

#include <cstring>
#include <limits>
#include <new>

#include "base/file.h"
#include "base/text.h"
#include "image/codec.h"
#include "image/decode.h"
#include "image/tone.h"

namespace steradian {
namespace {

/// Runs a decoder; the one place where exceptions of the image libraries and ours become errors.
template <class T, class Decode>
Result<T> guarded(const std::string& name, Decode decode) {
    const auto fail = [&](ErrorCode code, std::string message) {
        return Error{code, std::move(message), {name, 0, 0, {}}, {}, {}};
    };
    try {
        return decode();
    } catch (codec::Failure& failure) {
        return std::move(failure.error);
    } catch (const std::bad_alloc&) {
        return fail(ErrorCode::resources, "not enough memory to decode the picture");
    } catch (const std::length_error&) {
        return fail(ErrorCode::resources, "not enough memory to decode the picture");
    } catch (const std::exception& error) {
        return fail(ErrorCode::bad_input,
                    fmt::format("cannot decode the picture: {}", escape_for_display(error.what())));
    }
}

codec::Decoded decode(const codec::Source& source) {
    switch (image_kind(source.bytes)) {
        case ImageFileKind::png:
            return codec::decode_png(source);
        case ImageFileKind::jpeg:
            return codec::decode_jpeg(source);
        case ImageFileKind::exr:
            return codec::decode_exr_texels(source);
        case ImageFileKind::hdr:
            return codec::decode_hdr(source);
        case ImageFileKind::pfm:
            return codec::decode_pfm(source);
        case ImageFileKind::webp:
            return codec::decode_webp(source);
        case ImageFileKind::unknown:
            break;
    }
    if (source.bytes.empty()) source.fail("the file is empty, expected a picture");
    source.fail("this is not a picture that can be read: expected EXR, HDR, PFM, PNG, JPEG or WebP", 0);
}

template <class T>
T texel(const RawImage& raw, size_t i) {
    T value;
    std::memcpy(&value, raw.data.data() + i * sizeof value, sizeof value);
    return value;
}

/// 8 and 16 bit values are linearised from sRGB, alpha (the last of 2 or 4 channels) is not; floats stay.
void append_floats(const RawImage& raw, std::vector<float>& out) {
    const size_t count = size_t(raw.width) * raw.height * raw.channels;
    if (raw.format == TexelFormat::f32) {
        out.resize(count);
        std::memcpy(out.data(), raw.data.data(), count * sizeof(float));
        return;
    }
    const bool wide = raw.format == TexelFormat::u16;
    const uint32_t maximum = wide ? 65535 : 255;
    std::vector<float> linear(maximum + 1);
    for (uint32_t v = 0; v <= maximum; ++v)
        linear[v] = srgb_decode(static_cast<float>(v) / static_cast<float>(maximum));
    const bool has_alpha = raw.channels % 2 == 0;
    out.reserve(count);
    for (size_t i = 0; i < count; ++i) {
        const uint32_t v = wide ? texel<uint16_t>(raw, i) : texel<uint8_t>(raw, i);
        const bool is_alpha = has_alpha && i % raw.channels == raw.channels - 1u;
        out.push_back(is_alpha ? static_cast<float>(v) / static_cast<float>(maximum) : linear[v]);
    }
}

Image to_image(codec::Decoded decoded) {
    static const std::vector<std::string> kNames[] = {{"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
    Image image;
    image.width = decoded.raw.width;
    image.height = decoded.raw.height;
    image.channels = kNames[decoded.raw.channels - 1];
    image.metadata = std::move(decoded.metadata);
    append_floats(decoded.raw, image.pixels);
    return image;
}

/// No picture within the limits is longer: four floats a pixel, and room for a header.
uint64_t max_file_bytes(const ImageLimits& limits) {
    constexpr uint64_t kRoom = uint64_t(16) << 20;
    return limits.max_pixels > (uint64_t(1) << 56) ? std::numeric_limits<int64_t>::max()
                                                   : limits.max_pixels * 16 + kRoom;
}

}  // namespace

ImageFileKind image_kind(std::string_view bytes) noexcept {
    using namespace std::string_view_literals;
    if (bytes.starts_with("\x89PNG\r\n\x1a\n"sv)) return ImageFileKind::png;
    if (bytes.starts_with("\xff\xd8\xff"sv)) return ImageFileKind::jpeg;
    if (bytes.starts_with("\x76\x2f\x31\x01"sv)) return ImageFileKind::exr;
    if (bytes.starts_with("#?"sv)) return ImageFileKind::hdr;
    const bool pfm = bytes.size() > 2 && bytes[0] == 'P' && (bytes[1] == 'F' || bytes[1] == 'f');
    if (pfm && (bytes[2] == '\n' || bytes[2] == ' ' || bytes[2] == '\r' || bytes[2] == '\t')) return ImageFileKind::pfm;
    if (bytes.starts_with("RIFF"sv) && bytes.size() >= 12 && bytes.substr(8, 4) == "WEBP"sv) return ImageFileKind::webp;
    return ImageFileKind::unknown;
}

Result<RawImage> decode_texels(std::string_view bytes, const std::string& name, const ImageLimits& limits) {
    return guarded<RawImage>(name, [&] { return decode({bytes, name, limits}).raw; });
}

Result<RawImage> read_texels(const std::string& path, const ImageLimits& limits) {
    return guarded<RawImage>(path, [&]() -> Result<RawImage> {
        const auto bytes = read_file(path, max_file_bytes(limits));
        if (!bytes) return bytes.error();
        return decode_texels(*bytes, path, limits);
    });
}

Result<Image> decode_image(std::string_view bytes, const std::string& name, const ImageLimits& limits) {
    return guarded<Image>(name, [&] {
        const codec::Source source{bytes, name, limits};
        return image_kind(bytes) == ImageFileKind::exr ? codec::decode_exr_image(source) : to_image(decode(source));
    });
}

Result<Image> read_image(const std::string& path, const ImageLimits& limits) {
    return guarded<Image>(path, [&]() -> Result<Image> {
        const auto bytes = read_file(path, max_file_bytes(limits));
        if (!bytes) return bytes.error();
        return decode_image(*bytes, path, limits);
    });
}

}  // namespace steradian
