// The hash of a scene's content: every field that can reach a pixel, in declaration order, lengths included.
#include "base/hash.h"
#include "steradian/scene.h"

namespace steradian {
namespace {

class SceneHasher {
public:
    void scene(const Scene& s) {
        list(s.images);
        list(s.textures);
        list(s.materials);
        list(s.reliefs);
        list(s.meshes);
        list(s.shapes);
        list(s.instances);
        list(s.lights);
        list(s.cameras);
        light_textures(s.lights);
        profiles(s.profiles);
        dispersion(s.materials);
        bodies(s.materials);
    }
    std::string hex() const { return hash_.hex(); }

private:
    /// Behind everything else, each with a mark of its own: the hash of scenes without them is what it was before.
    void light_textures(const std::vector<Light>& lights) {
        for (uint32_t i = 0; i < lights.size(); ++i)
            if (const auto* area = std::get_if<AreaLight>(&lights[i]); area && area->texture)
                put('t', i, *area->texture);
    }

    void profiles(const std::vector<IntensityProfile>& profiles) {
        for (const IntensityProfile& profile : profiles) {
            put('p');
            put(profile);
        }
    }

    void dispersion(const std::vector<Material>& materials) {
        for (uint32_t i = 0; i < materials.size(); ++i) {
            if (const auto* glass = std::get_if<GlassMaterial>(&materials[i]); glass && glass->abbe != 0)
                put('d', i, glass->abbe);
            if (const auto* m = std::get_if<OpenPbrMaterial>(&materials[i]); m && m->transmission_dispersion_scale != 0)
                put('d', i, m->transmission_dispersion_scale, m->transmission_dispersion_abbe_number);
        }
    }

    void bodies(const std::vector<Material>& materials) {
        const auto body = [&](uint32_t i, const Medium& interior, const Priority& priority) {
            if (interior != Medium{}) put('m', i, interior);
            if (priority) put('n', i, *priority);
        };
        for (uint32_t i = 0; i < materials.size(); ++i) {
            if (const auto* m = std::get_if<GlassMaterial>(&materials[i])) body(i, m->interior, m->priority);
            if (const auto* m = std::get_if<OpenPbrMaterial>(&materials[i])) body(i, m->interior, m->priority);
        }
    }

    template <class T>
    void list(const std::vector<T>& elements) {
        hash_.value(uint64_t(elements.size()));
        for (const T& element : elements) put(element);
    }
    template <class... T>
    void put(const std::variant<T...>& v) {
        hash_.value(uint32_t(v.index()));
        std::visit([this](const auto& alternative) { this->put(alternative); }, v);
    }
    template <class T>
    requires std::is_arithmetic_v<T> || std::is_enum_v<T>
    void put(T v) { hash_.value(v); }
    template <class... T>
    requires(sizeof...(T) > 1) void put(const T&... fields) { (put(fields), ...); }

