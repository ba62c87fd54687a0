#include "formats/gltf/meshes.h"

#include <algorithm>
#include <numeric>

#include "formats/mesh/tangent_space.h"
#include "math/vector.h"

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
    if (!accessor.has_vectors_of(components) || accessor.component == ComponentType::u32) {
        const Object attributes(context_.source, primitive.require("attributes"), "'attributes'");
        context_.source.fail(attributes.offset_of(name), quoted(name) + " must be vectors of " +
                                                             std::to_string(components) +
                                                             " floats, or of integers with at most 16 bits");
    }
    return accessor;
}

Accessor Meshes::open_attribute(const Object& primitive, std::string_view name, uint32_t number, uint32_t components,
                                uint64_t vertices) {
    const Accessor accessor = open_attribute(primitive, name, number, components);
    if (accessor.count != vertices) {
        const Object attributes(context_.source, primitive.require("attributes"), "'attributes'");
        context_.source.fail(attributes.offset_of(name), quoted(name) + " has " + std::to_string(accessor.count) +
                                                             " elements, but there are " + std::to_string(vertices) +
                                                             " positions");
    }
    return accessor;
}

std::vector<uint32_t> Meshes::corners(const Object& primitive, const Key& key, uint64_t vertices) {
    std::vector<uint32_t> out;
    if (key.indices == kNone) {
        context_.budget.take(vertices * sizeof(uint32_t), context_.source, primitive.offset());
        out.resize(vertices);
        std::iota(out.begin(), out.end(), 0u);
    } else {
        const Accessor accessor = accessors_.open(key.indices);
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
    const uint32_t mode = key.mode;
    if (mode == kTriangles ? out.size() % 3 != 0 : out.size() < 3)
        context_.warn("the number of corners does not make whole triangles; what is left over is ignored",
                      primitive.offset());
    if (mode != kTriangles)
        context_.budget.take(3 * out.size() * sizeof(uint32_t), context_.source, primitive.offset());
    return as_triangles(std::move(out), mode);
}

/// All sets that textures read; zeros where the primitive has no such set.
void Meshes::read_uvs(const Object& primitive, const Key& key, Mesh& mesh) {
    const uint64_t vertices = mesh.positions.size();
    for (uint32_t set = 0; set < kMaxUvSets; ++set) {
        if (!(key.uv_sets >> set & 1)) continue;
        std::vector<Vec2> uvs;
        if (key.uvs[set] == kNone) {
            context_.warn("a primitive lacks texture coordinates that its material reads: zeros are used",
                          primitive.offset());
            context_.budget.take(vertices * sizeof(Vec2), context_.source, primitive.offset());
            uvs.resize(vertices);
        } else {
            const std::string name = "TEXCOORD_" + std::to_string(set);
            uvs = accessors_.read_vec2(open_attribute(primitive, name, key.uvs[set], 2, vertices));
        }
        if (set > 0) mesh.more_uvs.resize(set);
        (set == 0 ? mesh.uvs : mesh.more_uvs[set - 1]) = std::move(uvs);
    }
}

void Meshes::read_colors(const Object& primitive, const Key& key, Mesh& mesh) {
    const uint32_t components = colors_of(primitive) == VertexColors::rgba ? 4 : 3;
    const Accessor colors = open_attribute(primitive, "COLOR_0", key.colors, components, mesh.positions.size());
    bool clamped = false;
    const auto unit = [&](float& x) {
        if (x >= 0 && x <= 1) return;
        x = clamp_to(x, 0.0f, 1.0f);
        clamped = true;
    };
    mesh.colors = accessors_.read_rgb(colors);
    for (Rgb& c : mesh.colors) unit(c.r), unit(c.g), unit(c.b);
    if (components == 4) mesh.alphas = accessors_.read_component(colors, 3);
    for (float& a : mesh.alphas) unit(a);
    if (clamped)
        context_.warn("colours of vertices must be between 0 and 1 and were clamped", colors.offset, "out-of-range");
}

/// MikkTSpace, of the vertices as they are rendered.
void Meshes::add_made_tangents(const Object& primitive, const Key& key, Mesh& mesh) {
    if (!key.made_tangents) return;
    constexpr uint64_t kMostPerCorner = sizeof(Tangent) + sizeof(Vec3) * 2 + sizeof(Vec2);
    context_.budget.take(mesh.indices.size() * kMostPerCorner, context_.source, primitive.offset());
    add_tangents(mesh, *key.made_tangents);
}

std::optional<Mesh> Meshes::read(const Object& primitive, const Key& key, const Joints* joints) {
    const Accessor positions = open_attribute(primitive, "POSITION", key.positions, 3);
    Mesh mesh;
    mesh.indices = corners(primitive, key, positions.count);
    if (mesh.indices.empty()) return std::nullopt;
    mesh.positions = accessors_.read_vec3(positions);
    if (key.normals != kNone)
        mesh.normals = accessors_.read_vec3(open_attribute(primitive, "NORMAL", key.normals, 3, positions.count));
    read_uvs(primitive, key, mesh);
    if (key.colors != kNone) read_colors(primitive, key, mesh);
    if (key.tangents != kNone)
        mesh.tangents =
            accessors_.read_tangents(open_attribute(primitive, "TANGENT", key.tangents, 4, positions.count));
    if (!key.targets.empty()) morph(context_, accessors_, key.targets, mesh);
    if (!key.influences.empty())
        skin(context_, accessors_, Object(context_.source, primitive.require("attributes"), "'attributes'"),
             key.influences, *joints, mesh);
    add_made_tangents(primitive, key, mesh);
    return mesh;
}

Meshes::Key Meshes::key_of(const Object& primitive, const Object& attributes, const Look& look, uint32_t mode) {
    const auto accessor = [&](const Object& object, std::string_view name) {
        return object.reference(name, context_.tables.accessors).value_or(kNone);
    };
    Key key;
    key.positions = accessor(attributes, "POSITION");
    key.normals = accessor(attributes, "NORMAL");
    key.colors = accessor(attributes, "COLOR_0");
    key.indices = accessor(primitive, "indices");
    key.mode = mode;
    // The first set is there to look at (the uv integrator and AOV) even where no texture reads it.
    key.uv_sets = look.uv_sets | (attributes.has("TEXCOORD_0") ? 1u : 0u);
    key.uvs.fill(kNone);
    for (uint32_t set = 0; set < kMaxUvSets; ++set)
        if (key.uv_sets >> set & 1) key.uvs[set] = accessor(attributes, "TEXCOORD_" + std::to_string(set));
    // Flat normals leave no use for tangents of vertices (section 3.7.2.1 of the specification).
    if (look.tangents && key.normals != kNone) {
        key.tangents = accessor(attributes, "TANGENT");
        if (key.tangents == kNone) key.made_tangents = look.tangents;
    }
    return key;
}

/// By the type of its accessor.
VertexColors Meshes::colors_of(const Object& primitive) {
    const auto attributes = primitive.object("attributes");
    const auto number = attributes ? attributes->reference("COLOR_0", context_.tables.accessors) : std::nullopt;
    if (!number) return VertexColors::none;
    const Accessor colors = accessors_.open(*number);
    const bool whole = colors.component == ComponentType::u8 || colors.component == ComponentType::u16;
    if ((!colors.has_vectors_of(3) && !colors.has_vectors_of(4)) ||
        !(colors.component == ComponentType::f32 || (whole && colors.normalized)))
        context_.source.fail(attributes->offset_of("COLOR_0"),
                             "'COLOR_0' must be vectors of 3 or 4 floats, or of normalised UNSIGNED_BYTE or "
                             "UNSIGNED_SHORT");
    return colors.components == 4 ? VertexColors::rgba : VertexColors::rgb;
}

void Meshes::deform(const Object& primitive, const Object& attributes, const Deformation& deformation, Key& key) {
    key.targets = morph_targets(context_, primitive, deformation.weights);
    if (!deformation.joints) return;
    key.influences = influences_of(context_, attributes);
    if (key.influences.empty())
        context_.warn("a mesh without joints has a skin, which has no effect on it", primitive.offset());
    else
        key.skin = deformation.skin;
}

std::optional<Meshes::Part> Meshes::part(const Object& primitive, const Look& look, const std::string& name,
                                         const Deformation& deformation) {
    const Object attributes(context_.source, primitive.require("attributes"), "'attributes'");
    const auto mode = static_cast<uint32_t>(primitive.integer_or("mode", kTriangles, 0, kFan));
    if (mode < kTriangles) {
        context_.not_honoured("points and lines are not rendered", primitive.offset());
        return std::nullopt;
    }
    accessors_.decompress(primitive);
    Key key = key_of(primitive, attributes, look, mode);
    deform(primitive, attributes, deformation, key);
    if (key.positions == kNone) {
        context_.warn("a primitive without positions is ignored", attributes.offset());
        return std::nullopt;
    }
    auto known = shapes_.find(key);
    if (known == shapes_.end()) {
        std::optional<ShapeId> made;
        const Assets::Here here(context_.assets, primitive.offset());
        if (auto mesh = read(primitive, key, deformation.joints)) {
            context_.budget.take(sizeof(Mesh) + sizeof(Shape) + 2 * name.size(), context_.source, primitive.offset());
            const MeshId id = context_.assets.add_mesh(std::move(*mesh), name);
            made = context_.assets.add_shape(id, name);
        }
        known = shapes_.emplace(key, made).first;
    }
    if (!known->second) return std::nullopt;
    return Part{*known->second, look, !key.influences.empty()};
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

const Meshes::Morphing& Meshes::morphing(uint32_t number) {
    if (const auto known = morphing_.find(number); known != morphing_.end()) return known->second;
    const Object mesh(context_.source, context_.tables.meshes.elements[number], "a mesh");
    Morphing out;
    out.weights = read_weights(context_, mesh);
    const std::vector<Value> primitives = mesh.array("primitives");
    if (!primitives.empty())
        out.targets = Object(context_.source, primitives[0], "a primitive").array("targets").size();
    return morphing_.emplace(number, std::move(out)).first->second;
}

const std::vector<Meshes::Part>& Meshes::parts(uint32_t number, const Deformation& deformation) {
    MeshKey key{number, deformation.weights, deformation.skin};
    if (const auto known = meshes_.find(key); known != meshes_.end()) return known->second;
    const Object mesh(context_.source, context_.tables.meshes.elements[number], "a mesh");
    const std::string name = name_of(mesh, "mesh", number);
    mesh.require("primitives");
    std::vector<Part> parts;
    for (const Value value : mesh.array("primitives")) {
        const Object primitive(context_.source, value, "a primitive");
        const Look& look = materials_.look(material_of(primitive), colors_of(primitive));
        if (const auto made = part(primitive, look, name, deformation)) parts.push_back(*made);
    }
    return meshes_.emplace(std::move(key), std::move(parts)).first->second;
}

}  // namespace steradian::gltf
