#include <array>
#include <cmath>
#include <numbers>

#include "formats/gltf/nodes.h"
#include "math/transform.h"

namespace steradian::gltf {

std::optional<Camera> placed(const Camera& camera, const Affine& world_from_node) {
    const Vec3d position = transform_point(world_from_node, Vec3{0, 0, 0});
    const Vec3d back = normalize(transform_vector(world_from_node, Vec3{0, 0, 1}));
    const Vec3d up = normalize(transform_vector(world_from_node, Vec3{0, 1, 0}));
    if (!(length(cross(up, back)) > 1e-6)) return std::nullopt;
    // Far away one metre is lost in the rounding of positions.
    const double reach = max_of(1.0, 1e-3 * length(position));
    return std::visit(
        [&](auto kind) {
            kind.position = Vec3(position);
            kind.look_at = Vec3(position - back * reach);
            kind.up = Vec3(up);
            return Camera(kind);
        },
        camera);
}

ReadCamera read_camera(Context& context, const Object& object) {
    static constexpr std::array<std::string_view, 2> kTypes{"perspective", "orthographic"};
    constexpr Range kSize{0, 1e15, true}, kAnySize{-1e15, 1e15};
    const size_t type = json::read_choice(context.source, object.require("type"), "'type'", kTypes);
    const Object shape(context.source, object.require(kTypes[type]), kTypes[type]);
    ReadCamera out;
    if (type == 0) {
        PerspectiveCamera camera;
        const double fov = shape.number("yfov", {0, std::numbers::pi, true, true});
        camera.vertical_fov = static_cast<float>(fov * (180 / std::numbers::pi));
        if (shape.has("aspectRatio")) out.aspect = shape.number("aspectRatio", kSize);
        out.camera = camera;
    } else {
        const double x = shape.number("xmag", kAnySize), y = shape.number("ymag", kAnySize);
        if (x == 0 || y == 0) context.source.fail(shape.offset(), "'xmag' and 'ymag' must not be 0");
        if (x < 0 || y < 0) context.warn("'xmag' and 'ymag' of a camera should not be negative", shape.offset());
        OrthographicCamera camera;
        camera.height = static_cast<float>(2 * std::fabs(y));
        out.aspect = std::fabs(x / y);
        out.camera = camera;
    }
    return out;
}

}  // namespace steradian::gltf
