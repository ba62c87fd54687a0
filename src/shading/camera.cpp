#include "shading/camera.h"

#include <variant>

#include "math/elementary.h"

namespace steradian {
namespace {

/// Below this sine of the angle between `up` and the view, single precision says nothing about the picture's roll.
constexpr double kSmallestUpSine = 1e-6;

Error degenerate(std::string message, std::string hint) {
    Error error;
    error.code = ErrorCode::bad_input;
    error.message = "degenerate camera: " + std::move(message);
    error.hint = std::move(hint);
    return error;
}

}  // namespace

Result<CameraSampler> CameraSampler::make(const Camera& camera, uint32_t width, uint32_t height) {
    const auto& c = std::get<PerspectiveCamera>(camera);
    if (width == 0 || height == 0)
        return degenerate("the picture has no pixels", "give it a width and a height of 1 or more");
    if (!is_finite(c.position) || !is_finite(c.look_at) || !is_finite(c.up) || !is_finite(c.vertical_fov))
        return degenerate("its position, look_at, up and field of view must be finite numbers", "");
    if (!(c.vertical_fov > 0 && c.vertical_fov < 180))
        return degenerate("the vertical field of view must be between 0 and 180 degrees, both excluded", "40 is usual");
    const Vec3d view = Vec3d(c.look_at) - Vec3d(c.position);
    if (!(length(view) > 0)) return degenerate("it is at the point that it looks at", "move position or look_at");
    if (!(length(Vec3d(c.up)) > 0)) return degenerate("its up vector is zero", "(0, 1, 0) is usual");
    const Vec3d forward = normalize(view);
    const Vec3d right = cross(forward, normalize(Vec3d(c.up)));
    if (!(length(right) > kSmallestUpSine))
        return degenerate("its up vector is parallel to the direction of view",
                          "choose another up vector, such as (0, 0, 1)");

    CameraSampler out;
    const Vec3d x = normalize(right);
    const Vec3d y = cross(x, forward);
    const double half_height = math::tan(c.vertical_fov * (std::numbers::pi / 360));
    const double pixel = 2 * half_height / height;
    out.origin_ = c.position;
    out.forward_ = forward;
    out.corner_ = forward - x * (pixel * width / 2) + y * half_height;
    out.dx_ = x * pixel;
    out.dy_ = y * -pixel;
    return out;
}

Ray CameraSampler::generate(Vec2 film) const noexcept {
    Ray ray;
    ray.o = origin_;
    ray.d = Vec3(normalize(corner_ + dx_ * film.x + dy_ * film.y));
    return ray;
}

}  // namespace steradian
