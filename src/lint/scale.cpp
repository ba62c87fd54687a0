// Objects in other units than the rest of the scene, or too far away for them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lint/check.h"
#include "math/transform.h"
#include "shading/camera.h"

namespace steradian::lint_detail {
namespace {

constexpr double kMuchLarger = 1000;

/// Of its box in the world, in metres.
Vec3d extent(const Box& box) { return box.hi - box.lo; }
double thinnest(Vec3d v) { return min_of(v.x, min_of(v.y, v.z)); }
double longest(Vec3d v) { return max_of(v.x, max_of(v.y, v.z)); }

/// From a point to the nearest one of a triangle, or somewhat more: by its corners, its middle and those of its parts.
double distance_to(Vec3d p, Vec3d a, Vec3d b, Vec3d c, int parts = 4) {
    const Vec3d middle = (a + b + c) * (1.0 / 3);
    double nearest = min_of(min_of(length(p - a), length(p - b)), min_of(length(p - c), length(p - middle)));
    if (parts == 0) return nearest;
    const Vec3d ab = (a + b) * 0.5, bc = (b + c) * 0.5, ca = (c + a) * 0.5;
    const Vec3d quarters[4][3] = {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}};
    int best = 0;
    double best_distance = kInfinity;
    for (int i = 0; i < 4; ++i) {
        const Vec3d* q = quarters[i];
        const double d = length(p - (q[0] + q[1] + q[2]) * (1.0 / 3));
        if (d < best_distance) best_distance = d, best = i;
    }
    return min_of(nearest, distance_to(p, quarters[best][0], quarters[best][1], quarters[best][2], parts - 1));
}

/// Grounds and backdrops are large on purpose: they are flat, or they surround everything from afar.
bool is_backdrop(const Check& check, uint32_t instance, const Box& rest) {
    constexpr double kFlat = 0.25, kFar = 0.1;
    const Mesh* mesh = check.world.mesh_of(instance);
    const Box& box = check.world.box(instance);
    if (!mesh || thinnest(extent(box)) < kFlat * longest(extent(box))) return true;
    if (!box.contains(rest.center())) return false;
    double nearest = kInfinity;
    const auto corner = [&](size_t i) {
        return transform_point(check.scene.instances[instance].world_from_object, mesh->positions[mesh->indices[i]]);
    };
    for (size_t i = 0; i + 2 < mesh->indices.size(); i += 3)
        nearest = min_of(nearest, distance_to(rest.center(), corner(i), corner(i + 1), corner(i + 2)));
    return nearest > kFar * longest(extent(box));
}

/// One object a thousand times as large as all the others together.
void look_for_giants(Check& check) {
    const uint32_t count = check.own_instances;
    uint32_t giant = 0;
    for (uint32_t i = 1; i < count; ++i)
        if (check.world.box(i).size() > check.world.box(giant).size()) giant = i;
    Box rest;
    for (uint32_t i = 0; i < count; ++i)
        if (i != giant) rest.add(check.world.box(i));
    if (count < 2 || !(rest.size() > 0)) return;
    const double size = check.world.box(giant).size();
    if (!(size > kMuchLarger * rest.size()) || is_backdrop(check, giant, rest)) return;
    check.out.add(Rule::scale, Element{ElementKind::instance, giant},
                  fmt::format("{} is {:.3g} m large, all other objects together {:.3g} m", check.object(giant), size,
                              rest.size()),
                  "lengths are metres: a model in millimetres needs a scale of 0.001");
}

/// The whole scene within a pixel or two.
void look_for_dots(Check& check) {
    constexpr double kLeastPixels = 2;
    const Box& all = check.world.all();
    if (!(all.size() > 0)) return;
    for (uint32_t i = 0; i < check.scene.cameras.size(); ++i) {
        const auto* camera = std::get_if<PerspectiveCamera>(&check.scene.cameras[i]);
        if (!camera) continue;
        const auto sampler = CameraSampler::make(*camera, check.settings.width, check.settings.height);
        if (!sampler.ok()) continue;
        const auto w = static_cast<float>(check.settings.width), h = static_cast<float>(check.settings.height);
        const Vec3d a = sampler->generate({w / 2, h / 2 - 0.5f}).d, b = sampler->generate({w / 2, h / 2 + 0.5f}).d;
        const double pixel = length(a - b), distance = length(all.center() - Vec3d(camera->position));
        const double pixels = all.size() / (distance * pixel);
        if (!(pixels < kLeastPixels)) continue;
        const Element element{ElementKind::camera, i};
        check.out.add(Rule::scale, element,
                      fmt::format("{} is {:.3g} m from a scene of {:.3g} m, which is {:.2g} pixels in its picture",
                                  check.name(element), distance, all.size(), pixels),
                      "lengths are metres");
    }
}

/// What fills the bodies of a material and absorbs without scattering.
std::optional<Rgb> absorption_of(const Scene& scene, MaterialId id) {
    const Material& material = scene.materials[index(id)];
    if (const auto* mix = std::get_if<MixMaterial>(&material)) {
        const auto first = absorption_of(scene, mix->first);
        return first ? first : absorption_of(scene, mix->second);
    }
    const Medium* medium = nullptr;
    if (const auto* glass = std::get_if<GlassMaterial>(&material)) medium = &glass->interior;
    if (const auto* m = std::get_if<OpenPbrMaterial>(&material);
        m && m->transmission_weight.value > 0 && !m->geometry_thin_walled)
        medium = &m->interior;
    return medium && is_black(medium->scattering) ? std::optional(medium->absorption) : std::nullopt;
}

/// How far it is through a closed body, as the mean over all ways: four times its volume over its surface (Cauchy).
double mean_way_through(const Mesh& mesh, const Affine& world_from_object) {
    double volume = 0, surface = 0;
    const Vec3d origin = transform_point(world_from_object, mesh.positions[mesh.indices[0]]);
    const auto corner = [&](size_t i) {
        return transform_point(world_from_object, mesh.positions[mesh.indices[i]]) - origin;
    };
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const Vec3d a = corner(i), scaled_normal = cross(corner(i + 1) - a, corner(i + 2) - a);
        volume += dot(a, scaled_normal) / 6, surface += length(scaled_normal) / 2;
    }
    return surface > 0 ? 4 * std::fabs(volume) / surface : 0;
}

