// What nothing uses.
#include <fmt/format.h>

#include <algorithm>

#include "lint/check.h"
#include "scene/texture_uses.h"

namespace steradian::lint_detail {
namespace {

class Usage {
public:
    explicit Usage(const Scene& scene) {
        const size_t sizes[kElementKinds] = {scene.images.size(),
                                             scene.textures.size(),
                                             scene.materials.size(),
                                             scene.meshes.size(),
                                             scene.shapes.size(),
                                             0,
                                             0,
                                             0,
                                             scene.profiles.size()};
        for (size_t kind = 0; kind < kElementKinds; ++kind) used_[kind].resize(sizes[kind]);
        const auto texture = [&](TextureId id) { mark(ElementKind::texture, id); };
        const auto of_material = [&](TextureId id, TextureRole, std::string_view) { texture(id); };
        for (const Texture& t : scene.textures) {
            if (const auto* image = std::get_if<ImageTexture>(&t)) mark(ElementKind::image, image->image);
            if (const auto* product = std::get_if<ProductTexture>(&t))
                texture(product->first), texture(product->second);
        }
        for (const Material& m : scene.materials) {
            each_texture(m, of_material);
            if (const auto* mix = std::get_if<MixMaterial>(&m))
                mark(ElementKind::material, mix->first), mark(ElementKind::material, mix->second);
        }
        for (const Relief& relief : scene.reliefs) each_texture(relief, of_material);
        for (const Shape& shape : scene.shapes)
            if (const auto* mesh = std::get_if<MeshId>(&shape)) mark(ElementKind::mesh, *mesh);
        for (const Instance& i : scene.instances)
            mark(ElementKind::shape, i.shape), mark(ElementKind::material, i.material);
        for (const Light& light : scene.lights) add(light);
    }

    /// Ascending, kind by kind.
    template <class Visit>
    void each_unused(const Visit& visit) const {
        for (size_t kind = 0; kind < kElementKinds; ++kind)
            for (uint32_t i = 0; i < used_[kind].size(); ++i)
                if (!used_[kind][i]) visit(Element{static_cast<ElementKind>(kind), i});
    }

private:
    template <class Id>
    void mark(ElementKind kind, Id id) {
        used_[static_cast<size_t>(kind)][index(id)] = true;
    }
    void add(const Light& light) {
        if (const auto* area = std::get_if<AreaLight>(&light); area && area->texture)
            mark(ElementKind::texture, *area->texture);
        if (const auto* sky = std::get_if<EnvironmentLight>(&light); sky && sky->image)
            mark(ElementKind::image, *sky->image);
        if (const auto* lamp = std::get_if<GoniometricLight>(&light)) mark(ElementKind::profile, lamp->profile);
    }

    std::array<std::vector<bool>, kElementKinds> used_;
};

}  // namespace

void check_usage(Check& check) {
    if (!check.out.wants(Rule::unused)) return;
    std::vector<Element> consumed(check.consumed.begin(), check.consumed.end());
    std::sort(consumed.begin(), consumed.end());
    Usage(check.scene).each_unused([&](Element element) {
        if (std::binary_search(consumed.begin(), consumed.end(), element)) return;
        check.out.add(Rule::unused, element, fmt::format("{} is not used", check.name(element)));
    });
}

}  // namespace steradian::lint_detail
