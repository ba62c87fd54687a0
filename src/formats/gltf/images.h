// Images and the textures that read them.
#pragma once

#include <array>
#include <map>
#include <tuple>
#include <vector>

#include "formats/gltf/buffers.h"

namespace steradian::gltf {

/// Which of an image's channels a material reads. glTF packs numbers into the channels of one image; the scene keeps
/// each as an image of its own, so that nothing is stored that nobody reads.
enum class Plane : uint8_t { color, red, green, blue, alpha };

/// What a map of KHR_materials_pbrSpecularGlossiness becomes (specular_glossiness.h), times the factors beside it.
struct SpecularGlossinessPlane {
    enum class Kind : uint8_t { metalness, metal, dielectric, roughness } kind{};
    Rgb specular{1, 1, 1};
    float glossiness = 1;
    bool operator==(const SpecularGlossinessPlane&) const = default;
};

/// What an object of the file says about a texture ("baseColorTexture").
struct TextureUse {
    uint32_t texture = 0;
    uint32_t uv_set = 0;
    size_t offset = 0;                     ///< for messages
    Vec2 uv_scale{1, 1}, uv_offset{0, 0};  ///< KHR_texture_transform
    float uv_rotation = 0;                 ///< likewise, in degrees
};

class Images {
public:
    Images(Context& context, Buffers& buffers) : context_(context), buffers_(buffers) {}

    std::optional<TextureUse> use(const Object& object, std::string_view key);
    TextureId texture(const TextureUse& use, Plane plane, ColorSpace space);
    TextureId texture(const TextureUse& use, const SpecularGlossinessPlane& plane);

    /// Decodes what textures have been made of, on all cores. Until then the scene's images are empty.
    void decode();

private:
    struct Image {
        std::shared_ptr<const std::string> bytes;  ///< of a file or a URI
        std::string_view encoded;                  ///< the same, or in a buffer
        std::string name;                          ///< for messages
        size_t offset = 0;
        std::array<std::optional<ImageId>, 5> planes{};
        std::vector<std::pair<SpecularGlossinessPlane, ImageId>> converted{};
    };
    /// What an element of "textures" says.
    struct OpenTexture {
        ImageTexture sampled;  ///< with its sampler's wrapping and filter
        uint32_t image = 0;
        std::string name;
    };
    /// `offset`: of what uses it, for messages.
    const OpenTexture& open_texture(uint32_t number, size_t offset);
    const ImageTexture& open_sampler(uint32_t number);
    Image& opened(uint32_t image);
    ImageId add_plane(const Image& image);
    ImageId plane_of(uint32_t image, Plane plane);
    ImageId plane_of(uint32_t image, const SpecularGlossinessPlane& plane);
    TextureId add_texture(const TextureUse& use, const OpenTexture& opened, ImageId image, ColorSpace space);
    Image open(uint32_t number);
    Image find(uint32_t number);
    uint32_t image_of(const Object& texture, size_t offset);
    static Error cannot_decode(const Image& image, const Error& error);
    uint64_t claim(const Image& image);
    void keep(const Image& image, RawImage whole);

    Context& context_;
    Buffers& buffers_;
    std::map<uint32_t, Image> images_;
    // Each is read once, however many textures and materials use it.
    std::map<uint32_t, OpenTexture> open_textures_;
    std::map<uint32_t, ImageTexture> samplers_;
    using TextureKey = std::tuple<uint32_t, Plane, ColorSpace, uint32_t, std::array<float, 5>>;
    std::map<TextureKey, TextureId> textures_;
};

}  // namespace steradian::gltf
