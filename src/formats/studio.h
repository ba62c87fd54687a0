// Lights for a model that comes without any.
#pragma once

#include "formats/assets.h"

namespace steradian {

/// Environment and directional lights by degrees about +Y, counter-clockwise seen from above.
void turn_sky(Scene& scene, double degrees);

/// A photographer's table. The model stands on a wide grey floor, where there is one. Light comes from a warm softbox
/// on the left, a weaker and cooler one behind on the right, and a grey environment, as seen by a camera that has gone
/// `turn` degrees about +Y. Everything scales with the model, so that its size does not change the picture.
void add_studio(const LoadedScene& loaded, Assets& assets, bool floor, double turn);

}  // namespace steradian