    void put(const Vec2& v) { put(v.x, v.y); }
    void put(const Vec3& v) { put(v.x, v.y, v.z); }
    void put(const Tangent& t) { put(t.direction, t.side); }
    void put(const Rgb& c) { put(c.r, c.g, c.b); }
    void put(const Affine& a) {
        for (const auto& row : a.m)
            for (const double x : row) put(x);
    }
    void put(const RawImage& i) {
        put(i.width, i.height, i.channels, i.format);
        hash_.value(uint64_t(i.data.size()));
        hash_.bytes(i.data.data(), i.data.size());
    }
    void put(const VertexColorTexture& t) { put(t.alpha); }
    void put(const ProductTexture& t) { put(t.first, t.second); }
    void put(const ConstantTexture& t) { put(t.value); }
    void put(const ImageTexture& t) {
        put(t.image, t.color_space, t.wrap_u, t.wrap_v, t.bilinear, t.mip_map, t.scale, t.offset, t.rotation, t.uv_set);
    }
    void put(const CheckerTexture& t) { put(t.even, t.odd, t.scale, t.offset, t.rotation); }
    void put(const DiffuseMaterial& m) { put(m.reflectance, m.two_sided, m.roughness); }
    void put(const RefractionMaterial& m) { put(m.eta); }
    void put(const GlassMaterial& m) { put(m.eta, m.reflectance, m.transmittance, m.roughness); }
    void put(const Medium& m) { put(m.absorption, m.scattering, m.anisotropy); }
    void put(const MirrorMaterial& m) { put(m.reflectance); }
    void put(const std::optional<TextureId>& t) { put(t.has_value(), t.value_or(TextureId{})); }
    void put(const Roughness& r) { put(r.value, r.squared, r.texture); }
    void put(const ComplexIndex& i) { put(i.n, i.k); }
    void put(const SchlickReflectance& r) { put(r.normal, r.grazing); }
    void put(const ThinGlassMaterial& m) { put(m.eta, m.transmittance); }
    void put(const DiffuseTransmissionMaterial& m) { put(m.reflectance, m.transmittance); }
    void put(const FloatInput& i) { put(i.value, i.texture); }
    void put(const ColorInput& i) { put(i.value, i.texture); }
    void put(const FilmThickness& t) { put(t.maximum, t.texture, t.minimum); }
    void put(const NormalMap& m) { put(m.texture, m.strength, m.flip_y); }
    void put(const OpenPbrMaterial& m) {
        put(m.base_weight, m.base_color, m.base_metalness, m.base_diffuse_roughness);
        put(m.specular_weight, m.specular_color, m.specular_roughness, m.specular_ior, m.specular_roughness_anisotropy,
            m.specular_grain_shape, m.geometry_tangent.rotation, m.geometry_tangent.texture);
        put(m.transmission_weight, m.transmission_color, m.subsurface_weight, m.subsurface_color,
            m.subsurface_scatter_anisotropy);
        put(m.fuzz_weight, m.fuzz_color, m.fuzz_roughness);
        put(m.coat_weight, m.coat_color, m.coat_roughness, m.coat_roughness_anisotropy, m.coat_ior, m.coat_darkening);
        put(m.geometry_coat_normal.has_value(), m.geometry_coat_normal.value_or(NormalMap{}));
        put(m.thin_film_weight, m.thin_film_thickness, m.thin_film_ior, m.emission_luminance, m.emission_color);
        put(m.geometry_opacity, m.geometry_opacity_cutoff, m.geometry_thin_walled);
    }
    void put(const BumpMap& m) { put(m.texture, m.scale); }
    void put(const Relief& r) { put(r.material, r.map); }
    void put(const MixMaterial& m) { put(m.first, m.second, m.weight); }
    void put(const ConductorMaterial& m) { put(m.reflectance, m.roughness, m.tint); }
    template <class T>
    void put(const std::vector<T>& values) {
        raw(values);
    }
    template <class T>
    void raw(const std::vector<T>& values) {
        hash_.value(uint64_t(values.size()));
        hash_.bytes(values.data(), values.size() * sizeof(T));
    }
    void put(const Mesh& m) {
        raw(m.positions);
        raw(m.normals);
        raw(m.uvs);
        raw(m.indices);
        raw(m.colors);
        raw(m.alphas);
        list(m.tangents);
        list(m.more_uvs);
    }
    void put(const Sphere& s) { put(s.center, s.radius); }
    void put(const Rectangle& r) { put(r.center, r.half_u, r.half_v); }
    void put(const Disk& d) { put(d.center, d.normal, d.radius); }
    void put(const Instance& i) { put(i.shape, i.material, i.world_from_object); }
    void put(const PointLight& l) { put(l.position, l.intensity); }
    void put(const SpotLight& l) { put(l.position, l.direction, l.intensity, l.inner_angle, l.outer_angle, l.falloff); }
    void put(const DirectionalLight& l) { put(l.direction, l.irradiance, l.angular_diameter, l.visible_to_camera); }
    void put(const AreaLight& l) { put(l.instance, l.radiance, l.two_sided, l.samples, l.visible_to_camera); }
    void put(const EnvironmentLight& l) {
        put(l.radiance, l.image.has_value(), l.image.value_or(ImageId{}), l.color_space, l.rotation, l.samples,
            l.visible_to_camera);
    }
    void put(const GoniometricLight& l) { put(l.position, l.direction, l.rotation, l.intensity, l.profile); }
    void put(const IntensityProfile& p) {
        raw(p.vertical);
        raw(p.horizontal);
        raw(p.candela);
    }
    void put(const PerspectiveCamera& c) {
        put(c.position, c.look_at, c.up, c.vertical_fov, c.aperture_radius, c.focus_distance.has_value(),
            c.focus_distance.value_or(0), c.aperture_blades, c.aperture_rotation);
    }
    void put(const OrthographicCamera& c) { put(c.position, c.look_at, c.up, c.height); }
    void put(const PanoramaCamera& c) { put(c.position, c.look_at, c.up); }
    void put(const FisheyeCamera& c) { put(c.position, c.look_at, c.up, c.fov, c.projection); }

    Hasher hash_;
};

}  // namespace

std::string scene_hash(const Scene& scene) {
    SceneHasher hasher;
    hasher.scene(scene);
    return hasher.hex();
}

}  // namespace steradian
