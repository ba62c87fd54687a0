// Camera rays.
#pragma once

#include "math/ray.h"
#include "math/vector.h"
#include "steradian/result.h"
#include "steradian/scene.h"

namespace steradian {

/// A camera with everything that is the same for all rays worked out.
class CameraSampler {
public:
    /// bad_input for degenerate cameras: position equal to look_at, up parallel to the view or zero, a field of view
    /// outside (0, 180), values that are not finite.
    static Result<CameraSampler> make(const Camera& camera, uint32_t width, uint32_t height);

    /// Through a film position in pixels from the top left corner of the full picture. The direction has unit length.
    Ray generate(Vec2 film) const noexcept;

    /// Metres along the camera's own -Z.
    double depth_of(Vec3 p) const noexcept { return dot(Vec3d(p) - Vec3d(origin_), forward_); }

private:
    Vec3 origin_;
    Vec3d forward_;           ///< unit
    Vec3d corner_, dx_, dy_;  ///< direction through film (0, 0), and its change per pixel
};

}  // namespace steradian
