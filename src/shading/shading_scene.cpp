#include "shading/shading_scene.h"

#include <algorithm>
#include <map>
#include <new>
#include <tuple>

#include "base/text.h"
#include "math/elementary.h"
#include "math/warp.h"
#include "scene/emission.h"
#include "scene/texture_uses.h"
#include "shading/environment.h"
#include "shading/fresnel.h"
#include "shading/light/emitter_texture.h"
#include "shading/light/mesh_emitter.h"
#include "shading/light/sphere_emitter.h"
#include "shading/microfacet_energy.h"
#include "shading/mip_map.h"
#include "shading/opacity.h"
#include "shading/open_pbr_tables.h"
#include "shading/surface.h"
#include "shading/surface_error.h"
#include "shading/texture.h"

namespace steradian {
namespace {

/// Of a transform that is not the identity.
ShadingScene::TransformData transform_data(const Affine& m) {
    ShadingScene::TransformData out;
    out.identity = false;
    out.object_from_world = inverse(m).value_or(Affine{});  // validate() has refused singular transforms
    out.flips = determinant(m) < 0;
    double product[3][3] = {};
    for (size_t r = 0; r < 3; ++r)
        for (size_t c = 0; c < 3; ++c)
            for (size_t k = 0; k < 3; ++k)
                product[r][c] += std::fabs(m.m[r][k]) * std::fabs(out.object_from_world.m[k][c]);
    out.round_trip = {};
    for (size_t r = 0; r < 3; ++r)
        for (size_t c = 0; c < 3; ++c)
            for (size_t k = 0; k < 3; ++k) out.round_trip[3 * r + c] += product[r][k] * product[k][c];
    return out;
}

/// Turns the surface of an area light into world space. The fields that the light's kind of shape needs are filled in.
class EmitterBuilder {
public:
    EmitterBuilder(const ShadingScene& scene, const AreaLight& light, ShadingScene::LightData& out)
        : scene_(scene),
          id_(light.instance),
          two_sided_(light.two_sided),
          means_(texture_means(scene, light)),
          instance_(scene.scene.instances[index(id_)]),
          data_(scene.transform_of(index(id_))),
          transform_(instance_.world_from_object),
          out_(out) {}

    void operator()(MeshId id) {
        std::vector<LightBounds> triangles;
        triangles.reserve(scene_.scene.meshes[index(id)].indices.size() / 3);
        double total = 0;
        each_triangle_bounds(scene_, id_, id, two_sided_, [&](const LightBounds& triangle) {
            total += triangle.strength;
            triangles.push_back(triangle);
            if (!means_.triangles.empty()) triangles.back().strength *= means_.triangles[triangles.size() - 1];
        });
        finish(MeshEmitter{id_, id, LightTree(triangles)}, total);
    }

    void operator()(const Sphere& sphere) {
        const Vec3d center = sphere.center;
        const double r = sphere.radius;
        const double slack = sphere_slack(r, max_component(abs(center)) + r);
        const Vec3 p_error = error_within(center, {r, r, r}, slack);
        if (const std::optional<double> scale = uniform_scale(transform_)) {
            const double radius = *scale * r;
            finish(SphereEmitter{to_world(center), radius, p_error}, 4 * std::numbers::pi * radius * radius);
            return;
        }
        const EllipsoidEmitter e{id_, center, r, std::fabs(determinant(transform_)), p_error};
        finish(e, ellipsoid_area(e, data_.object_from_world));
    }

    void operator()(const Rectangle& r) {
        const Flat flat = flat_shape(r.center, r.half_u, r.half_v);
        const double lu = length(flat.u), lv = length(flat.v);
        // Half a unit in the last place of a float in the direction of either side is nothing to care about.
        const bool right_angled = std::fabs(dot(flat.u, flat.v)) <= 1e-6 * lu * lv;
        const double area = 4 * flat.spanned;
        finish(RectangleEmitter{flat.center, flat.u, flat.v, flat.normal, area, right_angled, flat.p_error}, area);
    }

    void operator()(const Disk& disk) {
        const DiskAxes axes = disk_axes(disk);
        const Flat flat = flat_shape(disk.center, axes.u, axes.v);
        const double area = std::numbers::pi * flat.spanned;
        finish(DiskEmitter{flat.center, flat.u, flat.v, flat.normal, area, flat.p_error}, area);
    }

private:
    struct Flat {
        Vec3d center, u, v, normal;
        double spanned = 0;  ///< |u × v|
        Vec3 p_error;
    };

    Vec3d to_world(Vec3d p) const { return data_.identity ? p : transform_point(transform_, p); }

