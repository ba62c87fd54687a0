// Cameras that see nothing.
#include <fmt/format.h>

#include "lint/check.h"
#include "math/transform.h"
#include "shading/camera.h"

namespace steradian::lint_detail {
namespace {

/// The four planes through the sides of a flat picture; what is inside is on their positive sides.
struct Frustum {
    struct Plane {
        Vec3d point, normal;
    };
    std::vector<Plane> planes;

    Frustum(const CameraSampler& camera, uint32_t width, uint32_t height) {
        const auto w = static_cast<float>(width), h = static_cast<float>(height);
        const Vec2 film[4] = {{0, 0}, {w, 0}, {w, h}, {0, h}};
        Ray corner[4];
        for (int i = 0; i < 4; ++i) corner[i] = camera.generate(film[i]);
        const Ray middle = camera.generate({w / 2, h / 2});
        const Vec3d forward = middle.d, ahead = Vec3d(middle.o) + forward;
        add(middle.o, forward, ahead);
        for (int i = 0; i < 4; ++i) {
            const Ray &a = corner[i], &b = corner[(i + 1) % 4];
            add(a.o, cross(Vec3d(a.d), Vec3d(b.o) + Vec3d(b.d) - Vec3d(a.o)), ahead);
        }
    }
    void add(Vec3d point, Vec3d normal, Vec3d inside) {
        planes.push_back({point, dot(inside - point, normal) < 0 ? -normal : normal});
    }
    /// False only where all corners are outside of one plane, so that nothing of the box can be seen.
    bool may_see(const Box& box) const {
        for (const Plane& plane : planes) {
            bool all_outside = true;
            for (int i = 0; i < 8; ++i) all_outside = all_outside && dot(box.corner(i) - plane.point, plane.normal) < 0;
            if (all_outside) return false;
        }
        return true;
    }
};

bool is_flat_pinhole(const Camera& camera) {
    const auto* lens = std::get_if<PerspectiveCamera>(&camera);
    return lens ? lens->aperture_radius == 0 : std::holds_alternative<OrthographicCamera>(camera);
}

void look_for_view(Check& check, uint32_t number, const CameraSampler& sampler) {
    const Frustum frustum(sampler, check.settings.width, check.settings.height);
    bool any = false;
    for (uint32_t i = 0; i < check.scene.instances.size(); ++i) {
        if (check.world.box(i).empty()) continue;
        any = true;
        if (check.world.visible_to_camera(i) && frustum.may_see(check.world.box(i))) return;
    }
    const Element element{ElementKind::camera, number};
    if (any)
        check.out.add(Rule::empty_view, element,
                      fmt::format("{} sees none of the {} objects: all are behind it or beside its picture",
                                  check.name(element), check.scene.instances.size()));
}

Vec3d position_of(const Camera& camera) {
    return std::visit([](const auto& c) { return Vec3d(c.position); }, camera);
}

/// Whether anything that shines may be inside of a body, or is it.
bool may_be_lit_inside(Check& check, uint32_t wall) {
    for (uint32_t i = 0; i < check.scene.instances.size(); ++i)
        if (check.world.emits(i) && check.world.box(i).touches(check.world.box(wall))) return true;
    for (const Light& light : check.scene.lights) {
        std::optional<Vec3d> p;
        if (const auto* point = std::get_if<PointLight>(&light)) p = point->position;
        if (const auto* spot = std::get_if<SpotLight>(&light)) p = spot->position;
        if (const auto* lamp = std::get_if<GoniometricLight>(&light)) p = lamp->position;
        if (p && check.bodies.inside(wall, *p).value_or(true)) return true;
    }
    return false;
}

void look_for_walls(Check& check, uint32_t number) {
    const IntegratorKind integrator = check.settings.integrator;
    if (integrator != IntegratorKind::path && integrator != IntegratorKind::direct) return;
    const Vec3d p = position_of(check.scene.cameras[number]);
    for (uint32_t i = 0; i < check.scene.instances.size(); ++i) {
        if (!check.world.box(i).contains(p) || !check.world.visible_to_camera(i)) continue;
        if (!optics_of(check.scene, check.scene.instances[i].material).opaque || !check.bodies.closed(i)) continue;
        if (!check.bodies.inside(i, p).value_or(false) || may_be_lit_inside(check, i)) continue;
        const Element element{ElementKind::camera, number};
        check.out.add(Rule::camera_in_wall, element,
                      fmt::format("{} is inside of {}, which is closed and opaque and has no light in it: the picture "
                                  "will be black",
                                  check.name(element), check.object(i)));
        return;
    }
}

}  // namespace

void check_cameras(Check& check) {
    for (uint32_t i = 0; i < check.scene.cameras.size(); ++i) {
        if (check.out.wants(Rule::camera_in_wall)) look_for_walls(check, i);
        const Camera& camera = check.scene.cameras[i];
        if (!check.out.wants(Rule::empty_view) || !is_flat_pinhole(camera)) continue;
        const auto sampler = CameraSampler::make(camera, check.settings.width, check.settings.height);
        if (sampler.ok()) look_for_view(check, i, *sampler);
    }
}

}  // namespace steradian::lint_detail
