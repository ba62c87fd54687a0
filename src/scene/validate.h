// Checks and preparations on a Scene, before anything is derived from it.
#pragma once

#include "steradian/result.h"
#include "steradian/scene.h"
#include "steradian/settings.h"

namespace steradian {

/// Every id refers to something, every number is finite and in its documented range, index counts fit, at most one
/// environment, one area light per instance. The first fault is named (by the element's name where it has one).
/// `any`: vertices may be where sanitize would not leave them.
enum class MeshNumbers : uint8_t { sanitized, any };
Status validate(const Scene& scene, MeshNumbers numbers = MeshNumbers::sanitized);

/// What can be known of settings without their scene: sizes, crop, samples, depth and filter are in their documented
/// ranges. Codes: usage, or resources for a picture beyond kMaxResolution or kMaxPixels.
Status validate(const RenderSettings& settings);

/// Removes triangles whose vertices are not finite or beyond kMaxCoordinate, replaces non-finite uvs and zero or
/// non-finite normals; each kind is one counted warning. Run before validate.
void sanitize(Scene& scene, Diagnostics& diagnostics);

/// A mesh that exactly one instance uses gets its transform applied to its vertices, in double, rounded once; the
/// instance's transform becomes the identity. Others keep theirs, and rays are transformed instead.
void bake_transforms(Scene& scene);

}  // namespace steradian
