#include "formats/gltf/morph.h"

#include <span>

#include "math/vector.h"

namespace steradian::gltf {
namespace {

/// Adds what targets say about one attribute of all vertices, in double, so that it is rounded once.
class Sum {
public:
    Sum(Context& context, Accessors& accessors, const std::vector<MorphTarget>& targets, uint64_t vertices)
        : context_(context), accessors_(accessors), targets_(targets), vertices_(vertices) {}

    /// `accessor_of` tells which accessor of a target it is. Their elements may have fewer components, never more;
    /// false where no target has one.
    template <class AccessorOf>
    bool add(std::string_view name, uint32_t components, AccessorOf accessor_of) {
        bool any = false;
        for (const MorphTarget& target : targets_) {
            const uint32_t number = accessor_of(target);
            if (number == MorphTarget::kNone) continue;
            if (!any) begin(components, target.offset);
            any = true;
            add(accessors_.open(number), name, target);
        }
        return any;
    }
    double at(uint64_t vertex, uint32_t c) const { return sums_[vertex * components_ + c]; }
    Vec3 moved(Vec3 from, uint64_t vertex) const {
        return Vec3(Vec3d(from) + Vec3d{at(vertex, 0), at(vertex, 1), at(vertex, 2)});
    }

private:
    void begin(uint32_t components, size_t offset) {
        components_ = components;
        context_.budget.take(vertices_ * components * sizeof(double), context_.source, offset);
        sums_.assign(vertices_ * components, 0.0);
    }
    void add(const Accessor& a, std::string_view name, const MorphTarget& target) {
        const bool color = components_ == 4;
        if (a.component == ComponentType::u32 || !(a.has_vectors_of(components_) || (color && a.has_vectors_of(3))))
            context_.source.fail(target.offset, quoted(name) + " of a morph target must be vectors of " +
                                                    (color ? "3 or 4" : std::to_string(components_)) +
                                                    " floats, or of integers with at most 16 bits");
        if (a.count != vertices_)
            context_.source.fail(target.offset, quoted(name) + " of a morph target has " + std::to_string(a.count) +
                                                    " elements, but there are " + std::to_string(vertices_) +
                                                    " positions");
        // Takes no memory, but time: many targets may name the same data.
        const uint64_t touched = (a.data ? a.count : 0) + a.sparse.count;
        context_.budget.take(touched * a.components * sizeof(float), context_.source, target.offset);
        a.add_to(sums_, components_, target.weight);
    }

    Context& context_;
    Accessors& accessors_;
    const std::vector<MorphTarget>& targets_;
    uint64_t vertices_;
    uint32_t components_ = 0;
    std::vector<double> sums_;
};

float unit(double x) { return static_cast<float>(clamp_to(x, 0.0, 1.0)); }

}  // namespace

std::vector<double> read_weights(const Context& context, const Object& object) {
    std::vector<double> out;
    for (const Value value : object.array("weights"))
        out.push_back(json::read_double(context.source, value, "'weights'", {-1e30, 1e30}));
    return out;
}

std::vector<MorphTarget> morph_targets(const Context& context, const Object& primitive,
                                       const std::vector<double>& weights) {
    std::vector<MorphTarget> out;
    if (weights.empty()) return out;
    const std::vector<Value> targets = primitive.array("targets");
    for (size_t i = 0; i < weights.size() && i < targets.size(); ++i) {
        if (weights[i] == 0) continue;
        const Object target(context.source, targets[i], "a morph target");
        const auto accessor = [&](std::string_view name) {
            return target.reference(name, context.tables.accessors).value_or(MorphTarget::kNone);
        };
        MorphTarget made{weights[i], accessor("POSITION"), accessor("NORMAL"), accessor("TANGENT"),
                         accessor("COLOR_0")};
        for (uint32_t set = 0; set < kMaxUvSets; ++set) made.uvs[set] = accessor("TEXCOORD_" + std::to_string(set));
        made.offset = target.offset();
        out.push_back(made);
    }
    return out;
}

void morph(Context& context, Accessors& accessors, const std::vector<MorphTarget>& targets, Mesh& mesh) {
    const uint64_t vertices = mesh.positions.size();
    Sum sum(context, accessors, targets, vertices);
    if (sum.add("POSITION", 3, [](const MorphTarget& t) { return t.positions; }))
        for (uint64_t i = 0; i < vertices; ++i) mesh.positions[i] = sum.moved(mesh.positions[i], i);
    if (!mesh.normals.empty() && sum.add("NORMAL", 3, [](const MorphTarget& t) { return t.normals; }))
        for (uint64_t i = 0; i < vertices; ++i) mesh.normals[i] = normalize(sum.moved(mesh.normals[i], i));
    if (!mesh.tangents.empty() && sum.add("TANGENT", 3, [](const MorphTarget& t) { return t.tangents; }))
        for (uint64_t i = 0; i < vertices; ++i)
            mesh.tangents[i].direction = normalize(sum.moved(mesh.tangents[i].direction, i));
    for (uint32_t set = 0; set <= mesh.more_uvs.size() && set < kMaxUvSets; ++set) {
        std::vector<Vec2>& uvs = set == 0 ? mesh.uvs : mesh.more_uvs[set - 1];
        const std::string name = "TEXCOORD_" + std::to_string(set);
        if (uvs.empty() || !sum.add(name, 2, [set](const MorphTarget& t) { return t.uvs[set]; })) continue;
        for (uint64_t i = 0; i < vertices; ++i)
            uvs[i] = {static_cast<float>(static_cast<double>(uvs[i].x) + sum.at(i, 0)),
                      static_cast<float>(static_cast<double>(uvs[i].y) + sum.at(i, 1))};
    }
    if (mesh.colors.empty() || !sum.add("COLOR_0", 4, [](const MorphTarget& t) { return t.colors; })) return;
    for (uint64_t i = 0; i < vertices; ++i) {
        Rgb& c = mesh.colors[i];
        for (int k = 0; k < 3; ++k) c[k] = unit(static_cast<double>(c[k]) + sum.at(i, static_cast<uint32_t>(k)));
        if (!mesh.alphas.empty()) mesh.alphas[i] = unit(static_cast<double>(mesh.alphas[i]) + sum.at(i, 3));
    }
}

}  // namespace steradian::gltf
