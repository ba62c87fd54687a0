#include "formats/gltf/meshes.h"

#include <algorithm>
#include <numeric>

namespace steradian::gltf {
namespace {

constexpr uint32_t kTriangles = 4, kStrip = 5, kFan = 6;

}  // namespace

std::vector<uint32_t> as_triangles(std::vector<uint32_t> corners, uint32_t mode) {
    if (mode == kTriangles) {
        corners.resize(corners.size() / 3 * 3);
        return corners;
    }
    std::vector<uint32_t> out;
    const size_t triangles = corners.size() < 3 ? 0 : corners.size() - 2;
    out.reserve(3 * triangles);
    for (size_t i = 0; i < triangles; ++i) {
        const size_t odd = i % 2;
        if (mode == kStrip)
            out.insert(out.end(), {corners[i], corners[i + 1 + odd], corners[i + 2 - odd]});
        else
            out.insert(out.end(), {corners[i + 1], corners[i + 2], corners[0]});
    }
    return out;
}

Accessor Meshes::open_attribute(const Object& primitive, std::string_view name, uint32_t number, uint32_t components) {
    const Accessor accessor = accessors_.open(number);
    if (accessor.components != components || accessor.component == ComponentType::u32) {
        const Object attributes(context_.source, primitive.require("attributes"), "'attributes'");
        context_.source.fail(attributes.offset_of(name), quoted(name) + " must be vectors of " +
                                                             std::to_string(components) +
                                                             " floats, or of integers with at most 16 bits");
    }
    return accessor;
}

std::vector<uint32_t> Meshes::corners(const Object& primitive, const Key& key, uint64_t vertices) {
    std::vector<uint32_t> out;
    if (key[3] == kNone) {
        context_.budget.take(vertices * sizeof(uint32_t), context_.source, primitive.offset());
        out.resize(vertices);
        std::iota(out.begin(), out.end(), 0u);
    } else {
        const Accessor accessor = accessors_.open(key[3]);
        out = accessors_.read_indices(accessor);
        const auto wrong = std::find_if(out.begin(), out.end(), [&](uint32_t i) { return i >= vertices; });
        if (wrong != out.end()) {
            const uint64_t largest = (uint64_t(1) << 8 * size_of(accessor.component)) - 1;
            context_.source.fail(primitive.offset_of("indices"),
                                 "index number " + std::to_string(wrong - out.begin()) + " is " +
                                     std::to_string(*wrong) + ", but there are " + std::to_string(vertices) +
                                     " vertices",
                                 *wrong == largest ? "glTF does not know primitive restart" : "");
        }
    }
    const uint32_t mode = key[4];
    if (mode == kTriangles ? out.size() % 3 != 0 : out.size() < 3)
        context_.warn("the number of corners does not make whole triangles; what is left over is ignored",
                      primitive.offset());
    if (mode != kTriangles)
        context_.budget.take(3 * out.size() * sizeof(uint32_t), context_.source, primitive.offset());
    return as_triangles(std::move(out), mode);
}

std::optional<Mesh> Meshes::read(const Object& primitive, const Key& key) {
    const Accessor positions = open_attribute(primitive, "POSITION", key[0], 3);
    Mesh mesh;
    mesh.indices = corners(primitive, key, positions.count);
    if (mesh.indices.empty()) return std::nullopt;
    mesh.positions = accessors_.read_vec3(positions);
    const auto check_count = [&](const Accessor& accessor, std::string_view name) {
        if (accessor.count == positions.count) return;
        const Object attributes(context_.source, primitive.require("attributes"), "'attributes'");
        context_.source.fail(attributes.offset_of(name), quoted(name) + " has " + std::to_string(accessor.count) +
                                                             " elements, but there are " +
                                                             std::to_string(positions.count) + " positions");
    };
    if (key[1] != kNone) {
        const Accessor normals = open_attribute(primitive, "NORMAL", key[1], 3);
        check_count(normals, "NORMAL");
        mesh.normals = accessors_.read_vec3(normals);
    }
    if (key[2] != kNone) {
        const Accessor uvs = open_attribute(primitive, "TEXCOORD", key[2], 2);
        check_count(uvs, "TEXCOORD");
        mesh.uvs = accessors_.read_vec2(uvs);
    }
    return mesh;
}

std::optional<ShapeId> Meshes::shape(const Object& primitive, const Look& look, const std::string& name) {
    const Object attributes(context_.source, primitive.require("attributes"), "'attributes'");
    const auto mode = static_cast<uint32_t>(primitive.integer_or("mode", kTriangles, 0, kFan));
    if (mode < kTriangles) {
        context_.not_honoured("points and lines are not rendered", primitive.offset());
        return std::nullopt;
    }
    const auto accessor = [&](const Object& object, std::string_view key) {
        return object.reference(key, context_.tables.accessors).value_or(kNone);
    };
    const Key key{accessor(attributes, "POSITION"), accessor(attributes, "NORMAL"),
                  accessor(attributes, "TEXCOORD_" + std::to_string(look.uv_set)), accessor(primitive, "indices"),
                  mode};
    if (key[0] == kNone) {
        context_.warn("a primitive without positions is ignored", attributes.offset());
        return std::nullopt;
    }
    if (attributes.has("COLOR_0"))
        context_.not_honoured("the colours of vertices have no effect", attributes.offset_of("COLOR_0"));
    if (const auto known = shapes_.find(key); known != shapes_.end()) return known->second;
    std::optional<ShapeId> made;
    if (auto mesh = read(primitive, key)) {
        const MeshId id = context_.assets.add_mesh(std::move(*mesh), name);
        made = context_.assets.add_shape(id, name);
    }
    shapes_.emplace(key, made);
    return made;
}

/// What the chosen variant says (KHR_materials_variants), or else the primitive's own.
std::optional<uint32_t> Meshes::material_of(const Object& primitive) {
    const auto variants = context_.variant ? primitive.extension("KHR_materials_variants") : std::nullopt;
    if (variants)
        for (const Value value : variants->array("mappings")) {
            const Object mapping(context_.source, value, "a mapping");
            for (const Value variant : mapping.array("variants"))
                if (read_reference(context_.source, variant, "variants", context_.tables.variants) == *context_.variant)
                    return mapping.require_reference("material", context_.tables.materials);
        }
    return primitive.reference("material", context_.tables.materials);
}

const std::vector<Meshes::Part>& Meshes::parts(uint32_t number) {
    if (const auto known = meshes_.find(number); known != meshes_.end()) return known->second;
    const Object mesh(context_.source, context_.tables.meshes.elements[number], "a mesh");
    const std::string name = name_of(mesh, "mesh", number);
    mesh.require("primitives");
    std::vector<Part> parts;
    for (const Value value : mesh.array("primitives")) {
        const Object primitive(context_.source, value, "a primitive");
        const Look& look = materials_.look(material_of(primitive));
        if (const auto made = shape(primitive, look, name)) parts.push_back({*made, look});
        if (!primitive.array("targets").empty())
            context_.not_honoured("morph targets are not applied", primitive.offset_of("targets"));
    }
    return meshes_.emplace(number, std::move(parts)).first->second;
}

}  // namespace steradian::gltf
