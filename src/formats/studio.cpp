#include "formats/studio.h"

#include <numbers>
#include <optional>
#include <vector>

#include "math/elementary.h"
#include "math/ray.h"
#include "math/transform.h"
#include "math/vector.h"

namespace steradian {
namespace {

struct Box {
    Vec3d lo{kMaxCoordinate, kMaxCoordinate, kMaxCoordinate}, hi = -lo;

    void add(Vec3d p) {
        lo = {min_of(lo.x, p.x), min_of(lo.y, p.y), min_of(lo.z, p.z)};
        hi = {max_of(hi.x, p.x), max_of(hi.y, p.y), max_of(hi.z, p.z)};
    }
    bool empty() const { return !(lo.x <= hi.x); }
    Vec3d corner(int i) const { return {i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z}; }
};

/// Calls `visit` for every vertex that a triangle uses and that can be rendered.
template <class Visit>
void each_vertex(const Mesh& mesh, Visit visit) {
    for (const uint32_t i : mesh.indices)
        if (usable_position(mesh.positions[i])) visit(Vec3d(mesh.positions[i]));
}

/// Calls `visit` for points in the world that no mesh of the scene reaches beyond.
template <class Visit>
void each_point(const Scene& scene, Visit visit) {
    std::vector<uint32_t> users(scene.meshes.size());
    std::vector<std::optional<Box>> boxes(scene.meshes.size());
    const auto mesh_of = [&](const Instance& i) { return std::get_if<MeshId>(&scene.shapes[index(i.shape)]); };
    for (const Instance& i : scene.instances)
        if (const MeshId* id = mesh_of(i)) ++users[index(*id)];
    for (const Instance& i : scene.instances) {
        const MeshId* id = mesh_of(i);
        if (!id) continue;
        const Mesh& mesh = scene.meshes[index(*id)];
        const bool stays = is_identity(i.world_from_object);
        const auto place = [&](Vec3d p) { visit(stays ? p : transform_point(i.world_from_object, p)); };
        if (users[index(*id)] == 1) {
            each_vertex(mesh, place);
            continue;
        }
        std::optional<Box>& box = boxes[index(*id)];
        if (!box) each_vertex(mesh, [&, &b = box.emplace()](Vec3d p) { b.add(p); });
        for (int corner = 0; corner < 8 && !box->empty(); ++corner) place(box->corner(corner));
    }
}

/// The same of shapes of all kinds, as balls of some radius about points.
template <class Visit>
void each_ball(const Scene& scene, Visit visit) {
    each_point(scene, [&](Vec3d p) { visit(p, 0.0); });
    for (const Instance& i : scene.instances) {
        const Shape& shape = scene.shapes[index(i.shape)];
        const auto place = [&](Vec3 p) { return transform_point(i.world_from_object, p); };
        const auto ball = [&](Vec3 center, float radius) {
            double longest = 0;  // no vector becomes longer than this times its length
            for (const auto& row : i.world_from_object.m)
                for (int c = 0; c < 3; ++c) longest += row[size_t(c)] * row[size_t(c)];
            const double scale = uniform_scale(i.world_from_object).value_or(std::sqrt(longest));
            visit(place(center), std::fabs(scale) * static_cast<double>(radius));
        };
        if (const auto* sphere = std::get_if<Sphere>(&shape)) ball(sphere->center, sphere->radius);
        if (const auto* disk = std::get_if<Disk>(&shape)) ball(disk->center, disk->radius);
        if (const auto* r = std::get_if<Rectangle>(&shape))
            for (const float u : {-1.0f, 1.0f})
                for (const float v : {-1.0f, 1.0f}) visit(place(r->center + r->half_u * u + r->half_v * v), 0.0);
    }
}

/// Where the model is: the middle of its bounding box, half the box's diagonal, its lowest height.
struct Extent {
    Vec3d center;
    double radius = 1, floor = -1;
};

/// A lone point gets a ball that it can be seen in.
Extent extent_of(const Box& box) {
    if (box.empty()) return {};
    const Vec3d center = (box.lo + box.hi) * 0.5;
    const double smallest = max_of(1e-6 * length(center), 1e-12);
    return {center, max_of(length(box.hi - box.lo) * 0.5, smallest), box.lo.y};
}

Extent extent_of(const Scene& scene) {
    Box box;
    each_point(scene, [&](Vec3d p) { box.add(p); });
    return extent_of(box);
}

/// About +Y, counter-clockwise seen from above.
Vec3d turned(Vec3d v, double degrees) {
    const double angle = degrees * (std::numbers::pi / 180), c = math::cos(angle), s = math::sin(angle);
    return {c * v.x + s * v.z, v.y, c * v.z - s * v.x};
}

/// The axes of a view: to the right, upwards, and back towards the camera.
struct ViewAxes {
    Vec3d right, up, back;

