// Cameras for models that come without any, and where models are.
#pragma once

#include "formats/assets.h"
#include "math/ray.h"
#include "math/transform.h"
#include "math/vector.h"

namespace steradian {

/// Calls `visit` for every vertex that a triangle uses and that can be rendered.
template <class Visit>
void each_vertex(const Mesh& mesh, Visit visit) {
    for (const uint32_t i : mesh.indices)
        if (usable_position(mesh.positions[i])) visit(Vec3d(mesh.positions[i]));
}

/// The axes of a view: to the right, upwards, and back towards the camera.
struct ViewAxes {
    Vec3d right, up, back;

    explicit ViewAxes(Vec3d towards_camera) : back(normalize(towards_camera)) {
        right = normalize(cross(Vec3d{0, 1, 0}, back));
        up = cross(back, right);
    }
};

/// Where the model is: the middle of its bounding box, half the box's diagonal, its lowest height.
struct Extent {
    Vec3d center;
    double radius = 1, floor = -1;
};
Extent extent_of(const Scene& scene);

/// From the front right and above: where cameras look from, unless a model shows more elsewhere.
constexpr Vec3d kUsualView{0.5, 0.42, 1};

/// About +Y, counter-clockwise seen from above.
Vec3d turned(Vec3d v, double degrees);

/// From the direction of `axes`, through the long lens that all cameras here have (25° across a square picture), from
/// the nearest place where a square picture holds every vertex with 14 % to spare. Of meshes that several objects share
/// the corners of their boxes count, of all others every vertex.
PerspectiveCamera framing_camera(const Scene& scene, const Extent& extent, const ViewAxes& axes);

/// Adds one that looks from where a model shows itself (front_view.h). A picture that is `aspect` times as wide as high
/// shows a square picture's content, and more at its longer sides. Returns by how many degrees about +Y the view
/// has been turned from the usual one, from the front right.
double add_framing_camera(const LoadedScene& loaded, Assets& assets, double aspect);

/// Of a scene of any kind that is turned by so many degrees as on a turntable (see LoadOptions::turn): from the usual
/// direction and through the same lens, from the nearest place where a square picture holds everything at every angle.
/// It is the scene itself that stays, and the camera that goes round. The settings choose it.
void add_turntable_camera(LoadedScene& loaded, Assets& assets, double degrees, double aspect);

}  // namespace steradian