    /// Bounds surface_error for all points of a shape that lies within center ± extent.
    Vec3 error_within(Vec3d center, Vec3d extent, double slack) const {
        const Vec3d object = abs(center) + extent;
        const Vec3d world = abs(to_world(center));
        Vec3d world_extent = extent;
        if (!data_.identity) {
            Affine magnitude;
            for (size_t r = 0; r < 3; ++r)
                for (size_t c = 0; c < 3; ++c) magnitude.m[r][c] = std::fabs(transform_.m[r][c]);
            world_extent = transform_vector(magnitude, extent);
        }
        return surface_error(transform_, data_, object, world + world_extent, slack);
    }

    Flat flat_shape(Vec3d center, Vec3d u, Vec3d v) const {
        const double size = 2 * (length(u) + length(v));
        const double slack = flat_slack(size, max_component(abs(center)) + size, 4 * length(cross(u, v)));
        Flat out;
        out.p_error = error_within(center, abs(u) + abs(v), slack);
        out.center = to_world(center);
        out.u = data_.identity ? u : transform_vector(transform_, u);
        out.v = data_.identity ? v : transform_vector(transform_, v);
        const Vec3d n = cross(out.u, out.v) * (data_.flips ? -1.0 : 1.0);
        out.spanned = length(n);
        out.normal = normalize(n);
        return out;
    }

    /// By the midpoint rule over the object's sphere: area is for statistics and light choice, not for densities.
    static double ellipsoid_area(const EllipsoidEmitter& e, const Affine& object_from_world) {
        constexpr int kRings = 64, kSectors = 128;
        double sum = 0;
        for (int ring = 0; ring < kRings; ++ring) {
            const double z = (2 * ring + 1.0) / kRings - 1, r = std::sqrt((1 - z) * (1 + z));
            for (int sector = 0; sector < kSectors; ++sector) {
                const double phi = 2 * std::numbers::pi * (sector + 0.5) / kSectors;
                const Vec3d n{r * math::cos(phi), r * math::sin(phi), z};
                sum += e.abs_determinant * length(transform_normal_by_inverse(object_from_world, n));
            }
        }
        return 4 * std::numbers::pi * e.radius * e.radius * sum / (kRings * kSectors);
    }

    /// A light without area, or with one that is not a number, has nothing to sample.
    void finish(Emitter emitter, double area) {
        if (!(area > 0) || !std::isfinite(area)) return;
        out_.area = area;
        out_.mean_texture = means_.whole;
        out_.emitter = std::move(emitter);
    }

    const ShadingScene& scene_;
    InstanceId id_;
    bool two_sided_;
    TextureMeans means_;
    const Instance& instance_;
    const ShadingScene::TransformData& data_;
    const Affine& transform_;
    ShadingScene::LightData& out_;
};

/// Adds what one light needs; one overload per kind.
class LightBuilder {
public:
    LightBuilder(ShadingScene& scene, Diagnostics& diagnostics) : scene_(scene), diagnostics_(diagnostics) {}

    void add(const Light& light) {
        scene_.lights.emplace_back();
        std::visit(*this, light);
    }

    void operator()(const PointLight&) {}
    void operator()(const SpotLight& light) {
        constexpr double kRadians = std::numbers::pi / 180;
        data().direction = normalize(Vec3d(light.direction));
        data().cos_inner = math::cos(light.inner_angle * kRadians);
        data().cos_outer = math::cos(light.outer_angle * kRadians);
    }
    void operator()(const DirectionalLight& light) {
        data().direction = normalize(Vec3d(light.direction));
        if (light.angular_diameter == 0) return;
        const double sine = math::sin(light.angular_diameter * (std::numbers::pi / 360));
        data().one_minus_cos = warp::one_minus_cos(sine * sine);
        // The cosine over the disc integrates to π sin², whatever the angle.
        const double per_irradiance = 1 / (std::numbers::pi * sine * sine);
        const auto scaled = [&](float e) { return static_cast<float>(e * per_irradiance); };
        data().radiance = {scaled(light.irradiance.r), scaled(light.irradiance.g), scaled(light.irradiance.b)};
        scene_.suns.push_back(current());
    }
    void operator()(const GoniometricLight& light) {
        const Vec3d down = normalize(Vec3d(light.direction));
        // +X, turned by the shortest way from -Y to `down`; a light that points up is turned over about +X.
        const double c = 1 - down.y;
        const Vec3d x = c > 1e-12 ? Vec3d{1 - down.x * down.x / c, -down.x * (down.y - 1) / c, -down.x * down.z / c}
                                  : Vec3d{1, 0, 0};
        const Vec3d y = cross(x, down);
        const double angle = light.rotation * (std::numbers::pi / 180), cosine = math::cos(angle),
                     sine = math::sin(angle);
        data().axes = {down, x * cosine + y * sine, y * cosine - x * sine};
    }
    void operator()(const AreaLight& light) {
        scene_.instances[index(light.instance)].area_light = current();
        scene_.hides_instances = scene_.hides_instances || !light.visible_to_camera;
        const MaterialId material = scene_.scene.instances[index(light.instance)].material;
        data().of_material = !is_black(emission_of(scene_.scene, material).radiance);
        const ShapeId shape = scene_.scene.instances[index(light.instance)].shape;
        std::visit(EmitterBuilder(scene_, light, data()), scene_.scene.shapes[index(shape)]);
    }
    void operator()(const EnvironmentLight& light) {
        scene_.environment_light = current();
        scene_.environment = EnvironmentTable::make(scene_.scene, light, diagnostics_);
    }

private:
    uint32_t current() const { return static_cast<uint32_t>(scene_.lights.size() - 1); }
    ShadingScene::LightData& data() { return scene_.lights.back(); }

