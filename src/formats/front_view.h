// From where a model without a camera is looked at.
#pragma once

#include "math/vector.h"
#include "steradian/scene.h"

namespace steradian {

struct View {
    Vec3d towards_camera;
    double turn = 0;  ///< degrees about +Y from the usual view, whatever the height
};

/// The usual view, but where at least a quarter of what it shows of a model are backs of surfaces (the outside of a
/// room's walls, a sheet that faces away) and another shows less than half as many: then the one that shows the most of
/// fronts, less its backs, where views from the usual height count double. Which side of a triangle is the front says
/// its winding, whatever its material is. Models of more than a million triangles and vertices (those of each object
/// counted) are seen as usual, and so are others that it would take long to compare.
View front_view(const Scene& scene);

}  // namespace steradian
