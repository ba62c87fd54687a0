// The reader of Steradian's own scene format, version 1 (docs/scene-format.md).
#pragma once

#include <map>
#include <optional>
#include <string>

#include "formats/scene_json/common.h"

namespace steradian::scene_json {

class NativeLoader {
public:
    explicit NativeLoader(const Context& context)
        : context_(context), source_(context.source), assets_(context.assets) {}

    void load(Value root);

private:
    // native.cpp
    void read_version(Value version) const;
    void read_film(Value value);
    AovSet read_aovs(Value value) const;
    void read_cameras(ObjectReader& scene);
    void read_camera(Value value, std::string name);
    void read_render(Value value);

    // native_surfaces.cpp
    void read_textures(Value value);
    TextureId read_texture(Value value, const std::string& name, bool numbers = false);
    TextureId read_image_texture(Value value, const std::string& name, bool numbers);
    /// What a texture is read for: images of numbers are linear by themselves, and only what reflects should not
    /// exceed 1. Weights are those numbers that an image has in its own colour space; they are clamped.
    enum class TextureUse : uint8_t { reflection, emission, weight, numbers };
    /// The name of a texture, or a texture; nothing for other values.
    std::optional<TextureId> find_texture(Value value, TextureUse use = TextureUse::reflection);
    /// A colour, the name of a texture, or a texture.
    TextureId read_reflectance(ObjectReader& material, std::string_view key = "reflectance");
    /// "roughness" or "alpha": a number, two, or a texture.
    Roughness read_roughness(ObjectReader& material);
    ConductorMaterial read_conductor(ObjectReader& material);
    GlassMaterial read_glass(ObjectReader& material);
    Rgb read_tint(ObjectReader& material, std::string_view key);
    Medium read_interior(ObjectReader& material);
    Priority read_priority(ObjectReader& material);
    FloatInput read_input(ObjectReader& material, std::string_view key, FloatInput fallback);
    ColorInput read_input(ObjectReader& material, std::string_view key, ColorInput fallback,
                          TextureUse use = TextureUse::reflection);
    OpenPbrMaterial read_open_pbr(ObjectReader& material);
    FilmThickness read_film_thickness(Value value);
    void read_open_pbr_interior(ObjectReader& material, OpenPbrMaterial& m);
    // native_no_effect.cpp
    void note_no_effect(ObjectReader& material, std::string_view key, const std::string& why);
    void find_no_effect(ObjectReader& material, const OpenPbrMaterial& m);
    void find_no_effect(ObjectReader& material, const GlassMaterial& m);
    DiffuseTransmissionMaterial read_diffuse_transmission(ObjectReader& material);
    /// "normal_map" or "bump_map"; `material` is filled in later.
    std::optional<Relief> read_relief(ObjectReader& material);
    /// A texture of numbers that are no colours: linear.
    TextureId read_numbers(Value value, std::string_view what);
    /// A texture, or an object with one and more.
    NormalMap read_normal_map(Value value, std::string_view what);
    MixMaterial read_mix(ObjectReader& material);
    void read_materials(Value value);
    MaterialId read_material(Value value, const std::string& name);
    /// A name or a material.
    MaterialId use_material(Value value);

    // native_objects.cpp
    /// What an object or a named shape is made of: one of the two.
    struct Geometry {
        std::optional<size_t> model;
        std::optional<ShapeId> shape;
    };
    struct Emission {
        Rgb radiance;
        bool two_sided;
        uint32_t samples;
        bool visible_to_camera;
        std::optional<TextureId> texture;
    };
    void read_shapes(Value value);
    Geometry read_geometry(ObjectReader& reader, size_t type, const std::string& name);
    Geometry read_mesh(ObjectReader& reader, const std::string& name);
    Mesh read_inline_mesh(ObjectReader& reader) const;
    void read_objects(Value value);
    void read_object(Value value);
    void make_emitters(InstanceRange range, const Emission& emission, const std::string& name);
    Emission read_emission(ObjectReader& reader);

    // native_lights.cpp
    void read_lights(Value value);
    void read_point_light(Value value);
    void read_spot_light(Value value);
    void read_directional_light(Value value);
    void read_area_light(Value value);
    void read_environment_light(Value value);
    void read_goniometric_light(Value value);
    /// "intensity", or "flux" times `per_flux`: one of the two.
    Rgb read_intensity(ObjectReader& reader, double per_flux) const;

    Scene& scene() { return context_.loaded.scene; }

    struct NamedObject {
        InstanceRange instances;
        bool emits;
    };
    const Context& context_;
    const Source& source_;
    Assets& assets_;
    NameTable<TextureId> textures_{"texture"};
    struct Bright {
        Rgb color;
        size_t offset;
    };
    std::map<TextureId, Bright> too_bright_;  ///< textures above 1 that nothing reflects by, so far
    NameTable<MaterialId> materials_{"material"};
    NameTable<Geometry> shapes_{"shape"};
    NameTable<NamedObject> objects_{"object"};
    bool has_environment_ = false;
};

}  // namespace steradian::scene_json
