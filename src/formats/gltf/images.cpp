#include "formats/gltf/images.h"

#include <cstring>

#include "base/parallel.h"
#include "base/text.h"
#include "image/decode.h"
#include "math/vector.h"

namespace steradian::gltf {
namespace {

Wrap read_wrap(const Object& sampler, std::string_view key) {
    const uint64_t mode = sampler.integer_or(key, 10497, 0, 0xffff);
    if (mode == 33071) return Wrap::clamp;
    if (mode == 33648) return Wrap::mirror;
    if (mode != 10497)
        sampler.source().fail(sampler.offset_of(key),
                              quoted(key) + " is " + std::to_string(mode) + ", expected 10497, 33071 or 33648");
    return Wrap::repeat;
}

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

RawImage white() { return {1, 1, 1, TexelFormat::u8, {std::byte{255}}}; }

std::string what_it_is(std::string_view bytes) {
    if (bytes.starts_with("\xabKTX 20")) return "a KTX2 texture (KHR_texture_basisu)";
    if (bytes.starts_with("RIFF") && bytes.substr(8, 4) == "WEBP") return "a WebP picture";
    if (bytes.starts_with("DDS ")) return "a DDS texture";
    return {};
}

}  // namespace

std::optional<TextureUse> Images::use(const Object& object, std::string_view key) {
    const auto info = object.object(key);
    if (!info) return std::nullopt;
    TextureUse out;
    out.texture = info->require_reference("index", context_.tables.textures);
    out.uv_set = static_cast<uint32_t>(info->integer_or("texCoord", 0, 0, 1000));
    out.offset = info->offset();
    if (const auto transform = info->extension("KHR_texture_transform")) {
        constexpr Range kAny{-1e15, 1e15};
        out.uv_set = static_cast<uint32_t>(transform->integer_or("texCoord", out.uv_set, 0, 1000));
        out.uv_scale = transform->vec2_or("scale", {1, 1}, kAny);
        out.uv_offset = transform->vec2_or("offset", {0, 0}, kAny);
        if (transform->number_or("rotation", 0, kAny) != 0)
            context_.not_honoured("textures are not rotated (KHR_texture_transform)", transform->offset_of("rotation"));
    }
    return out;
}

uint32_t Images::image_of(const Object& texture, size_t offset) {
    if (const auto image = texture.reference("source", context_.tables.images)) return *image;
    context_.source.fail(texture.offset(), "the texture has no image that can be read",
                         "the material that uses it is at " + context_.source.where(offset).str());
}

TextureId Images::texture(const TextureUse& use, Plane plane, ColorSpace space) {
    const TextureKey key{use.texture, plane, space, {use.uv_scale.x, use.uv_scale.y, use.uv_offset.x, use.uv_offset.y}};
    if (const auto known = textures_.find(key); known != textures_.end()) return known->second;
    const Object texture(context_.source, context_.tables.textures.elements[use.texture], "a texture");
    ImageTexture out;
    out.color_space = space;
    out.scale = use.uv_scale;
    out.offset = use.uv_offset;
    if (const auto number = texture.reference("sampler", context_.tables.samplers)) {
        const Object sampler(context_.source, context_.tables.samplers.elements[*number], "a sampler");
        out.wrap_u = read_wrap(sampler, "wrapS");
        out.wrap_v = read_wrap(sampler, "wrapT");
        constexpr uint64_t kNearest = 9728;
        out.bilinear = sampler.integer_or("magFilter", 0, 0, 0xffff) != kNearest;
    }
    out.image = plane_of(image_of(texture, use.offset), plane);
    const TextureId id = context_.assets.add_texture(out, std::string(texture.string_or("name", "")));
    return textures_.emplace(key, id).first->second;
}

Images::Image Images::open(uint32_t number) {
    const Object object(context_.source, context_.tables.images.elements[number], "an image");
    Image out;
    out.offset = object.offset();
    out.name = name_of(object, "image", number);
    const auto uri = object.find("uri");
    if (const auto view = object.reference("bufferView", context_.tables.buffer_views)) {
        if (uri) context_.source.fail(uri->offset(), "an image has either a 'uri' or a 'bufferView', not both");
        const auto bytes = buffers_.view(*view).bytes;
        out.encoded = {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
        return out;
    }
    if (!uri) context_.source.fail(object.offset(), "an image needs a 'uri' or a 'bufferView'");
    out.bytes = buffers_.read_uri(json::read_string(context_.source, *uri, "'uri'"), uri->offset());
    return out;
}

ImageId Images::plane_of(uint32_t number, Plane plane) {
    auto found = images_.find(number);
    if (found == images_.end()) {
        found = images_.emplace(number, open(number)).first;
        if (!found->second.bytes.empty()) found->second.encoded = found->second.bytes;
    }
    Image& image = found->second;
    auto& id = image.planes[static_cast<size_t>(plane)];
    if (!id) id = context_.assets.add_image({}, image.name);
    return *id;
}

Error Images::cannot_decode(const Image& image, const Error& error) {
    const std::string what = what_it_is(image.encoded);
    if (!what.empty())
        return {ErrorCode::bad_input,
                "the image is " + what + ", which is not supported",
                {},
                {},
                "export it as PNG or JPEG"};
    const std::string at = error.where.byte ? " (at byte " + std::to_string(*error.where.byte) + ")" : std::string();
    return {error.code, "the image cannot be decoded: " + error.message + at, {}, {}, error.hint};
}

void Images::keep(const Image& image, RawImage whole) {
    const auto id_of = [&](Plane plane) { return image.planes[static_cast<size_t>(plane)]; };
    std::vector<RawImage>& images = context_.loaded.scene.images;
    for (const Plane plane : {Plane::red, Plane::green, Plane::blue, Plane::alpha}) {
        if (!id_of(plane)) continue;
        const auto channel = channel_of(whole, plane);
        images[index(*id_of(plane))] = channel ? channels(whole, *channel, 1) : white();
    }
    if (const auto id = id_of(Plane::color)) {
        const bool has_alpha = whole.channels % 2 == 0;
        images[index(*id)] =
            has_alpha ? channels(whole, 0, static_cast<uint8_t>(whole.channels - 1)) : std::move(whole);
    }
}

void Images::decode() {
    std::vector<Image*> list;
    for (auto& [number, image] : images_) list.push_back(&image);
    // A batch at a time, so that files with many bombs are found out early. What is wrong is told in the order of the
    // file, whichever was decoded first.
    const size_t batch = hardware_threads();
    for (size_t begin = 0; begin < list.size(); begin += batch) {
        const size_t count = min_of(batch, list.size() - begin);
        std::vector<std::optional<Result<RawImage>>> decoded(count);
        parallel_for(count, 1, [&](size_t i, size_t end) {
            for (; i < end; ++i)
                decoded[i] = decode_texels(list[begin + i]->encoded, list[begin + i]->name, context_.options.images);
        });
        for (size_t i = 0; i < count; ++i) {
            Image& image = *list[begin + i];
            Result<RawImage>& whole = *decoded[i];
            if (!whole) {
                const Error error = cannot_decode(image, whole.error());
                context_.source.fail(image.offset, error.message, error.hint, error.code);
            }
            context_.texels.take(whole->data.size(), context_.source, image.offset);
            keep(image, std::move(*whole));
            image.bytes = {};
        }
    }
}

}  // namespace steradian::gltf
