#include "formats/gltf/nodes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "math/transform.h"
#include "math/vector.h"

namespace steradian::gltf {
namespace {

constexpr Range kNumber{-1e30, 1e30};

Affine from_columns(const std::vector<double>& m) {
    Affine out;
    for (size_t row = 0; row < 3; ++row)
        for (size_t column = 0; column < 4; ++column) out.m[row][column] = m[4 * column + row];
    return out;
}

/// Of a quaternion (x, y, z, w) of unit length.
Affine rotation(double x, double y, double z, double w) {
    Affine out;
    out.m[0] = {1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), 0};
    out.m[1] = {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), 0};
    out.m[2] = {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), 0};
    return out;
}

Affine rotation(Context& context, std::array<double, 4> q, size_t offset) {
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(std::fabs(length - 1) <= 1e-2)) context.warn("a rotation is not of unit length and was normalised", offset);
    if (!(length > 0 && length < 1e30)) return {};
    return rotation(q[0] / length, q[1] / length, q[2] / length, q[3] / length);
}

Affine read_rotation(Context& context, const Object& node) {
    const auto q = node.numbers("rotation", 4, kNumber);
    return q ? rotation(context, {(*q)[0], (*q)[1], (*q)[2], (*q)[3]}, node.offset_of("rotation")) : Affine{};
}

class Placer {
public:
    Placer(Context& context, Accessors& accessors, Meshes& meshes, const Pose& pose)
        : context_(context), accessors_(accessors), meshes_(meshes), skins_(context, accessors), pose_(pose) {}

    /// Where every node is comes first: skins look at others than their own.
    void run(const Object& root) {
        const size_t nodes = context_.tables.nodes.elements.size();
        context_.budget.grant_nodes(nodes);
        context_.budget.take(nodes * (sizeof(Skins::Places::value_type) + sizeof(uint32_t)), context_.source,
                             root.offset());
        seen_.assign(nodes, false);
        world_from_node_.resize(nodes);
        walk(root);
        for (const uint32_t node : order_) fill(node);
    }

private:
    void walk(const Object& root) {
        // Last in, first out: in reverse, so that nodes come in the order of the file.
        std::vector<Step> open;
        for (const Start& start : roots(root)) push(open, start.node, start.offset, {});
        std::reverse(open.begin(), open.end());
        while (!open.empty()) {
            const Step step = open.back();
            open.pop_back();
            visit(step, open);
        }
    }

    struct Start {
        uint32_t node;
        size_t offset;  ///< of what names it
    };
    // Read once, however many nodes refer to them.
    struct NamedLight {
        Light light;
        std::string name;
    };
    struct NamedCamera {
        ReadCamera camera;
        std::string name;
        size_t offset;
    };
    struct Step {
        uint32_t node;
        Affine world_from_parent;
    };

    void push(std::vector<Step>& open, uint32_t node, size_t offset, const Affine& world_from_parent) {
        if (seen_[node])
            context_.source.fail(offset, "node " + std::to_string(node) +
                                             " has been reached before: a node has at most "
                                             "one parent and is not its own ancestor");
        seen_[node] = true;
        open.push_back({node, world_from_parent});
    }

    std::vector<Start> roots(const Object& root) {
        const Tables& tables = context_.tables;
        std::optional<uint32_t> scene = root.reference("scene", tables.scenes);
        if (!scene && !tables.scenes.elements.empty()) scene = 0;
        std::vector<Start> out;
        if (scene) {
            const Object object(context_.source, tables.scenes.elements[*scene], "a scene");
            for (const Value value : object.array("nodes"))
                out.push_back({read_reference(context_.source, value, "nodes", tables.nodes), value.offset()});
            return out;
        }
        std::vector<bool> child(tables.nodes.elements.size());
        for (const Value value : tables.nodes.elements)
            for (const Value c : Object(context_.source, value, "a node").array("children"))
                child[read_reference(context_.source, c, "children", tables.nodes)] = true;
        for (uint32_t i = 0; i < child.size(); ++i)
            if (!child[i]) out.push_back({i, tables.nodes.elements[i].offset()});
        return out;
    }

    void visit(const Step& step, std::vector<Step>& open) {
        const Object node(context_.source, context_.tables.nodes.elements[step.node], "a node");
        const Affine world_from_node = step.world_from_parent * node_transform(context_, node, pose_of(step.node));
        if (!is_finite(world_from_node)) context_.source.fail(node.offset(), "the transform of this node overflows");
        world_from_node_[step.node] = world_from_node;
        order_.push_back(step.node);
        const auto first = static_cast<std::ptrdiff_t>(open.size());
        for (const Value child : node.array("children"))
            push(open, read_reference(context_.source, child, "children", context_.tables.nodes), child.offset(),
                 world_from_node);
        std::reverse(open.begin() + first, open.end());
    }

