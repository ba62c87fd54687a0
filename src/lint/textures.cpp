// Textures that are read as something else than they are, or looked up without coordinates.
#include <fmt/format.h>

#include <cmath>
#include <set>

#include "lint/check.h"
#include "lint/texels.h"
#include "scene/texture_uses.h"
#include "shading/texture.h"

namespace steradian::lint_detail {
namespace {

bool holds_integers(const RawImage& image) {
    return image.format == TexelFormat::u8 || image.format == TexelFormat::u16;
}

class TextureCheck {
public:
    explicit TextureCheck(Check& check) : check_(check), scene_(check.scene), texels_(check.scene) {}

    void run() {
        const auto look = [&](TextureId id, TextureRole role, std::string_view what) { look_at(id, role, what); };
        for (uint32_t i = 0; i < scene_.materials.size(); ++i) {
            user_ = check_.material(MaterialId(i));
            each_texture(scene_.materials[i], look);
        }
        for (const Relief& relief : scene_.reliefs) {
            user_ = check_.material(relief.material);
            each_texture(relief, look);
        }
        for (uint32_t i = 0; i < scene_.lights.size(); ++i) {
            user_ = check_.name({ElementKind::light, i});
            const auto* area = std::get_if<AreaLight>(&scene_.lights[i]);
            if (area && area->texture) look_at(*area->texture, TextureRole::emission, "texture");
        }
        for (uint32_t i = 0; i < scene_.images.size(); ++i)
            if (const uint64_t bad = count_bad_texels(scene_.images[i], false))
                check_.out.add(
                    Rule::out_of_range, Element{ElementKind::image, i},
                    fmt::format("{}: {} texel{} not finite and count{} as 0", check_.name({ElementKind::image, i}), bad,
                                bad == 1 ? " is" : "s are", bad == 1 ? "s" : ""));
    }

private:
    void look_at(TextureId whole, TextureRole role, std::string_view what) {
        each_factor(scene_, whole, [&](TextureId id) {
            const auto* texture = std::get_if<ImageTexture>(&scene_.textures[index(id)]);
            // Once for each texture and what it is read for, however many materials do.
            if (!texture || !seen_.insert({id, role}).second) return;
            const RawImage& image = scene_.images[index(texture->image)];
            const Element element{ElementKind::texture, index(id)};
            if (!(role == TextureRole::color && is_of_normals(image, element, what)))
                color_space(*texture, image, element, role, what);
            if (role == TextureRole::number && !holds_integers(image)) range(*texture, element, what);
            if (role == TextureRole::normal) normals(image, element);
        });
    }

    void color_space(const ImageTexture& texture, const RawImage& image, Element element, TextureRole role,
                     std::string_view what) {
        if (!check_.out.wants(Rule::color_space)) return;
        const bool is_color = role == TextureRole::color || role == TextureRole::emission;
        const bool as_srgb = texture.color_space == ColorSpace::srgb;
        if (is_color ? (as_srgb || image.format != TexelFormat::u8 || image.channels < 3) : !as_srgb) return;
        if (texels_.range(texture.image, texture.color_space).black_and_white) return;
        check_.out.add(Rule::color_space, element,
                       is_color ? fmt::format("{} is read as linear for '{}' of {}: 8-bit pictures of colours are sRGB",
                                              check_.name(element), what, user_)
                                : fmt::format("{} is read as sRGB for '{}' of {}, which is a number and no colour",
                                              check_.name(element), what, user_),
                       fmt::format("\"color_space\": \"{}\"", is_color ? "srgb" : "linear"));
    }

    void range(const ImageTexture& texture, Element element, std::string_view what) {
        const TexelRange& r = texels_.range(texture.image, texture.color_space);
        if (r.lowest.r >= 0 && r.highest.r <= 1) return;
        check_.out.add(Rule::out_of_range, element,
                       fmt::format("{} has values from {:.4g} to {:.4g} for '{}' of {}, which is clamped to 0 … 1",
                                   check_.name(element), r.lowest.r, r.highest.r, what, user_));
    }

    /// Normals have length 1, which eight bits keep to within 1 %. Of anything else, half of the texels do not.
    void normals(const RawImage& image, Element element) {
        const NormalTexels t = normal_texels(image);
        std::string fault, hint = "2 rgb - 1 is a unit vector; a picture of heights is a bump map";
        if (2 * t.roughly_unit < t.looked_at) {
            fault = fmt::format("{} % of its texels are not of unit length",
                                100 * (t.looked_at - t.roughly_unit) / t.looked_at);
        } else if (2 * t.inwards > t.looked_at) {
            fault = fmt::format("{} % of its texels point into the surface", 100 * t.inwards / t.looked_at);
        }
        if (t.decoded() && (2 * t.unit < t.looked_at)) {
            fault = fmt::format("{} % of its texels are unit vectors once they are decoded as sRGB",
                                100 * t.unit_decoded / t.looked_at);
            hint = "it was saved as colours: save the numbers as they are";
        }
        if (!fault.empty())
            check_.out.add(Rule::normal_map, element,
                           fmt::format("{} is no normal map of {}: {}", check_.name(element), user_, fault), hint);
    }

