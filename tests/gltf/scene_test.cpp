// Nodes, cameras, lights and materials as parts of a scene.
#include <cmath>

#include "gltf_builder.h"
#include "math/transform.h"

namespace steradian {
namespace {

using namespace test;

std::string with_node(const std::string& node, const std::string& more = {}) {
    GltfBuilder b;
    const int p = b.floats("VEC3", 3, kTriangle);
    return b.text("\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": " + std::to_string(p) +
                  "}, \"material\": 0}]}], \"nodes\": [" + node + "]" +
                  (more.empty() ? std::string(", \"materials\": [{}]") : ", " + more));
}

Vec3d moved(const std::string& node, Vec3 p) {
    const LoadedScene loaded = good_gltf(with_node(node));
    return transform_point(loaded.scene.instances.at(0).world_from_object, p);
}

void expect_near(Vec3d a, Vec3d b) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-12);
}

TEST(GltfNode, ScaleThenRotationThenTranslation) {
    // A quarter turn about +z takes (2 · 1, 0, 0) to (0, 2, 0).
    expect_near(moved("{\"mesh\": 0, \"translation\": [10, 20, 30], \"scale\": [2, 3, 4], \"rotation\": [0, 0, "
                      "0.7071067811865475244, 0.7071067811865475244]}",
                      {1, 0, 0}),
                {10, 22, 30});
    expect_near(moved("{\"mesh\": 0, \"matrix\": [0,2,0,0, -3,0,0,0, 0,0,4,0, 10,20,30,1]}", {1, 1, 1}), {7, 22, 34});
    // A mirror image.
    expect_near(moved("{\"mesh\": 0, \"scale\": [-1, 1, 1]}", {1, 2, 3}), {-1, 2, 3});
}

TEST(GltfNode, ChildrenFollowTheirParents) {
    expect_near(moved("{\"children\": [1], \"translation\": [1, 0, 0], \"scale\": [2, 2, 2]}, {\"mesh\": 0, "
                      "\"translation\": [0, 5, 0]}",
                      {1, 0, 0}),
                {3, 10, 0});
}

TEST(GltfNode, CyclesAndSecondParentsAreRefused) {
    const std::string scene = "\"materials\": [{}], \"scenes\": [{\"nodes\": [0]}], \"scene\": 0";
    expect_refused(with_node("{\"children\": [1]}, {\"children\": [0]}", scene), "/nodes/1/children/0",
                   "reached before");
    expect_refused(with_node("{\"children\": [1, 1]}, {\"mesh\": 0}", scene), "/nodes/0/children/1", "reached before");
}

TEST(GltfNode, AHundredThousandLevelsDoNotOverflowTheStack) {
    std::string nodes = "{\"children\": [1]}";
    constexpr int kDepth = 100000;
    for (int i = 1; i < kDepth; ++i) nodes += ",{\"children\": [" + std::to_string(i + 1) + "]}";
    EXPECT_EQ(good_gltf(with_node(nodes + ",{\"mesh\": 0}")).scene.instances.size(), 1u);
}

TEST(GltfNode, InstancesOfGpuInstancing) {
    GltfBuilder b;
    const int p = b.floats("VEC3", 3, kTriangle), t = b.floats("VEC3", 3, {1, 0, 0, 0, 2, 0});
    const int s = b.accessor<float>("VEC3", 5126, 3, {2, 2, 2, 1, 1, 1});
    const LoadedScene loaded = good_gltf(b.text(
        "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": " + std::to_string(p) +
        "}}]}], \"nodes\": [{\"mesh\": 0, \"translation\": [0, 0, 9], \"extensions\": {\"EXT_mesh_gpu_instancing\": "
        "{\"attributes\": {\"TRANSLATION\": " +
        std::to_string(t) + ", \"SCALE\": " + std::to_string(s) + "}}}}]"));
    ASSERT_EQ(loaded.scene.instances.size(), 2u);
    expect_near(transform_point(loaded.scene.instances[0].world_from_object, Vec3{1, 1, 1}), {3, 2, 11});
    expect_near(transform_point(loaded.scene.instances[1].world_from_object, Vec3{1, 1, 1}), {1, 3, 10});
}

