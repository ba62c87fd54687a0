// Camera rays.
#pragma once

#include "math/ray.h"
#include "math/vector.h"
#include "shading/ray_cone.h"
#include "steradian/result.h"
#include "steradian/scene.h"

namespace steradian {

/// A camera with everything that is the same for all rays worked out.
class CameraSampler {
public:
    /// bad_input for degenerate cameras: position equal to look_at, up parallel to the view or zero, and values outside
    /// the ranges that scene.h states.
    static Result<CameraSampler> make(const Camera& camera, uint32_t width, uint32_t height);

    /// Whether a lens takes part: generate() then wants two more numbers.
    bool has_lens() const noexcept { return lens_radius_ > 0; }
    /// Whether anything is seen at a film position; a fisheye's picture is round.
    bool sees(Vec2 film) const noexcept;
    /// Through a film position in pixels from the top left corner of the full picture, and a place on the lens by two
    /// uniform numbers. The direction has unit length.
    Ray generate(Vec2 film, Vec2 lens = {}) const noexcept;

    /// Of the ray that generate() makes: as large as a pixel. Of a panorama or a fisheye roughly so.
    RayCone cone(Vec2 film) const noexcept;

    /// Metres along the camera's own -Z; from the camera itself where the picture is not flat (panorama, fisheye).
    double depth_of(Vec3 p) const noexcept {
        const Vec3d way = Vec3d(p) - Vec3d(origin_);
        return is_flat() ? dot(way, forward_) : length(way);
    }

private:
    enum class Kind : uint8_t { perspective, orthographic, panorama, fisheye };

    bool is_flat() const noexcept { return kind_ == Kind::perspective || kind_ == Kind::orthographic; }
    void aim(Vec3 position, Vec3d right, Vec3d forward) noexcept;
    void set(const PerspectiveCamera& c, Vec3d view) noexcept;
    void set(const OrthographicCamera& c, Vec3d view) noexcept;
    void set(const PanoramaCamera& c, Vec3d view) noexcept;
    void set(const FisheyeCamera& c, Vec3d view) noexcept;
    /// Of a flat picture that is `height` high, `distance` in front of the camera.
    void span_film(double height, double distance) noexcept;
    Vec3d lens_offset(Vec2 u) const noexcept;
    Vec3d panorama_direction(Vec2 film) const noexcept;
    Vec3d fisheye_direction(Vec2 film) const noexcept;
    /// Distance from the picture's middle in radii of a fisheye's circle.
    double fisheye_radius(Vec2 film) const noexcept;

    Kind kind_ = Kind::perspective;
    FisheyeProjection projection_ = FisheyeProjection::equidistant;
    uint32_t width_ = 0, height_ = 0;
    Vec3 origin_;
    Vec3d right_, up_, forward_;  ///< unit
    Vec3d corner_, dx_, dy_;      ///< flat pictures: from the origin to film (0, 0), and its change per pixel
    double focus_distance_ = 0, lens_radius_ = 0;
    Vec3d lens_x_, lens_y_;  ///< the lens turned as it is, as long as its radius
    uint32_t blades_ = 0;
    double half_angle_ = 0;  ///< of a fisheye, radians
};

}  // namespace steradian
