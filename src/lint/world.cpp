#include "lint/world.h"

#include "math/ray.h"
#include "math/transform.h"
#include "scene/emission.h"
#include "shading/opacity.h"

namespace steradian::lint_detail {

void Box::add(Vec3d p) {
    lo = {min_of(lo.x, p.x), min_of(lo.y, p.y), min_of(lo.z, p.z)};
    hi = {max_of(hi.x, p.x), max_of(hi.y, p.y), max_of(hi.z, p.z)};
}

void Box::add(const Box& box) {
    if (!box.empty()) add(box.lo), add(box.hi);
}

bool Box::contains(Vec3d p) const {
    return p.x >= lo.x && p.x <= hi.x && p.y >= lo.y && p.y <= hi.y && p.z >= lo.z && p.z <= hi.z;
}

bool Box::touches(const Box& o) const {
    return lo.x <= o.hi.x && o.lo.x <= hi.x && lo.y <= o.hi.y && o.lo.y <= hi.y && lo.z <= o.hi.z && o.lo.z <= hi.z;
}

namespace {

bool lets_pass(const Scene& scene, MaterialId id) {
    return may_let_pass(scene.materials[index(id)], [&](MaterialId part) { return lets_pass(scene, part); });
}

Optics optics(const Scene&, const DiffuseMaterial& m) { return {false, !m.two_sided, true}; }
Optics optics(const Scene&, const RefractionMaterial&) { return {true, false, false}; }
Optics optics(const Scene&, const GlassMaterial&) { return {true, false, false}; }
Optics optics(const Scene&, const MirrorMaterial&) { return {}; }
Optics optics(const Scene&, const ConductorMaterial&) { return {}; }
Optics optics(const Scene&, const ThinGlassMaterial&) { return {false, false, false}; }
Optics optics(const Scene&, const DiffuseTransmissionMaterial&) { return {false, false, false}; }
Optics optics(const Scene&, const OpenPbrMaterial& m) {
    // Metals let nothing pass, whatever their transmission.
    const bool metal = m.base_metalness.value == 1 && !m.base_metalness.texture;
    const bool transmits = m.transmission_weight.value > 0 && !metal;
    const bool thin = m.geometry_thin_walled;
    const bool scatters_through = thin && m.subsurface_weight.value > 0;
    return {transmits && !thin, false, !transmits && !scatters_through};
}
Optics optics(const Scene& scene, const MixMaterial& m) {
    const Optics a = optics_of(scene, m.first), b = optics_of(scene, m.second);
    return {a.solid || b.solid, a.one_sided && b.one_sided, a.opaque && b.opaque};
}

Box box_of(const Mesh& mesh) {
    Box out;
    for (const uint32_t i : mesh.indices)
        if (usable_position(mesh.positions[i])) out.add(mesh.positions[i]);
    return out;
}

Box around(Vec3 center, Vec3 extent) {
    Box out;
    out.add(Vec3d(center) - Vec3d(extent));
    out.add(Vec3d(center) + Vec3d(extent));
    return out;
}

}  // namespace

Optics optics_of(const Scene& scene, MaterialId id) {
    Optics out = std::visit([&](const auto& m) { return optics(scene, m); }, scene.materials[index(id)]);
    out.opaque = out.opaque && !lets_pass(scene, id);
    return out;
}

namespace {

bool has_priority(const Scene& scene, MaterialId id) {
    const Material& material = scene.materials[index(id)];
    if (const auto* mix = std::get_if<MixMaterial>(&material))
        return has_priority(scene, mix->first) || has_priority(scene, mix->second);
    if (const auto* glass = std::get_if<GlassMaterial>(&material)) return glass->priority.has_value();
    const auto* layered = std::get_if<OpenPbrMaterial>(&material);
    return layered && layered->priority && optics_of(scene, id).solid;
}

}  // namespace

bool ordered(const Scene& scene, MaterialId a, MaterialId b) {
    return a != b && has_priority(scene, a) && has_priority(scene, b);
}

World::World(const Scene& scene) : scene_(scene) {
    mesh_boxes_.reserve(scene.meshes.size());
    for (const Mesh& mesh : scene.meshes) mesh_boxes_.push_back(box_of(mesh));
    const size_t count = scene.instances.size();
    boxes_.resize(count), emits_.resize(count), hidden_.resize(count);
    user_begin_.assign(scene.meshes.size() + 1, 0);
    for (uint32_t i = 0; i < count; ++i) {
        const Instance& instance = scene.instances[i];
        const Box local = std::visit(
            [&](const auto& shape) -> Box {
                using T = std::decay_t<decltype(shape)>;
                if constexpr (std::is_same_v<T, MeshId>) {
                    ++user_begin_[index(shape) + 1];
                    return mesh_boxes_[index(shape)];
                } else if constexpr (std::is_same_v<T, Rectangle>) {
                    return around(shape.center, abs(shape.half_u) + abs(shape.half_v));
                } else {
                    return around(shape.center, {shape.radius, shape.radius, shape.radius});
                }
            },
            scene.shapes[index(instance.shape)]);
        for (int corner = 0; corner < 8 && !local.empty(); ++corner)
            boxes_[i].add(transform_point(instance.world_from_object, local.corner(corner)));
        all_.add(boxes_[i]);
        emits_[i] = !is_black(emission_of(scene, instance.material).radiance);
    }
    for (size_t m = 0; m < scene.meshes.size(); ++m) user_begin_[m + 1] += user_begin_[m];
    users_.resize(user_begin_.back());
    std::vector<uint32_t> next(user_begin_.begin(), user_begin_.end() - 1);
    for (uint32_t i = 0; i < count; ++i)
        if (const auto* id = std::get_if<MeshId>(&scene.shapes[index(scene.instances[i].shape)]))
            users_[next[index(*id)]++] = i;
    for (const Light& light : scene.lights)
        if (const auto* area = std::get_if<AreaLight>(&light)) {
            emits_[index(area->instance)] = emits_[index(area->instance)] || !is_black(area->radiance);
            hidden_[index(area->instance)] = !area->visible_to_camera;
        }
}

const Mesh* World::mesh_of(uint32_t instance) const {
    const auto* id = std::get_if<MeshId>(&scene_.shapes[index(scene_.instances[instance].shape)]);
    return id ? &scene_.meshes[index(*id)] : nullptr;
}

std::span<const uint32_t> World::users(MeshId id) const {
    return std::span(users_).subspan(user_begin_[index(id)], user_begin_[index(id) + 1] - user_begin_[index(id)]);
}

}  // namespace steradian::lint_detail
