// Rays recorded once for each mesh, so that every engine traces the same ones.
#pragma once

#include <string>
#include <vector>

#include "mesh.h"

namespace steradian::bench {

struct RaySet {
    std::string name;
    bool any_hit = false;
    bool coherent = false;  ///< neighbours start at one point and have nearly the same direction
    std::vector<Ray> rays;
};

/// camera, diffuse, diffuse-2, occlusion, shadow.
const std::vector<std::string>& ray_set_names();

/// Rays as a renderer makes them, in pixel order:
///   camera:    size² pinhole rays; from the middle of an interior, else from outside with the mesh filling the picture
///   diffuse:   one cosine-distributed ray from every point that the camera sees
///   diffuse-2: one more from what those hit
///   occlusion: from what the camera sees, any hit within a tenth of the diagonal
///   shadow:    any hit between one light and what the camera sees and the light faces, from the light
/// Only those whose names are given (all when none is).
std::vector<RaySet> record_rays(const Accel& accel, const BenchMesh& mesh, uint32_t size,
                                const std::vector<std::string>& names);

/// `chunks` pieces of `chunk` rays, evenly spaced; everything when there are no more than that.
RaySet sample(const RaySet& set, size_t chunk, size_t chunks);

}  // namespace steradian::bench
