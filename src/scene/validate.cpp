#include "scene/validate.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/names.h"
#include "base/text.h"
#include "math/ray.h"
#include "math/transform.h"
#include "scene/emission.h"

namespace steradian {
namespace {

/// Thrown inside this file only; validate() converts it.
struct Fault {
    std::string message;
};

class Validator {
public:
    Validator(const Scene& scene, MeshNumbers numbers) : s_(scene), numbers_(numbers) {}

    void run() {
        each("image", s_.images, s_.names.images);
        each("texture", s_.textures, s_.names.textures);
        each("material", s_.materials, s_.names.materials);
        each("relief", s_.reliefs, {});
        each("mesh", s_.meshes, s_.names.meshes);
        each("shape", s_.shapes, s_.names.shapes);
        each("object", s_.instances, s_.names.instances);
        each("profile", s_.profiles, s_.names.profiles);
        each("light", s_.lights, s_.names.lights);
        each("camera", s_.cameras, s_.names.cameras);
        light_uniqueness();
        relief_uniqueness();
        mixes_end();
        priorities();
        emission_uniqueness();
    }

private:
    template <class T>
    void each(const char* kind, const std::vector<T>& elements, const std::vector<std::string>& names) {
        if (elements.size() >= kNoHit) throw Fault{fmt::format("too many elements of kind {}", kind)};
        for (size_t i = 0; i < elements.size(); ++i) {
            where_ = i < names.size() && !names[i].empty() ? fmt::format("{} '{}'", kind, escape_for_display(names[i]))
                                                           : fmt::format("{} {}", kind, i);
            check(elements[i]);
        }
    }
    template <class... T>
    void check(const std::variant<T...>& v) const {
        std::visit([this](const auto& alternative) { this->check(alternative); }, v);
    }
    void require(bool good, const char* what) const {
        if (!good) throw Fault{fmt::format("{}: {}", where_, what)};
    }
    template <class Id, class T>
    void refers(Id id, const std::vector<T>& pool, const char* what) const {
        if (index(id) >= pool.size())
            throw Fault{fmt::format("{}: refers to {} {}, but there are {}", where_, what, index(id), pool.size())};
    }
    void color(Rgb c, const char* what) const { require(is_finite(c) && c.r >= 0 && c.g >= 0 && c.b >= 0, what); }
    void point(Vec3 p, const char* what) const { require(usable_position(p), what); }
    void direction(Vec3 d, const char* what) const {
        require(is_finite(d) && (d.x != 0 || d.y != 0 || d.z != 0), what);
    }
    template <class T>
    void uv_transform(const T& t) const {
        require(is_finite(t.scale.x) && is_finite(t.scale.y) && is_finite(t.offset.x) && is_finite(t.offset.y) &&
                    is_finite(t.rotation),
                "scale, offset and rotation must be finite");
    }