    /// Whether a picture of colours was meant.
    bool is_of_normals(const RawImage& image, Element element, std::string_view what) {
        if (!check_.out.wants(Rule::color_space) || !holds_integers(image) || image.channels < 3) return false;
        const NormalTexels t = normal_texels(image);
        if (!t.normal_map()) return false;
        check_.out.add(Rule::color_space, element,
                       fmt::format("{} is read as colours for '{}' of {} and looks like a normal map: {} % of its "
                                   "texels are unit vectors about +z",
                                   check_.name(element), what, user_, 100 * t.unit / t.looked_at),
                       "were two textures mixed up?");
        return true;
    }

    Check& check_;
    const Scene& scene_;
    Texels texels_;
    std::string user_;
    std::set<std::pair<TextureId, TextureRole>> seen_;
};

/// Image and checker textures of a material and its parts that look different in different places.
class Lookups {
public:
    explicit Lookups(const Scene& scene) : scene_(scene), of_(scene.materials.size()), colors_(scene.materials.size()) {
        for (uint32_t i = 0; i < scene.materials.size(); ++i) {
            each_texture(scene.materials[i], [&](TextureId t, TextureRole, std::string_view) { add(i, t); });
            if (const auto* mix = std::get_if<MixMaterial>(&scene.materials[i]))
                for (const MaterialId part : {mix->first, mix->second}) {
                    of_[i] |= of_[index(part)];
                    colors_[i] = colors_[i] || colors_[index(part)];
                }
        }
        for (const Relief& relief : scene.reliefs)
            each_texture(relief, [&](TextureId t, TextureRole, std::string_view) { add(index(relief.material), t); });
    }
    /// Bit n stands for set n.
    uint32_t uv_sets(MaterialId id) const { return of_[index(id)]; }
    bool vertex_colors(MaterialId id) const { return colors_[index(id)]; }
    uint32_t uv_sets(TextureId whole) const {
        uint32_t out = 0;
        each_factor(scene_, whole, [&](TextureId t) {
            const Texture& texture = scene_.textures[index(t)];
            if (std::holds_alternative<CheckerTexture>(texture)) out |= 1;
            const auto* image = std::get_if<ImageTexture>(&texture);
            if (!image) return;
            const RawImage& texels = scene_.images[index(image->image)];
            if (texels.width > 1 || texels.height > 1) out |= 1u << image->uv_set;
        });
        return out;
    }

private:
    void add(uint32_t material, TextureId texture) {
        of_[material] |= uv_sets(texture);
        each_factor(scene_, texture, [&](TextureId t) {
            if (std::holds_alternative<VertexColorTexture>(scene_.textures[index(t)])) colors_[material] = true;
        });
    }
    const Scene& scene_;
    std::vector<uint32_t> of_;
    std::vector<bool> colors_;
};

bool has_uvs(const Mesh& mesh, uint32_t set) {
    if (set == 0) return !mesh.uvs.empty();
    return set <= mesh.more_uvs.size() && !mesh.more_uvs[set - 1].empty();
}

void check_attributes(Check& check) {
    const Scene& scene = check.scene;
    const Lookups lookups(scene);
    std::vector<uint32_t> lights(scene.instances.size());
    for (const Light& light : scene.lights)
        if (const auto* area = std::get_if<AreaLight>(&light); area && area->texture)
            lights[index(area->instance)] |= lookups.uv_sets(*area->texture);
    std::set<std::tuple<const Mesh*, MaterialId, uint32_t>> seen;
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
        const Mesh* mesh = check.world.mesh_of(i);
        const MaterialId material = scene.instances[i].material;
        if (!mesh || mesh->indices.empty() || !seen.insert({mesh, material, lights[i]}).second) continue;
        const Element element{ElementKind::instance, i};
        const uint32_t sets = lookups.uv_sets(material) | lights[i];
        for (uint32_t set = 0; set < kMaxUvSets; ++set) {
            if (!(sets >> set & 1) || has_uvs(*mesh, set)) continue;
            const bool none = mesh->uvs.empty();
            check.out.add(Rule::missing_uvs, element,
                          none ? fmt::format("{} has no texture coordinates for the textures of {}", check.object(i),
                                             check.material(material))
                               : fmt::format("{} has no texture coordinates of set {} for the textures of {}: set 0 is "
                                             "used",
                                             check.object(i), set, check.material(material)),
                          none ? "without them every triangle shows its textures by itself" : "");
            break;
        }
        if (lookups.vertex_colors(material) && mesh->colors.empty() && mesh->alphas.empty())
            check.out.add(Rule::missing_colors, element,
                          fmt::format("{} has no colours of vertices for {}: it is white", check.object(i),
                                      check.material(material)));
    }
}

}  // namespace

void check_textures(Check& check) {
    const auto wants = [&](auto... rules) { return (check.out.wants(rules) || ...); };
    if (wants(Rule::color_space, Rule::normal_map, Rule::out_of_range)) TextureCheck(check).run();
    if (wants(Rule::missing_uvs, Rule::missing_colors)) check_attributes(check);
}

}  // namespace steradian::lint_detail
