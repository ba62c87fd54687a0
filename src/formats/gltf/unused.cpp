#include "formats/gltf/unused.h"

#include <cmath>
#include <map>

namespace steradian::gltf {
namespace {

std::optional<Value> member(Value object, std::string_view key) {
    if (object.is(Kind::object))
        for (const json::Member m : object.members())
            if (m.key == key) return m.value;
    return std::nullopt;
}

/// Calls `visit` for every element of an array that is a member.
template <class Visit>
void each_element(Value object, std::string_view key, const Visit& visit) {
    const auto array = member(object, key);
    if (array && array->is(Kind::array))
        for (const Value element : array->elements()) visit(element);
}

class References {
public:
    /// What an index that stands somewhere in the file refers to.
    void add(const Table& table, std::optional<Value> index) {
        std::vector<bool>& used = used_[table.key];
        used.resize(table.elements.size());
        if (!index || !index->is(Kind::number)) return;
        const double i = index->number();
        if (i >= 0 && i < static_cast<double>(used.size()) && std::floor(i) == i) used[static_cast<size_t>(i)] = true;
    }
    void add(const Table& table, Value object, std::string_view key) { add(table, member(object, key)); }

    template <class Visit>
    void each_unused(const Table& table, const Visit& visit) {
        std::vector<bool>& used = used_[table.key];
        used.resize(table.elements.size());
        for (uint32_t i = 0; i < used.size(); ++i)
            if (!used[i]) visit(table.elements[i], i);
    }

private:
    std::map<std::string_view, std::vector<bool>> used_;
};

std::optional<Value> extension(Value object, std::string_view name) {
    const auto all = member(object, "extensions");
    return all ? member(*all, name) : std::nullopt;
}

void add_meshes(const Tables& tables, References& references) {
    for (const Value mesh : tables.meshes.elements)
        each_element(mesh, "primitives", [&](Value primitive) {
            references.add(tables.materials, primitive, "material");
            if (const auto variants = extension(primitive, "KHR_materials_variants"))
                each_element(*variants, "mappings",
                             [&](Value mapping) { references.add(tables.materials, mapping, "material"); });
        });
}

void add_nodes(const Tables& tables, References& references) {
    for (const Value scene : tables.scenes.elements)
        each_element(scene, "nodes", [&](Value node) { references.add(tables.nodes, node); });
    for (const Value node : tables.nodes.elements) {
        each_element(node, "children", [&](Value child) { references.add(tables.nodes, child); });
        references.add(tables.meshes, node, "mesh");
        references.add(tables.cameras, node, "camera");
        references.add(tables.skins, node, "skin");
        if (const auto light = extension(node, "KHR_lights_punctual")) references.add(tables.lights, *light, "light");
    }
}

/// Textures are referred to by the "index" of objects whose keys end so, at any depth: extensions have theirs.
void add_materials(const Tables& tables, References& references) {
    std::vector<Value> open(tables.materials.elements.begin(), tables.materials.elements.end());
    while (!open.empty()) {
        const Value value = open.back();
        open.pop_back();
        if (!value.is(Kind::object)) continue;
        for (const json::Member m : value.members()) {
            if (m.key.ends_with("Texture")) references.add(tables.textures, m.value, "index");
            open.push_back(m.value);
        }
    }
}

void add_textures(const Tables& tables, References& references) {
    for (const Value texture : tables.textures.elements) {
        references.add(tables.images, texture, "source");
        if (const auto extensions = member(texture, "extensions"); extensions && extensions->is(Kind::object))
            for (const json::Member m : extensions->members()) references.add(tables.images, m.value, "source");
    }
}

std::optional<double> number(Value object, std::string_view key) {
    const auto value = member(object, key);
    return value && value->is(Kind::number) ? std::optional(value->number()) : std::nullopt;
}

}  // namespace

void find_ineffective(Context& context) {
    for (const Value material : context.tables.materials.elements) {
        const auto occlusion = member(material, "occlusionTexture");
        if (!occlusion) continue;
        context.unused("'occlusionTexture' has no effect: how much light comes into corners is computed",
                       occlusion->offset(), "no-effect");
        const double strength = number(*occlusion, "strength").value_or(1);
        if (!(strength >= 0 && strength <= 1))
            context.unused("'strength' of an 'occlusionTexture' must be between 0 and 1", occlusion->offset(),
                           "out-of-range");
    }
    for (const Value camera : context.tables.cameras.elements)
        for (const std::string_view kind : {"perspective", "orthographic"}) {
            const auto shape = member(camera, kind);
            if (!shape) continue;
            const auto near = number(*shape, "znear"), far = number(*shape, "zfar");
            const bool good_near = !near || (kind == "perspective" ? *near > 0 : *near >= 0);
            if (!good_near || (far && !(*far > near.value_or(0))))
                context.unused("'znear' of a camera must be positive, and 'zfar' beyond it; they have no effect",
                               shape->offset(), "out-of-range");
        }
}

void find_unused(Context& context) {
    const Tables& tables = context.tables;
    References references;
    add_meshes(tables, references);
    add_nodes(tables, references);
    add_materials(tables, references);
    add_textures(tables, references);
    for (const Table* table : {&tables.cameras, &tables.images, &tables.lights, &tables.materials, &tables.meshes,
                               &tables.skins, &tables.textures})
        references.each_unused(*table, [&](Value element, uint32_t i) {
            const auto name = member(element, "name");
            const std::string shown = name && name->is(Kind::string) && !name->string().empty()
                                          ? std::string(table->what) + " " + quoted(name->string())
                                          : std::string(table->what) + " " + std::to_string(i);
            context.unused(shown + " is not used", element.offset());
        });
    // Without scenes all nodes are shown.
    if (!tables.scenes.elements.empty())
        references.each_unused(tables.nodes, [&](Value node, uint32_t i) {
            context.unused("node " + std::to_string(i) + " is in no scene", node.offset());
        });
}

}  // namespace steradian::gltf
