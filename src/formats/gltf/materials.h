// Materials: metallic-roughness as OpenPBR, or as the simpler material that says the same where there is one.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "formats/gltf/images.h"

namespace steradian::gltf {

/// A material as primitives use it.
struct Look {
    MaterialId material{};
    Rgb emission{0, 0, 0};
    std::optional<TextureId> emission_texture = std::nullopt;  ///< multiplies it
    bool two_sided = false;  ///< emits on both sides; everything else of it is seen from both sides anyway
    uint32_t uv_sets = 0;    ///< which texture coordinates its textures read: bit n stands for TEXCOORD_n
    /// Its mesh needs tangents, along these texture coordinates where it has none.
    std::optional<uint32_t> tangents = std::nullopt;
};

/// What COLOR_0 of a primitive has.
enum class VertexColors : uint8_t { none, rgb, rgba };

class Materials {
public:
    Materials(Context& context, Images& images) : context_(context), images_(images) {}

    /// Of a primitive; nothing: the default material of the specification.
    const Look& look(std::optional<uint32_t> number, VertexColors colors);
    /// Where the first of the materials that are in use says that light passes through it.
    std::optional<size_t> first_transmitting() const { return first_transmitting_; }

private:
    using Remove = void (*)(OpenPbrMaterial&);
    /// One material while it is being read.
    struct Reading {
        OpenPbrMaterial surface;
        Rgb emission{0, 0, 0};
        std::optional<TextureId> emission_texture;
        VertexColors colors = VertexColors::none;
        uint32_t uv_sets = 0;
        std::optional<NormalMap> normals;
        std::optional<uint32_t> tangents;
        uint32_t grain_uv_set = 0;
        std::optional<TextureUse> base_color;
        bool unlit = false;
        /// Where metal and dielectric are materials of their own: the part of the surface that is metal; the rest is
        /// as it stands here, to the part `reflects` with its specular layer.
        struct MetalPart {
            FloatInput weight;
            ColorInput color;
            std::optional<TextureId> reflects;
        };
        std::optional<MetalPart> metal;
        /// How many materials that are no mixes it becomes, without its layers.
        size_t parts() const { return !metal ? 1u : metal->reflects ? 3u : 2u; }
        bool solid = true;  ///< what transmits encloses a volume; false: it is a thin sheet
        /// What is there to a part that OpenPBR has no place for, mostly layers as far as a texture says.
        struct Layer {
            FloatInput weight;
            Remove remove;
        };
        std::vector<Layer> layers;
        /// Each layer doubles the materials.
        bool takes_another_layer() const { return parts() << (layers.size() + 1) <= kMaxMixed; }
    };
    static Reading start(VertexColors colors);
    Look read(const Object& material, VertexColors colors, const std::string& name);
    Look finish(const Reading& r, const std::string& name);
    void read_color_and_alpha(const Object& object, std::string_view factors, std::string_view map, Reading& r);
    void read_metallic_roughness(const Object& material, Reading& r);
    void read_alpha(const Object& material, Reading& r);
    void read_emission(const Object& material, Reading& r);
    void read_normals(const Object& material, Reading& r);
    std::optional<NormalMap> read_normal_map(const Object& object, std::string_view key, Reading& r);
    void multiply_by_vertices(std::optional<TextureId>& texture, bool alpha);
    MaterialId make(const Reading& r, const std::string& name);
    MaterialId make_plain(const Reading& r, const std::string& name);
    MaterialId make_split(const Reading& r, const std::string& name);
    MaterialId make_unlit(const Reading& r, const std::string& name);
    std::optional<Material> make_simple(const Reading& r, const std::string& name);
    std::optional<TextureId> texture(const Object& object, std::string_view key, Plane plane, Reading& r);
    TextureId texture(const TextureUse& use, Plane plane, ColorSpace space, Reading& r);
    float factor(double x, const Object& object, std::string_view key, double most = 1);
    float unit(const Object& object, std::string_view key, float fallback);
    Rgb color(const Object& object, std::string_view key, Rgb fallback, double most = 1);
    /// Of an extension's texture that the scene has no place for.
    void no_texture(const Object& object, std::string_view key);

    // specular_glossiness.cpp
    void read_specular_glossiness(const Object& extension, Reading& r);
    void report_excluded(const Object& material);

    // material_extensions.cpp, each by its extension.
    void read_extensions(const Object& material, Reading& r);
    void read_transmission(const Object& material, Reading& r);
    void read_dispersion(const Object& dispersion, Reading& r);
    double read_ior(const Object& material);
    void read_specular(const Object& material, Reading& r);
    static OpenPbrMaterial below_coat(OpenPbrMaterial s);
    void split_below_coat(const Object& clearcoat, Reading& r);
    void read_diffuse_transmission(const Object& material, Reading& r);
    void read_clearcoat(const Object& clearcoat, Reading& r);
    void read_sheen(const Object& sheen, Reading& r);
    void read_anisotropy(const Object& anisotropy, Reading& r);
    void read_iridescence(const Object& iridescence, Reading& r);
    void read_weight(const Object& extension, std::string_view key, Plane plane, Reading& r, Remove remove);

    Context& context_;
    Images& images_;
    std::optional<size_t> first_transmitting_;
    std::map<std::pair<std::optional<uint32_t>, VertexColors>, Look> looks_;
    std::array<std::optional<TextureId>, 2> vertex_colors_;
};

}  // namespace steradian::gltf