    /// What the node holds.
    void fill(uint32_t number) {
        const Object node(context_.source, context_.tables.nodes.elements[number], "a node");
        const Affine& world_from_node = *world_from_node_[number];
        const Assets::Here here(context_.assets, node.offset());
        const std::string name(node.string_or("name", ""));
        if (const auto mesh = node.reference("mesh", context_.tables.meshes))
            place_mesh(node, *mesh, world_from_node, name, deformation(node, *mesh, pose_of(number)));
        if (const auto camera = node.reference("camera", context_.tables.cameras))
            place_camera(node, *camera, world_from_node, name);
        if (const auto punctual = node.extension("KHR_lights_punctual")) {
            const NamedLight& light = open_light(punctual->require_reference("light", context_.tables.lights));
            const std::string& shown = name.empty() ? light.name : name;
            context_.budget.take(sizeof(Light) + shown.size(), context_.source, node.offset());
            context_.assets.add_light(placed(light.light, world_from_node), shown);
        }
    }

    const NodePose& pose_of(uint32_t node) const {
        static const NodePose kAsWritten;
        const auto found = pose_.find(node);
        return found != pose_.end() ? found->second : kAsWritten;
    }

    /// Weights of an animation count before the node's, and those before the mesh's.
    Deformation deformation(const Object& node, uint32_t mesh, const NodePose& pose) {
        Deformation out;
        const Meshes::Morphing& morphing = meshes_.morphing(mesh);
        out.weights = pose.weights          ? *pose.weights
                      : node.has("weights") ? read_weights(context_, node)
                                            : morphing.weights;
        if (!out.weights.empty() && out.weights.size() != morphing.targets)
            context_.not_honoured("there are not as many weights as morph targets: what is missing is 0",
                                  node.offset_of("weights"));
        out.weights.resize(min_of(out.weights.size(), morphing.targets));
        while (!out.weights.empty() && out.weights.back() == 0) out.weights.pop_back();
        context_.budget.take(out.weights.size() * sizeof(double), context_.source, node.offset());
        if (const auto skin = node.reference("skin", context_.tables.skins)) {
            out.joints = skins_.joints(*skin, world_from_node_);
            if (out.joints) out.skin = skin;
        }
        return out;
    }

    void place_mesh(const Object& node, uint32_t mesh, const Affine& world_from_node, const std::string& name,
                    const Deformation& deformation) {
        const auto instancing = node.extension("EXT_mesh_gpu_instancing");
        if (instancing && deformation.joints)
            context_.not_honoured("a mesh with a skin is there once, without its instances", instancing->offset());
        if (instancing && !deformation.joints)
            for (const Affine& node_from_instance : read_instances(context_, accessors_, *instancing))
                place_one(node, mesh, world_from_node * node_from_instance, name, deformation);
        else
            place_one(node, mesh, world_from_node, name, deformation);
    }

    void place_one(const Object& node, uint32_t mesh, const Affine& world_from_node, const std::string& name,
                   const Deformation& deformation) {
        const bool has_place = usable_inverse(world_from_node).has_value();  // else singular, or not finite
        const auto nowhere = [&] { context_.warn("nodes that are scaled to nothing are not rendered", node.offset()); };
        if (!has_place && !deformation.joints) return nowhere();
        const std::vector<Meshes::Part>& parts = meshes_.parts(mesh, deformation);
        context_.budget.take(parts.size() * (sizeof(Instance) + name.size()), context_.source, node.offset());
        for (const Meshes::Part& part : parts) {
            if (!part.in_world && !has_place) {
                nowhere();
                continue;
            }
            const Affine& place = part.in_world ? Affine{} : world_from_node;
            const InstanceId instance = context_.assets.add_instance({part.shape, part.look.material, place}, name);
            if (!is_black(part.look.emission)) {
                context_.budget.take(sizeof(Light) + name.size(), context_.source, node.offset());
                context_.assets.add_light(
                    AreaLight{instance, part.look.emission, part.look.two_sided, 1, true, part.look.emission_texture},
                    name);
            }
        }
    }

    /// The first camera decides the shape of the picture, which has as many pixels as it has by default.
    void place_camera(const Object& node, uint32_t number, const Affine& world_from_node, const std::string& name) {
        const NamedCamera& named = open_camera(number);
        const auto camera = placed(named.camera.camera, world_from_node);
        if (!camera) context_.source.fail(named.offset, "the node of this camera is scaled to nothing");
        if (context_.loaded.scene.cameras.empty() && named.camera.aspect) {
            RenderSettings& settings = context_.loaded.settings;
            constexpr double kMostUneven = 8;
            const double aspect = clamp_to(*named.camera.aspect, 1 / kMostUneven, kMostUneven);
            const double root = std::sqrt(aspect), side = settings.width;
            settings.width = static_cast<uint32_t>(side * root + 0.5);
            settings.height = static_cast<uint32_t>(side / root + 0.5);
        }
        const std::string& shown = name.empty() ? named.name : name;
        context_.budget.take(sizeof(Camera) + shown.size(), context_.source, node.offset());
        context_.assets.add_camera(*camera, shown);
    }

