#include "formats/gltf/images.h"

#include <numbers>

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
        const double radians = transform->number_or("rotation", 0, kAny);
        out.uv_rotation = static_cast<float>(radians * (180 / std::numbers::pi));
    }
    if (out.uv_set >= kMaxUvSets) {
        context_.not_honoured("sets of texture coordinates beyond number " + std::to_string(kMaxUvSets - 1) +
                                  " are not there: the first set is used",
                              out.offset);
        out.uv_set = 0;
    }
    return out;
}

uint32_t Images::image_of(const Object& texture, size_t offset) {
    if (const auto webp = texture.extension("EXT_texture_webp"))
        return webp->require_reference("source", context_.tables.images);
    if (const auto image = texture.reference("source", context_.tables.images)) return *image;
    if (texture.extension("KHR_texture_basisu"))
        context_.source.fail(texture.offset(), "the only image of the texture is a KTX2 file (KHR_texture_basisu)",
                             remedy("KHR_texture_basisu"));
    context_.source.fail(texture.offset(), "the texture has no image that can be read",
                         "the material that uses it is at " + context_.source.where(offset).str());
}

const ImageTexture& Images::open_sampler(uint32_t number) {
    if (const auto known = samplers_.find(number); known != samplers_.end()) return known->second;
    const Object sampler(context_.source, context_.tables.samplers.elements[number], "a sampler");
    constexpr uint64_t kNearest = 9728, kLinear = 9729;
    ImageTexture out;
    out.wrap_u = read_wrap(sampler, "wrapS");
    out.wrap_v = read_wrap(sampler, "wrapT");
    const uint64_t filter = sampler.integer_or("magFilter", kLinear, 0, 0xffff);
    if (filter != kNearest && filter != kLinear)
        context_.warn("a 'magFilter' is neither 9728 nor 9729; 9729, which is bilinear, is used",
                      sampler.offset_of("magFilter"));
    out.bilinear = filter != kNearest;
    return samplers_.emplace(number, out).first->second;
}

const Images::OpenTexture& Images::open_texture(uint32_t number, size_t offset) {
    if (const auto known = open_textures_.find(number); known != open_textures_.end()) return known->second;
    const Object texture(context_.source, context_.tables.textures.elements[number], "a texture");
    OpenTexture out;
    if (const auto sampler = texture.reference("sampler", context_.tables.samplers))
        out.sampled = open_sampler(*sampler);
    out.image = image_of(texture, offset);
    out.name = texture.string_or("name", "");
    return open_textures_.emplace(number, std::move(out)).first->second;
}

TextureId Images::texture(const TextureUse& use, Plane plane, ColorSpace space) {
    const TextureKey key{use.texture,
                         plane,
                         space,
                         use.uv_set,
                         {use.uv_scale.x, use.uv_scale.y, use.uv_offset.x, use.uv_offset.y, use.uv_rotation}};
    if (const auto known = textures_.find(key); known != textures_.end()) return known->second;
    const OpenTexture& opened = open_texture(use.texture, use.offset);
    return textures_.emplace(key, add_texture(use, opened, plane_of(opened.image, plane), space)).first->second;
}

TextureId Images::texture(const TextureUse& use, const SpecularGlossinessPlane& plane) {
    const OpenTexture& opened = open_texture(use.texture, use.offset);
    const bool color = plane.kind == SpecularGlossinessPlane::Kind::metal;
    return add_texture(use, opened, plane_of(opened.image, plane), color ? ColorSpace::srgb : ColorSpace::linear);
}

TextureId Images::add_texture(const TextureUse& use, const OpenTexture& opened, ImageId image, ColorSpace space) {
    ImageTexture out = opened.sampled;
    out.color_space = space;
    out.scale = use.uv_scale;
    out.offset = use.uv_offset;
    out.rotation = use.uv_rotation;
    out.uv_set = use.uv_set;
    out.image = image;
    context_.budget.take(sizeof(Texture) + opened.name.size(), context_.source, use.offset);
    const Assets::Here here(context_.assets, context_.tables.textures.elements[use.texture].offset());
    return context_.assets.add_texture(out, opened.name);
}

Images::Image Images::open(uint32_t number) {
    Image out = find(number);
    context_.budget.grant(std::as_bytes(std::span(out.encoded)));
    return out;
}

Images::Image Images::find(uint32_t number) {
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
    out.encoded = *out.bytes;
    return out;
}

Images::Image& Images::opened(uint32_t number) {
    auto found = images_.find(number);
    if (found == images_.end()) found = images_.emplace(number, open(number)).first;
    return found->second;
}

ImageId Images::add_plane(const Image& image) {
    const Assets::Here here(context_.assets, image.offset);
    return context_.assets.add_image({}, image.name);
}

ImageId Images::plane_of(uint32_t number, Plane plane) {
    Image& image = opened(number);
    auto& id = image.planes[static_cast<size_t>(plane)];
    if (!id) id = add_plane(image);
    return *id;
}

ImageId Images::plane_of(uint32_t number, const SpecularGlossinessPlane& plane) {
    Image& image = opened(number);
    for (const auto& [known, id] : image.converted)
        if (known == plane) return id;
    return image.converted.emplace_back(plane, add_plane(image)).second;
}

}  // namespace steradian::gltf
