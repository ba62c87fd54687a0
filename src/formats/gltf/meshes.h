// Meshes: primitives of all modes as indexed triangles.
#pragma once

#include <array>
#include <compare>
#include <map>
#include <tuple>
#include <vector>

#include "formats/gltf/accessors.h"
#include "formats/gltf/materials.h"
#include "formats/gltf/morph.h"
#include "formats/gltf/skin.h"

namespace steradian::gltf {

/// What a node makes of its mesh.
struct Deformation {
    std::vector<double> weights;     ///< of morph targets in order; those that are missing are 0, the last one is not
    std::optional<uint32_t> skin;    ///< its number
    const Joints* joints = nullptr;  ///< of that skin, where there is one
};

class Meshes {
public:
    Meshes(Context& context, Accessors& accessors, Materials& materials)
        : context_(context), accessors_(accessors), materials_(materials) {}

    struct Part {
        ShapeId shape{};
        Look look;
        bool in_world = false;  ///< a skin has moved it there; others are where their nodes are
    };
    /// What a mesh consists of, read when it is first asked for: nodes that share it share its triangles, unless they
    /// deform them.
    const std::vector<Part>& parts(uint32_t mesh, const Deformation& deformation);

    /// A mesh's own weights and how many targets it has, by the first of its primitives.
    struct Morphing {
        std::vector<double> weights;
        size_t targets = 0;
    };
    const Morphing& morphing(uint32_t mesh);

private:
    static constexpr uint32_t kNone = 0xffffffffu;
    /// What makes the triangles of a primitive: accessors, kNone where there is none, and what is made of them.
    struct Key {
        uint32_t positions = kNone, normals = kNone, tangents = kNone, colors = kNone, indices = kNone;
        std::array<uint32_t, kMaxUvSets> uvs{};
        uint32_t mode = 0;
        uint32_t uv_sets = 0;                                  ///< bits: those that somebody reads
        std::optional<uint32_t> made_tangents = std::nullopt;  ///< along these coordinates
        std::vector<MorphTarget> targets = {};
        std::vector<Influences> influences = {};
        std::optional<uint32_t> skin = std::nullopt;
        auto operator<=>(const Key&) const = default;
    };

    std::optional<uint32_t> material_of(const Object& primitive);
    std::optional<Part> part(const Object& primitive, const Look& look, const std::string& name,
                             const Deformation& deformation);
    Key key_of(const Object& primitive, const Object& attributes, const Look& look, uint32_t mode);
    void deform(const Object& primitive, const Object& attributes, const Deformation& deformation, Key& key);
    std::optional<Mesh> read(const Object& primitive, const Key& key, const Joints* joints);
    void add_made_tangents(const Object& primitive, const Key& key, Mesh& mesh);
    void read_uvs(const Object& primitive, const Key& key, Mesh& mesh);
    void read_colors(const Object& primitive, const Key& key, Mesh& mesh);
    VertexColors colors_of(const Object& primitive);
    std::vector<uint32_t> corners(const Object& primitive, const Key& key, uint64_t vertices);
    Accessor open_attribute(const Object& primitive, std::string_view name, uint32_t accessor, uint32_t components);
    /// The same, with as many elements as the primitive has vertices.
    Accessor open_attribute(const Object& primitive, std::string_view name, uint32_t accessor, uint32_t components,
                            uint64_t vertices);

    Context& context_;
    Accessors& accessors_;
    Materials& materials_;
    using MeshKey = std::tuple<uint32_t, std::vector<double>, std::optional<uint32_t>>;  ///< with weights and skin
    std::map<MeshKey, std::vector<Part>> meshes_;
    std::map<uint32_t, Morphing> morphing_;
    std::map<Key, std::optional<ShapeId>> shapes_;  ///< of primitives that say the same
};

/// Corners of triangles as corners of a strip (mode 5) or fan (mode 6) say them, in the order of the specification;
/// of anything else they are what they are. Incomplete triangles are left out.
std::vector<uint32_t> as_triangles(std::vector<uint32_t> corners, uint32_t mode);

}  // namespace steradian::gltf