/// Two instances of a triangle; `attributes` is of the extension.
std::string with_instances(GltfBuilder& b, const std::string& attributes) {
    const std::string p = std::to_string(b.floats("VEC3", 3, kTriangle));
    return b.text("\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": " + p +
                  "}}]}], \"nodes\": [{\"mesh\": 0, \"extensions\": {\"EXT_mesh_gpu_instancing\": {\"attributes\": {" +
                  attributes + "}}}}]");
}

TEST(GltfNode, RotationsOfInstancesAreFloatsOrNormalisedIntegers) {
    // A quarter turn about +z, and about +x: (0, 0, 1, 1) and (1, 0, 0, 1) over the root of 2.
    const auto check = [](GltfBuilder& b, int accessor, double tolerance) {
        const LoadedScene loaded = good_gltf(with_instances(b, "\"ROTATION\": " + std::to_string(accessor)));
        EXPECT_TRUE(loaded.diagnostics.empty());  // they are of unit length
        ASSERT_EQ(loaded.scene.instances.size(), 2u);
        const Vec3d a = transform_point(loaded.scene.instances[0].world_from_object, Vec3{1, 2, 3}),
                    b2 = transform_point(loaded.scene.instances[1].world_from_object, Vec3{1, 2, 3});
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(a[i], (Vec3d{-2, 1, 3})[i], tolerance);
            EXPECT_NEAR(b2[i], (Vec3d{1, -3, 2})[i], tolerance);
        }
    };
    GltfBuilder floats, bytes, shorts, whole, unsigned_bytes;
    const float h = 0.70710678f;
    check(floats, floats.floats("VEC4", 4, {0, 0, h, h, h, 0, 0, h}), 1e-6);
    constexpr std::string_view kNormalized = ", \"normalized\": true";
    check(bytes, bytes.accessor<int8_t>("VEC4", 5120, 4, {0, 0, 90, 90, 90, 0, 0, 90}, kNormalized), 1e-6);
    check(shorts, shorts.accessor<int16_t>("VEC4", 5122, 4, {0, 0, 23170, 23170, 23170, 0, 0, 23170}, kNormalized),
          1e-6);
    const std::string pointer = "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/ROTATION";
    const int w = whole.accessor<int16_t>("VEC4", 5122, 4, {0, 0, 1, 0, 1, 0, 0, 0});
    expect_refused(with_instances(whole, "\"ROTATION\": " + std::to_string(w)), pointer, "normalised BYTE or SHORT");
    const int u = unsigned_bytes.accessor<uint8_t>("VEC4", 5121, 4, {0, 0, 255, 0, 255, 0, 0, 0}, kNormalized);
    expect_refused(with_instances(unsigned_bytes, "\"ROTATION\": " + std::to_string(u)), pointer, "normalised BYTE");
}

TEST(GltfNode, AttributesOfInstancesMayBeSparse) {
    GltfBuilder b;
    const auto sparse = [&](const std::string& kind, uint8_t element, const std::vector<float>& values) {
        const std::string index = std::to_string(b.view(std::string(1, static_cast<char>(element)))),
                          at =
                              std::to_string(b.view({reinterpret_cast<const char*>(values.data()), 4 * values.size()}));
        return std::to_string(b.raw_accessor("\"componentType\": 5126, \"type\": \"" + kind +
                                             "\", \"count\": 2, \"sparse\": {\"count\": 1, \"indices\": "
                                             "{\"bufferView\": " +
                                             index + ", \"componentType\": 5121}, \"values\": {\"bufferView\": " + at +
                                             "}}"));
    };
    const std::string t = sparse("VEC3", 1, {10, 20, 30});
    const std::string s = std::to_string(b.floats("VEC3", 3, {2, 2, 2, 3, 3, 3}));
    const LoadedScene loaded = good_gltf(with_instances(b, "\"TRANSLATION\": " + t + ", \"SCALE\": " + s));
    EXPECT_TRUE(loaded.fidelity.empty());
    expect_near(transform_point(loaded.scene.instances.at(0).world_from_object, Vec3{1, 1, 1}), {2, 2, 2});
    expect_near(transform_point(loaded.scene.instances.at(1).world_from_object, Vec3{1, 1, 1}), {13, 23, 33});
}

