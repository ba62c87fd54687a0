// A camera and lights for a model that comes without any.
#pragma once

#include "formats/assets.h"

namespace steradian {

/// Frames all instances of the scene: a three-quarter view from the right, slightly above, whose vertical field of view
/// (35°) holds the bounding sphere with a tenth to spare. Light comes from a grey environment and one rectangular key
/// light above on the left, behind the camera; both scale with the model, so that its size does not change the picture.
/// A white surface that faces the key light sends back a radiance of about 1.
void add_studio(LoadedScene& loaded, Assets& assets);

}  // namespace steradian