    explicit ViewAxes(Vec3d towards_camera) : back(normalize(towards_camera)) {
        right = normalize(cross(Vec3d{0, 1, 0}, back));
        up = cross(back, right);
    }
};

constexpr Vec3d kTowardsCamera{0.5, 0.42, 1};
constexpr double kFieldOfView = 25;  // degrees
/// The tangent of half the field of view, of the part of it that is to be filled.
double framed_slope() { return 0.86 * math::tan(kFieldOfView * std::numbers::pi / 360); }

PerspectiveCamera camera_at(Vec3d position, Vec3d target) {
    PerspectiveCamera camera;
    camera.position = Vec3(position);
    camera.look_at = Vec3(target);
    camera.vertical_fov = static_cast<float>(kFieldOfView);
    return camera;
}

/// The nearest place from which a picture with this slope (the tangent of half its field of view, both ways) holds
/// every vertex. One along an axis a of the picture with coordinate p and depth z is inside when
/// |p - c| <= slope (d - z), so that the largest p + slope z and -p + slope z give the place c and the distance d.
PerspectiveCamera frame(const Scene& scene, const Extent& extent, const ViewAxes& axes, double slope) {
    Vec3d high{-kInfinity, -kInfinity, -kInfinity}, low = high;
    each_point(scene, [&](Vec3d p) {
        const Vec3d q = p - extent.center;
        const double x = dot(q, axes.right), y = dot(q, axes.up), z = dot(q, axes.back);
        high = {max_of(high.x, x + slope * z), max_of(high.y, y + slope * z), max_of(high.z, z)};
        low = {max_of(low.x, -x + slope * z), max_of(low.y, -y + slope * z), 0};
    });
    if (!(high.z > -kInfinity)) high = low = {extent.radius, extent.radius, extent.radius};
    const double tight = max_of(high.x + low.x, high.y + low.y) / (2 * slope);
    const double distance = max_of(tight, high.z + extent.radius);
    const Vec3d middle = extent.center + axes.right * ((high.x - low.x) * 0.5) + axes.up * ((high.y - low.y) * 0.5);
    return camera_at(middle + axes.back * distance, middle);
}

/// The same where everything goes round the vertical through the middle: of a point at the distance r and the height h
/// the most along a vector v is then h v.y + r |(v.x, v.z)|.
PerspectiveCamera frame_turning(const Scene& scene, const Extent& extent, const ViewAxes& axes, double slope) {
    double side = -kInfinity, high = side, low = side, depth = side;
    each_ball(scene, [&](Vec3d p, double radius) {
        const Vec3d q = p - extent.center;
        const double r = std::sqrt(q.x * q.x + q.z * q.z);
        const auto most = [&](Vec3d v) {
            return q.y * v.y + r * std::sqrt(v.x * v.x + v.z * v.z) + radius * length(v);
        };
        side = max_of(side, most(axes.right + axes.back * slope));
        high = max_of(high, most(axes.up + axes.back * slope));
        low = max_of(low, most(-axes.up + axes.back * slope));
        depth = max_of(depth, most(axes.back));
    });
    if (!(depth > -kInfinity)) side = high = low = depth = extent.radius;
    const double distance = max_of(max_of(2 * side, high + low) / (2 * slope), depth + extent.radius);
    const Vec3d middle = extent.center + axes.up * ((high - low) * 0.5);
    return camera_at(middle + axes.back * distance, middle);
}

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

void add_framing_camera(const LoadedScene& loaded, Assets& assets) {
    assets.add_camera(frame(loaded.scene, extent_of(loaded.scene), ViewAxes(kTowardsCamera), framed_slope()), "camera");
}

void add_turntable_camera(LoadedScene& loaded, Assets& assets, double degrees) {
    Box box;
    each_ball(loaded.scene, [&](Vec3d p, double r) { box.add(p - Vec3d{r, r, r}), box.add(p + Vec3d{r, r, r}); });
    const ViewAxes axes(turned(kTowardsCamera, -degrees));
    assets.add_camera(frame_turning(loaded.scene, extent_of(box), axes, framed_slope()), "turntable");
    loaded.settings.camera = static_cast<uint32_t>(loaded.scene.cameras.size() - 1);
}

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
    add_softbox(softbox(extent, turned({-0.9, 1.2, 0.8}, -turn), 5, 1.5), {8.8f, 8.2f, 7.4f}, "key light");
    add_softbox(softbox(extent, turned({1.0, 0.7, -0.9}, -turn), 5, 1.2), {4, 4.5f, 5.2f}, "rim light");
    EnvironmentLight fill;
    fill.radiance = {0.26f, 0.28f, 0.31f};
    assets.add_light(fill, "studio");
}

}  // namespace steradian