TEST(GltfCamera, LooksAlongMinusZAndShapesThePicture) {
    const LoadedScene loaded = good_gltf(with_node("{\"camera\": 0, \"translation\": [1, 2, 3]}",
                                                   "\"materials\": [{}], \"cameras\": [{\"type\": \"perspective\", "
                                                   "\"perspective\": {\"yfov\": 1.5707963267948966, "
                                                   "\"aspectRatio\": 4, \"znear\": 1}}]"));
    const auto& camera = std::get<PerspectiveCamera>(loaded.scene.cameras.at(0));
    EXPECT_EQ(camera.position, (Vec3{1, 2, 3}));
    EXPECT_EQ(camera.look_at, (Vec3{1, 2, 2}));
    EXPECT_FLOAT_EQ(camera.vertical_fov, 90);
    EXPECT_EQ(loaded.settings.width, 1024u);
    EXPECT_EQ(loaded.settings.height, 256u);
}

std::string with_light(const std::string& light) {
    return with_node("{\"translation\": [0, 3, 0], \"extensions\": {\"KHR_lights_punctual\": {\"light\": 0}}}",
                     "\"materials\": [{}], \"extensions\": {\"KHR_lights_punctual\": {\"lights\": [" + light + "]}}");
}

TEST(GltfLight, Kinds) {
    const LoadedScene point = good_gltf(with_light("{\"type\": \"point\", \"intensity\": 6, \"color\": [1, 0.5, 0]}"));
    EXPECT_EQ(std::get<PointLight>(point.scene.lights.at(0)).intensity, (Rgb{6, 3, 0}));
    EXPECT_EQ(std::get<PointLight>(point.scene.lights.at(0)).position, (Vec3{0, 3, 0}));
    const LoadedScene sun = good_gltf(with_light("{\"type\": \"directional\"}"));
    EXPECT_EQ(std::get<DirectionalLight>(sun.scene.lights.at(0)).direction, (Vec3{0, 0, -1}));
    const LoadedScene spot = good_gltf(with_light("{\"type\": \"spot\", \"spot\": {}}"));
    const auto& s = std::get<SpotLight>(spot.scene.lights.at(0));
    EXPECT_FLOAT_EQ(s.outer_angle, 45);
    EXPECT_EQ(s.inner_angle, 0);
    EXPECT_EQ(s.falloff, SpotFalloff::squared);
    LoadOptions options;
    options.gltf_light_units = GltfLightUnits::photometric;
    const LoadedScene lumens = good_gltf(with_light("{\"type\": \"point\", \"intensity\": 683}"), options);
    EXPECT_FLOAT_EQ(std::get<PointLight>(lumens.scene.lights.at(0)).intensity.r, 1);
    expect_refused(with_light("{\"type\": \"sun\"}"), "/extensions/KHR_lights_punctual/lights/0/type", "sun");
}

LoadedScene with_material(const std::string& material) {
    return good_gltf(with_node("{\"mesh\": 0}", "\"materials\": [{" + material + "}]"));
}
template <class M>
M material_of(const LoadedScene& loaded) {
    return std::get<M>(loaded.scene.materials[index(loaded.scene.instances.at(0).material)]);
}

TEST(GltfMaterial, DefaultIsRoughWhiteMetal) {
    const auto m = material_of<OpenPbrMaterial>(with_material(""));
    EXPECT_EQ(m.base_color.value, (Rgb{1, 1, 1}));
    EXPECT_EQ(m.base_metalness.value, 1);
    EXPECT_EQ(m.specular_roughness.value, 1);
    EXPECT_EQ(m.specular_ior, 1.5f);
}

