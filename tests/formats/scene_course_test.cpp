// The course's vocabulary: its own scenes where they are at hand, and its words one by one.
#include <numbers>

#include "formats/scene_test.h"
#include "math/transform.h"
#include "steradian/image_io.h"

namespace steradian::test {
namespace {

class CourseFiles : public testing::Test {
protected:
    void SetUp() override {
        const auto shared = shared_folder();
        if (!shared) GTEST_SKIP() << "the folder of outside test files is missing";
        folder_ = *shared / "scenes" / "cs171";
    }
    LoadedScene load(std::string_view name) const {
        auto loaded = load_scene((folder_ / name).string());
        if (!loaded) throw std::runtime_error(loaded.error().str());
        return std::move(loaded).value();
    }
    std::filesystem::path folder_;
};

Rgb reflectance_of(const LoadedScene& loaded, size_t instance) {
    const Scene& s = loaded.scene;
    const auto& diffuse = std::get<DiffuseMaterial>(s.materials[index(s.instances.at(instance).material)]);
    return std::get<ConstantTexture>(s.textures[index(diffuse.reflectance)]).value;
}

void expect_course_camera(const Scene& scene) {
    const auto& camera = std::get<PerspectiveCamera>(scene.cameras.at(0));
    EXPECT_EQ(camera.position, (Vec3{0, 1, 6.8f}));
    EXPECT_EQ(camera.look_at, (Vec3{0, 1, 0}));
    EXPECT_EQ(camera.up, (Vec3{0, 1, 0}));
    EXPECT_EQ(camera.vertical_fov, 19.5f);
}

void expect_path(const LoadedScene& loaded, LightSampling sampling, std::string_view warning) {
    EXPECT_EQ(loaded.settings.integrator, IntegratorKind::path);
    EXPECT_EQ(loaded.settings.light_sampling, sampling);
    if (warning.empty()) {
        EXPECT_TRUE(loaded.diagnostics.empty());
        return;
    }
    ASSERT_EQ(loaded.diagnostics.warnings().size(), 1u);
    EXPECT_EQ(loaded.diagnostics.warnings()[0].message, warning);
    EXPECT_EQ(loaded.diagnostics.warnings()[0].where.line, 3u);
}

TEST_F(CourseFiles, CornellBoxWithAnAreaLight) {
    const LoadedScene loaded = load("cbox.json");
    expect_course_camera(loaded.scene);
    expect_path(loaded, LightSampling::mis, "the integrator 'bdpt' is not there: rendered with 'path'");
    EXPECT_EQ(loaded.settings.width, 256u);
    EXPECT_EQ(loaded.settings.samples_per_pixel, 128u);
    EXPECT_EQ(loaded.settings.max_depth, 12u);
    EXPECT_EQ(loaded.settings.filter, (Filter{FilterKind::box, 0.5f}));
    EXPECT_EQ(loaded.scene.instances.size(), 8u);
    ASSERT_EQ(loaded.scene.lights.size(), 1u);
    const auto& light = std::get<AreaLight>(loaded.scene.lights[0]);
    EXPECT_EQ(index(light.instance), 0u);
    EXPECT_EQ(light.radiance, (Rgb{17, 12, 5}));
    EXPECT_FALSE(light.two_sided);
    EXPECT_EQ(reflectance_of(loaded, 0), (Rgb{0, 0, 0}));
    EXPECT_EQ(reflectance_of(loaded, 1), (Rgb{0.63f, 0.065f, 0.05f}));
    EXPECT_EQ(reflectance_of(loaded, 2), (Rgb{0.14f, 0.45f, 0.091f}));
    EXPECT_EQ(reflectance_of(loaded, 3), (Rgb{0.725f, 0.71f, 0.68f}));
    EXPECT_EQ(loaded.scene.instances[6].world_from_object, translation(-0.7f, 0, 0.6f));
    EXPECT_EQ(loaded.scene.instances[7].world_from_object, translation(0.7f, 0, -0.5));
}

TEST_F(CourseFiles, CornellBoxWithThePointLightOfTheIntegrator) {
    for (const char* name : {"cbox_no_light.json", "cbox_no_light_refract.json"}) {
        const LoadedScene loaded = load(name);
        expect_course_camera(loaded.scene);
        EXPECT_TRUE(loaded.diagnostics.empty());
        EXPECT_EQ(loaded.settings.integrator, IntegratorKind::direct);
        EXPECT_EQ(loaded.settings.samples_per_pixel, 32u);
        EXPECT_EQ(loaded.settings.max_depth, 16u);
        EXPECT_EQ(loaded.settings.width, 512u);
        ASSERT_EQ(loaded.scene.lights.size(), 1u);
        const auto& light = std::get<PointLight>(loaded.scene.lights[0]);
        EXPECT_EQ(light.position, (Vec3{0, 1.5f, 0.5f}));
        const double sphere = 4 * std::numbers::pi;
        EXPECT_EQ(light.intensity, (Rgb{float(17 / sphere), float(12 / sphere), float(5 / sphere)}));
    }
    const LoadedScene refract = load("cbox_no_light_refract.json");
    ASSERT_EQ(refract.scene.instances.size(), 8u);
    EXPECT_EQ(std::get<RefractionMaterial>(refract.scene.materials[index(refract.scene.instances[7].material)]).eta, 2);
}

TEST_F(CourseFiles, Spheres) {
    const LoadedScene one = load("sphere.json");
    expect_path(one, LightSampling::mis, "");
    EXPECT_EQ(std::get<EnvironmentLight>(one.scene.lights.at(0)).radiance, (Rgb{1, 1, 1}));
    EXPECT_EQ(std::get<Sphere>(one.scene.shapes.at(0)).center, (Vec3{0, 1, 0}));
    EXPECT_EQ(reflectance_of(one, 0), (Rgb{1, 1, 1}));

    const LoadedScene two = load("two_spheres.json");
    expect_path(two, LightSampling::mis, "the integrator 'bdpt' is not there: rendered with 'path'");
    EXPECT_EQ(two.settings.filter, (Filter{FilterKind::gaussian, 1.5f}));
    ASSERT_EQ(two.scene.instances.size(), 2u);
    EXPECT_TRUE(two.scene.meshes.empty());
    EXPECT_EQ(std::get<Sphere>(two.scene.shapes[0]).radius, 0.3f);
    EXPECT_EQ(std::get<AreaLight>(two.scene.lights.at(0)).radiance, (Rgb{5, 5, 5}));

    const LoadedScene glass = load("glass_cbox.json");
    const Scene& s = glass.scene;
    const auto& material = std::get<GlassMaterial>(s.materials[index(s.instances.back().material)]);
    EXPECT_EQ(material.eta, 1.5f);
    EXPECT_EQ(material.reflectance, (Rgb{0.8f, 0.2f, 0.7f}));
    EXPECT_EQ(material.transmittance, (Rgb{0.2f, 0.7f, 0.8f}));
}

TEST_F(CourseFiles, RoughConductors) {
    const LoadedScene veach = load("veach.json");
    std::vector<ConductorMaterial> metals;
    for (const Material& material : veach.scene.materials)
        if (const auto* metal = std::get_if<ConductorMaterial>(&material)) metals.push_back(*metal);
    ASSERT_EQ(metals.size(), 4u);
    EXPECT_EQ(metals[1].roughness.value, (Vec2{0.05f, 0.05f}));
    for (const ConductorMaterial& metal : metals) {
        EXPECT_FALSE(metal.roughness.squared);
        EXPECT_EQ(metal.tint, (Rgb{0.3f, 0.3f, 0.3f}));
        EXPECT_EQ(std::get<ComplexIndex>(metal.reflectance).n, (Rgb{0.200438f, 0.924033f, 1.10221f}));
        EXPECT_EQ(std::get<ComplexIndex>(metal.reflectance).k, (Rgb{3.91295f, 2.45285f, 2.14219f}));
    }
}

constexpr std::string_view kCamera = "\"camera\": {\"position\": [0, 0, 5], \"look_at\": [0, 0, 0], \"fov\": 30}";

std::string course(std::string_view members, std::string_view integrator = "{\"type\": \"path\"}") {
    return "{\"integrator\": " + std::string(integrator) + ", " + std::string(kCamera) +
           (members.empty() ? "" : ",\n") + std::string(members) + "}";
}

TEST(CourseScene, EnvironmentMaps) {
    const auto environment = [](std::string_view members) {
        return std::get<EnvironmentLight>(
            load_good(course("\"textures\": {\"sky\": {\"type\": \"constant\", \"color\": [1, 2, 3]}}, "
                             "\"environment_map\": {\"texture_name\": \"sky\"" +
                             std::string(members) + "}"))
                .scene.lights.at(0));
    };
    EXPECT_EQ(environment("").radiance, (Rgb{1, 2, 3}));
    EXPECT_EQ(environment(", \"scale\": 2").radiance, (Rgb{2, 4, 6}));
    EXPECT_EQ(environment(", \"scale\": [1, 0.5, 2]").radiance, (Rgb{1, 1, 6}));
    EXPECT_EQ(environment(", \"transform\": [[0,0,1,0],[0,1,0,0],[-1,0,0,0],[0,0,0,1]]").radiance, (Rgb{1, 2, 3}));

    TemporaryFolder folder;
    Image image{2, 1, {"R", "G", "B"}, {0, 0.5f, 1, 1, 0.5f, 0}, {}};
    ASSERT_TRUE(write_image(folder.file("sky.hdr"), image).ok());
    const std::string textures =
        "\"textures\": {\"sky\": {\"type\": \"image\", \"path\": \"sky.hdr\"}}, \"environment_map\": "
        "{\"texture_name\": \"sky\"";
    for (const double angle : {0.0, 90.0, -45.0, 30.0, 179.0}) {
        const LoadedScene loaded = load_good(
            course(textures + ", \"scale\": 3, \"transform\": [{\"rotate\": {\"axis\": [0, 1, 0], \"angle\": " +
                   std::to_string(angle) + "}}]}"),
            folder.path().string());
        const auto& light = std::get<EnvironmentLight>(loaded.scene.lights.at(0));
        EXPECT_NEAR(light.rotation, angle, 1e-4);
        EXPECT_TRUE(light.image);
        EXPECT_EQ(light.color_space, ColorSpace::linear);
        EXPECT_EQ(light.radiance, (Rgb{3, 3, 3}));
    }
    const auto refused = [&](std::string_view transform) {
        expect_error(course(textures + ", \"transform\": §" + std::string(transform) + "}"),
                     "must be a rotation about the y axis", "not supported", folder.path().string());
    };
    refused("{\"rotate\": {\"axis\": [1, 0, 0], \"angle\": 10}}");
    refused("{\"translate\": [1, 0, 0]}");
    refused("{\"scale\": 2}");
    refused("{\"scale\": [1, 1, -1]}");
}

TEST(CourseScene, TextureCoordinatesAreFlippedLikeTheMeshes) {
    // A point with v upwards of 0.25 has v = 0.75 here; v * 2 + 0.1 = 0.6 upwards is 0.4 downwards.
    const LoadedScene loaded = load_good(course(R"("textures": {"c": {"type": "checkerboard", "color0": 1, "color1": 0,
        "tex_coordinate_generator": {"type": "uvmapping2d", "scale": [3, 2], "delta": [0.5, 0.1]}}})"));
    const auto& checks = std::get<CheckerTexture>(loaded.scene.textures.at(0));
    EXPECT_EQ(checks.scale, (Vec2{3, 2}));
    EXPECT_EQ(checks.offset.x, 0.5f);
    EXPECT_NEAR(0.75 * checks.scale.y + checks.offset.y, 0.4, 1e-6);
}

TEST(CourseScene, MaterialsAndObjects) {
    const LoadedScene loaded = load_good(course(R"("textures": {"t": {"type": "constant", "color": 0.5}}, "materials": {
        "a": {"type": "diffuse", "texture_name": "t", "twosided": true}, "b": {"type": "diffuse", "color": [0.1, 0.2, 0.3]},
        "c": {"type": "refraction"}, "d": {"type": "glass", "eta": 1.2}},
        "objects": [{"type": "sphere", "path": "nothing.obj", "center": [1, 0, 0], "radius": 2, "material_name": "a",
                     "transform": {"scale": 2}, "translate": [0, 0, 1]}])"));
    const auto& m = loaded.scene.materials;
    EXPECT_TRUE(std::get<DiffuseMaterial>(m.at(0)).two_sided);
    EXPECT_FALSE(std::get<DiffuseMaterial>(m.at(1)).two_sided);
    EXPECT_EQ(std::get<RefractionMaterial>(m.at(2)).eta, 1.5f);
    EXPECT_EQ(std::get<GlassMaterial>(m.at(3)).eta, 1.2f);
    EXPECT_EQ(loaded.scene.instances.at(0).world_from_object, translation(0, 0, 1) * scaling(2, 2, 2));
}

TEST(CourseScene, IntegratorsThatAreNotThereBecomePathWithAWarning) {
    for (const char* type : {"bdpt", "photon"}) {
        const LoadedScene loaded = load_good(course("", "{\"type\": \"" + std::string(type) + "\"}"));
        ASSERT_EQ(loaded.diagnostics.warnings().size(), 1u);
        EXPECT_NE(loaded.diagnostics.warnings()[0].message.find(type), std::string::npos);
        EXPECT_EQ(loaded.settings.integrator, IntegratorKind::path);
    }
    const std::pair<const char*, LightSampling> profiles[] = {{"RandomWalk", LightSampling::bsdf},
                                                              {"NextEventEstimation", LightSampling::light},
                                                              {"MIS", LightSampling::mis}};
    for (const auto& [profile, sampling] : profiles) {
        const LoadedScene loaded =
            load_good(course("", "{\"type\": \"path\", \"profile\": \"" + std::string(profile) + "\"}"));
        EXPECT_TRUE(loaded.diagnostics.empty());
        EXPECT_EQ(loaded.settings.integrator, IntegratorKind::path);
        EXPECT_EQ(loaded.settings.light_sampling, sampling);
    }
    const LoadedScene ignored =
        load_good(course("", R"({"type": "path", "point_light_position": [0, 0, 0], "point_light_flux": 1})"));
    EXPECT_EQ(ignored.diagnostics.warnings().size(), 2u);
    EXPECT_TRUE(ignored.scene.lights.empty());
}

TEST(CourseScene, MistakesAreLocated) {
    const auto refused = [](std::string_view members, std::string_view message, std::string_view hint = {}) {
        expect_error(course(members), message, hint);
    };
    const auto refused_integrator = [](std::string_view integrator, std::string_view message,
                                       std::string_view hint = {}) {
        expect_error(course("", integrator), message, hint);
    };
    refused_integrator("{\"type\": §\"mlt\"}", "the type of the integrator cannot be \"mlt\"", "");
    refused_integrator("§{}", "missing key 'type' in 'integrator'");
    refused_integrator("{\"type\": \"path\", \"profile\": §\"mis\"}", "'profile' cannot be \"mis\"",
                       "did you mean 'MIS'?");
    refused_integrator("{\"type\": \"path\", \"spp\": §0}", "'spp' must be a whole number");
    refused_integrator("{\"type\": \"path\", §\"seed\": 0}", "unknown key 'seed' in 'integrator'", "");
    refused_integrator("§{\"type\": \"intersection_test\", \"point_light_flux\": 1}",
                       "missing key 'point_light_position'");
    refused_integrator("§{\"type\": \"intersection_test\", \"point_light_position\": [0, 0, 0]}",
                       "missing key 'point_light_flux'");
    refused("§\"lights\": []", "unknown key 'lights' in the scene", "");
    refused("\"film\": {\"resolution\": §[0]}", "'resolution' must be an array of 2");
    refused("\"materials\": {\"m\": §{\"type\": \"diffuse\"}}", "missing key 'texture_name' in material 'm'");
    refused("\"materials\": {\"m\": {\"type\": \"diffuse\", \"texture_name\": §\"t\"}}",
            "there is no texture called 't'", "the file defines no texture");
    refused("\"materials\": {\"m\": {\"type\": \"glass\", \"eta\": §-1}}", "'eta' must be from 0.001 to 1000");
    refused("\"environment_map\": {\"texture_name\": §\"t\"}", "there is no texture called 't'", "");
    refused("\"textures\": {\"c\": {\"type\": \"checkerboard\"}}, \"environment_map\": {\"texture_name\": §\"c\"}",
            "must be constant or an image");
    refused("\"objects\": [{\"type\": §\"disk\"}]", "the type of an object cannot be \"disk\"", "mesh, sphere");
    refused("\"objects\": [§{\"type\": \"sphere\", \"radius\": 1}]", "missing key 'center' in this sphere");
    refused("\"objects\": [{\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": §-1}]",
            "'radius' must be from 1e-15 to 1e+15, got -1");
    refused("\"objects\": [{\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": 1, \"material_name\": §\"m\"}]",
            "there is no material called 'm'", "");
    refused(
        "\"objects\": [{\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": 1, \"light\": {\"type\": §\"spot\", "
        "\"radiance\": 1}}]",
        "'type' cannot be \"spot\"", "area");
    expect_error(
        "{\"integrator\": {\"type\": \"path\"}, \"camera\": {\"position\": [0, 0, 5], \"look_at\": [0, 0, 0], "
        "\"ref_up\": §[0, 0, 1], \"fov\": 30}}",
        "'ref_up' is parallel to the camera's view");
    expect_error(
        "{\"integrator\": {\"type\": \"path\"}, \"camera\": §{\"position\": [0, 0, 5], \"look_at\": [0, 0, 0]}}",
        "missing key 'fov'");
}

}  // namespace
}  // namespace steradian::test