    ShadingScene& scene_;
    Diagnostics& diagnostics_;
};

/// Materials that are equally rough share their tables.
class MaterialBuilder {
public:
    explicit MaterialBuilder(ShadingScene& scene) : scene_(scene) {}

    void operator()(const ConductorMaterial& m) {
        if (m.roughness.value != Vec2{0, 0}) data().energy = shared_.reflecting(m.roughness);
        if (const auto* complex = std::get_if<ComplexIndex>(&m.reflectance))
            data().mean_fresnel = mean_fresnel_conductor(*complex);
    }
    void operator()(const GlassMaterial& m) {
        data().glass = GlassIndex(m.eta, static_cast<double>(m.abbe));
        data().disperses = data().glass.disperses();
        if (refracts_visibly(m.eta) && m.roughness.value != Vec2{0, 0})
            data().energy = shared_.transmitting(m.roughness, data().glass.range());
        data().dielectric = Dielectric{m.eta, m.interior, m.priority};
    }
    void operator()(const OpenPbrMaterial& m) {
        data().open_pbr = std::make_shared<const OpenPbrTables>(make_open_pbr_tables(m, shared_));
        data().disperses = data().open_pbr->glass_index.disperses();
        const bool metal = m.base_metalness.value == 1 && !m.base_metalness.texture;
        if (m.transmission_weight.value > 0 && !m.geometry_thin_walled && !metal)
            data().dielectric = Dielectric{data().open_pbr->glass_index.at(0), m.interior, m.priority};
    }
    void operator()(const MixMaterial& m) {
        data().disperses = scene_.materials[index(m.first)].disperses || scene_.materials[index(m.second)].disperses;
        for (const MaterialId part : {m.second, m.first})
            if (const auto& body = scene_.materials[index(part)].dielectric) data().dielectric = body;
    }
    template <class Other>
    void operator()(const Other&) {}

    /// Once all materials are known: of what is rough and has a priority, against every other index that there is.
    void add_nested() {
        for (size_t i = 0; i < scene_.materials.size(); ++i) {
            ShadingScene::MaterialData& data = scene_.materials[i];
            if (!data.dielectric || !data.dielectric->priority) continue;
            for (const ShadingScene::MaterialData& other : scene_.materials) {
                if (!other.dielectric || data.nested.size() == kMostNested) continue;
                const float outer = other.dielectric->eta;
                const auto same = [&](const ShadingScene::NestedEnergy& n) { return n.outer_index == outer; };
                if (outer == 1 || std::any_of(data.nested.begin(), data.nested.end(), same)) continue;
                if (auto energy = nested(scene_.scene.materials[i], data, outer))
                    data.nested.push_back({outer, std::move(energy)});
            }
        }
    }

private:
    static constexpr size_t kMostNested = 16;

    std::shared_ptr<const MicrofacetEnergy> nested(const Material& material, const ShadingScene::MaterialData& data,
                                                   float outer) {
        const auto against = [&](const GlassIndex& own) {
            const IndexRange range = own.range();
            return IndexRange{range.first / outer, range.last / outer};
        };
        const bool visible = refracts_visibly(data.dielectric->eta / outer);
        if (const auto* m = std::get_if<GlassMaterial>(&material)) {
            const bool rough = visible && m->roughness.value != Vec2{0, 0};
            return rough ? shared_.transmitting(m->roughness, against(data.glass)) : nullptr;
        }
        if (!data.open_pbr) return nullptr;
        constexpr IndexRange least{double{kLeastVisibleIndex}, double{kLeastVisibleIndex}};
        return shared_.transmitting(data.open_pbr->base, visible ? against(data.open_pbr->glass_index) : least);
    }

