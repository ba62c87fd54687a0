// What each key of our own format means.
#include <array>
#include <cmath>
#include <numbers>

#include "formats/scene_test.h"

namespace steradian::test {
namespace {

TEST(NativeScene, SilenceMeansTheDefaults) {
    const LoadedScene loaded = load_good(scene_with(""));
    const RenderSettings& s = loaded.settings;
    const RenderSettings defaults;
    EXPECT_EQ(s.width, defaults.width);
    EXPECT_EQ(s.height, defaults.height);
    EXPECT_EQ(s.max_depth, defaults.max_depth);
    EXPECT_EQ(s.samples_per_pixel, defaults.samples_per_pixel);
    EXPECT_EQ(s.filter, defaults.filter);
    EXPECT_EQ(s.seed, 0u);
    EXPECT_EQ(s.camera, 0u);
    EXPECT_FALSE(s.crop);
    EXPECT_TRUE(loaded.scene.instances.empty());
    EXPECT_TRUE(loaded.diagnostics.empty());
    const auto& camera = std::get<PerspectiveCamera>(loaded.scene.cameras.at(0));
    EXPECT_EQ(camera.position, (Vec3{0, 0, 5}));
    EXPECT_EQ(camera.look_at, (Vec3{0, 0, 0}));
    EXPECT_EQ(camera.up, (Vec3{0, 1, 0}));
    EXPECT_EQ(camera.vertical_fov, 40);
}

TEST(NativeScene, RenderAndFilm) {
    const LoadedScene loaded = load_good(scene_with(R"("$schema": "x", "comment": "y",
        "render": {"integrator": "direct", "light_sampling": "light", "light_choice": "power", "roulette_depth": 7, "clamp": 2.5, "ao_distance": 0.25, "max_depth": 0, "spp": 1e3, "sampler": "independent", "seed": 18446744073709551615, "camera": "camera"},
        "film": {"resolution": [640, 360], "filter": {"type": "mitchell"}, "crop": [10, 20, 640, 30]})"));
    const RenderSettings& s = loaded.settings;
    EXPECT_EQ(s.integrator, IntegratorKind::direct);
    EXPECT_EQ(s.light_sampling, LightSampling::light);
    EXPECT_EQ(s.light_choice, LightChoice::power);
    EXPECT_EQ(s.roulette_depth, 7u);
    EXPECT_EQ(s.clamp, 2.5f);
    EXPECT_EQ(s.ao_distance, 0.25f);
    EXPECT_EQ(s.max_depth, 0u);
    EXPECT_EQ(s.samples_per_pixel, 1000u);
    EXPECT_EQ(s.sampler, SamplerKind::independent);
    EXPECT_EQ(s.seed, UINT64_MAX);
    EXPECT_EQ(s.width, 640u);
    EXPECT_EQ(s.height, 360u);
    EXPECT_EQ(s.filter, (Filter{FilterKind::mitchell, 2}));
    EXPECT_EQ(s.crop, (Crop{10, 20, 640, 30}));
}

TEST(NativeScene, Aovs) {
    EXPECT_TRUE(load_good(scene_with("\"film\": {}")).settings.aovs.empty());
    EXPECT_EQ(load_good(scene_with(R"("film": {"aovs": "all"})")).settings.aovs, AovSet::all());
    EXPECT_EQ(load_good(scene_with(R"("film": {"aovs": ["normal", "depth", "normal"]})")).settings.aovs,
              (AovSet{Aov::depth, Aov::normal}));
    expect_error(scene_with(R"("film": {"aovs": ["depth", §"normals"]})"), "normals", "normal");
    expect_error(scene_with(R"("film": {"aovs": §"some"})"), "some", "all");
    expect_error(scene_with(R"("film": {"aovs": §7})"), "'aovs'");
}

TEST(NativeScene, ATargetForTheErrorMakesSppALimit) {
    const auto settings = [](const char* render) {
        return load_good(scene_with(std::string("\"render\": {") + render + "}")).settings;
    };
    EXPECT_EQ(settings("").target_error, 0);
    EXPECT_EQ(settings("\"target_error\": 0.05").target_error, 0.05f);
    EXPECT_EQ(settings("\"target_error\": 0.05").samples_per_pixel, kDefaultMostSamples);
    EXPECT_EQ(settings("\"spp\": 512, \"target_error\": 0.05").samples_per_pixel, 512u);
    EXPECT_FALSE(load_text(scene_with("\"render\": {\"target_error\": 0}")).ok());
}

TEST(NativeScene, FiltersHaveTheirOwnDefaultRadius) {
    const std::pair<std::string, Filter> cases[] = {{"box", {FilterKind::box, 0.5f}},
                                                    {"tent", {FilterKind::tent, 1}},
                                                    {"gaussian", {FilterKind::gaussian, 1.5f}},
                                                    {"mitchell", {FilterKind::mitchell, 2}}};
    for (const auto& [name, filter] : cases) {
        EXPECT_EQ(load_good(scene_with("\"film\": {\"filter\": {\"type\": \"" + name + "\"}}")).settings.filter,
                  filter);
        const Filter wide{filter.kind, 3};
        EXPECT_EQ(load_good(scene_with("\"film\": {\"filter\": {\"type\": \"" + name + "\", \"radius\": 3}}"))
                      .settings.filter,
                  wide);
    }
}

TEST(NativeScene, NamedCameras) {
    const LoadedScene loaded = load_good(R"({"version": 1, "render": {"camera": "top"}, "cameras": {
        "front": {"type": "perspective", "position": [0, 0, 5], "look_at": [0, 0, 0], "vertical_fov": 30},
        "top": {"position": [0, 9, 0], "look_at": [0, 0, 0], "up": [0, 0, -1]}}})");
    EXPECT_EQ(loaded.settings.camera, 1u);
    EXPECT_EQ(loaded.scene.names.cameras, (std::vector<std::string>{"front", "top"}));
    EXPECT_EQ(std::get<PerspectiveCamera>(loaded.scene.cameras[0]).vertical_fov, 30);
    EXPECT_EQ(std::get<PerspectiveCamera>(loaded.scene.cameras[1]).up, (Vec3{0, 0, -1}));
}

TEST(NativeScene, CamerasOfEveryKind) {
    const LoadedScene loaded = load_good(R"({"version": 1, "cameras": {
        "lens": {"position": [0, 0, 5], "look_at": [0, 0, 0], "aperture_radius": 0.5, "focus_distance": 2,
                 "aperture_blades": 6, "aperture_rotation": 15},
        "round": {"type": "perspective", "position": [0, 0, 5], "look_at": [0, 0, 0], "aperture_radius": 0.25},
        "plan": {"type": "orthographic", "position": [0, 9, 0], "look_at": [0, 0, 0], "up": [1, 0, 0], "height": 12},
        "all": {"type": "panorama", "position": [1, 2, 3], "look_at": [0, 2, 3]},
        "fish": {"type": "fisheye", "position": [0, 0, 5], "look_at": [0, 0, 0], "fov": 200, "projection": "equisolid"},
        "plain": {"type": "fisheye", "position": [0, 0, 5], "look_at": [0, 0, 0]}}})");
    const auto& cameras = loaded.scene.cameras;
    const auto& lens = std::get<PerspectiveCamera>(cameras.at(0));
    EXPECT_EQ(lens.aperture_radius, 0.5f);
    EXPECT_EQ(lens.focus_distance, 2.0f);
    EXPECT_EQ(lens.aperture_blades, 6u);
    EXPECT_EQ(lens.aperture_rotation, 15);
    const auto& round = std::get<PerspectiveCamera>(cameras.at(1));
    EXPECT_EQ(round.aperture_radius, 0.25f);
    EXPECT_FALSE(round.focus_distance);
    EXPECT_EQ(round.aperture_blades, 0u);
    const auto& plan = std::get<OrthographicCamera>(cameras.at(2));
    EXPECT_EQ(plan.height, 12);
    EXPECT_EQ(plan.up, (Vec3{1, 0, 0}));
    EXPECT_EQ(std::get<PanoramaCamera>(cameras.at(3)).position, (Vec3{1, 2, 3}));
    const auto& fish = std::get<FisheyeCamera>(cameras.at(4));
    EXPECT_EQ(fish.fov, 200);
    EXPECT_EQ(fish.projection, FisheyeProjection::equisolid);
    EXPECT_EQ(std::get<FisheyeCamera>(cameras.at(5)).fov, 180);
    EXPECT_EQ(std::get<FisheyeCamera>(cameras.at(5)).projection, FisheyeProjection::equidistant);
}

