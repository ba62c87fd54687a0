// Materials that emit make lights of the objects that have them.
#pragma once

#include "steradian/scene.h"

namespace steradian {

/// The most that surfaces of the material emit towards any direction, textures at 1, and on which sides. Black for what
/// does not emit.
struct Emission {
    Rgb radiance{0, 0, 0};
    bool two_sided = false;
    bool textured = false;  ///< how much they emit depends on the place
};
Emission emission_of(const Scene& scene, MaterialId material);

/// Adds an AreaLight for each instance whose material emits, in order: its radiance is that of emission_of, which says
/// how much the light counts where lights are chosen. The scene must be valid, and nothing added yet.
void add_emission(Scene& scene);

}  // namespace steradian