/// Large bodies that light would pass through, if it were not absorbed at once: the way that absorbs is in metres
/// whatever the model is in. Deep water lets more light pass than these.
void look_for_ink(Check& check) {
    constexpr double kLarge = 10, kOpaque = 100;
    for (uint32_t i = 0; i < check.own_instances; ++i) {
        const Instance& instance = check.scene.instances[i];
        const Mesh* mesh = check.world.mesh_of(i);
        const auto absorption = absorption_of(check.scene, instance.material);
        if (!mesh || !absorption || !(check.world.box(i).size() > kLarge)) continue;
        const double least = min_of(absorption->r, min_of(absorption->g, absorption->b));
        if (!(least * check.world.box(i).size() > kOpaque) || !check.bodies.closed(i)) continue;
        const double way = mean_way_through(*mesh, instance.world_from_object);
        if (!(least * way > kOpaque)) continue;
        check.out.add(Rule::scale, Element{ElementKind::instance, i},
                      fmt::format("{} is transparent and {:.3g} m large, but {} lets half of the light pass through "
                                  "{:.2g} m: it is black",
                                  check.object(i), check.world.box(i).size(), check.material(instance.material),
                                  std::numbers::ln2 / least),
                      "lengths are metres: a model in millimetres needs a scale of 0.001");
    }
}

/// Floats have 24 bits: far from the origin little is left for the shape.
void look_for_rounding(Check& check) {
    constexpr double kFewestSteps = 4096, kStep = 1.0 / (1 << 23);
    for (uint32_t m = 0; m < check.scene.meshes.size(); ++m) {
        const Box& box = check.world.mesh_box(MeshId(m));
        if (!(box.size() > 0)) continue;
        double far = 0;
        for (int axis = 0; axis < 3; ++axis)
            far = max_of(far, max_of(std::fabs(box.lo[axis]), std::fabs(box.hi[axis])));
        if (!(box.size() < kFewestSteps * kStep * far)) continue;
        const Element element{ElementKind::mesh, m};
        check.out.add(Rule::precision, element,
                      fmt::format("{} is {:.3g} m large and up to {:.3g} m from its origin: its vertices lie on a grid "
                                  "of {:.2g} m",
                                  check.name(element), box.size(), far, far * kStep),
                      "move the model to the origin in the program that made it, and back by a transform");
    }
}

}  // namespace

void check_scale(Check& check) {
    if (check.out.wants(Rule::scale)) look_for_giants(check), look_for_dots(check), look_for_ink(check);
    if (check.out.wants(Rule::precision)) look_for_rounding(check);
}

}  // namespace steradian::lint_detail