TEST(NativeScene, Textures) {
    const LoadedScene loaded = load_good(scene_with(R"("textures": {
        "grey": {"type": "constant", "color": 0.25}, "red": {"type": "constant", "color": [1, 0.5, 0]},
        "plain": {"type": "checkerboard"},
        "checks": {"type": "checkerboard", "color0": 1, "color1": [0, 0, 1], "scale": 8, "offset": [0.5, 0.25]}})"));
    const auto& t = loaded.scene.textures;
    ASSERT_EQ(t.size(), 4u);
    EXPECT_EQ(std::get<ConstantTexture>(t[0]).value, (Rgb{0.25f, 0.25f, 0.25f}));
    EXPECT_EQ(std::get<ConstantTexture>(t[1]).value, (Rgb{1, 0.5f, 0}));
    EXPECT_EQ(std::get<CheckerTexture>(t[2]).even, CheckerTexture{}.even);
    const auto& checks = std::get<CheckerTexture>(t[3]);
    EXPECT_EQ(checks.even, (Rgb{1, 1, 1}));
    EXPECT_EQ(checks.odd, (Rgb{0, 0, 1}));
    EXPECT_EQ(checks.scale, (Vec2{8, 8}));
    EXPECT_EQ(checks.offset, (Vec2{0.5f, 0.25f}));
    EXPECT_EQ(loaded.scene.names.textures, (std::vector<std::string>{"grey", "red", "plain", "checks"}));
}

