#include "formats/framing.h"

#include <numbers>
#include <optional>

#include "formats/front_view.h"
#include "math/elementary.h"

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

/// A lone point gets a ball that it can be seen in.
Extent extent_of(const Box& box) {
    if (box.empty()) return {};
    const Vec3d center = (box.lo + box.hi) * 0.5;
    const double smallest = max_of(1e-6 * length(center), 1e-12);
    return {center, max_of(length(box.hi - box.lo) * 0.5, smallest), box.lo.y};
}

}  // namespace

Extent extent_of(const Scene& scene) {
    Box box;
    each_point(scene, [&](Vec3d p) { box.add(p); });
    return extent_of(box);
}

Vec3d turned(Vec3d v, double degrees) {
    const double angle = degrees * (std::numbers::pi / 180), c = math::cos(angle), s = math::sin(angle);
    return {c * v.x + s * v.z, v.y, c * v.z - s * v.x};
}

namespace {

constexpr double kFieldOfView = 25;  // degrees, across a square picture
/// The tangent of half the field of view, of the part of it that is to be filled.
double framed_slope() { return 0.86 * math::tan(kFieldOfView * std::numbers::pi / 360); }

PerspectiveCamera camera_at(Vec3d position, Vec3d target) {
    PerspectiveCamera camera;
    camera.position = Vec3(position);
    camera.look_at = Vec3(target);
    camera.vertical_fov = static_cast<float>(kFieldOfView);
    return camera;
}

/// In a picture that is higher than wide what a square one shows spans the width.
void fit_width(PerspectiveCamera& camera, double aspect) {
    if (!(aspect < 1)) return;
    const double slope = math::tan(kFieldOfView * std::numbers::pi / 360) / aspect;
    camera.vertical_fov = static_cast<float>(math::atan2(slope, 1) * (360 / std::numbers::pi));
}

/// As framing_camera, where everything goes round the vertical through the middle: of a point at the distance r and the
/// height h the most along a vector v is then h v.y + r |(v.x, v.z)|.
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

}  // namespace

// A vertex along an axis a of the picture with coordinate p and depth z is inside when |p - c| <= slope (d - z), so
// that the largest p + slope z and -p + slope z give the place c and the distance d.
PerspectiveCamera framing_camera(const Scene& scene, const Extent& extent, const ViewAxes& axes) {
    const double slope = framed_slope();
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

double add_framing_camera(const LoadedScene& loaded, Assets& assets, double aspect) {
    const View view = front_view(loaded.scene);
    PerspectiveCamera camera = framing_camera(loaded.scene, extent_of(loaded.scene), ViewAxes(view.towards_camera));
    fit_width(camera, aspect);
    assets.add_camera(camera, "camera");
    return view.turn;
}

void add_turntable_camera(LoadedScene& loaded, Assets& assets, double degrees, double aspect) {
    Box box;
    each_ball(loaded.scene, [&](Vec3d p, double r) { box.add(p - Vec3d{r, r, r}), box.add(p + Vec3d{r, r, r}); });
    const ViewAxes axes(turned(kUsualView, -degrees));
    PerspectiveCamera camera = frame_turning(loaded.scene, extent_of(box), axes, framed_slope());
    fit_width(camera, aspect);
    assets.add_camera(camera, "turntable");
    loaded.settings.camera = static_cast<uint32_t>(loaded.scene.cameras.size() - 1);
}

}  // namespace steradian