    void check(const RawImage& i) const {
        static constexpr uint64_t kSize[] = {1, 2, 2, 4};
        require(i.width > 0 && i.height > 0 && i.channels >= 1 && i.channels <= 4,
                "an image needs pixels and 1 to 4 channels");
        require(i.data.size() == uint64_t(i.width) * i.height * i.channels * kSize[size_t(i.format)],
                "the image's data does not have the size that its header says");
    }
    void check(const VertexColorTexture&) const {}
    void check(const ProductTexture& t) const {
        for (const TextureId id : {t.first, t.second}) {
            refers(id, s_.textures, "texture");
            require(!std::holds_alternative<ProductTexture>(s_.textures[index(id)]),
                    "a product of textures is not made of products");
        }
    }
    void check(const ConstantTexture& t) const { color(t.value, "a colour must be finite and not negative"); }
    void check(const ImageTexture& t) const {
        refers(t.image, s_.images, "image");
        uv_transform(t);
        require(t.uv_set < kMaxUvSets, "a set of texture coordinates has a number from 0 to 7");
    }
    void check(const CheckerTexture& t) const {
        color(t.even, "a colour must be finite and not negative");
        color(t.odd, "a colour must be finite and not negative");
        uv_transform(t);
    }
    void check(const DiffuseMaterial& m) const {
        refers(m.reflectance, s_.textures, "texture");
        require(m.roughness >= 0 && m.roughness <= 1, "the roughness must be between 0 and 1");
    }
    void eta(float value) const { require(value >= 1e-3f && value <= 1e3f, "eta must be between 0.001 and 1000"); }
    void check(const RefractionMaterial& m) const { eta(m.eta); }
    void check(const GlassMaterial& m) const {
        eta(m.eta);
        color(m.reflectance, "the reflectance must be finite and not negative");
        color(m.transmittance, "the transmittance must be finite and not negative");
        check(m.roughness);
        require(m.abbe == 0 || m.abbe >= 1, "an Abbe number must be at least 1, or 0 for no dispersion");
        check(m.interior);
    }
    void check(const Medium& m) const {
        for (const Rgb coefficient : {m.absorption, m.scattering}) {
            color(coefficient, "the coefficients of a medium must be finite and not negative");
            require(static_cast<double>(max_component(coefficient)) <= kMaxMediumCoefficient,
                    "the coefficients of a medium must be at most 1e9 per metre");
        }
        require(m.anisotropy >= -kMaxAnisotropy && m.anisotropy <= kMaxAnisotropy,
                "the anisotropy of a medium must be between -0.999 and 0.999");
    }
    void check(const ThinGlassMaterial& m) const {
        eta(m.eta);
        const Rgb t = m.transmittance;
        color(t, "the transmittance must be finite and not negative");
        require(t.r <= 1 && t.g <= 1 && t.b <= 1, "the transmittance of a thin sheet must be at most 1");
    }
    void check(const MirrorMaterial& m) const {
        color(m.reflectance, "the reflectance must be finite and not negative");
    }
    void check(const Roughness& r) const {
        require(r.value.x >= 0 && r.value.x <= 1 && r.value.y >= 0 && r.value.y <= 1,
                "the roughness must be between 0 and 1");
        if (r.texture) refers(*r.texture, s_.textures, "texture");
    }
    void check(const ComplexIndex& i) const {
        color(i.k, "k must be finite and not negative");
        require(is_finite(i.n) && i.n.r > 0 && i.n.g > 0 && i.n.b > 0, "n must be finite and positive");
    }
    void check(const SchlickReflectance& r) const {
        refers(r.normal, s_.textures, "texture");
        color(r.grazing, "the reflectance at the edge must be finite and not negative");
    }
    void check(const DiffuseTransmissionMaterial& m) const {
        refers(m.reflectance, s_.textures, "texture");
        refers(m.transmittance, s_.textures, "texture");
    }
    void unit(float value, const char* what) const { require(value >= 0 && value <= 1, what); }
    void unit(const FloatInput& input, const char* what) const {
        unit(input.value, what);
        if (input.texture) refers(*input.texture, s_.textures, "texture");
    }
    void color(const ColorInput& input, const char* what) const {
        color(input.value, what);
        if (input.texture) refers(*input.texture, s_.textures, "texture");
    }
    void check(const OpenPbrMaterial& m) const {
        const char* weights = "weights must be between 0 and 1";
        unit(m.base_weight, weights);
        for (const FloatInput* w :
             {&m.base_metalness, &m.transmission_weight, &m.subsurface_weight, &m.fuzz_weight, &m.thin_film_weight})
            unit(*w, weights);
        unit(m.coat_weight, weights);
        unit(m.coat_darkening, "coat_darkening must be between 0 and 1");
        unit(m.geometry_opacity, "geometry_opacity must be between 0 and 1");
        unit(m.geometry_opacity_cutoff, "geometry_opacity_cutoff must be between 0 and 1");
        const char* roughness = "roughnesses and anisotropies must be between 0 and 1";
        for (const FloatInput* r :
             {&m.specular_roughness, &m.specular_roughness_anisotropy, &m.fuzz_roughness, &m.coat_roughness})
            unit(*r, roughness);
        for (const float r : {m.base_diffuse_roughness, m.coat_roughness_anisotropy}) unit(r, roughness);
        require(std::fabs(m.geometry_tangent.rotation) <= 1e9f, "the rotation of a grain must be between -1e9 and 1e9");
        if (m.geometry_tangent.texture) linear(*m.geometry_tangent.texture);
        if (m.geometry_coat_normal) check(*m.geometry_coat_normal);
        const char* colors = "colours must be finite and not negative";
        for (const ColorInput* c : {&m.base_color, &m.specular_color, &m.transmission_color, &m.subsurface_color,
                                    &m.fuzz_color, &m.coat_color, &m.emission_color})
            color(*c, colors);
        require(max_component(m.specular_color.value) <= 1, "the specular colour must be at most 1");
        require(m.specular_weight >= 0 && m.specular_weight <= 10, "specular_weight must be between 0 and 10");
        require(m.specular_ior >= 0.1f && m.specular_ior <= 10, "specular_ior must be between 0.1 and 10");
        require(m.coat_ior >= 1.01f && m.coat_ior <= 3, "coat_ior must be between 1.01 and 3");
        require(m.subsurface_scatter_anisotropy >= -1 && m.subsurface_scatter_anisotropy <= 1,
                "subsurface_scatter_anisotropy must be between -1 and 1");
        unit(m.transmission_dispersion_scale, "transmission_dispersion_scale must be between 0 and 1");
        require(m.transmission_dispersion_abbe_number >= 1, "transmission_dispersion_abbe_number must be at least 1");
        for (const float thickness : {m.thin_film_thickness.minimum, m.thin_film_thickness.maximum})
            require(thickness >= 0 && thickness <= 10, "thin_film_thickness must be between 0 and 10 micrometres");
        if (m.thin_film_thickness.texture) refers(*m.thin_film_thickness.texture, s_.textures, "texture");
        require(m.thin_film_ior >= 1 && m.thin_film_ior <= 3, "thin_film_ior must be between 1 and 3");
        require(m.emission_luminance >= 0 && m.emission_luminance <= 1e9f,
                "emission_luminance must be between 0 and 1e9");
        check(m.interior);
        const bool there = m.geometry_opacity.value == 1 && !m.geometry_opacity.texture;
        require(!m.priority || (there && !m.geometry_thin_walled),
                "a body with a priority has neither holes nor thin walls");
    }
    void check(const MixMaterial& m) const {
        unit(m.weight, "the weight must be between 0 and 1");
        refers(m.first, s_.materials, "material");
        refers(m.second, s_.materials, "material");
    }
    void check(const ConductorMaterial& m) const {
        check(m.reflectance);
        check(m.roughness);
        color(m.tint, "the tint must be finite and not negative");
    }