TEST(NativeScene, Materials) {
    const LoadedScene loaded =
        load_good(scene_with(R"("textures": {"t": {"type": "constant", "color": 0.1}}, "materials": {
        "by_name": {"type": "diffuse", "reflectance": "t"},
        "inline": {"type": "diffuse", "reflectance": {"type": "constant", "color": 0.2}, "two_sided": true},
        "color": {"type": "diffuse", "reflectance": [0.1, 0.2, 0.3], "roughness": 0.5},
        "refraction": {"type": "refraction", "eta": 2}, "refraction0": {"type": "refraction"},
        "glass": {"type": "glass", "eta": 1.33, "reflectance": 0.5, "transmittance": [1, 0.5, 0.25]}, "glass0": {"type": "glass"},
        "mirror": {"type": "mirror", "reflectance": 0.9}, "mirror0": {"type": "mirror"}})"));
    const auto& m = loaded.scene.materials;
    ASSERT_EQ(m.size(), 9u);
    EXPECT_EQ(index(std::get<DiffuseMaterial>(m[0]).reflectance), 0u);
    EXPECT_FALSE(std::get<DiffuseMaterial>(m[0]).two_sided);
    const auto constant = [&](const Material& material) {
        return std::get<ConstantTexture>(loaded.scene.textures[index(std::get<DiffuseMaterial>(material).reflectance)])
            .value;
    };
    EXPECT_EQ(constant(m[1]), (Rgb{0.2f, 0.2f, 0.2f}));
    EXPECT_TRUE(std::get<DiffuseMaterial>(m[1]).two_sided);
    EXPECT_EQ(constant(m[2]), (Rgb{0.1f, 0.2f, 0.3f}));
    EXPECT_EQ(std::get<DiffuseMaterial>(m[1]).roughness, 0);
    EXPECT_EQ(std::get<DiffuseMaterial>(m[2]).roughness, 0.5f);
    EXPECT_EQ(std::get<RefractionMaterial>(m[3]).eta, 2);
    EXPECT_EQ(std::get<RefractionMaterial>(m[4]).eta, 1.5f);
    const auto& glass = std::get<GlassMaterial>(m[5]);
    EXPECT_EQ(glass.eta, 1.33f);
    EXPECT_EQ(glass.reflectance, (Rgb{0.5f, 0.5f, 0.5f}));
    EXPECT_EQ(glass.transmittance, (Rgb{1, 0.5f, 0.25f}));
    EXPECT_EQ(std::get<GlassMaterial>(m[6]).eta, 1.5f);
    EXPECT_EQ(std::get<GlassMaterial>(m[6]).reflectance, (Rgb{1, 1, 1}));
    EXPECT_EQ(std::get<MirrorMaterial>(m[7]).reflectance, (Rgb{0.9f, 0.9f, 0.9f}));
    EXPECT_EQ(std::get<MirrorMaterial>(m[8]).reflectance, (Rgb{1, 1, 1}));
}

TEST(NativeScene, Conductors) {
    const LoadedScene loaded =
        load_good(scene_with(R"("textures": {"t": {"type": "constant", "color": 0.1}}, "materials": {
        "gold": {"type": "conductor", "metal": "gold"},
        "index": {"type": "conductor", "n": [0.2, 0.9, 1.1], "k": 3, "roughness": 0.5},
        "brushed": {"type": "conductor", "reflectance": [0.9, 0.8, 0.7], "alpha": [0.1, 0.4], "tint": [0.5, 1, 1]},
        "textured": {"type": "conductor", "reflectance": "t", "edge_reflectance": 0.5, "roughness": "t"}})"));
    std::vector<ConductorMaterial> m;
    for (const Material& material : loaded.scene.materials) m.push_back(std::get<ConductorMaterial>(material));
    ASSERT_EQ(m.size(), 4u);
    const auto& gold = std::get<ComplexIndex>(m[0].reflectance);
    EXPECT_EQ(gold.n, metal_index("gold")->n);
    EXPECT_EQ(gold.k, metal_index("gold")->k);
    EXPECT_EQ(m[0].roughness.value, (Vec2{0, 0}));
    EXPECT_TRUE(m[0].roughness.squared);
    EXPECT_EQ(std::get<ComplexIndex>(m[1].reflectance).n, (Rgb{0.2f, 0.9f, 1.1f}));
    EXPECT_EQ(std::get<ComplexIndex>(m[1].reflectance).k, (Rgb{3, 3, 3}));
    EXPECT_EQ(m[1].roughness.value, (Vec2{0.5f, 0.5f}));
    EXPECT_EQ(std::get<SchlickReflectance>(m[2].reflectance).grazing, (Rgb{1, 1, 1}));
    EXPECT_EQ(m[2].roughness.value, (Vec2{0.1f, 0.4f}));
    EXPECT_FALSE(m[2].roughness.squared);
    EXPECT_EQ(m[2].tint, (Rgb{0.5f, 1, 1}));
    EXPECT_EQ(m[3].tint, (Rgb{1, 1, 1}));
    EXPECT_FALSE(m[2].roughness.texture);
    EXPECT_EQ(std::get<SchlickReflectance>(m[3].reflectance).grazing, (Rgb{0.5f, 0.5f, 0.5f}));
    EXPECT_EQ(m[3].roughness.value, (Vec2{1, 1}));
    EXPECT_EQ(m[3].roughness.texture, TextureId{0});
}