    const NamedLight& open_light(uint32_t number) {
        if (const auto known = lights_.find(number); known != lights_.end()) return known->second;
        const Object object(context_.source, context_.tables.lights.elements[number], "a light");
        return lights_.emplace(number, NamedLight{read_light(context_, object), name_of(object, "light", number)})
            .first->second;
    }

    const NamedCamera& open_camera(uint32_t number) {
        if (const auto known = cameras_.find(number); known != cameras_.end()) return known->second;
        const Object object(context_.source, context_.tables.cameras.elements[number], "a camera");
        return cameras_
            .emplace(number,
                     NamedCamera{read_camera(context_, object), name_of(object, "camera", number), object.offset()})
            .first->second;
    }

    Context& context_;
    Accessors& accessors_;
    Meshes& meshes_;
    Skins skins_;
    const Pose& pose_;
    std::vector<bool> seen_;
    std::map<uint32_t, NamedLight> lights_;
    std::map<uint32_t, NamedCamera> cameras_;
    Skins::Places world_from_node_;
    std::vector<uint32_t> order_;  ///< of the nodes in the scene
};

}  // namespace

Affine node_transform(Context& context, const Object& node, const NodePose& pose) {
    if (const auto matrix = node.numbers("matrix", 16, kNumber)) {
        for (const std::string_view key : {"translation", "rotation", "scale"})
            if (node.has(key))
                context.warn("a node has a 'matrix' and " + quoted(key) + ": the matrix counts", node.offset_of(key));
        const auto last = [&](size_t column) { return (*matrix)[4 * column + 3]; };
        if (last(0) != 0 || last(1) != 0 || last(2) != 0 || last(3) != 1)
            context.source.fail(node.offset_of("matrix"), "the last row of a 'matrix' must be 0, 0, 0, 1");
        return from_columns(*matrix);
    }
    const auto vector = [&](std::string_view key, const std::optional<std::array<double, 3>>& animated,
                            double fallback) {
        if (animated) return *animated;
        const auto v = node.numbers(key, 3, kNumber);
        return v ? std::array{(*v)[0], (*v)[1], (*v)[2]} : std::array{fallback, fallback, fallback};
    };
    const auto t = vector("translation", pose.translation, 0), s = vector("scale", pose.scale, 1);
    const auto& q = pose.rotation;
    Affine out = q ? rotation((*q)[0], (*q)[1], (*q)[2], (*q)[3]) : read_rotation(context, node);
    out = out * scaling(s[0], s[1], s[2]);
    for (size_t row = 0; row < 3; ++row) out.m[row][3] = t[row];
    return out;
}

std::vector<Affine> read_instances(Context& context, Accessors& accessors, const Object& extension) {
    const Object attributes(context.source, extension.require("attributes"), "'attributes'");
    std::optional<uint64_t> count;
    const auto open = [&](std::string_view key, uint32_t components) -> std::optional<Accessor> {
        const auto number = attributes.reference(key, context.tables.accessors);
        if (!number) return std::nullopt;
        const Accessor accessor = accessors.open(*number);
        const bool fraction = components == 4 && accessor.normalized &&
                              (accessor.component == ComponentType::i8 || accessor.component == ComponentType::i16);
        if (!accessor.has_vectors_of(components) || !(accessor.component == ComponentType::f32 || fraction))
            context.source.fail(attributes.offset_of(key),
                                quoted(key) + " must be vectors of " + std::to_string(components) + " floats" +
                                    (components == 4 ? ", or of normalised BYTE or SHORT" : ""));
        if (count.value_or(accessor.count) != accessor.count)
            context.source.fail(attributes.offset_of(key), quoted(key) + " has " + std::to_string(accessor.count) +
                                                               " elements, the attributes before it have " +
                                                               std::to_string(*count));
        count = accessor.count;
        return accessor;
    };
    const auto translations = open("TRANSLATION", 3), rotations = open("ROTATION", 4), scales = open("SCALE", 3);
    context.budget.take(count.value_or(0) * sizeof(Affine), context.source, extension.offset());
    std::vector<Affine> out(count.value_or(0));
    if (rotations) {
        const auto q = accessors.read_vec4(*rotations);
        for (size_t i = 0; i < out.size(); ++i)
            out[i] = rotation(context, {double(q[i][0]), double(q[i][1]), double(q[i][2]), double(q[i][3])},
                              rotations->offset);
    }
    if (scales) {
        const std::vector<Vec3> s = accessors.read_vec3(*scales);
        for (size_t i = 0; i < out.size(); ++i)
            out[i] = out[i] * scaling(double(s[i].x), double(s[i].y), double(s[i].z));
    }
    if (translations) {
        const std::vector<Vec3> t = accessors.read_vec3(*translations);
        for (size_t i = 0; i < out.size(); ++i)
            for (int row = 0; row < 3; ++row) out[i].m[static_cast<size_t>(row)][3] = static_cast<double>(t[i][row]);
    }
    return out;
}

void place_nodes(Context& context, Accessors& accessors, Meshes& meshes, const Pose& pose, const Object& root) {
    Placer(context, accessors, meshes, pose).run(root);
}

}  // namespace steradian::gltf