    void linear(TextureId id) const {
        refers(id, s_.textures, "texture");
        require(!std::holds_alternative<ProductTexture>(s_.textures[index(id)]),
                "normals, heights and directions are not products of textures");
        const auto* image = std::get_if<ImageTexture>(&s_.textures[index(id)]);
        require(!image || image->color_space == ColorSpace::linear,
                "normals, heights and directions are numbers, their texture must be linear");
    }
    void check(const NormalMap& m) const {
        linear(m.texture);
        require(m.strength >= -100 && m.strength <= 100, "the strength must be between -100 and 100");
    }
    void check(const BumpMap& m) const {
        linear(m.texture);
        require(!std::holds_alternative<VertexColorTexture>(s_.textures[index(m.texture)]),
                "heights must come from an image or a pattern");
        require(m.scale >= -1e6f && m.scale <= 1e6f, "the scale of heights must be between -1e6 and 1e6");
    }
    void check(const Relief& r) const {
        refers(r.material, s_.materials, "material");
        check(r.map);
    }

    void check(const Mesh& m) const {
        require(m.indices.size() % 3 == 0, "the number of indices must be a multiple of three");
        require(m.indices.size() / 3 < kNoHit && m.positions.size() < kNoHit,
                "too many triangles or vertices for 32-bit ids");
        require(m.normals.empty() || m.normals.size() == m.positions.size(),
                "there must be one normal per position, or none");
        require(m.uvs.empty() || m.uvs.size() == m.positions.size(), "there must be one uv per position, or none");
        require(m.colors.empty() || m.colors.size() == m.positions.size(),
                "there must be one colour per position, or none");
        const auto per_position = [&](const auto& values) {
            return values.empty() || values.size() == m.positions.size();
        };
        require(per_position(m.alphas), "there must be one alpha per position, or none");
        require(per_position(m.tangents), "there must be one tangent per position, or none");
        require(m.more_uvs.size() < kMaxUvSets, "there are too many sets of texture coordinates");
        for (const auto& uvs : m.more_uvs) require(per_position(uvs), "there must be one uv per position, or none");
        for (const float a : m.alphas) unit(a, "the alphas of vertices must be between 0 and 1");
        for (const Rgb& c : m.colors) color(c, "the colours of vertices must be finite and not negative");
        const size_t count = m.positions.size();
        require(std::all_of(m.indices.begin(), m.indices.end(), [&](uint32_t i) { return i < count; }),
                "an index refers to a vertex that does not exist");
        require(numbers_ == MeshNumbers::any || std::all_of(m.positions.begin(), m.positions.end(), usable_position),
                "a vertex is not finite or beyond 1e15");
    }
    void check(MeshId id) const { refers(id, s_.meshes, "mesh"); }
    void check(const Sphere& s) const {
        point(s.center, "the centre must be finite and within 1e15");
        require(s.radius > 0 && s.radius <= kMaxCoordinate, "the radius must be positive and at most 1e15");
    }
    void check(const Rectangle& r) const {
        point(r.center, "the centre must be finite and within 1e15");
        point(r.half_u, "the axes must be finite and within 1e15");
        point(r.half_v, "the axes must be finite and within 1e15");
    }
    void check(const Disk& d) const {
        point(d.center, "the centre must be finite and within 1e15");
        direction(d.normal, "the normal must be finite and not zero");
        require(d.radius > 0 && d.radius <= kMaxCoordinate, "the radius must be positive and at most 1e15");
    }
    void check(const Instance& i) const {
        refers(i.shape, s_.shapes, "shape");
        refers(i.material, s_.materials, "material");
        require(usable_inverse(i.world_from_object).has_value(),
                "the transform is singular or not finite, or it scales beyond 1e30 or 1e-30");
    }