TEST(NativeScene, DiffuseTransmission) {
    const LoadedScene loaded = load_good(scene_with(R"("materials": {
        "leaf": {"type": "diffuse_transmission", "reflectance": 0.25, "transmittance": [0.5, 0.75, 0]}})"));
    const auto& m = std::get<DiffuseTransmissionMaterial>(loaded.scene.materials[0]);
    const auto color = [&](TextureId id) { return std::get<ConstantTexture>(loaded.scene.textures[index(id)]).value; };
    EXPECT_EQ(color(m.reflectance), (Rgb{0.25f, 0.25f, 0.25f}));
    EXPECT_EQ(color(m.transmittance), (Rgb{0.5f, 0.75f, 0}));
}

TEST(NativeScene, RoughAndThinGlass) {
    const LoadedScene loaded = load_good(scene_with(R"("materials": {
        "frosted": {"type": "glass", "roughness": 0.4}, "clear": {"type": "glass"},
        "pane": {"type": "thin_glass", "eta": 1.6, "transmittance": [0.9, 1, 0.8]},
        "flint": {"type": "glass", "abbe": 30.5}, "ideal": {"type": "glass", "abbe": 0}})"));
    const auto& m = loaded.scene.materials;
    EXPECT_EQ(std::get<GlassMaterial>(m[3]).abbe, 30.5f);
    for (const size_t i : {0, 1, 4}) EXPECT_EQ(std::get<GlassMaterial>(m[i]).abbe, 0);
    EXPECT_EQ(std::get<GlassMaterial>(m[0]).roughness.value, (Vec2{0.4f, 0.4f}));
    EXPECT_EQ(std::get<GlassMaterial>(m[1]).roughness.value, (Vec2{0, 0}));
    EXPECT_EQ(std::get<ThinGlassMaterial>(m[2]).eta, 1.6f);
    EXPECT_EQ(std::get<ThinGlassMaterial>(m[2]).transmittance, (Rgb{0.9f, 1, 0.8f}));
}

TEST(NativeScene, ReflectanceAboveOneIsWarnedAboutOnce) {
    const LoadedScene loaded =
        load_good(scene_with("\"materials\": {\n\"a\": {\"type\": \"diffuse\", \"reflectance\": 1.5},\n"
                             "\"b\": {\"type\": \"mirror\", \"reflectance\": 2}}"));
    ASSERT_EQ(loaded.diagnostics.warnings().size(), 1u);
    const Warning& warning = loaded.diagnostics.warnings()[0];
    EXPECT_EQ(warning.count, 2u);
    EXPECT_NE(warning.message.find("above 1"), std::string::npos);
    EXPECT_EQ(warning.where.line, 3u);
    EXPECT_EQ(warning.where.column, 41u);
}