TEST(GltfMaterial, FactorsAndAlpha) {
    const std::string pbr =
        "\"pbrMetallicRoughness\": {\"baseColorFactor\": [0.1, 0.2, 0.3, 0.4], \"metallicFactor\": "
        "0.5, \"roughnessFactor\": 0.6}";
    const auto opaque = material_of<OpenPbrMaterial>(with_material(pbr));
    EXPECT_EQ(opaque.base_color.value, (Rgb{0.1f, 0.2f, 0.3f}));
    EXPECT_EQ(opaque.base_metalness.value, 0.5f);
    EXPECT_EQ(opaque.specular_roughness.value, 0.6f);
    EXPECT_EQ(opaque.geometry_opacity.value, 1);
    EXPECT_EQ(material_of<OpenPbrMaterial>(with_material(pbr + ", \"alphaMode\": \"BLEND\"")).geometry_opacity.value,
              0.4f);
    const auto mask =
        material_of<OpenPbrMaterial>(with_material(pbr + ", \"alphaMode\": \"MASK\", \"alphaCutoff\": 0.3"));
    EXPECT_EQ(mask.geometry_opacity_cutoff, 0.3f);
    EXPECT_EQ(mask.geometry_opacity.value, 0.4f);
}

TEST(GltfMaterial, UnlitOnesAreThereAsFarAsTheirAlphaSays) {
    const std::string unlit =
        "\"pbrMetallicRoughness\": {\"baseColorFactor\": [0.1, 0.2, 0.3, 0.4]}, \"extensions\": "
        "{\"KHR_materials_unlit\": {}}";
    const LoadedScene opaque = with_material(unlit), blended = with_material(unlit + ", \"alphaMode\": \"BLEND\""),
                      masked = with_material(unlit + ", \"alphaMode\": \"MASK\", \"alphaCutoff\": 0.3");
    for (const LoadedScene* loaded : {&opaque, &blended, &masked}) {
        EXPECT_EQ(std::get<AreaLight>(loaded->scene.lights.at(0)).radiance, (Rgb{0.1f, 0.2f, 0.3f}));
        EXPECT_TRUE(std::get<AreaLight>(loaded->scene.lights.at(0)).two_sided);  // a colour, from behind as well
    }
    (void)material_of<DiffuseMaterial>(opaque);
    const auto blend = material_of<OpenPbrMaterial>(blended), mask = material_of<OpenPbrMaterial>(masked);
    EXPECT_EQ(blend.geometry_opacity.value, 0.4f);
    EXPECT_EQ(blend.geometry_opacity_cutoff, 0);
    EXPECT_EQ(mask.geometry_opacity.value, 0.4f);
    EXPECT_EQ(mask.geometry_opacity_cutoff, 0.3f);
    for (const OpenPbrMaterial& m : {blend, mask}) {
        EXPECT_EQ(m.base_color.value, (Rgb{0, 0, 0}));
        EXPECT_EQ(m.base_metalness.value, 0);
        EXPECT_EQ(m.specular_weight, 0);
    }
}