    void check(const PointLight& l) const {
        point(l.position, "the position must be finite and within 1e15");
        color(l.intensity, "the intensity must be finite and not negative");
    }
    void check(const SpotLight& l) const {
        point(l.position, "the position must be finite and within 1e15");
        direction(l.direction, "the direction must be finite and not zero");
        color(l.intensity, "the intensity must be finite and not negative");
        require(l.outer_angle > 0 && l.outer_angle <= 180, "the outer angle must be in (0, 180] degrees");
        require(l.inner_angle >= 0 && l.inner_angle <= l.outer_angle,
                "the inner angle must be between 0 and the outer angle");
    }
    void check(const DirectionalLight& l) const {
        direction(l.direction, "the direction must be finite and not zero");
        color(l.irradiance, "the irradiance must be finite and not negative");
        require(l.angular_diameter == 0 || (l.angular_diameter >= float(kMinAngularDiameter) &&
                                            l.angular_diameter <= float(kMaxAngularDiameter)),
                "the angular diameter must be 0 or between 0.001 and 90 degrees");
    }
    void check(const GoniometricLight& l) const {
        point(l.position, "the position must be finite and within 1e15");
        direction(l.direction, "the direction must be finite and not zero");
        require(is_finite(l.rotation), "the rotation must be finite");
        color(l.intensity, "the intensity must be finite and not negative");
        refers(l.profile, s_.profiles, "profile");
    }
    void check(const IntensityProfile& p) const {
        const auto ascend = [](const std::vector<float>& angles, float most) {
            for (size_t i = 0; i + 1 < angles.size(); ++i)
                if (!(angles[i] < angles[i + 1])) return false;
            return angles.front() >= 0 && angles.back() <= most;
        };
        require(p.vertical.size() >= 2 && ascend(p.vertical, 180),
                "there must be two vertical angles or more, ascending within 0 to 180 degrees");
        const std::vector<float>& h = p.horizontal;
        require(h.size() == 1 || (h.size() > 1 && h.front() == 0 && h.back() == 360 && ascend(h, 360)),
                "horizontal angles must ascend from 0 to 360 degrees, or there must be one");
        require(p.candela.size() == p.vertical.size() * h.size(), "there must be a value for each pair of angles");
        require(std::all_of(p.candela.begin(), p.candela.end(), [](float c) { return is_finite(c) && c >= 0; }),
                "values must be finite and not negative");
    }
    void samples(uint32_t n) const {
        require(n >= 1 && n <= kMaxLightSamples, "the number of light samples must be between 1 and 4096");
    }
    void check(const AreaLight& l) const {
        refers(l.instance, s_.instances, "object");
        if (l.texture) refers(*l.texture, s_.textures, "texture");
        color(l.radiance, "the radiance must be finite and not negative");
        samples(l.samples);
    }
    void check(const EnvironmentLight& l) const {
        color(l.radiance, "the radiance must be finite and not negative");
        if (l.image) refers(*l.image, s_.images, "image");
        require(is_finite(l.rotation), "the rotation must be finite");
        samples(l.samples);
    }
    /// Whether the axes make sense together is the camera's own business (CameraSampler::make).
    template <class C>
    void pose(const C& c) const {
        point(c.position, "the position must be finite and within 1e15");
        point(c.look_at, "look_at must be finite and within 1e15");
        direction(c.up, "up must be finite and not zero");
    }
    void check(const PerspectiveCamera& c) const {
        pose(c);
        require(c.vertical_fov > 0 && c.vertical_fov < 180, "the field of view must be between 0 and 180 degrees");
        require(c.aperture_radius >= 0 && c.aperture_radius <= kMaxCoordinate,
                "the aperture's radius must be between 0 and 1e15");
        const float focus = c.focus_distance.value_or(1);
        require(focus > 0 && focus <= kMaxCoordinate, "the focus distance must be positive and at most 1e15");
        require(c.aperture_blades == 0 ||
                    (c.aperture_blades >= kMinApertureBlades && c.aperture_blades <= kMaxApertureBlades),
                "an aperture has 3 to 64 blades, or 0 where it is round");
        require(is_finite(c.aperture_rotation), "the aperture's rotation must be finite");
    }
    void check(const OrthographicCamera& c) const {
        pose(c);
        require(c.height > 0 && c.height <= kMaxCoordinate, "the height must be positive and at most 1e15");
    }
    void check(const PanoramaCamera& c) const { pose(c); }
    void check(const FisheyeCamera& c) const {
        pose(c);
        require(c.fov > 0 && c.fov <= 360, "the field of view must be in (0, 360] degrees");
    }

