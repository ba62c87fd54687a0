// A camera and lights for a model that comes without any.
#pragma once

#include "formats/assets.h"

namespace steradian {

// A photographer's table. Everything scales with the model, so that its size does not change the picture. Of meshes
// that several objects share the corners of their boxes count, of all others every vertex.

/// The camera looks from the front right and above, through a long lens (a vertical field of view of 25°), from the
/// nearest place where a square picture holds every vertex with 14 % to spare; wider pictures show more at the sides.
void add_framing_camera(const LoadedScene& loaded, Assets& assets);

/// Of a scene of any kind that is turned by so many degrees as on a turntable (see LoadOptions::turn): from the same
/// direction and through the same lens, from the nearest place where a square picture holds everything at every angle.
/// It is the scene itself that stays, and the camera that goes round. The settings choose it.
void add_turntable_camera(LoadedScene& loaded, Assets& assets, double degrees);

/// Environment and directional lights by degrees about +Y, counter-clockwise seen from above.
void turn_sky(Scene& scene, double degrees);

/// The model stands on a wide grey floor, where there is one. Light comes from a warm softbox on the left, a weaker and
/// cooler one behind on the right, and a grey environment. The boxes go round as the turntable's camera does.
void add_studio(const LoadedScene& loaded, Assets& assets, bool floor, double turn);

}  // namespace steradian
