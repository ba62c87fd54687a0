#include "formats/gltf/skin.h"

#include <algorithm>
#include <cmath>

#include "math/transform.h"
#include "math/vector.h"

namespace steradian::gltf {
namespace {

/// Of a joint by what the file says of it; the last row of the matrix must be that of an affine one.
class InverseBindMatrices {
public:
    InverseBindMatrices(Context& context, Accessors& accessors, const Object& skin, uint64_t joints)
        : context_(context) {
        const auto number = skin.reference("inverseBindMatrices", context.tables.accessors);
        if (!number) return;
        accessor_ = &accessors.open(*number);
        const size_t offset = skin.offset_of("inverseBindMatrices");
        if (accessor_->components != 16 || accessor_->component != ComponentType::f32)
            context.source.fail(offset, "'inverseBindMatrices' must be 4 × 4 matrices of FLOAT");
        if (accessor_->count < joints)
            context.source.fail(offset, "there are " + std::to_string(accessor_->count) +
                                            " inverse bind matrices, but " + std::to_string(joints) + " joints");
    }
    Affine operator()(uint64_t joint) const {
        Affine out;
        if (!accessor_) return out;
        for (uint32_t row = 0; row < 3; ++row)
            for (uint32_t column = 0; column < 4; ++column)
                out.m[row][column] = accessor_->element(joint, 4 * column + row);
        if (!is_finite(out))
            context_.source.fail(accessor_->offset, "matrix " + std::to_string(joint) + " is not finite");
        for (uint32_t column = 0; column < 4; ++column)
            if (accessor_->element(joint, 4 * column + 3) != (column == 3 ? 1.0f : 0.0f))
                context_.warn("the last row of an inverse bind matrix is not 0, 0, 0, 1 and was taken as that",
                              accessor_->offset);
        return out;
    }

private:
    Context& context_;
    const Accessor* accessor_ = nullptr;
};

/// Where a vertex goes: the mean of its joints, by their weights.
class Blend {
public:
    Blend(Context& context, Accessors& accessors, const Object& attributes, const std::vector<Influences>& influences,
          const Joints& joints, uint64_t vertices)
        : context_(context), joints_(joints) {
        for (uint32_t n = 0; n < influences.size(); ++n) {
            const std::string set = std::to_string(n);
            const Accessor& j = accessors.open(influences[n].joints);
            const Accessor& w = accessors.open(influences[n].weights);
            Set& made = sets_.emplace_back(
                Set{j, w, attributes.offset_of("JOINTS_" + set), attributes.offset_of("WEIGHTS_" + set)});
            const bool narrow = j.component == ComponentType::u8 || j.component == ComponentType::u16;
            if (!j.has_vectors_of(4) || !narrow || j.normalized)
                context.source.fail(made.joints_offset,
                                    "'JOINTS_" + set + "' must be vectors of 4 UNSIGNED_BYTE or UNSIGNED_SHORT");
            const bool unorm = w.normalized && (w.component == ComponentType::u8 || w.component == ComponentType::u16);
            if (!w.has_vectors_of(4) || !(unorm || w.component == ComponentType::f32))
                context.source.fail(made.weights_offset, "'WEIGHTS_" + set +
                                                             "' must be vectors of 4 floats, or of normalised "
                                                             "UNSIGNED_BYTE or UNSIGNED_SHORT");
            for (const auto& [a, offset] : {std::pair(&j, made.joints_offset), std::pair(&w, made.weights_offset)})
                if (a->count != vertices)
                    context.source.fail(offset, "there are joints for " + std::to_string(a->count) + " of " +
                                                    std::to_string(vertices) + " vertices");
        }
        // Takes no memory, but time: many sets may name the same data.
        context.budget.take(vertices * sets_.size() * 8 * sizeof(float), context.source, attributes.offset());
    }

    Affine operator()(uint64_t vertex) {
        Affine sum;
        for (auto& row : sum.m) row.fill(0);
        double total = 0;
        for (const Set& set : sets_)
            for (uint32_t c = 0; c < 4; ++c) {
                const double weight = set.weights.element(vertex, c);
                if (!(weight >= 0) || !std::isfinite(weight))
                    context_.source.fail(set.weights_offset, "the weights of vertex " + std::to_string(vertex) +
                                                                 " must be finite and not negative");
                if (weight == 0) continue;
                const Affine& joint = joints_[joint_of(set, vertex, c)];
                for (size_t row = 0; row < 3; ++row)
                    for (size_t column = 0; column < 4; ++column) sum.m[row][column] += weight * joint.m[row][column];
                total += weight;
            }
        if (total == 0) {
            lost_ = true;
            return joints_[joint_of(sets_[0], vertex, 0)];
        }
        constexpr double kRounded = 1e-3;
        if (std::fabs(total - 1) > kRounded) uneven_ = true;
        for (auto& row : sum.m)
            for (double& x : row) x /= total;
        return sum;
    }
    /// Of what the vertices so far had to be given.
    void report() {
        if (uneven_)
            context_.not_honoured("weights of joints whose sum is not 1 count as parts of their sum",
                                  sets_[0].weights_offset);
        if (lost_)
            context_.not_honoured("vertices without a weight follow the first of their joints",
                                  sets_[0].weights_offset);
    }

private:
    struct Set {
        const Accessor& joints;
        const Accessor& weights;
        size_t joints_offset, weights_offset;
    };

