// Materials that no real surface could have.
#include <fmt/format.h>

#include <cmath>

#include "lint/check.h"
#include "lint/texels.h"
#include "scene/texture_uses.h"

namespace steradian::lint_detail {
namespace {

/// Rounding of a sum of colours is no energy.
constexpr float kMostReflected = 1 + 1e-5f;
/// As GlassMaterial has it: nearer to 1 there is nothing to see of a boundary.
constexpr float kNoBoundary = 1e-3f;

class MaterialCheck {
public:
    explicit MaterialCheck(Check& check) : check_(check), scene_(check.scene), texels_(check.scene) {}

    void run() {
        for (uint32_t i = 0; i < scene_.materials.size(); ++i) {
            id_ = MaterialId(i);
            reported_ = false;
            std::visit([this](const auto& m) { look_at(m); }, scene_.materials[i]);
        }
    }

private:
    Element element() const { return {ElementKind::material, index(id_)}; }

    /// One finding for each material.
    void albedo(std::optional<Rgb> c, std::string_view what) {
        if (!c || reported_ || !(max_component(*c) > kMostReflected)) return;
        reported_ = true;
        check_.out.add(Rule::albedo_above_one, element(),
                       fmt::format("{}: {} is up to {:.4g}: surfaces that send more light on than they receive do not "
                                   "exist",
                                   check_.material(id_), what, max_component(*c)),
                       "values are linear and at most 1; a light is made with 'light' or emission");
    }
    /// Images of integers never exceed 1: what is not asked for is not decoded.
    bool may_exceed(TextureId id) const {
        bool out = false;
        each_factor(scene_, id, [&](TextureId t) {
            const auto* image = std::get_if<ImageTexture>(&scene_.textures[index(t)]);
            const TexelFormat format = image ? scene_.images[index(image->image)].format : TexelFormat::f32;
            out = out || format == TexelFormat::f16 || format == TexelFormat::f32;
        });
        return out;
    }
    void albedo(TextureId id, std::string_view what) {
        if (std::holds_alternative<VertexColorTexture>(scene_.textures[index(id)])) return vertex_colors(what);
        if (may_exceed(id)) albedo(texels_.highest(id), what);
    }
    void albedo(const ColorInput& input, float weight, std::string_view what) {
        const Rgb factor = input.value * weight;
        if (!input.texture)
            albedo(factor, what);
        else if (max_component(factor) > 1 || may_exceed(*input.texture))
            if (const auto highest = texels_.highest(*input.texture)) albedo(factor * *highest, what);
    }
    /// Of the meshes that have the material.
    void vertex_colors(std::string_view what) {
        for (uint32_t i = 0; i < scene_.instances.size() && !reported_; ++i) {
            const Mesh* mesh = scene_.instances[i].material == id_ ? check_.world.mesh_of(i) : nullptr;
            if (!mesh) continue;
            Rgb highest;
            for (const Rgb& c : mesh->colors)
                for (int k = 0; k < 3; ++k) highest[k] = max_of(highest[k], c[k]);
            albedo(highest, what);
        }
    }
    /// Fog has no boundary to see, and with a priority an index of 1 is that of a bubble.
    template <class Body>
    void index_of_body(const Body& m, float eta) {
        if (m.interior == Medium{} && !m.priority) index_of_refraction(eta);
    }
    void index_of_refraction(float eta) {
        if (!(std::fabs(eta - 1) < kNoBoundary)) return;
        check_.out.add(Rule::ior_one, element(),
                       fmt::format("{} has an index of refraction of {:.6g}: it neither bends nor reflects light",
                                   check_.material(id_), eta),
                       "glass has 1.5, water 1.33");
    }

    void look_at(const DiffuseMaterial& m) { albedo(m.reflectance, "reflectance"); }
    void look_at(const RefractionMaterial& m) { index_of_refraction(m.eta); }
    void look_at(const GlassMaterial& m) {
        index_of_body(m, m.eta);
        albedo(m.reflectance, "reflectance");
        albedo(m.transmittance, "transmittance");
    }
    void look_at(const ThinGlassMaterial& m) { index_of_refraction(m.eta); }
    void look_at(const MirrorMaterial& m) { albedo(m.reflectance, "reflectance"); }
    void look_at(const ConductorMaterial& m) {
        if (const auto* schlick = std::get_if<SchlickReflectance>(&m.reflectance)) {
            albedo(schlick->normal, "reflectance");
            albedo(schlick->grazing, "edge_reflectance");
        }
        albedo(m.tint, "tint");
    }
    void look_at(const DiffuseTransmissionMaterial& m) {
        albedo(m.reflectance, "reflectance");
        albedo(m.transmittance, "transmittance");
        const auto is_constant = [&](TextureId t) {
            return std::holds_alternative<ConstantTexture>(scene_.textures[index(t)]);
        };
        // Two pictures need not be at their brightest in the same place.
        if (reported_ || !(is_constant(m.reflectance) || is_constant(m.transmittance))) return;
        const auto r = texels_.highest(m.reflectance), t = texels_.highest(m.transmittance);
        if (r && t) albedo(*r + *t, "the sum of reflectance and transmittance");
    }
    void look_at(const OpenPbrMaterial& m) {
        if (m.transmission_weight.value > 0) index_of_body(m, m.specular_ior);
        albedo(m.base_color, m.base_weight, "base_color");
        if (m.subsurface_weight.value > 0) albedo(m.subsurface_color, 1, "subsurface_color");
        if (m.transmission_weight.value > 0) albedo(m.transmission_color, 1, "transmission_color");
        if (m.fuzz_weight.value > 0) albedo(m.fuzz_color, 1, "fuzz_color");
        if (m.coat_weight > 0) albedo(m.coat_color, 1, "coat_color");
    }
    void look_at(const MixMaterial&) {}

    Check& check_;
    const Scene& scene_;
    Texels texels_;
    MaterialId id_{};
    bool reported_ = false;
};

}  // namespace

void check_materials(Check& check) {
    if (check.out.wants(Rule::albedo_above_one) || check.out.wants(Rule::ior_one)) MaterialCheck(check).run();
}

}  // namespace steradian::lint_detail