TEST(GltfMaterial, ColourFactorsOutsideTheirRangeAreClamped) {
    const auto loaded = [](const std::string& material, std::string_view key) {
        LoadedScene out = with_material(material);
        EXPECT_TRUE(has(out.diagnostics, "'" + std::string(key) + "' of a material must")) << key;
        return out;
    };
    const auto base = material_of<OpenPbrMaterial>(
        loaded("\"alphaMode\": \"BLEND\", \"pbrMetallicRoughness\": {\"baseColorFactor\": [-0.1, 2, 0.5, -3]}",
               "baseColorFactor"));
    EXPECT_EQ(base.base_color.value, (Rgb{0, 1, 0.5f}));
    EXPECT_EQ(base.geometry_opacity.value, 0);
    const LoadedScene shines = loaded("\"emissiveFactor\": [2, -1, 0.5]", "emissiveFactor");
    EXPECT_EQ(std::get<AreaLight>(shines.scene.lights.at(0)).radiance, (Rgb{1, 0, 0.5f}));
    const auto extension = [&](const std::string& name, const std::string& members) {
        return "\"pbrMetallicRoughness\": {\"metallicFactor\": 0}, \"extensions\": {\"" + name + "\": {" + members +
               "}}";
    };
    const auto sheen = material_of<OpenPbrMaterial>(
        loaded(extension("KHR_materials_sheen", "\"sheenColorFactor\": [1.5, -1, 0.5]"), "sheenColorFactor"));
    EXPECT_EQ(sheen.fuzz_weight.value, 1);
    EXPECT_EQ(sheen.fuzz_color.value, (Rgb{1, 0, 0.5f}));
    const auto specular = material_of<OpenPbrMaterial>(
        loaded(extension("KHR_materials_specular", "\"specularColorFactor\": [2, -1, 1]"), "specularColorFactor"));
    EXPECT_EQ(specular.specular_color.value, (Rgb{1, 0, 0.5f}));
    EXPECT_EQ(specular.specular_weight, 2);
    const LoadedScene thin =
        loaded(extension("KHR_materials_diffuse_transmission",
                         "\"diffuseTransmissionFactor\": 1, \"diffuseTransmissionColorFactor\": [0.5, 7, -7]"),
               "diffuseTransmissionColorFactor");
    const auto transmits = material_of<OpenPbrMaterial>(thin);
    EXPECT_EQ(transmits.subsurface_color.value, (Rgb{0.5f, 1, 0}));
    EXPECT_EQ(transmits.subsurface_weight.value, 1);
    EXPECT_TRUE(transmits.geometry_thin_walled);
    const auto absorbs = material_of<OpenPbrMaterial>(loaded(
        "\"pbrMetallicRoughness\": {\"metallicFactor\": 0}, \"extensions\": {\"KHR_materials_transmission\": "
        "{\"transmissionFactor\": 1}, \"KHR_materials_volume\": {\"thicknessFactor\": 2, \"attenuationDistance\": 1, "
        "\"attenuationColor\": [1.5, 0.25, -1]}}",
        "attenuationColor"));
    EXPECT_EQ(absorbs.transmission_color.value, (Rgb{1, 1, 1}));
    EXPECT_EQ(absorbs.interior, open_pbr_interior({1, 0.25f, 0}, 1));
    EXPECT_NEAR(absorbs.interior.absorption.g, std::log(4.0), 1e-6);
}

TEST(GltfMaterial, DiffuseTransmissionIsThatOfSheets) {
    const auto with = [](const std::string& more) {
        return with_material(
            "\"pbrMetallicRoughness\": {\"metallicFactor\": 0}, \"extensions\": "
            "{\"KHR_materials_diffuse_transmission\": "
            "{\"diffuseTransmissionFactor\": 0.5}" +
            more + "}");
    };
    const std::string volume = ", \"KHR_materials_volume\": {\"thicknessFactor\": 1}";
    EXPECT_TRUE(with("").fidelity.empty());
    EXPECT_TRUE(has(with(volume).fidelity, "thin sheet"));
    const std::string transparent = ", \"KHR_materials_transmission\": {\"transmissionFactor\": 0.5}";
    const auto thin = material_of<OpenPbrMaterial>(with(transparent));
    EXPECT_EQ(thin.subsurface_weight.value, 0.5f);
    EXPECT_TRUE(thin.geometry_thin_walled);
    const LoadedScene solid = with(transparent + volume);
    EXPECT_TRUE(has(solid.fidelity, "also transparent"));
    EXPECT_EQ(material_of<OpenPbrMaterial>(solid).subsurface_weight.value, 0);
    EXPECT_FALSE(material_of<OpenPbrMaterial>(solid).geometry_thin_walled);
}