TEST(NativeScene, ShapesOfObjects) {
    const LoadedScene loaded = load_good(scene_with_object(R"(
        {"type": "sphere", "center": [1, 2, 3], "radius": 0.5}, {"type": "sphere"},
        {"type": "rectangle", "center": [1, 2, 3], "half_u": [2, 0, 0], "half_v": [0, 0, 3]}, {"type": "rectangle"},
        {"type": "disk", "center": [1, 2, 3], "normal": [0, 2, 0], "radius": 4}, {"type": "disk"},
        {"type": "mesh", "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]],
         "normals": [[0, 0, 1], [0, 0, 1], [0, 1, 1]], "uvs": [[0, 0], [1, 0], [0, 1]]})"));
    const Scene& s = loaded.scene;
    ASSERT_EQ(s.instances.size(), 7u);
    const auto shape = [&](size_t i) { return s.shapes[index(s.instances[i].shape)]; };
    EXPECT_EQ(std::get<Sphere>(shape(0)).center, (Vec3{1, 2, 3}));
    EXPECT_EQ(std::get<Sphere>(shape(0)).radius, 0.5f);
    EXPECT_EQ(std::get<Sphere>(shape(1)).center, (Vec3{0, 0, 0}));
    EXPECT_EQ(std::get<Sphere>(shape(1)).radius, 1);
    EXPECT_EQ(std::get<Rectangle>(shape(2)).half_u, (Vec3{2, 0, 0}));
    EXPECT_EQ(std::get<Rectangle>(shape(2)).half_v, (Vec3{0, 0, 3}));
    EXPECT_EQ(std::get<Rectangle>(shape(3)).half_v, (Vec3{0, 1, 0}));
    EXPECT_EQ(std::get<Disk>(shape(4)).normal, (Vec3{0, 2, 0}));
    EXPECT_EQ(std::get<Disk>(shape(4)).radius, 4);
    EXPECT_EQ(std::get<Disk>(shape(5)).normal, (Vec3{0, 0, 1}));
    const Mesh& mesh = s.meshes[index(std::get<MeshId>(shape(6)))];
    EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 2}));
    EXPECT_EQ(mesh.normals[2], (Vec3{0, 1, 1}));
    EXPECT_EQ(mesh.uvs[1], (Vec2{1, 0}));
    // Nothing was said about their looks: all share one neutral grey.
    ASSERT_EQ(s.materials.size(), 1u);
    const auto& grey = std::get<DiffuseMaterial>(s.materials[0]);
    EXPECT_TRUE(grey.two_sided);
    EXPECT_EQ(std::get<ConstantTexture>(s.textures[index(grey.reflectance)]).value, (Rgb{0.5f, 0.5f, 0.5f}));
}