    /// Ids are in range by now.
    void mixes_end() const {
        std::vector<uint32_t> parts(s_.materials.size(), 1);
        for (uint32_t i = 0; i < parts.size(); ++i) {
            const auto* mix = std::get_if<MixMaterial>(&s_.materials[i]);
            if (!mix) continue;
            if (index(mix->first) >= i || index(mix->second) >= i)
                throw Fault{fmt::format("material {} mixes one that does not come before it", i)};
            parts[i] = parts[index(mix->first)] + parts[index(mix->second)];
            if (parts[i] > kMaxMixed)
                throw Fault{fmt::format("material {} is a mix of {}, expected at most {}", i, parts[i], kMaxMixed)};
        }
        for (const Relief& relief : s_.reliefs)
            if (std::holds_alternative<MixMaterial>(s_.materials[index(relief.material)]))
                throw Fault{
                    fmt::format("material {} is a mix: relief belongs to what is mixed", index(relief.material))};
    }

    /// Where a boundary is not there, neither is what it emits; and light samples do not know in which bodies a ray is
    /// behind a hole. So what has a priority has neither. Mixes are known to end.
    void priorities() const {
        struct Traits {
            bool priority = false, holes = false;
        };
        std::vector<Traits> of(s_.materials.size());
        for (size_t i = 0; i < of.size(); ++i) {
            if (const auto* glass = std::get_if<GlassMaterial>(&s_.materials[i])) of[i].priority = !!glass->priority;
            if (const auto* m = std::get_if<OpenPbrMaterial>(&s_.materials[i]))
                of[i] = {m->priority.has_value(), m->geometry_opacity.value < 1 || m->geometry_opacity.texture};
            if (const auto* mix = std::get_if<MixMaterial>(&s_.materials[i])) {
                const Traits &a = of[index(mix->first)], &b = of[index(mix->second)];
                of[i] = {a.priority || b.priority, a.holes || b.holes};
                if (of[i].priority && of[i].holes)
                    throw Fault{fmt::format("material {} is a mix of a body with a priority and of holes", i)};
            }
        }
        for (size_t i = 0; i < s_.lights.size(); ++i)
            if (const auto* light = std::get_if<AreaLight>(&s_.lights[i]))
                if (of[index(s_.instances[index(light->instance)].material)].priority)
                    throw Fault{fmt::format("light {}: the surface of a body with a priority emits nothing", i)};
    }