TEST(GltfMaterial, IridescenceIsAThinFilm) {
    const auto with = [](const std::string& members) {
        return with_material(
            "\"pbrMetallicRoughness\": {\"metallicFactor\": 1, \"roughnessFactor\": 0}, \"extensions\": "
            "{\"KHR_materials_iridescence\": {" +
            members + "}}");
    };
    const auto film = material_of<OpenPbrMaterial>(
        with("\"iridescenceFactor\": 0.5, \"iridescenceIor\": 1.8, \"iridescenceThicknessMinimum\": 200, "
             "\"iridescenceThicknessMaximum\": 550"));
    EXPECT_EQ(film.thin_film_weight.value, 0.5f);
    EXPECT_EQ(film.thin_film_ior, 1.8f);
    EXPECT_EQ(film.thin_film_thickness.maximum, 0.55f);  // without a texture there is no minimum
    EXPECT_EQ(film.thin_film_thickness.minimum, 0);
    EXPECT_FALSE(film.thin_film_thickness.texture);
    const auto by_default = material_of<OpenPbrMaterial>(with("\"iridescenceFactor\": 1"));
    EXPECT_EQ(by_default.thin_film_ior, 1.3f);
    EXPECT_EQ(by_default.thin_film_thickness.maximum, 0.4f);
    (void)material_of<ConductorMaterial>(with("\"iridescenceIor\": 1.8"));  // no film
    const LoadedScene beyond =
        with("\"iridescenceFactor\": 1, \"iridescenceIor\": 0.5, \"iridescenceThicknessMaximum\": 1e6");
    const auto clamped = material_of<OpenPbrMaterial>(beyond);
    EXPECT_EQ(clamped.thin_film_ior, 1);
    EXPECT_EQ(clamped.thin_film_thickness.maximum, 10);
    EXPECT_TRUE(has(beyond.fidelity, "10 micrometres"));
    EXPECT_TRUE(has(beyond.diagnostics, "'iridescenceIor' must be at least 1"));
    EXPECT_TRUE(
        has(with("\"iridescenceFactor\": 1, \"iridescenceIor\": 3.5").fidelity, "an index of a film of more than 3"));
}

/// 20 over the Abbe number; of bodies only.
TEST(GltfMaterial, DispersionIsAnAbbeNumber) {
    const auto with = [](const std::string& dispersion, const std::string& roughness, double thickness) {
        return with_material("\"pbrMetallicRoughness\": {\"metallicFactor\": 0, \"roughnessFactor\": " + roughness +
                             "}, \"extensions\": {\"KHR_materials_transmission\": {\"transmissionFactor\": 1}, "
                             "\"KHR_materials_volume\": {\"thicknessFactor\": " +
                             std::to_string(thickness) + "}, \"KHR_materials_dispersion\": {" + dispersion + "}}");
    };
    const auto layered = material_of<OpenPbrMaterial>(with("\"dispersion\": 0.5", "0.4", 1));
    EXPECT_EQ(layered.transmission_dispersion_scale, 1);
    EXPECT_EQ(layered.transmission_dispersion_abbe_number, 40);
    EXPECT_EQ(material_of<GlassMaterial>(with("\"dispersion\": 0.5", "0", 1)).abbe, 40);
    EXPECT_EQ(material_of<GlassMaterial>(with("", "0", 1)).abbe, 0);
    EXPECT_EQ(material_of<OpenPbrMaterial>(with("", "0.4", 1)).transmission_dispersion_scale, 0);
    EXPECT_EQ(material_of<OpenPbrMaterial>(with("\"dispersion\": 0.5", "0.4", 0)).transmission_dispersion_scale, 0);
    const LoadedScene beyond = with("\"dispersion\": 1e3", "0", 1);
    EXPECT_EQ(material_of<GlassMaterial>(beyond).abbe, 1);
    EXPECT_TRUE(has(beyond.fidelity, "a dispersion of more than 20"));
    EXPECT_FALSE(has(with("\"dispersion\": 20", "0", 1).fidelity, "dispersion"));
}

