// The scene's hash notices every field, and nothing but content.
#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "steradian/scene.h"

namespace steradian {
namespace {

Scene full_scene() {
    Scene s;
    s.images.push_back({2, 1, 3, TexelFormat::u8, std::vector<std::byte>(6)});
    add<TextureId>(s.textures, Texture(ConstantTexture{}));
    add<TextureId>(s.textures, Texture(ImageTexture{}));
    add<TextureId>(s.textures, Texture(CheckerTexture{}));
    add<TextureId>(s.textures, Texture(VertexColorTexture{}));
    add<TextureId>(s.textures, Texture(ProductTexture{}));
    add<MaterialId>(s.materials, Material(DiffuseMaterial{}));
    add<MaterialId>(s.materials, Material(RefractionMaterial{}));
    add<MaterialId>(s.materials, Material(GlassMaterial{}));
    add<MaterialId>(s.materials, Material(MirrorMaterial{}));
    add<MaterialId>(s.materials, Material(ConductorMaterial{ComplexIndex{}, {}}));
    add<MaterialId>(s.materials, Material(ConductorMaterial{SchlickReflectance{}, {}}));
    add<MaterialId>(s.materials, Material(ThinGlassMaterial{}));
    add<MaterialId>(s.materials, Material(DiffuseTransmissionMaterial{}));
    add<MaterialId>(s.materials, Material(OpenPbrMaterial{}));
    add<MaterialId>(s.materials, Material(MixMaterial{}));
    s.reliefs = {{MaterialId{0}, NormalMap{}}, {MaterialId{1}, BumpMap{}}};
    s.meshes.push_back(
        {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, {{0, 0}, {1, 0}, {0, 1}}, {0, 1, 2}});
    add<ShapeId>(s.shapes, Shape(MeshId{0}));
    add<ShapeId>(s.shapes, Shape(Sphere{}));
    add<ShapeId>(s.shapes, Shape(Rectangle{}));
    add<ShapeId>(s.shapes, Shape(Disk{}));
    s.instances.push_back({});
    s.lights = {PointLight{}, SpotLight{}, DirectionalLight{}, AreaLight{}, EnvironmentLight{}, GoniometricLight{}};
    s.profiles = {IntensityProfile{{0, 180}, {0}, {1, 2}}};
    s.cameras = {PerspectiveCamera{}, OrthographicCamera{}, PanoramaCamera{}, FisheyeCamera{}};
    return s;
}

OpenPbrMaterial& open_pbr(Scene& s) { return std::get<OpenPbrMaterial>(s.materials[8]); }

using Change = std::function<void(Scene&)>;

std::vector<Change> changes() {
    return {
        [](Scene& s) { s.images[0].data[5] = std::byte{1}; },
        [](Scene& s) { s.images[0].width = 1, s.images[0].height = 2; },
        [](Scene& s) { s.images[0].format = TexelFormat::u16; },
        [](Scene& s) { std::get<ConstantTexture>(s.textures[0]).value.g = 0.25f; },
        [](Scene& s) { std::get<ImageTexture>(s.textures[1]).wrap_v = Wrap::mirror; },
        [](Scene& s) { std::get<ImageTexture>(s.textures[1]).bilinear = false; },
        [](Scene& s) { std::get<ImageTexture>(s.textures[1]).color_space = ColorSpace::linear; },
        [](Scene& s) { std::get<ImageTexture>(s.textures[1]).offset.y = 1; },
        [](Scene& s) { std::get<CheckerTexture>(s.textures[2]).odd.b = 1; },
        [](Scene& s) { std::get<CheckerTexture>(s.textures[2]).scale.x = 2; },
        [](Scene& s) { std::get<DiffuseMaterial>(s.materials[0]).two_sided = true; },
        [](Scene& s) { std::get<DiffuseMaterial>(s.materials[0]).reflectance = TextureId{1}; },
        [](Scene& s) { std::get<DiffuseMaterial>(s.materials[0]).roughness = 0.5f; },
        [](Scene& s) { std::get<RefractionMaterial>(s.materials[1]).eta = 2; },
        [](Scene& s) { std::get<GlassMaterial>(s.materials[2]).transmittance.r = 0.5f; },
        [](Scene& s) { std::get<MirrorMaterial>(s.materials[3]).reflectance.r = 0.5f; },
        [](Scene& s) { std::get<ComplexIndex>(std::get<ConductorMaterial>(s.materials[4]).reflectance).n.b = 2; },
        [](Scene& s) { std::get<ComplexIndex>(std::get<ConductorMaterial>(s.materials[4]).reflectance).k.r = 2; },
        [](Scene& s) { std::get<ConductorMaterial>(s.materials[4]).roughness.value.y = 1; },
        [](Scene& s) { std::get<ConductorMaterial>(s.materials[4]).tint.g = 0.5f; },
        [](Scene& s) { std::get<ConductorMaterial>(s.materials[4]).roughness.squared = false; },
        [](Scene& s) { std::get<ConductorMaterial>(s.materials[4]).roughness.texture = TextureId{0}; },
        [](Scene& s) {
            std::get<SchlickReflectance>(std::get<ConductorMaterial>(s.materials[5]).reflectance).grazing.g = 0;
        },
        [](Scene& s) { std::get<GlassMaterial>(s.materials[2]).roughness.value.x = 0.5f; },
        [](Scene& s) { std::get<ThinGlassMaterial>(s.materials[6]).eta = 2; },
        [](Scene& s) { std::get<ThinGlassMaterial>(s.materials[6]).transmittance.b = 0.5f; },
        [](Scene& s) { std::get<DiffuseTransmissionMaterial>(s.materials[7]).reflectance = TextureId{1}; },
        [](Scene& s) { std::get<DiffuseTransmissionMaterial>(s.materials[7]).transmittance = TextureId{1}; },
        [](Scene& s) { open_pbr(s).base_weight = 0.5f; },
        [](Scene& s) { open_pbr(s).base_color.value.g = 0.5f; },
        [](Scene& s) { open_pbr(s).base_color.texture = TextureId{0}; },
        [](Scene& s) { open_pbr(s).base_metalness.value = 1; },
        [](Scene& s) { open_pbr(s).base_metalness.texture = TextureId{1}; },
        [](Scene& s) { open_pbr(s).base_diffuse_roughness = 1; },
        [](Scene& s) { open_pbr(s).specular_weight = 0.5f; },
        [](Scene& s) { open_pbr(s).specular_color.value.b = 0; },
        [](Scene& s) { open_pbr(s).specular_roughness.value = 1; },
        [](Scene& s) { open_pbr(s).specular_ior = 2; },
        [](Scene& s) { open_pbr(s).specular_roughness_anisotropy.value = 1; },
        [](Scene& s) { open_pbr(s).specular_grain_shape = GrainShape::gltf; },
        [](Scene& s) { open_pbr(s).geometry_tangent.rotation = 1; },
        [](Scene& s) { open_pbr(s).geometry_tangent.texture = TextureId{1}; },
        [](Scene& s) { open_pbr(s).geometry_coat_normal = NormalMap{}; },
        [](Scene& s) {
            open_pbr(s).geometry_coat_normal = NormalMap{TextureId{0}, 2};
        },
        [](Scene& s) { open_pbr(s).transmission_weight.value = 1; },
        [](Scene& s) { open_pbr(s).transmission_color.value.r = 0; },
        [](Scene& s) { std::get<GlassMaterial>(s.materials[2]).abbe = 30; },
        [](Scene& s) { std::get<GlassMaterial>(s.materials[2]).abbe = 60; },
        [](Scene& s) { open_pbr(s).transmission_dispersion_scale = 1; },
        [](Scene& s) {
            open_pbr(s).transmission_dispersion_scale = 1;
            open_pbr(s).transmission_dispersion_abbe_number = 30;
        },
        [](Scene& s) { open_pbr(s).subsurface_weight.value = 1; },
        [](Scene& s) { open_pbr(s).subsurface_color.value.r = 0; },
        [](Scene& s) { open_pbr(s).fuzz_weight.value = 1; },
        [](Scene& s) { open_pbr(s).fuzz_color.value.b = 0; },
        [](Scene& s) { open_pbr(s).fuzz_roughness.value = 1; },
        [](Scene& s) { open_pbr(s).coat_weight = 1; },
        [](Scene& s) { open_pbr(s).coat_color.value.r = 0; },
        [](Scene& s) { open_pbr(s).coat_roughness.value = 1; },
        [](Scene& s) { open_pbr(s).coat_roughness_anisotropy = 1; },
        [](Scene& s) { open_pbr(s).coat_ior = 2; },
        [](Scene& s) { open_pbr(s).coat_darkening = 0; },
        [](Scene& s) { open_pbr(s).subsurface_scatter_anisotropy = 0.5f; },
        [](Scene& s) { open_pbr(s).thin_film_weight.value = 1; },
        [](Scene& s) { open_pbr(s).thin_film_weight.texture = TextureId{0}; },
        [](Scene& s) { open_pbr(s).thin_film_thickness.maximum = 1; },
        [](Scene& s) { open_pbr(s).thin_film_thickness.minimum = 1; },
        [](Scene& s) { open_pbr(s).thin_film_thickness.texture = TextureId{0}; },
        [](Scene& s) { open_pbr(s).thin_film_ior = 2; },
        [](Scene& s) { open_pbr(s).emission_luminance = 1; },
        [](Scene& s) { open_pbr(s).emission_color.value.g = 0; },
        [](Scene& s) { open_pbr(s).geometry_thin_walled = true; },
        [](Scene& s) { open_pbr(s).geometry_opacity.value = 0; },
        [](Scene& s) { open_pbr(s).geometry_opacity_cutoff = 0.5f; },
        [](Scene& s) { open_pbr(s).interior.absorption.r = 1; },
        [](Scene& s) { open_pbr(s).priority = 0; },
        [](Scene& s) { open_pbr(s).priority = 1; },
        [](Scene& s) { std::get<GlassMaterial>(s.materials[2]).interior.absorption.r = 1; },
        [](Scene& s) { std::get<GlassMaterial>(s.materials[2]).interior.scattering.r = 1; },
        [](Scene& s) { std::get<GlassMaterial>(s.materials[2]).interior.anisotropy = 0.5f; },
        [](Scene& s) { std::get<GlassMaterial>(s.materials[2]).priority = 0; },
        [](Scene& s) { s.materials[3] = RefractionMaterial{}; },
        [](Scene& s) { s.reliefs[0].material = MaterialId{2}; },
        [](Scene& s) { std::get<NormalMap>(s.reliefs[0].map).texture = TextureId{1}; },
        [](Scene& s) { std::get<NormalMap>(s.reliefs[0].map).strength = 2; },
        [](Scene& s) { std::get<NormalMap>(s.reliefs[0].map).flip_y = true; },
        [](Scene& s) { std::get<BumpMap>(s.reliefs[1].map).texture = TextureId{1}; },
        [](Scene& s) { std::get<BumpMap>(s.reliefs[1].map).scale = 2; },
        [](Scene& s) { s.reliefs.pop_back(); },
        [](Scene& s) { std::get<MixMaterial>(s.materials[9]).first = MaterialId{1}; },
        [](Scene& s) { std::get<MixMaterial>(s.materials[9]).second = MaterialId{1}; },
        [](Scene& s) { std::get<MixMaterial>(s.materials[9]).weight.value = 0.25f; },
        [](Scene& s) { s.textures[3] = ConstantTexture{}; },
        [](Scene& s) {
            s.meshes[0].colors = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        },
        [](Scene& s) {
            s.meshes[0].alphas = {1, 0, 1};
        },
        [](Scene& s) {
            s.meshes[0].tangents.assign(3, Tangent{{1, 0, 0}, 1});
        },
        [](Scene& s) {
            s.meshes[0].tangents.assign(3, Tangent{{1, 0, 0}, -1});
        },
        [](Scene& s) { s.meshes[0].more_uvs = {s.meshes[0].uvs}; },
        [](Scene& s) {
            s.meshes[0].more_uvs = {{}, s.meshes[0].uvs};
        },
        [](Scene& s) { std::get<VertexColorTexture>(s.textures[3]).alpha = true; },
        [](Scene& s) { std::get<ProductTexture>(s.textures[4]).first = TextureId{1}; },
        [](Scene& s) { std::get<ProductTexture>(s.textures[4]).second = TextureId{1}; },
        [](Scene& s) { std::get<ImageTexture>(s.textures[1]).uv_set = 1; },
        [](Scene& s) { std::get<ImageTexture>(s.textures[1]).mip_map = true; },
        [](Scene& s) { std::get<ImageTexture>(s.textures[1]).rotation = 1; },
        [](Scene& s) { std::get<CheckerTexture>(s.textures[2]).rotation = 1; },
        [](Scene& s) { s.meshes[0].positions[2].z = 1; },
        [](Scene& s) { s.meshes[0].normals.clear(); },
        [](Scene& s) { s.meshes[0].uvs[1].x = 0.5f; },
        [](Scene& s) { std::swap(s.meshes[0].indices[0], s.meshes[0].indices[1]); },
        [](Scene& s) { std::get<Sphere>(s.shapes[1]).radius = 2; },
        [](Scene& s) { std::get<Rectangle>(s.shapes[2]).half_v.y = 2; },
        [](Scene& s) { std::get<Disk>(s.shapes[3]).normal.x = 2; },
        [](Scene& s) { s.instances[0].world_from_object = translation(0, 1e-9, 0); },
        [](Scene& s) { s.instances[0].material = MaterialId{1}; },
        [](Scene& s) { std::get<PointLight>(s.lights[0]).intensity.b = 2; },
        [](Scene& s) { std::get<SpotLight>(s.lights[1]).inner_angle = 20; },
        [](Scene& s) { std::get<SpotLight>(s.lights[1]).falloff = SpotFalloff::squared; },
        [](Scene& s) { std::get<DirectionalLight>(s.lights[2]).direction.x = 1; },
        [](Scene& s) { std::get<DirectionalLight>(s.lights[2]).angular_diameter = 1; },
        [](Scene& s) { std::get<DirectionalLight>(s.lights[2]).visible_to_camera = false; },
        [](Scene& s) { std::get<AreaLight>(s.lights[3]).visible_to_camera = false; },
        [](Scene& s) { std::get<EnvironmentLight>(s.lights[4]).visible_to_camera = false; },
        [](Scene& s) { std::get<AreaLight>(s.lights[3]).samples = 4; },
        [](Scene& s) { std::get<EnvironmentLight>(s.lights[4]).image = ImageId{0}; },
        [](Scene& s) { std::get<EnvironmentLight>(s.lights[4]).rotation = 90; },
        [](Scene& s) { std::get<AreaLight>(s.lights[3]).texture = TextureId{0}; },
        [](Scene& s) { std::get<GoniometricLight>(s.lights[5]).direction.x = 1; },
        [](Scene& s) { std::get<GoniometricLight>(s.lights[5]).rotation = 1; },
        [](Scene& s) { std::get<GoniometricLight>(s.lights[5]).intensity.r = 2; },
        [](Scene& s) { s.profiles[0].vertical[1] = 90; },
        [](Scene& s) { s.profiles[0].horizontal[0] = 1; },
        [](Scene& s) { s.profiles[0].candela[1] = 3; },
        [](Scene& s) { s.profiles.push_back({}); },
        [](Scene& s) { std::get<PerspectiveCamera>(s.cameras[0]).up.x = 1; },
        [](Scene& s) { std::get<PerspectiveCamera>(s.cameras[0]).aperture_radius = 1; },
        [](Scene& s) { std::get<PerspectiveCamera>(s.cameras[0]).focus_distance = 1.0f; },
        [](Scene& s) { std::get<PerspectiveCamera>(s.cameras[0]).aperture_blades = 3; },
        [](Scene& s) { std::get<PerspectiveCamera>(s.cameras[0]).aperture_rotation = 3; },
        [](Scene& s) { std::get<OrthographicCamera>(s.cameras[1]).height = 3; },
        [](Scene& s) { std::get<OrthographicCamera>(s.cameras[1]).position.x = 3; },
        [](Scene& s) { std::get<PanoramaCamera>(s.cameras[2]).look_at.x = 3; },
        [](Scene& s) { std::get<FisheyeCamera>(s.cameras[3]).fov = 3; },
        [](Scene& s) { std::get<FisheyeCamera>(s.cameras[3]).projection = FisheyeProjection::equisolid; },
        [](Scene& s) { s.lights.pop_back(); },
        [](Scene& s) { std::swap(s.lights[0], s.lights[1]); },
    };
}

TEST(SceneHash, EveryFieldCounts) {
    std::set<std::string> hashes{scene_hash(full_scene())};
    size_t i = 0;
    for (const Change& change : changes()) {
        Scene s = full_scene();
        change(s);
        EXPECT_TRUE(hashes.insert(scene_hash(s)).second) << "change " << i << " was not noticed";
        ++i;
    }
}

TEST(SceneHash, NamesDoNotCount) {
    Scene s = full_scene();
    const std::string before = scene_hash(s);
    s.names.materials = {"wood"};
    EXPECT_EQ(scene_hash(s), before);
    EXPECT_EQ(before.size(), 32u);
}

}  // namespace
}  // namespace steradian
