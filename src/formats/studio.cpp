#include "formats/studio.h"

#include <numbers>

#include "math/elementary.h"
#include "math/ray.h"
#include "math/vector.h"

namespace steradian {
namespace {

struct Ball {
    Vec3d center;
    double radius = 1;
};

/// Around the bounding box of everything that can be rendered. A lone point gets a ball that it can be seen in.
Ball bounding_ball(const Scene& scene) {
    Vec3d lo{kMaxCoordinate, kMaxCoordinate, kMaxCoordinate}, hi = -lo;
    bool any = false;
    for (const Mesh& mesh : scene.meshes) {
        for (const uint32_t i : mesh.indices) {
            const Vec3 p = mesh.positions[i];
            if (!is_finite(p) || max_component(abs(p)) > kMaxCoordinate) continue;
            any = true;
            lo = {min_of<double>(lo.x, p.x), min_of<double>(lo.y, p.y), min_of<double>(lo.z, p.z)};
            hi = {max_of<double>(hi.x, p.x), max_of<double>(hi.y, p.y), max_of<double>(hi.z, p.z)};
        }
    }
    if (!any) return {};
    Ball ball{(lo + hi) * 0.5, length(hi - lo) * 0.5};
    const double smallest = max_of(1e-6 * length(ball.center), 1e-12);
    ball.radius = max_of(ball.radius, smallest);
    return ball;
}

}  // namespace

void add_studio(LoadedScene& loaded, Assets& assets) {
    constexpr double kFieldOfView = 35, kMargin = 1.1;
    const Ball ball = bounding_ball(loaded.scene);
    const Vec3d c = ball.center;

    const Vec3d towards_camera = normalize(Vec3d{0.55, 0.35, 1});
    const double distance = kMargin * ball.radius / math::sin(kFieldOfView * std::numbers::pi / 360);
    PerspectiveCamera camera;
    camera.position = Vec3(c + towards_camera * distance);
    camera.look_at = Vec3(c);
    camera.vertical_fov = static_cast<float>(kFieldOfView);
    assets.add_camera(camera, "camera");

    // A square with sides of 3 radii, 5 radii away, facing the model: it sends E = L (3/5)² to the centre, nearly.
    const Vec3d towards_key = normalize(Vec3d{-0.8, 1.1, 0.9});
    const Vec3d u = normalize(cross(towards_key, Vec3d{0, 1, 0})), v = cross(u, towards_key);
    const double half = 1.5 * ball.radius;
    Rectangle key;
    key.center = Vec3(c + towards_key * (5 * ball.radius));
    key.half_u = Vec3(u * half);
    key.half_v = Vec3(v * half);  // half_u × half_v looks back at the model
    const ShapeId shape = assets.add_shape(key, "key light");
    const InstanceId instance = assets.add_instance({shape, assets.default_material(true), Affine{}}, "key light");
    assets.add_light(AreaLight{instance, {7, 6.8f, 6.5f}, false, 1}, "key light");
    EnvironmentLight fill;
    fill.radiance = {0.3f, 0.32f, 0.35f};
    assets.add_light(fill, "studio");
}

}  // namespace steradian