TEST(GltfMaterial, SimpleOnesAreWhatTheyAre) {
    const std::string start = "\"pbrMetallicRoughness\": {\"roughnessFactor\": 0, \"metallicFactor\": ";
    EXPECT_EQ(material_of<ConductorMaterial>(with_material(start + "1}")).roughness.value, (Vec2{0, 0}));
    const std::string glass = start +
                              "0, \"baseColorFactor\": [1, 0.5, 0.25, 1]}, \"extensions\": "
                              "{\"KHR_materials_transmission\": {\"transmissionFactor\": 1}, "
                              "\"KHR_materials_ior\": {\"ior\": 1.3}";
    const auto solid =
        material_of<GlassMaterial>(with_material(glass + ", \"KHR_materials_volume\": {\"thicknessFactor\": 1}}"));
    EXPECT_EQ(solid.eta, 1.3f);
    EXPECT_EQ(solid.transmittance, (Rgb{1, 0.5f, 0.25f}));
    EXPECT_EQ(solid.interior, Medium{});
    // The mesh says how thick the body is, not the file.
    for (const char* thickness : {"1", "0.001"}) {
        const LoadedScene tinted =
            with_material(glass + ", \"KHR_materials_volume\": {\"thicknessFactor\": " + thickness +
                          ", \"attenuationDistance\": 0.5, \"attenuationColor\": [1, 0.5, 0.25]}}");
        const Medium interior = material_of<GlassMaterial>(tinted).interior;
        EXPECT_EQ(interior.absorption.r, 0);
        EXPECT_NEAR(interior.absorption.g, 2 * std::log(2.0), 1e-6);
        EXPECT_NEAR(interior.absorption.b, 2 * std::log(4.0), 1e-6);
        EXPECT_TRUE(tinted.fidelity.empty());
    }
    EXPECT_EQ(material_of<ThinGlassMaterial>(with_material(glass + "}")).eta, 1.3f);
    EXPECT_TRUE(material_of<DiffuseMaterial>(
                    with_material(start + "0}, \"extensions\": {\"KHR_materials_specular\": {\"specularFactor\": 0}}"))
                    .two_sided);
}

TEST(GltfMaterial, AnisotropyHasItsOwnShapeAndAngle) {
    const auto m = material_of<OpenPbrMaterial>(
        with_material("\"pbrMetallicRoughness\": {\"roughnessFactor\": 0.5}, \"extensions\": "
                      "{\"KHR_materials_anisotropy\": {\"anisotropyStrength\": 0.8, \"anisotropyRotation\": 0.5}}"));
    EXPECT_EQ(m.specular_roughness.value, 0.5f);
    EXPECT_EQ(m.specular_roughness_anisotropy.value, 0.8f);
    EXPECT_EQ(m.specular_grain_shape, GrainShape::gltf);
    EXPECT_NEAR(m.geometry_tangent.rotation, 0.5 * 180 / 3.14159265, 1e-5);
    // A polished surface with a grain is no mirror.
    (void)material_of<OpenPbrMaterial>(
        with_material("\"pbrMetallicRoughness\": {\"roughnessFactor\": 0}, \"extensions\": "
                      "{\"KHR_materials_anisotropy\": {\"anisotropyStrength\": 0.8}}"));
}

TEST(GltfMaterial, EmissionIsALight) {
    const LoadedScene loaded = with_material(
        "\"emissiveFactor\": [1, 0.5, 0], \"extensions\": {\"KHR_materials_emissive_strength\": {\"emissiveStrength\": "
        "4}}");
    const auto& light = std::get<AreaLight>(loaded.scene.lights.at(0));
    EXPECT_EQ(light.radiance, (Rgb{4, 2, 0}));
    EXPECT_FALSE(light.two_sided);
    EXPECT_TRUE(
        std::get<AreaLight>(with_material("\"emissiveFactor\": [1, 1, 1], \"doubleSided\": true").scene.lights.at(0))
            .two_sided);
}

}  // namespace
}  // namespace steradian
