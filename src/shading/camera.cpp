#include "shading/camera.h"

#include <variant>

#include "math/elementary.h"
#include "math/warp.h"

namespace steradian {
namespace {

/// Below this sine of the angle between `up` and the view, single precision says nothing about the picture's roll.
constexpr double kSmallestUpSine = 1e-6;
constexpr double kRadians = std::numbers::pi / 180;

Error degenerate(std::string message, std::string hint) {
    Error error;
    error.code = ErrorCode::bad_input;
    error.message = "degenerate camera: " + std::move(message);
    error.hint = std::move(hint);
    return error;
}

/// The numbers that only one kind has.
Status check(const PerspectiveCamera& c) {
    const float focus = c.focus_distance.value_or(1);
    if (!is_finite(c.vertical_fov) || !is_finite(c.aperture_radius) || !is_finite(c.aperture_rotation) ||
        !is_finite(focus))
        return degenerate("its field of view, aperture and focus must be finite numbers", "");
    if (!(c.vertical_fov > 0 && c.vertical_fov < 180))
        return degenerate("the vertical field of view must be between 0 and 180 degrees, both excluded", "40 is usual");
    if (!(c.aperture_radius >= 0)) return degenerate("the radius of the aperture is negative", "0 is a pinhole");
    if (!(focus > 0)) return degenerate("the focus distance must be more than 0", "leave it out to focus on look_at");
    if (c.aperture_blades != 0 && (c.aperture_blades < kMinApertureBlades || c.aperture_blades > kMaxApertureBlades))
        return degenerate("an aperture has 3 to 64 blades", "0 is a round one");
    return Ok{};
}
Status check(const OrthographicCamera& c) {
    if (!(c.height > 0) || !is_finite(c.height))
        return degenerate("the height of the picture must be a positive number of metres", "");
    return Ok{};
}
Status check(const PanoramaCamera&) { return Ok{}; }
Status check(const FisheyeCamera& c) {
    if (!(c.fov > 0 && c.fov <= 360))
        return degenerate("the field of view must be more than 0 and at most 360 degrees", "180 is usual");
    return Ok{};
}

}  // namespace

Result<CameraSampler> CameraSampler::make(const Camera& camera, uint32_t width, uint32_t height) {
    const auto make_one = [&](const auto& c) -> Result<CameraSampler> {
        if (width == 0 || height == 0)
            return degenerate("the picture has no pixels", "give it a width and a height of 1 or more");
        if (!is_finite(c.position) || !is_finite(c.look_at) || !is_finite(c.up))
            return degenerate("its position, look_at and up must be finite numbers", "");
        if (auto status = check(c); !status) return std::move(status).error();
        const Vec3d view = Vec3d(c.look_at) - Vec3d(c.position);
        if (!(length(view) > 0)) return degenerate("it is at the point that it looks at", "move position or look_at");
        if (!(length(Vec3d(c.up)) > 0)) return degenerate("its up vector is zero", "(0, 1, 0) is usual");
        const Vec3d forward = normalize(view);
        const Vec3d right = cross(forward, normalize(Vec3d(c.up)));
        if (!(length(right) > kSmallestUpSine))
            return degenerate("its up vector is parallel to the direction of view",
                              "choose another up vector, such as (0, 0, 1)");
        CameraSampler out;
        out.width_ = width;
        out.height_ = height;
        out.aim(c.position, right, forward);
        out.set(c, view);
        return out;
    };
    return std::visit(make_one, camera);
}

void CameraSampler::aim(Vec3 position, Vec3d right, Vec3d forward) noexcept {
    origin_ = position;
    forward_ = forward;
    right_ = normalize(right);
    up_ = cross(right_, forward);
}

void CameraSampler::span_film(double height, double distance) noexcept {
    const double pixel = height / height_;
    corner_ = forward_ * distance - right_ * (pixel * width_ / 2) + up_ * (height / 2);
    dx_ = right_ * pixel;
    dy_ = up_ * -pixel;
}

void CameraSampler::set(const PerspectiveCamera& c, Vec3d view) noexcept {
    kind_ = Kind::perspective;
    span_film(2 * math::tan(c.vertical_fov * (std::numbers::pi / 360)), 1);
    lens_radius_ = c.aperture_radius;
    focus_distance_ = c.focus_distance ? double(*c.focus_distance) : length(view);
    blades_ = c.aperture_blades;
    const double cos = math::cos(c.aperture_rotation * kRadians), sin = math::sin(c.aperture_rotation * kRadians);
    lens_x_ = (right_ * cos + up_ * sin) * lens_radius_;
    lens_y_ = (up_ * cos - right_ * sin) * lens_radius_;
}

void CameraSampler::set(const OrthographicCamera& c, Vec3d) noexcept {
    kind_ = Kind::orthographic;
    span_film(c.height, 0);
}

void CameraSampler::set(const PanoramaCamera&, Vec3d) noexcept { kind_ = Kind::panorama; }

void CameraSampler::set(const FisheyeCamera& c, Vec3d) noexcept {
    kind_ = Kind::fisheye;
    projection_ = c.projection;
    half_angle_ = c.fov * (kRadians / 2);
}

double CameraSampler::fisheye_radius(Vec2 film) const noexcept {
    const double x = film.x - width_ / 2.0, y = film.y - height_ / 2.0;
    return std::sqrt(x * x + y * y) / (min_of(width_, height_) / 2.0);
}

bool CameraSampler::sees(Vec2 film) const noexcept { return kind_ != Kind::fisheye || fisheye_radius(film) <= 1; }

Vec3d CameraSampler::lens_offset(Vec2 u) const noexcept {
    const warp::DiskPoint p = blades_ == 0 ? warp::disk(u) : warp::polygon(u, blades_);
    return lens_x_ * p.x + lens_y_ * p.y;
}

/// The angle from `up` grows downwards, that about it grows to the right and is 0 in the middle. Beyond the picture's
/// upper and lower edge, where a wide filter looks, lies the other side of the pole.
Vec3d CameraSampler::panorama_direction(Vec2 film) const noexcept {
    const double theta = std::numbers::pi * (film.y / height_);
    const double phi = 2 * std::numbers::pi * (film.x / width_ - 0.5);
    const math::SinCos t = math::sin_cos(theta), p = math::sin_cos(phi);
    return up_ * t.cos + right_ * (t.sin * p.sin) + forward_ * (t.sin * p.cos);
}

Vec3d CameraSampler::fisheye_direction(Vec2 film) const noexcept {
    const double x = film.x - width_ / 2.0, y = height_ / 2.0 - film.y;
    const double length = std::sqrt(x * x + y * y);
    if (!(length > 0)) return forward_;
    const double r = fisheye_radius(film);
    const double theta = projection_ == FisheyeProjection::equidistant
                             ? r * half_angle_
                             : 2 * math::asin(min_of(r * math::sin(half_angle_ / 2), 1.0));
    const double s = math::sin(theta) / length;
    return forward_ * math::cos(theta) + right_ * (s * x) + up_ * (s * y);
}

RayCone CameraSampler::cone(Vec2 film) const noexcept {
    const double pi = std::numbers::pi;
    switch (kind_) {
        case Kind::perspective: {
            // A pixel of the plane at distance 1 has the solid angle of its area over the cube of its distance.
            const double distance = length(corner_ + dx_ * film.x + dy_ * film.y);
            return {0, static_cast<float>(length(dy_) / (distance * std::sqrt(distance)))};
        }
        case Kind::orthographic:
            return {static_cast<float>(length(dy_)), 0};
        case Kind::panorama: {
            const double sine = math::sin(pi * (film.y / height_));
            return {0, static_cast<float>(pi * std::sqrt(2.0 / height_ / width_ * max_of(sine, 0.0)))};
        }
        case Kind::fisheye:
            return {0, static_cast<float>(half_angle_ / (min_of(width_, height_) / 2.0))};
    }
    return {};
}

Ray CameraSampler::generate(Vec2 film, Vec2 lens) const noexcept {
    Ray ray;
    ray.o = origin_;
    switch (kind_) {
        case Kind::perspective: {
            const Vec3d through = corner_ + dx_ * film.x + dy_ * film.y;
            if (!has_lens()) {
                ray.d = Vec3(normalize(through));
                break;
            }
            const Vec3d offset = lens_offset(lens);
            ray.o = Vec3(Vec3d(origin_) + offset);
            ray.d = Vec3(normalize(through * focus_distance_ - offset));
            break;
        }
        case Kind::orthographic:
            ray.o = Vec3(Vec3d(origin_) + corner_ + dx_ * film.x + dy_ * film.y);
            ray.d = Vec3(forward_);
            break;
        case Kind::panorama:
            ray.d = Vec3(normalize(panorama_direction(film)));
            break;
        case Kind::fisheye:
            ray.d = Vec3(normalize(fisheye_direction(film)));
            break;
    }
    return ray;
}

}  // namespace steradian