    size_t joint_of(const Set& set, uint64_t vertex, uint32_t c) const {
        const auto joint = static_cast<size_t>(set.joints.element(vertex, c));
        if (joint >= joints_.size())
            context_.source.fail(set.joints_offset, "vertex " + std::to_string(vertex) + " follows joint " +
                                                        std::to_string(joint) + ", but the skin has " +
                                                        std::to_string(joints_.size()) + " of them, counted from 0");
        return joint;
    }

    Context& context_;
    const Joints& joints_;
    std::vector<Set> sets_;
    bool uneven_ = false, lost_ = false;
};

/// The matrix of cofactors, which takes normals to where their surfaces are, in length and sign too: the transposed
/// inverse times the determinant. It is there for singular matrices as well.
Vec3d by_cofactors(const Affine& a, Vec3d n) {
    const auto row = [&](size_t i) { return Vec3d{a.m[i][0], a.m[i][1], a.m[i][2]}; };
    return {dot(cross(row(1), row(2)), n), dot(cross(row(2), row(0)), n), dot(cross(row(0), row(1)), n)};
}

}  // namespace

std::optional<Joints> Skins::read(const Object& skin, const Places& world_from_node) {
    skin.require("joints");
    const std::vector<Value> nodes = skin.array("joints");
    if (nodes.empty()) {
        context_.not_honoured("a skin without joints has no effect", skin.offset_of("joints"));
        return std::nullopt;
    }
    const InverseBindMatrices bind_from_mesh(context_, accessors_, skin, nodes.size());
    context_.budget.take(nodes.size() * sizeof(Affine), context_.source, skin.offset());
    Joints out;
    for (const Value value : nodes) {
        const std::optional<Affine>& place =
            world_from_node[read_reference(context_.source, value, "joints", context_.tables.nodes)];
        if (!place) {
            context_.not_honoured("a skin has no effect whose joints are not in the scene", value.offset());
            return std::nullopt;
        }
        out.push_back(*place * bind_from_mesh(out.size()));
        if (!is_finite(out.back())) context_.source.fail(value.offset(), "the transform of this joint overflows");
    }
    return out;
}

const Joints* Skins::joints(uint32_t number, const Places& world_from_node) {
    auto known = skins_.find(number);
    if (known == skins_.end()) {
        const Object skin(context_.source, context_.tables.skins.elements[number], "a skin");
        known = skins_.emplace(number, read(skin, world_from_node)).first;
    }
    return known->second ? &*known->second : nullptr;
}

std::vector<Influences> influences_of(Context& context, const Object& attributes) {
    std::vector<Influences> out;
    for (uint32_t n = 0;; ++n) {
        const std::string set = std::to_string(n), joints = "JOINTS_" + set, weights = "WEIGHTS_" + set;
        const auto j = attributes.reference(joints, context.tables.accessors);
        const auto w = attributes.reference(weights, context.tables.accessors);
        if (!j && !w) return out;
        if (!j || !w)
            context.source.fail(attributes.offset(), "there is " + quoted(j ? joints : weights) + ", but no " +
                                                         quoted(j ? weights : joints));
        if (n == kMaxInfluences) {
            context.not_honoured("only the first 8 sets of joints of a vertex are looked at",
                                 attributes.offset_of(joints));
            return out;
        }
        out.push_back({*j, *w});
    }
}

void skin(Context& context, Accessors& accessors, const Object& attributes, const std::vector<Influences>& influences,
          const Joints& joints, Mesh& mesh) {
    Blend world_from_mesh(context, accessors, attributes, influences, joints, mesh.positions.size());
    std::vector<bool> mirrored(mesh.positions.size());
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        const Affine place = world_from_mesh(i);
        mirrored[i] = determinant(place) < 0;
        const double side = mirrored[i] ? -1 : 1;
        mesh.positions[i] = Vec3(transform_point(place, mesh.positions[i]));
        if (!mesh.normals.empty()) mesh.normals[i] = Vec3(normalize(by_cofactors(place, mesh.normals[i]) * side));
        if (mesh.tangents.empty()) continue;
        Tangent& t = mesh.tangents[i];
        t.direction = Vec3(normalize(transform_vector(place, t.direction)));
        if (mirrored[i]) t.side = -t.side;
    }
    for (size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
        uint32_t* corners = &mesh.indices[t];
        if (mirrored[corners[0]] && mirrored[corners[1]] && mirrored[corners[2]]) std::swap(corners[1], corners[2]);
    }
    world_from_mesh.report();
}

}  // namespace steradian::gltf
