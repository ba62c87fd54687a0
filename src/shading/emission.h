// What materials emit.
#pragma once

#include "shading/surface.h"
#include "steradian/vec.h"

namespace steradian {

struct ShadingScene;

/// Towards `w`, by what is there at the point; of a mix the mean over its parts.
Rgb material_emission(const ShadingScene& scene, const SurfacePoint& point, Vec3 w) noexcept;

}  // namespace steradian