    ShadingScene::MaterialData& data() { return scene_.materials.back(); }
    ShadingScene& scene_;
    SharedTables shared_;
};

/// Only images of floats can.
bool adds_energy(const RawImage& image) {
    if (image.format != TexelFormat::f16 && image.format != TexelFormat::f32) return false;
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x)
            if (max_component(texel(image, ColorSpace::linear, x, y)) > 1) return true;
    return false;
}

/// Textures of one image, read alike, share one.
std::vector<std::shared_ptr<const MipMap>> make_mip_maps(const Scene& scene) {
    std::map<std::pair<ImageId, ColorSpace>, std::shared_ptr<const MipMap>> known;
    std::vector<std::shared_ptr<const MipMap>> out(scene.textures.size());
    for (size_t i = 0; i < out.size(); ++i) {
        const auto* texture = std::get_if<ImageTexture>(&scene.textures[i]);
        if (!texture || !texture->mip_map || !texture->bilinear) continue;
        auto& map = known[{texture->image, texture->color_space}];
        const RawImage& image = scene.images[index(texture->image)];
        if (!map) map = std::make_shared<const MipMap>(MipMap::make(image, texture->color_space));
        out[i] = map;
    }
    if (known.empty()) out.clear();
    return out;
}

/// Of each image whether it is a colour of what surfaces reflect or let pass. The colour of a coat never adds energy,
/// and numbers are clamped where they are shares.
std::vector<bool> reflecting_images(const Scene& scene) {
    std::vector<bool> out(scene.images.size(), false);
    const auto mark = [&](TextureId id) {
        if (const auto* image = std::get_if<ImageTexture>(&scene.textures[index(id)])) out[index(image->image)] = true;
    };
    for (const Material& material : scene.materials)
        each_texture(material, [&](TextureId id, TextureRole role, std::string_view what) {
            if (role == TextureRole::color && what != "coat_color") each_factor(scene, id, mark);
        });
    return out;
}

/// Image textures only: the environment counts its own. What shines may have any value.
void warn_about_texels(const Scene& scene, Diagnostics& diagnostics) {
    std::vector<bool> used(scene.images.size(), false);
    for (const Texture& texture : scene.textures)
        if (const auto* image = std::get_if<ImageTexture>(&texture)) used[index(image->image)] = true;
    const std::vector<bool> reflects = reflecting_images(scene);
    for (size_t i = 0; i < used.size(); ++i) {
        if (!used[i]) continue;
        std::string name = "image texture";
        if (i < scene.names.images.size() && !scene.names.images[i].empty())
            name += " " + escape_for_display(scene.names.images[i], 4096);
        const uint64_t bad = count_bad_texels(scene.images[i], false);
        if (bad > 0) diagnostics.warn(name + ": texels that are not finite count as 0", {}, bad);
        if (!reflects[i]) continue;
        if (const uint64_t negative = count_bad_texels(scene.images[i], true) - bad; negative > 0)
            diagnostics.warn(name + ": texels below 0 count as 0", {}, negative);
        if (adds_energy(scene.images[i]))
            diagnostics.warn(name + ": values above 1: surfaces that add energy do not exist");
    }
}

}  // namespace

Result<ShadingScene> make_shading_scene(Scene scene, Diagnostics& diagnostics) {
    try {
        ShadingScene out;
        out.scene = std::move(scene);
        out.instances.reserve(out.scene.instances.size());
        for (const Instance& instance : out.scene.instances) {
            out.instances.emplace_back();
            if (is_identity(instance.world_from_object)) continue;
            out.instances.back().transform = static_cast<uint32_t>(out.transforms.size());
            out.transforms.push_back(transform_data(instance.world_from_object));
        }
        out.lights.reserve(out.scene.lights.size());
        out.materials.reserve(out.scene.materials.size());
        MaterialBuilder materials(out);
        for (const Material& material : out.scene.materials) {
            out.materials.emplace_back();
            std::visit(materials, material);
            out.materials.back().cut_out =
                may_let_pass(material, [&](MaterialId id) { return out.materials[index(id)].cut_out; });
        }
        materials.add_nested();
        for (uint32_t i = 0; i < out.instances.size(); ++i) {
            out.has_cut_outs = out.has_cut_outs || out.is_cut_out(i);
            const Dielectric* body = out.dielectric(i);
            out.has_interiors = out.has_interiors || (body && (body->priority || body->medium != Medium{}));
        }
        for (const Instance& instance : out.scene.instances)
            if (out.materials[index(instance.material)].disperses && !out.wavelengths)
                out.wavelengths = std::make_shared<const WavelengthSampler>();
        for (uint32_t i = 0; i < out.scene.reliefs.size(); ++i)
            out.materials[index(out.scene.reliefs[i].material)].relief = i;
        out.mip_maps = make_mip_maps(out.scene);
        LightBuilder lights(out, diagnostics);
        for (const Light& light : out.scene.lights) lights.add(light);
        out.light_selection = LightSelection(out);
        warn_about_texels(out.scene, diagnostics);
        return out;
    } catch (const std::bad_alloc&) {
        return Error{
            ErrorCode::resources, "not enough memory for the tables of the scene's lights and materials", {}, {}, {}};
    }
}

}  // namespace steradian