TEST(NativeScene, InstancesShareOneMesh) {
    const LoadedScene loaded = load_good(scene_with(R"("shapes": {
        "tri": {"type": "mesh", "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]]},
        "ball": {"type": "sphere", "radius": 2}, "quad": {"type": "rectangle"}, "coin": {"type": "disk"}},
        "objects": [{"type": "instance", "shape": "tri"}, {"type": "instance", "shape": "tri", "transform": {"translate": [1, 0, 0]}},
                    {"type": "instance", "shape": "ball"}, {"type": "instance", "shape": "ball"},
                    {"type": "instance", "shape": "quad"}, {"type": "instance", "shape": "coin"}])"));
    const Scene& s = loaded.scene;
    EXPECT_EQ(s.meshes.size(), 1u);
    EXPECT_EQ(s.shapes.size(), 4u);
    ASSERT_EQ(s.instances.size(), 6u);
    EXPECT_EQ(s.instances[0].shape, s.instances[1].shape);
    EXPECT_EQ(s.instances[2].shape, s.instances[3].shape);
    EXPECT_EQ(s.instances[1].world_from_object, translation(1, 0, 0));
}

// A list of names is as long as what it names, or empty when nothing has one.
TEST(NativeScene, WhatHasNoNamesKeepsNone) {
    const std::string sphere = R"({"type": "sphere"})", named = R"({"type": "sphere", "name": "it"})";
    const auto names = [&](const std::string& objects) {
        return load_good(scene_with("\"objects\": [" + objects + "]")).scene.names.instances;
    };
    EXPECT_EQ(names(sphere + "," + sphere), std::vector<std::string>{});
    EXPECT_EQ(names(sphere + "," + sphere + "," + named), (std::vector<std::string>{"", "", "it"}));
    EXPECT_EQ(names(named + "," + sphere), (std::vector<std::string>{"it", ""}));
}

TEST(NativeScene, ObjectsHaveNamesMaterialsAndLights) {
    const LoadedScene loaded = load_good(scene_with(R"("materials": {"m": {"type": "mirror"}}, "objects": [
        {"type": "sphere", "name": "one", "material": "m"}, {"type": "sphere", "material": {"type": "glass"}},
        {"type": "disk", "name": "lamp", "light": {"type": "area", "radiance": [1, 2, 3], "two_sided": true, "light_samples": 4}},
        {"type": "disk", "material": "m", "light": {"radiance": 5}}])"));
    const Scene& s = loaded.scene;
    EXPECT_EQ(s.names.instances, (std::vector<std::string>{"one", "", "lamp", ""}));
    EXPECT_TRUE(std::holds_alternative<MirrorMaterial>(s.materials[index(s.instances[0].material)]));
    EXPECT_TRUE(std::holds_alternative<GlassMaterial>(s.materials[index(s.instances[1].material)]));
    ASSERT_EQ(s.lights.size(), 2u);
    const auto& lamp = std::get<AreaLight>(s.lights[0]);
    EXPECT_EQ(index(lamp.instance), 2u);
    EXPECT_EQ(lamp.radiance, (Rgb{1, 2, 3}));
    EXPECT_TRUE(lamp.two_sided);
    EXPECT_EQ(lamp.samples, 4u);
    const auto& other = std::get<AreaLight>(s.lights[1]);
    EXPECT_EQ(index(other.instance), 3u);
    EXPECT_EQ(other.radiance, (Rgb{5, 5, 5}));
    EXPECT_FALSE(other.two_sided);
    EXPECT_EQ(other.samples, 1u);
    // An emitter without a material reflects nothing.
    const auto& black = std::get<DiffuseMaterial>(s.materials[index(s.instances[2].material)]);
    EXPECT_EQ(std::get<ConstantTexture>(s.textures[index(black.reflectance)]).value, (Rgb{0, 0, 0}));
    EXPECT_EQ(s.instances[3].material, s.instances[0].material);
}

TEST(NativeScene, Lights) {
    const LoadedScene loaded = load_good(scene_with(R"("objects": [{"type": "sphere", "name": "bulb"}], "lights": [
        {"type": "point", "name": "p", "position": [1, 2, 3], "intensity": [1, 2, 3]},
        {"type": "point", "position": [1, 2, 3], "flux": [17, 12, 5]},
        {"type": "spot", "position": [0, 2, 0], "direction": [0, -3, 0], "intensity": 4, "inner_angle": 10, "outer_angle": 20},
        {"type": "spot", "position": [0, 2, 0], "look_at": [3, 2, 4], "intensity": 4, "outer_angle": 30},
        {"type": "directional", "direction": [1, -1, 0], "irradiance": 3},
        {"type": "area", "name": "a", "object": "bulb", "radiance": 2, "two_sided": true, "light_samples": 3},
        {"type": "environment", "radiance": [1, 2, 4], "scale": 0.5, "light_samples": 2}])"));
    const auto& l = loaded.scene.lights;
    ASSERT_EQ(l.size(), 7u);
    EXPECT_EQ(loaded.scene.names.lights, (std::vector<std::string>{"p", "", "", "", "", "a", ""}));
    EXPECT_EQ(std::get<PointLight>(l[0]).position, (Vec3{1, 2, 3}));
    EXPECT_EQ(std::get<PointLight>(l[0]).intensity, (Rgb{1, 2, 3}));
    const double sphere = 4 * std::numbers::pi;
    EXPECT_EQ(std::get<PointLight>(l[1]).intensity, (Rgb{float(17 / sphere), float(12 / sphere), float(5 / sphere)}));
    const auto& spot = std::get<SpotLight>(l[2]);
    EXPECT_EQ(spot.direction, (Vec3{0, -3, 0}));
    EXPECT_EQ(spot.inner_angle, 10);
    EXPECT_EQ(spot.outer_angle, 20);
    const auto& aimed = std::get<SpotLight>(l[3]);
    EXPECT_EQ(aimed.direction, (Vec3{0.6f, 0, 0.8f}));
    EXPECT_EQ(aimed.inner_angle, 20);
    EXPECT_EQ(std::get<DirectionalLight>(l[4]).direction, (Vec3{1, -1, 0}));
    EXPECT_EQ(std::get<DirectionalLight>(l[4]).irradiance, (Rgb{3, 3, 3}));
    const auto& area = std::get<AreaLight>(l[5]);
    EXPECT_EQ(index(area.instance), 0u);
    EXPECT_EQ(area.radiance, (Rgb{2, 2, 2}));
    EXPECT_TRUE(area.two_sided);
    EXPECT_EQ(area.samples, 3u);
    const auto& environment = std::get<EnvironmentLight>(l[6]);
    EXPECT_EQ(environment.radiance, (Rgb{0.5f, 1, 2}));
    EXPECT_FALSE(environment.image);
    EXPECT_EQ(environment.samples, 2u);
}

TEST(NativeScene, HiddenLightsAndSuns) {
    const LoadedScene loaded = load_good(scene_with(R"("objects": [
        {"type": "sphere", "light": {"radiance": 1, "visible_to_camera": false}},
        {"type": "sphere", "name": "bulb"}], "lights": [
        {"type": "directional", "direction": [1, -1, 0], "irradiance": 3, "angular_diameter": 0.53, "visible_to_camera": false},
        {"type": "area", "object": "bulb", "radiance": 2, "visible_to_camera": false},
        {"type": "environment", "radiance": 1, "visible_to_camera": false}])"));
    const auto& l = loaded.scene.lights;
    EXPECT_FALSE(std::get<AreaLight>(l[0]).visible_to_camera);
    EXPECT_EQ(std::get<DirectionalLight>(l[1]).angular_diameter, 0.53f);
    EXPECT_FALSE(std::get<DirectionalLight>(l[1]).visible_to_camera);
    EXPECT_FALSE(std::get<AreaLight>(l[2]).visible_to_camera);
    EXPECT_FALSE(std::get<EnvironmentLight>(l[3]).visible_to_camera);
}

TEST(NativeScene, TexturedLights) {
    const LoadedScene loaded = load_good(scene_with(R"("textures": {"screen": {"type": "checkerboard"}}, "objects": [
        {"type": "sphere", "light": {"radiance": 3, "texture": "screen"}},
        {"type": "sphere", "name": "bulb"}], "lights": [
        {"type": "area", "object": "bulb", "radiance": 2, "texture": {"type": "vertex_color"}}])"));
    const auto& first = std::get<AreaLight>(loaded.scene.lights[0]);
    ASSERT_TRUE(first.texture);
    EXPECT_TRUE(std::holds_alternative<CheckerTexture>(loaded.scene.textures[index(*first.texture)]));
    EXPECT_EQ(first.radiance, (Rgb{3, 3, 3}));
    const auto& second = std::get<AreaLight>(loaded.scene.lights[1]);
    ASSERT_TRUE(second.texture);
    EXPECT_TRUE(std::holds_alternative<VertexColorTexture>(loaded.scene.textures[index(*second.texture)]));
}

/// A light may be as bright as it likes. What is named is warned about once, where it stands.
TEST(NativeScene, OnlyWhatReflectsShouldNotExceedOne) {
    const auto warnings = [](const std::string& use) {
        return load_good(scene_with(R"("textures": {"t": {"type": "checkerboard", "color1": [0, 4, 0]}},
            "materials": {"shining": {"type": "open_pbr", "emission_luminance": 1, "emission_color": "t"}},
            "objects": [{"type": "sphere", "name": "bulb"})" +
                                    use))
            .diagnostics.warnings();
    };
    const std::string light = R"(], "lights": [{"type": "area", "object": "bulb", "radiance": 1, "texture": )";
    EXPECT_TRUE(warnings(light + "\"t\"}]").empty());
    EXPECT_TRUE(warnings(light + R"({"type": "constant", "color": 5}}])").empty());
    const std::string reflecting = R"(, {"type": "sphere", "material": {"type": "diffuse", "reflectance": "t"}})";
    const std::vector<Warning> once = warnings(reflecting + reflecting + light + "\"t\"}]");
    ASSERT_EQ(once.size(), 1u);
    EXPECT_EQ(once[0].count, 1u);
    EXPECT_NE(once[0].message.find("reflectance above 1"), std::string::npos) << once[0].message;
    const std::vector<Warning> at_place = warnings(
        R"(, {"type": "sphere", "material": {"type": "diffuse", "reflectance": {"type": "constant", "color": 5}}}])");
    ASSERT_EQ(at_place.size(), 1u);
    EXPECT_GT(at_place[0].where.line, once[0].where.line);
}

/// The flux of a spot is its intensity integrated over directions; here by the midpoint rule over the cosine, with the
/// smoothstep written out once more.
TEST(NativeScene, TheFluxOfASpotIsItsIntegratedIntensity) {
    for (const auto& [inner, outer] : {std::pair{10.0, 20.0}, {0.0, 90.0}, {45.0, 45.0}, {100.0, 180.0}, {0.5, 0.75}}) {
        const LoadedScene loaded = load_good(scene_with_light(
            "{\"type\": \"spot\", \"position\": [0, 0, 0], \"direction\": [0, 0, 1], \"flux\": 10, \"inner_angle\": " +
            std::to_string(inner) + ", \"outer_angle\": " + std::to_string(outer) + "}"));
        const double intensity = std::get<SpotLight>(loaded.scene.lights[0]).intensity.r;
        const double ci = std::cos(inner * std::numbers::pi / 180), co = std::cos(outer * std::numbers::pi / 180);
        constexpr int kSteps = 1'000'000;
        double integral = 0;
        for (int i = 0; i < kSteps; ++i) {
            const double c = co + (1 - co) * (i + 0.5) / kSteps;
            const double t = c >= ci ? 1 : (c - co) / (ci - co);
            integral += t * t * (3 - 2 * t) * (1 - co) / kSteps;
        }
        EXPECT_NEAR(intensity * 2 * std::numbers::pi * integral / 10, 1, 1e-5) << inner << " " << outer;
    }
}

TEST(NativeScene, NormalAndBumpMaps) {
    const LoadedScene loaded =
        load_good(scene_with(R"("textures": {"flat": {"type": "constant", "color": [0.5, 0.5, 1]}},
        "materials": {
            "plain": {"type": "mirror"},
            "short": {"type": "glass", "normal_map": "flat"},
            "long": {"type": "diffuse", "reflectance": 0.5, "normal_map": {"texture": "flat", "strength": 2, "flip_y": true}},
            "bumpy": {"type": "open_pbr", "bump_map": {"texture": {"type": "checkerboard"}, "scale": -0.5}}})"));
    const Scene& scene = loaded.scene;
    ASSERT_EQ(scene.reliefs.size(), 3u);
    EXPECT_EQ(index(scene.reliefs[0].material), 1u);
    const auto& first = std::get<NormalMap>(scene.reliefs[0].map);
    EXPECT_EQ(index(first.texture), 0u);
    EXPECT_EQ(first.strength, 1);
    EXPECT_FALSE(first.flip_y);
    EXPECT_EQ(index(scene.reliefs[1].material), 2u);
    EXPECT_EQ(std::get<NormalMap>(scene.reliefs[1].map).strength, 2);
    EXPECT_TRUE(std::get<NormalMap>(scene.reliefs[1].map).flip_y);
    EXPECT_EQ(index(scene.reliefs[2].material), 3u);
    const auto& bump = std::get<BumpMap>(scene.reliefs[2].map);
    EXPECT_EQ(bump.scale, -0.5f);
    EXPECT_TRUE(std::holds_alternative<CheckerTexture>(scene.textures[index(bump.texture)]));
}

TEST(NativeScene, NormalMapsMayBeTexturesInPlace) {
    const LoadedScene loaded = load_good(scene_with(R"("materials": {
        "a": {"type": "diffuse", "reflectance": 0.5, "normal_map": {"type": "constant", "color": [0.5, 0.5, 1]}},
        "b": {"type": "open_pbr", "geometry_coat_normal": {"type": "checkerboard"}}})"));
    const Scene& s = loaded.scene;
    ASSERT_EQ(s.reliefs.size(), 1u);
    const auto& map = std::get<NormalMap>(s.reliefs[0].map);
    EXPECT_EQ(std::get<ConstantTexture>(s.textures[index(map.texture)]).value, (Rgb{0.5f, 0.5f, 1}));
    EXPECT_EQ(map.strength, 1);
    const auto& coat = std::get<OpenPbrMaterial>(s.materials.at(1)).geometry_coat_normal;
    ASSERT_TRUE(coat);
    EXPECT_TRUE(std::holds_alternative<CheckerTexture>(s.textures[index(coat->texture)]));
}

TEST(NativeScene, MixesAndColoursOfVertices) {
    const LoadedScene loaded = load_good(scene_with(R"("textures": {"c": {"type": "vertex_color"}}, "materials": {
            "a": {"type": "diffuse", "reflectance": "c"}, "b": {"type": "mirror"},
            "m": {"type": "mix", "materials": ["b", "a"]},
            "n": {"type": "mix", "materials": ["m", {"type": "glass"}], "weight": "c"}},
        "objects": [{"type": "mesh", "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]],
            "colors": [[1, 0, 0], [0, 0.5, 0], [0, 0, 2]], "material": "n"}])"));
    const Scene& s = loaded.scene;
    EXPECT_TRUE(std::holds_alternative<VertexColorTexture>(s.textures.at(0)));
    const auto& m = std::get<MixMaterial>(s.materials.at(2));
    EXPECT_EQ(index(m.first), 1u);
    EXPECT_EQ(index(m.second), 0u);
    EXPECT_EQ(m.weight.value, 0.5f);
    const auto& n = std::get<MixMaterial>(s.materials.at(4));
    EXPECT_EQ(index(n.first), 2u);
    EXPECT_EQ(index(n.second), 3u);
    EXPECT_EQ(n.weight.value, 1);
    EXPECT_EQ(n.weight.texture, TextureId{0});
    EXPECT_EQ(s.meshes.at(0).colors, (std::vector<Rgb>{{1, 0, 0}, {0, 0.5f, 0}, {0, 0, 2}}));
}

TEST(NativeScene, TexturesAreTurned) {
    const LoadedScene loaded = load_good(scene_with(
        R"("textures": {"a": {"type": "checkerboard", "rotation": 30, "scale": 2, "offset": [1, 2]}, "b": {"type": "checkerboard"}})"));
    EXPECT_EQ(std::get<CheckerTexture>(loaded.scene.textures[0]).rotation, 30);
    EXPECT_EQ(std::get<CheckerTexture>(loaded.scene.textures[0]).offset, (Vec2{1, 2}));
    EXPECT_EQ(std::get<CheckerTexture>(loaded.scene.textures[1]).rotation, 0);
}

TEST(NativeScene, WeightsAreClampedAndNoReflectance) {
    for (const char* use : {R"({"type": "open_pbr", "fuzz_weight": {"type": "constant", "color": 3}})",
                            R"({"type": "glass", "roughness": {"type": "constant", "color": 3}})"})
        EXPECT_TRUE(
            load_good(scene_with("\"materials\": {\"a\": " + std::string(use) + "}")).diagnostics.warnings().empty());
}

}  // namespace
}  // namespace steradian::test
