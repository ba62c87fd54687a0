#include "formats/studio.h"

#include "formats/framing.h"
#include "math/ray.h"
#include "math/vector.h"

namespace steradian {
namespace {

/// A square light of the given half side that faces the model's middle.
Rectangle softbox(const Extent& extent, Vec3d towards, double distance, double half_side) {
    const ViewAxes axes(towards);
    Rectangle r;
    r.center = Vec3(extent.center + axes.back * (distance * extent.radius));
    r.half_u = Vec3(axes.up * (half_side * extent.radius));
    r.half_v = Vec3(axes.right * (half_side * extent.radius));  // half_u × half_v looks back at the model
    return r;
}

/// A hair below the model, so that a flat underside does not lie in the floor itself.
void add_floor(const Extent& extent, Assets& assets) {
    constexpr double kFloorRadius = 60, kGap = 2e-3;
    Disk floor;
    floor.center = Vec3(Vec3d{extent.center.x, extent.floor - kGap * extent.radius, extent.center.z});
    floor.normal = {0, 1, 0};
    floor.radius = static_cast<float>(min_of<double>(kFloorRadius * extent.radius, kMaxCoordinate));
    const MaterialId grey = assets.add_diffuse({0.3f, 0.31f, 0.33f}, true, "floor");
    assets.add_instance({assets.add_shape(floor, "floor"), grey, Affine{}}, "floor");
}

}  // namespace

void turn_sky(Scene& scene, double degrees) {
    for (Light& light : scene.lights) {
        if (auto* environment = std::get_if<EnvironmentLight>(&light))
            environment->rotation += static_cast<float>(degrees);
        if (auto* sun = std::get_if<DirectionalLight>(&light)) sun->direction = Vec3(turned(sun->direction, degrees));
    }
}

void add_studio(const LoadedScene& loaded, Assets& assets, bool floor, double turn) {
    const Extent extent = extent_of(loaded.scene);
    if (floor) add_floor(extent, assets);
    const auto add_softbox = [&](const Rectangle& shape, Rgb radiance, const std::string& name) {
        const InstanceId instance =
            assets.add_instance({assets.add_shape(shape, name), assets.default_material(true), Affine{}}, name);
        assets.add_light(AreaLight{instance, radiance, false, 1}, name);
    };
    add_softbox(softbox(extent, turned({-0.9, 1.2, 0.8}, turn), 5, 1.5), {8.8f, 8.2f, 7.4f}, "key light");
    add_softbox(softbox(extent, turned({1.0, 0.7, -0.9}, turn), 5, 1.2), {4, 4.5f, 5.2f}, "rim light");
    EnvironmentLight fill;
    fill.radiance = {0.26f, 0.28f, 0.31f};
    assets.add_light(fill, "studio");
}

}  // namespace steradian
