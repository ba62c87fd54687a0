// From encoded images to the planes that materials read.
#include <cstring>

#include "base/parallel.h"
#include "base/text.h"
#include "formats/gltf/images.h"
#include "formats/gltf/specular_glossiness.h"
#include "image/decode.h"
#include "math/vector.h"

namespace steradian::gltf {
namespace {

/// What a channel of an image means where it has fewer: grey stands for all colours, and without alpha it is opaque.
std::optional<size_t> channel_of(const RawImage& image, Plane plane) {
    if (plane == Plane::alpha)
        return image.channels % 2 == 0 ? std::optional<size_t>(image.channels - 1u) : std::nullopt;
    if (image.channels < 3) return 0;
    return plane == Plane::red ? 0 : plane == Plane::green ? 1 : 2;
}

size_t texel_bytes(TexelFormat format) { return format == TexelFormat::u8 ? 1 : format == TexelFormat::f32 ? 4 : 2; }

/// `count` neighbouring channels of each texel from `first` on.
RawImage channels(const RawImage& from, size_t first, uint8_t count) {
    const size_t size = texel_bytes(from.format), texels = size_t(from.width) * from.height;
    RawImage out{from.width, from.height, count, from.format, std::vector<std::byte>(texels * count * size)};
    for (size_t i = 0; i < texels; ++i)
        std::memcpy(out.data.data() + i * count * size, from.data.data() + (i * from.channels + first) * size,
                    count * size);
    return out;
}

/// Pictures whose decoding may be under way at once, as bytes of texels: so much of a small file, and of a large one a
/// part of what it comes to.
constexpr uint64_t kFreeInFlight = uint64_t(48) << 20;
constexpr uint64_t kShareInFlight = 8;

RawImage white() { return {1, 1, 1, TexelFormat::u8, {std::byte{255}}}; }

std::string what_it_is(std::string_view bytes) {
    if (bytes.starts_with("\xabKTX 20")) return "a KTX2 texture (KHR_texture_basisu)";
    if (bytes.starts_with("DDS ")) return "a DDS texture";
    return {};
}

}  // namespace

Error Images::cannot_decode(const Image& image, const Error& error) {
    const std::string what = what_it_is(image.encoded);
    if (!what.empty())
        return {ErrorCode::bad_input,
                "the image is " + what + ", which is not supported",
                {},
                {},
                "export it as PNG, JPEG or WebP"};
    const std::string at = error.where.byte ? " (at byte " + std::to_string(*error.where.byte) + ")" : std::string();
    return {error.code, "the image cannot be decoded: " + error.message + at, {}, {}, error.hint};
}

/// The bytes that an image takes when it is decoded. Fails where that is too much, or where it is of a kind that glTF
/// does not have.
uint64_t Images::claim(const Image& image) {
    const auto header = texel_claim(image.encoded);
    if (!header) {
        const bool known = image_kind(image.encoded) != ImageFileKind::unknown;
        Error error =
            make_error(ErrorCode::bad_input, known ? "its header is damaged, or it is none of PNG, JPEG and WebP"
                                                   : "expected PNG, JPEG or WebP");
        error = cannot_decode(image, error);
        context_.source.fail(image.offset, error.message, error.hint, error.code);
    }
    if (header->width == 0 || header->height > context_.options.images.max_pixels / header->width) return 0;
    const uint64_t value = header->value_bytes, whole = header->texels() * header->channels * value;
    uint64_t kept = 0;
    for (size_t plane = 0; plane < image.planes.size(); ++plane)
        if (image.planes[plane])
            kept += header->texels() * value * (plane == 0 ? min_of<uint64_t>(header->channels, 3) : 1);
    for (const auto& [plane, id] : image.converted)
        kept += header->texels() * (plane.kind == SpecularGlossinessPlane::Kind::metal ? 3 : 1);
    context_.budget.take(max_of(whole, kept), context_.source, image.offset);
    return whole;
}

void Images::keep(const Image& image, RawImage whole) {
    const auto id_of = [&](Plane plane) { return image.planes[static_cast<size_t>(plane)]; };
    std::vector<RawImage>& images = context_.loaded.scene.images;
    for (const Plane plane : {Plane::red, Plane::green, Plane::blue, Plane::alpha}) {
        if (!id_of(plane)) continue;
        const auto channel = channel_of(whole, plane);
        images[index(*id_of(plane))] = channel ? channels(whole, *channel, 1) : white();
    }
    for (const auto& [plane, id] : image.converted) images[index(id)] = convert_specular_glossiness(whole, plane);
    if (const auto id = id_of(Plane::color)) {
        const bool has_alpha = whole.channels % 2 == 0;
        images[index(*id)] =
            has_alpha ? channels(whole, 0, static_cast<uint8_t>(whole.channels - 1)) : std::move(whole);
    }
}

void Images::decode() {
    struct Work {
        Image* image;
        uint64_t whole = 0;  ///< bytes that decoding takes, kept or not
        std::optional<Error> error = std::nullopt;
    };
    std::vector<Work> list;
    uint64_t sum = 0;
    for (auto& [number, image] : images_) {
        list.push_back({&image, claim(image)});
        sum += list.back().whole;
    }
    // A batch at a time. What is wrong is told in the order of the file, whichever was decoded first.
    const uint64_t limit = max_of(kFreeInFlight, sum / kShareInFlight);
    for (size_t begin = 0, end = 0; begin < list.size(); begin = end) {
        for (uint64_t bytes = 0; end < list.size() && (end == begin || bytes + list[end].whole <= limit); ++end)
            bytes += list[end].whole;
        parallel_for(end - begin, 1, [&](size_t i, size_t last) {
            for (; i < last; ++i) {
                Work& work = list[begin + i];
                auto whole = decode_texels(work.image->encoded, work.image->name, context_.options.images);
                if (whole)
                    keep(*work.image, std::move(*whole));
                else
                    work.error = std::move(whole).error();
                work.image->bytes = {};
            }
        });
        for (size_t i = begin; i < end; ++i)
            if (list[i].error) {
                const Error error = cannot_decode(*list[i].image, *list[i].error);
                context_.source.fail(list[i].image->offset, error.message, error.hint, error.code);
            }
    }
}

}  // namespace steradian::gltf
