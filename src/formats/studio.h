// A camera and lights for a model that comes without any.
#pragma once

#include "formats/assets.h"

namespace steradian {

/// A photographer's table. The camera looks from the front right and above, through a long lens (a vertical field of
/// view of 25°), from the nearest place where a square picture holds every vertex with 14 % to spare; wider pictures
/// show more at the sides. The model stands on a wide grey floor that fills the rest of the picture. Light comes from a
/// warm softbox on the left, a weaker and cooler one behind on the right, and a grey environment. Everything scales
/// with the model, so that its size does not change the picture.
void add_studio(LoadedScene& loaded, Assets& assets);

}  // namespace steradian