    void relief_uniqueness() const {
        std::vector<bool> turned(s_.materials.size());
        for (const Relief& relief : s_.reliefs) {
            if (turned[index(relief.material)])
                throw Fault{
                    fmt::format("material {} has two reliefs, at most one is possible", index(relief.material))};
            turned[index(relief.material)] = true;
        }
    }

    void light_uniqueness() const {
        size_t environments = 0;
        std::vector<bool> lit(s_.instances.size());
        for (const Light& light : s_.lights) {
            environments += std::holds_alternative<EnvironmentLight>(light);
            if (const auto* area = std::get_if<AreaLight>(&light)) {
                if (lit[index(area->instance)])
                    throw Fault{
                        fmt::format("object {} has two area lights, at most one is possible", index(area->instance))};
                lit[index(area->instance)] = true;
            }
        }
        if (environments > 1) throw Fault{"there are two environment lights, at most one is possible"};
    }

    void emission_uniqueness() const {
        for (const Light& light : s_.lights) {
            const auto* area = std::get_if<AreaLight>(&light);
            if (!area || is_black(emission_of(s_, s_.instances[index(area->instance)].material).radiance)) continue;
            throw Fault{
                fmt::format("object {} has an area light and a material that emits, only one of them is possible",
                            index(area->instance))};
        }
    }

    const Scene& s_;
    MeshNumbers numbers_;
    std::string where_;
};

/// Removes triangles with an unusable vertex and moves unusable vertices to the origin, where nothing refers to them.
uint64_t drop_triangles(Mesh& mesh) {
    std::vector<Vec3>& positions = mesh.positions;
    if (std::all_of(positions.begin(), positions.end(), usable_position)) return 0;
    size_t kept = 0;
    uint64_t dropped = 0;
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        bool good = true;
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t v = mesh.indices[i + k];
            good = good && (v >= positions.size() || usable_position(positions[v]));
        }
        if (good) {
            std::copy_n(mesh.indices.begin() + std::ptrdiff_t(i), 3, mesh.indices.begin() + std::ptrdiff_t(kept));
            kept += 3;
        } else {
            ++dropped;
        }
    }
    mesh.indices.resize(kept);
    for (Vec3& p : positions)
        if (!usable_position(p)) p = {};
    return dropped;
}

}  // namespace

Status validate(const Scene& scene, MeshNumbers numbers) {
    try {
        Validator(scene, numbers).run();
        return Ok{};
    } catch (const Fault& fault) {
        return make_error(ErrorCode::bad_input, fault.message);
    }
}

Status validate(const RenderSettings& s) {
    const auto usage = [](std::string message) { return make_error(ErrorCode::usage, std::move(message)); };
    if (s.width < 1 || s.height < 1) return usage("the picture must be at least 1 × 1 pixels");
    if (s.width > kMaxResolution || s.height > kMaxResolution || uint64_t(s.width) * s.height > kMaxPixels)
        return make_error(ErrorCode::resources,
                          fmt::format("{} × {} pixels are too many: at most {} a side and {} in all", s.width, s.height,
                                      kMaxResolution, kMaxPixels));
    if (const auto& c = s.crop; c && !(c->x0 < c->x1 && c->y0 < c->y1 && c->x1 <= s.width && c->y1 <= s.height))
        return usage(fmt::format("the crop {},{},{},{} is empty or leaves the picture of {} × {} pixels", c->x0, c->y0,
                                 c->x1, c->y1, s.width, s.height));
    if (s.samples_per_pixel < 1 || s.samples_per_pixel > kMaxSamplesPerPixel)
        return usage(fmt::format("{} samples per pixel: expected 1 to {}", s.samples_per_pixel, kMaxSamplesPerPixel));
    if (s.max_depth > kMaxDepth)
        return usage(fmt::format("a depth of {}: expected at most {}", s.max_depth, kMaxDepth));
    if (s.roulette_depth > kMaxDepth)
        return usage(
            fmt::format("Russian roulette after {} bounces: expected at most {}", s.roulette_depth, kMaxDepth));
    if (!(s.clamp >= 0 && s.clamp <= float(kMaxClamp)))
        return usage(fmt::format("a clamp of {}: expected 0 to {}", s.clamp, kMaxClamp));
    if (!(s.target_error == 0 ||
          (s.target_error >= float(kMinTargetError) && s.target_error <= float(kMaxTargetError))))
        return usage(
            fmt::format("a target error of {}: expected {} to {}", s.target_error, kMinTargetError, kMaxTargetError));
    if (s.target_error > 0 && s.samples_per_pixel < kLeastMostSamples)
        return usage(fmt::format("at most {} samples per pixel towards a target error: expected at least {}",
                                 s.samples_per_pixel, kLeastMostSamples));
    if (!(s.ao_distance >= 0 && s.ao_distance <= float(kMaxAoDistance)))
        return usage(
            fmt::format("an ambient occlusion distance of {}: expected 0 to {}", s.ao_distance, kMaxAoDistance));
    if (!(s.filter.radius >= float(kMinFilterRadius) && s.filter.radius <= float(kMaxFilterRadius)))
        return usage(fmt::format("a filter radius of {}: expected {} to {} pixels", s.filter.radius, kMinFilterRadius,
                                 kMaxFilterRadius));
    if (!s.aovs.empty() && s.integrator != IntegratorKind::path && s.integrator != IntegratorKind::direct)
        return make_error(
            ErrorCode::usage,
            fmt::format("the integrator {} has no AOVs, which come with path and direct", name_of(s.integrator)),
            "choose one of these, or no AOVs");
    return Ok{};
}

void sanitize(Scene& scene, Diagnostics& diagnostics) {
    uint64_t triangles = 0, uvs = 0, normals = 0, tangents = 0;
    for (Mesh& mesh : scene.meshes) {
        triangles += drop_triangles(mesh);
        const auto clean = [&](std::vector<Vec2>& set) {
            for (Vec2& uv : set)
                if (!is_finite(uv.x) || !is_finite(uv.y)) uv = {}, ++uvs;
        };
        clean(mesh.uvs);
        for (std::vector<Vec2>& set : mesh.more_uvs) clean(set);
        // A zero normal stands for "use the flat one" and is understood as such by surface_at.
        for (Vec3& n : mesh.normals)
            if (!is_finite(n)) n = {}, ++normals;
        for (Tangent& t : mesh.tangents)
            if (!is_finite(t.direction) || !is_finite(t.side)) t = {}, ++tangents;
    }
    if (triangles)
        diagnostics.warn("triangles with vertices that are not finite or beyond 1e15 were dropped", {}, triangles);
    if (uvs) diagnostics.warn("texture coordinates that are not finite were replaced by 0", {}, uvs);
    if (normals) diagnostics.warn("normals that are not finite were replaced by the flat ones", {}, normals);
    if (tangents) diagnostics.warn("tangents that are not finite were left out", {}, tangents);
}

void bake_transforms(Scene& scene) {
    // An object is what counts: two shapes may name one mesh.
    std::vector<uint32_t> users(scene.meshes.size(), 0);
    const auto mesh_of = [&](const Instance& i) { return std::get_if<MeshId>(&scene.shapes[index(i.shape)]); };
    for (const Instance& i : scene.instances)
        if (const MeshId* mesh = mesh_of(i)) ++users[index(*mesh)];
    for (Instance& i : scene.instances) {
        const MeshId* id = mesh_of(i);
        if (!id || users[index(*id)] != 1 || is_identity(i.world_from_object)) continue;
        const Affine& world_from_object = i.world_from_object;
        const auto object_from_world = inverse(world_from_object);
        if (!object_from_world) continue;
        Mesh& mesh = scene.meshes[index(*id)];
        for (Vec3& p : mesh.positions) p = Vec3(transform_point(world_from_object, p));
        for (Vec3& n : mesh.normals) n = Vec3(normalize(transform_normal_by_inverse(*object_from_world, n)));
        // A mirror image turns the winding around; outside stays outside.
        const bool mirrors = determinant(world_from_object) < 0;
        for (Tangent& t : mesh.tangents)
            t = {Vec3(transform_vector(world_from_object, t.direction)), mirrors ? -t.side : t.side};
        if (mirrors)
            for (size_t k = 0; k + 2 < mesh.indices.size(); k += 3) std::swap(mesh.indices[k + 1], mesh.indices[k + 2]);
        i.world_from_object = {};
    }
}

}  // namespace steradian
