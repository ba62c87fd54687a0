// Scenes and the files that they name: models, images, paths; and models by themselves.
#include <sys/stat.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "formats/scene_test.h"
#include "math/vector.h"
#include "steradian/image_io.h"

namespace steradian::test {
namespace {

constexpr std::string_view kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
/// One part for each of two materials, one of which emits.
constexpr std::string_view kTwoParts =
    "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\nusemtl lamp\nf 3 2 1\n";
constexpr std::string_view kTwoMaterials = "newmtl red\nKd 1 0 0\nnewmtl lamp\nKd 0 0 0\nKe 5 4 3\n";

class SceneFiles : public testing::Test {
protected:
    void SetUp() override {
        spit(folder_.path() / "triangle.obj", kTriangle);
        spit(folder_.path() / "two.obj", kTwoParts);
        spit(folder_.path() / "two.mtl", kTwoMaterials);
        Image image{2, 1, {"R", "G", "B"}, {0, 0.5f, 1, 1, 0.5f, 0}, {}};
        for (const char* name : {"image.png", "image.exr", "image.hdr"})
            ASSERT_TRUE(write_image(folder_.file(name), image).ok());
    }
    LoadedScene load(std::string_view text) { return load_good(text, folder_.path().string()); }
    void refused(std::string_view text, std::string_view message, std::string_view hint = {}) {
        expect_error(text, message, hint, folder_.path().string());
    }

    TemporaryFolder folder_;
};

/// What stands between a fence that begins with `fence` and the next one.
std::string code_block(const std::string& text, const std::string& fence, size_t from = 0) {
    const size_t begin = text.find(fence, from);
    if (begin == std::string::npos) return {};
    const size_t first = begin + fence.size();
    return text.substr(first, text.find("```", first) - first);
}

// What a newcomer types first, and the mistake that is shown there.
TEST(Readme, ItsSceneLoadsAndItsMistakeReadsAsPrinted) {
    const std::string readme = slurp(source_folder() / "README.md");
    std::string scene = code_block(readme, "```json\n");
    EXPECT_EQ(load_good(scene).scene.instances.size(), 3u);
    const size_t radius = scene.find("radius");
    ASSERT_NE(radius, std::string::npos);
    const std::string message = code_block(readme, "```\n", readme.find("Mistakes are shown"));
    const auto refused = load_scene_json(scene.replace(radius, 6, "radios"), "first.json", {});
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().str() + "\n", message);
}

TEST_F(SceneFiles, AModelThatIsNamedTwiceIsLoadedOnce) {
    std::filesystem::create_directory(folder_.path() / "sub");
    const LoadedScene loaded =
        load(scene_with(R"("shapes": {"t": {"type": "mesh", "path": "sub/../triangle.obj"}}, "objects": [
        {"type": "mesh", "path": "triangle.obj"}, {"type": "mesh", "path": "./triangle.obj", "transform": {"scale": 2}}, {"type": "instance", "shape": "t"}])"));
    EXPECT_EQ(loaded.scene.meshes.size(), 1u);
    EXPECT_EQ(loaded.scene.shapes.size(), 1u);
    EXPECT_EQ(loaded.scene.instances.size(), 3u);
    EXPECT_EQ(loaded.scene.meshes[0].positions.size(), 3u);
}

TEST_F(SceneFiles, TheMaterialsOfTheFileAreUsedUnlessTheObjectHasOne) {
    const LoadedScene loaded = load(scene_with(R"("materials": {"m": {"type": "mirror"}}, "objects": [
        {"type": "mesh", "path": "two.obj"}, {"type": "mesh", "path": "two.obj"}, {"type": "mesh", "path": "two.obj", "material": "m"}])"));
    const Scene& s = loaded.scene;
    EXPECT_EQ(s.meshes.size(), 2u);
    ASSERT_EQ(s.instances.size(), 6u);
    const auto& red = std::get<DiffuseMaterial>(s.materials[index(s.instances[0].material)]);
    EXPECT_EQ(std::get<ConstantTexture>(s.textures[index(red.reflectance)]).value, (Rgb{1, 0, 0}));
    EXPECT_TRUE(red.two_sided);
    EXPECT_EQ(s.instances[0].material, s.instances[2].material);
    EXPECT_TRUE(std::holds_alternative<MirrorMaterial>(s.materials[index(s.instances[4].material)]));
    EXPECT_EQ(s.instances[4].material, s.instances[5].material);
    EXPECT_EQ(s.materials.size(), 3u);
    // The second part emits in the first two objects, not where another material covers it.
    ASSERT_EQ(s.lights.size(), 2u);
    EXPECT_EQ(index(std::get<AreaLight>(s.lights[0]).instance), 1u);
    EXPECT_EQ(std::get<AreaLight>(s.lights[0]).radiance, (Rgb{5, 4, 3}));
    EXPECT_EQ(index(std::get<AreaLight>(s.lights[1]).instance), 3u);
}

TEST_F(SceneFiles, ALightOnAModelLightsEachPartOnce) {
    const LoadedScene loaded =
        load(scene_with(R"("objects": [{"type": "mesh", "path": "two.obj", "light": {"radiance": 1}}])"));
    ASSERT_EQ(loaded.scene.lights.size(), 2u);
    for (uint32_t i = 0; i < 2; ++i) {
        EXPECT_EQ(index(std::get<AreaLight>(loaded.scene.lights[i]).instance), i);
        EXPECT_EQ(std::get<AreaLight>(loaded.scene.lights[i]).radiance, (Rgb{1, 1, 1}));
    }
    refused(
        scene_with(
            R"("objects": [{"type": "mesh", "name": "two", "path": "two.obj"}], "lights": [{"type": "area", "object": §"two", "radiance": 1}])"),
        "'two' is a light already");
}

/// Integers are sRGB unless the object says otherwise; a model that has colours and no material shows them.
TEST_F(SceneFiles, ColoursOfVerticesAreReadInTheirColourSpace) {
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n"
        "0 0 0 0 128 255\n1 0 0 0 128 255\n0 1 0 0 128 255\n3 0 1 2\n";
    spit(folder_.path() / "painted.ply", text);
    const LoadedScene loaded = load(scene_with(R"("objects": [{"type": "mesh", "path": "painted.ply"},
        {"type": "mesh", "path": "painted.ply", "color_space": "linear"}])"));
    ASSERT_EQ(loaded.scene.meshes.size(), 2u);
    EXPECT_NEAR(loaded.scene.meshes[0].colors.at(0).g, 0.2158605f, 1e-6);
    EXPECT_EQ(loaded.scene.meshes[1].colors.at(0).g, 128 / 255.0f);
    for (const Instance& instance : loaded.scene.instances) {
        const auto& material = std::get<DiffuseMaterial>(loaded.scene.materials[index(instance.material)]);
        EXPECT_TRUE(material.two_sided);
        EXPECT_TRUE(std::holds_alternative<VertexColorTexture>(loaded.scene.textures[index(material.reflectance)]));
    }
}

/// Normals and heights are not colours.
TEST_F(SceneFiles, ImagesOfNumbersAreLinear) {
    const LoadedScene loaded = load(scene_with(R"("materials": {
        "a": {"type": "mirror", "normal_map": {"texture": {"type": "image", "path": "image.png"}}},
        "b": {"type": "mirror", "bump_map": {"texture": {"type": "image", "path": "image.png", "color_space": "linear"}}}})"));
    ASSERT_EQ(loaded.scene.textures.size(), 2u);
    for (const Texture& texture : loaded.scene.textures)
        EXPECT_EQ(std::get<ImageTexture>(texture).color_space, ColorSpace::linear);
    refused(scene_with(R"("textures": {"n": {"type": "image", "path": "image.png"}},
        "materials": {"a": {"type": "mirror", "normal_map": §"n"}})"),
            "its texture must be linear");
    refused(scene_with(R"("materials": {"a": {"type": "mirror", "bump_map": {"texture":
        §{"type": "image", "path": "image.png", "color_space": "srgb"}}}})"),
            "its texture must be linear");
}

TEST_F(SceneFiles, ImagesAreReadOnceAndInTheirColourSpace) {
    const LoadedScene loaded = load(scene_with(R"("textures": {
        "a": {"type": "image", "path": "image.png"}, "b": {"type": "image", "path": "./image.png", "color_space": "linear"},
        "c": {"type": "image", "path": "image.exr"}, "d": {"type": "image", "path": "image.hdr", "color_space": "srgb"},
        "e": {"type": "image", "path": "image.png", "wrap": ["mirror", "black"], "filter": "nearest", "scale": 2, "offset": [0.5, 1]},
        "f": {"type": "image", "path": "image.png", "wrap": "clamp"}}, "lights": [
        {"type": "environment", "path": "image.hdr", "radiance": [1, 2, 3], "scale": 2, "rotation": 90, "light_samples": 5}])"));
    const Scene& s = loaded.scene;
    EXPECT_EQ(s.images.size(), 3u);
    const auto texture = [&](size_t i) { return std::get<ImageTexture>(s.textures[i]); };
    EXPECT_EQ(texture(0).image, texture(1).image);
    EXPECT_EQ(texture(0).color_space, ColorSpace::srgb);
    EXPECT_EQ(texture(1).color_space, ColorSpace::linear);
    EXPECT_EQ(texture(2).color_space, ColorSpace::linear);
    EXPECT_EQ(texture(3).color_space, ColorSpace::srgb);
    EXPECT_EQ(texture(0).wrap_u, Wrap::repeat);
    EXPECT_TRUE(texture(0).bilinear);
    EXPECT_EQ(texture(4).wrap_u, Wrap::mirror);
    EXPECT_EQ(texture(4).wrap_v, Wrap::black);
    EXPECT_FALSE(texture(4).bilinear);
    EXPECT_EQ(texture(4).scale, (Vec2{2, 2}));
    EXPECT_EQ(texture(4).offset, (Vec2{0.5f, 1}));
    EXPECT_EQ(texture(5).wrap_u, Wrap::clamp);
    EXPECT_EQ(texture(5).wrap_v, Wrap::clamp);
    const auto& environment = std::get<EnvironmentLight>(s.lights.at(0));
    EXPECT_EQ(environment.image, texture(3).image);
    EXPECT_EQ(environment.radiance, (Rgb{2, 4, 6}));
    EXPECT_EQ(environment.rotation, 90);
    EXPECT_EQ(environment.color_space, ColorSpace::linear);
    EXPECT_EQ(environment.samples, 5u);
    const LoadedScene png = load(scene_with_light(R"({"type": "environment", "path": "image.png"})"));
    EXPECT_EQ(std::get<EnvironmentLight>(png.scene.lights.at(0)).color_space, ColorSpace::srgb);
}

TEST_F(SceneFiles, FilesThatCannotBeReadAreReportedWhereTheyAreNamed) {
    const auto object = [](std::string_view path) {
        return scene_with_object("{\"type\": \"mesh\",\n \"path\": §\"" + std::string(path) + "\"}");
    };
    refused(object("missing.obj"), "missing.obj: cannot open the file: No such file or directory");
    std::filesystem::create_directory(folder_.path() / "folder.obj");
    refused(object("folder.obj"), "this is a folder, expected a regular file");
    ASSERT_EQ(::mkfifo(folder_.file("pipe.obj").c_str(), 0600), 0);
    refused(object("pipe.obj"), "this is a pipe, expected a regular file");
    refused(object(""), "the path is empty");
    refused(object("model.stl"), "");
    refused(object("a\\u0000b.obj"), "NUL");
    refused(object(std::string(5000, 'x') + ".obj"), "cannot open the file: File name too long");
    refused(object("a%20b.obj"), "a%20b.obj: cannot open the file");
    for (const char* address : {"http://example.org/a.obj", "https://example.org/a.obj", "file:///etc/passwd",
                                "FILE:a.obj", "ftp://h/a.obj", "data:text/plain,v"})
        refused(object(address), "this is an address, expected a path: nothing is fetched");
}

TEST_F(SceneFiles, NamesWithSpacesAndUnicodeWork) {
    for (const char* name : {"a b.obj", "ä€😀.obj", "-leading.obj", "c:colon.obj"}) {
        spit(folder_.path() / name, kTriangle);
        EXPECT_EQ(load(scene_with_object("{\"type\": \"mesh\", \"path\": \"" + std::string(name) + "\"}"))
                      .scene.meshes.size(),
                  1u);
    }
}

TEST_F(SceneFiles, AnErrorInsideAModelKeepsItsPlaceAndSaysWhoNamedIt) {
    spit(folder_.path() / "broken.obj", "v 0 0 0\nv 1 0 x\n");
    const auto loaded =
        load_text(scene_with_object(R"({"type": "mesh", "path": "broken.obj"})"), folder_.path().string());
    ASSERT_FALSE(loaded.ok());
    EXPECT_TRUE(loaded.error().where.file.ends_with("broken.obj"));
    EXPECT_EQ(loaded.error().where.line, 2u);
    EXPECT_NE(loaded.error().hint.find("the file is named at test.json:2:38"), std::string::npos)
        << loaded.error().str();
}

TEST_F(SceneFiles, PathsOutOfTheFolderCanBeForbidden) {
    std::filesystem::create_directory(folder_.path() / "inner");
    spit(folder_.path() / "inner" / "triangle.obj", kTriangle);
    std::filesystem::create_symlink("../triangle.obj", folder_.path() / "inner" / "link.obj");
    const std::string inner = (folder_.path() / "inner").string();
    LoadOptions confined;
    confined.allow_outside_paths = false;
    const auto load_path = [&](const std::string& path, const LoadOptions& options) {
        return load_scene_json(scene_with_object("{\"type\": \"mesh\", \"path\": \"" + path + "\"}"), "test.json",
                               inner, options);
    };
    const std::string absolute = inner + "/triangle.obj";
    for (const std::string& path : {std::string("triangle.obj"), std::string("./../inner/triangle.obj")})
        EXPECT_TRUE(load_path(path, confined).ok()) << path;
    for (const std::string& path :
         {std::string("../triangle.obj"), std::string("x/../../triangle.obj"), std::string("link.obj"), absolute}) {
        EXPECT_TRUE(load_path(path, {}).ok() || path.starts_with("x/")) << path;
        const auto loaded = load_path(path, confined);
        ASSERT_FALSE(loaded.ok()) << path;
        EXPECT_NE(loaded.error().hint.find("not allowed"), std::string::npos) << loaded.error().str();
        EXPECT_EQ(loaded.error().where.line, 2u);
    }
    // The same for images that a model's materials name.
    std::filesystem::copy(folder_.path() / "image.png", folder_.path() / "inner" / "inside.png");
    for (const auto& [image, allowed] :
         {std::pair<std::string, bool>{"inside.png", true}, {"../image.png", false}, {"http://h/i.png", false}}) {
        spit(folder_.path() / "inner" / "map.mtl", "newmtl m\nmap_Kd " + image + "\n");
        spit(folder_.path() / "inner" / "map.obj", "mtllib map.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
        EXPECT_EQ(load_path("map.obj", confined).ok(), allowed) << image;
    }
}

TEST_F(SceneFiles, RelativePathsStartAtTheSceneFile) {
    const std::string path = folder_.file("scene.json");
    spit(path, scene_with_object(R"({"type": "mesh", "path": "triangle.obj"})"));
    const auto loaded = load_scene(path);
    ASSERT_TRUE(loaded.ok()) << loaded.error().str();
    EXPECT_EQ(loaded->scene.meshes.size(), 1u);
}

TEST_F(SceneFiles, TheFormatIsToldByTheExtension) {
    const auto error = [&](const std::string& name) { return load_scene(folder_.file(name)).error(); };
    EXPECT_NE(error("scene.fbx").message.find("unknown kind of scene file '.fbx'"), std::string::npos);
    EXPECT_EQ(error("scene.fbx").hint, "expected one of .json, .gltf, .glb, .obj, .ply");
    EXPECT_NE(error("scene.jsn").hint.find("did you mean '.json'?"), std::string::npos);
    EXPECT_NE(error("scene").message.find("needs an extension"), std::string::npos);
    EXPECT_NE(error("missing.json").message.find("No such file"), std::string::npos);
    spit(folder_.path() / "empty.json", "");
    EXPECT_NE(error("empty.json").message.find("empty"), std::string::npos);
    spit(folder_.path() / "UPPER.OBJ", kTriangle);
    EXPECT_TRUE(load_scene(folder_.file("UPPER.OBJ")).ok());
}

TEST_F(SceneFiles, FilesOverTheLimitAreRefused) {
    spit(folder_.path() / "scene.json", scene_with(""));
    LoadOptions options;
    options.max_file_bytes = 10;
    const auto loaded = load_scene(folder_.file("scene.json"), options);
    ASSERT_FALSE(loaded.ok());
    EXPECT_EQ(loaded.error().code, ErrorCode::resources);
}

TEST_F(SceneFiles, WithoutFacesThereIsNothingToLight) {
    spit(folder_.path() / "points.obj", "v 0 0 0\n");
    const LoadedScene loaded = load(scene_with_object(R"({"type": "mesh", "path": "points.obj"})"));
    EXPECT_TRUE(loaded.scene.instances.empty());
    EXPECT_FALSE(loaded.diagnostics.empty());
    refused(scene_with_object(R"({"type": "mesh", "path": "points.obj", §"light": {"radiance": 1}})"),
            "without faces cannot be a light");
    const auto model = load_scene(folder_.file("points.obj"));
    ASSERT_FALSE(model.ok());
    EXPECT_NE(model.error().message.find("no faces"), std::string::npos);
}

TEST_F(SceneFiles, AModelWithoutUsableVerticesSaysWhyThereIsNothing) {
    spit(folder_.path() / "nan.obj", "v nan 0 0\nv 1 nan 0\nv 0 1 inf\nf 1 2 3\nf 3 2 1\n");
    spit(folder_.path() / "far.ply",
         "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
         "1e16 0 0\n0 1e16 0\n0 0 1e16\n3 0 1 2\n");
    const auto message = [&](const char* name) { return load_scene(folder_.file(name)).error().message; };
    EXPECT_EQ(message("nan.obj"),
              "there is nothing to render: all 2 faces have coordinates that are not finite or beyond 1e15");
    EXPECT_EQ(message("far.ply"),
              "there is nothing to render: the only face has coordinates that are not finite or beyond 1e15");
}

TEST_F(SceneFiles, ReflectancesOfMtlAboveOneAreCountedWithThePlaceOfTheFirst) {
    spit(folder_.path() / "bright.mtl",
         "newmtl white\nKd 1 1 1\nnewmtl bright\nKd 1 1.5 1\nnewmtl mirror\nillum 3\nKs 2 2 2\nnewmtl glass\nillum 7\n"
         "Tf 3\nnewmtl unused\nKd 4 4 4\nnewmtl dark\nKd -1 0 0\n");
    std::string text = "mtllib bright.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (const char* name : {"white", "bright", "mirror", "glass", "dark"})
        text += "usemtl " + std::string(name) + "\nf 1 2 3\n";
    spit(folder_.path() / "bright.obj", text);
    const LoadedScene loaded = load_scene(folder_.file("bright.obj")).value();
    ASSERT_EQ(loaded.diagnostics.warnings().size(), 2u);
    const Warning& clamped = loaded.diagnostics.warnings()[0];
    EXPECT_NE(clamped.message.find("'Kd' is out of range and was clamped"), std::string::npos) << clamped.message;
    const Warning& above = loaded.diagnostics.warnings()[1];
    EXPECT_NE(above.message.find("reflectance above 1"), std::string::npos) << above.message;
    EXPECT_EQ(above.count, 3u);
    EXPECT_EQ(above.where.str(), folder_.file("bright.mtl") + ":3:8");
}

/// A model of eight vertices, of which the last pulls the middle of the picture aside.
std::string framed_model(double scale) {
    std::string text;
    for (int i = 0; i < 8; ++i) {
        const double x = (i & 1 ? 1 : -1) + 7.0, y = i & 2 ? 2 : -2, z = i == 7 ? 3 : i & 4 ? 1 : -1;
        for (const double c : {x, y, z}) text += (c == x ? "v " : " ") + std::to_string(c * scale);
        text += '\n';
    }
    return text + "f 1 2 3\nf 5 6 7 8\nf 4 1 2\n";
}

TEST_F(SceneFiles, AModelByItselfFillsASquarePicture) {
    for (const double scale : {1e-3, 1.0, 1e6}) {
        spit(folder_.path() / "box.obj", framed_model(scale));
        const auto loaded = load_scene(folder_.file("box.obj"));
        ASSERT_TRUE(loaded.ok()) << loaded.error().str();
        const auto& camera = std::get<PerspectiveCamera>(loaded->scene.cameras.at(0));
        const Vec3d eye(camera.position), view = normalize(Vec3d(camera.look_at) - eye);
        const Vec3d right = normalize(cross(view, Vec3d(camera.up))), up = cross(right, view);
        const double slope = std::tan(camera.vertical_fov / 2 * 3.14159265358979 / 180);
        double left_edge = 0, right_edge = 0, low_edge = 0, high_edge = 0;
        for (const Vec3 p : loaded->scene.meshes.at(0).positions) {
            const Vec3d q = Vec3d(p) - eye;
            const double x = dot(q, right) / (dot(q, view) * slope), y = dot(q, up) / (dot(q, view) * slope);
            left_edge = std::min(left_edge, x), right_edge = std::max(right_edge, x);
            low_edge = std::min(low_edge, y), high_edge = std::max(high_edge, y);
        }
        // In the middle, and the larger side takes what the margin leaves of the picture.
        EXPECT_NEAR(left_edge, -right_edge, 0.05);  // the smaller side nearly
        EXPECT_NEAR(low_edge, -high_edge, 1e-4);
        EXPECT_NEAR(std::max(right_edge, high_edge), 0.86, 1e-4);
    }
}

TEST_F(SceneFiles, AModelByItselfStandsOnAFloorBetweenTwoLights) {
    spit(folder_.path() / "box.obj", framed_model(1));
    const Scene s = load_scene(folder_.file("box.obj")).value().scene;
    const auto shape_of = [&](InstanceId i) { return s.shapes[index(s.instances[index(i)].shape)]; };
    ASSERT_EQ(s.instances.size(), 4u);
    const auto floor = std::get<Disk>(shape_of(InstanceId{1}));
    EXPECT_LT(floor.center.y, -2);
    EXPECT_GT(floor.center.y, -2.02f);
    EXPECT_GT(floor.radius, 100);
    ASSERT_EQ(s.lights.size(), 3u);
    const Vec3d middle{7, 0, 1};  // of the bounding box
    for (size_t i = 0; i < 2; ++i) {
        const auto light = std::get<Rectangle>(shape_of(std::get<AreaLight>(s.lights[i]).instance));
        const Vec3d to_model = normalize(middle - Vec3d(light.center));
        EXPECT_GT(dot(to_model, normalize(cross(Vec3d(light.half_u), Vec3d(light.half_v)))), 0.999);
        EXPECT_GT(light.center.y, 2);
        EXPECT_EQ(light.center.x < middle.x, i == 0);  // the first on the left, in front
        EXPECT_EQ(light.center.z > middle.z, i == 0);
    }
    EXPECT_TRUE(std::holds_alternative<EnvironmentLight>(s.lights[2]));
}

TEST_F(SceneFiles, TheSizeOfAModelOnlyScalesItsStudio) {
    const auto studio = [&](const char* scale) {
        const std::string s(scale);
        spit(folder_.path() / "scaled.obj", "v 0 0 0\nv " + s + " 0 0\nv 0 " + s + " 0\nf 1 2 3\n");
        return load_scene(folder_.file("scaled.obj")).value().scene;
    };
    const Scene one = studio("1"), four = studio("4");
    const auto& camera = std::get<PerspectiveCamera>(one.cameras[0]);
    EXPECT_EQ(std::get<PerspectiveCamera>(four.cameras[0]).position, camera.position * 4);
    EXPECT_EQ(std::get<Disk>(four.shapes[1]).radius, std::get<Disk>(one.shapes[1]).radius * 4);
    EXPECT_EQ(std::get<Rectangle>(four.shapes[2]).half_u, std::get<Rectangle>(one.shapes[2]).half_u * 4);
    EXPECT_EQ(std::get<AreaLight>(four.lights[0]).radiance, std::get<AreaLight>(one.lights[0]).radiance);
}

TEST_F(SceneFiles, MtlBecomesMaterials) {
    spit(folder_.path() / "all.mtl",
         "newmtl mirror\nillum 3\nKs 0.9 0.8 0.7\nnewmtl glass\nillum 7\nNi 1.33\nTf 0.5 0.6 0.7\nnewmtl thin\nd 0.1\n"
         "newmtl odd\nillum 4\nNi 0\nnewmtl half\nd 0.7\nKd 0.1 0.2 0.3\nnewmtl map\nmap_Kd -s 2 3 1 -clamp on "
         "image.png\nnewmtl map2\nmap_Kd image.png\n");
    std::string text = "mtllib all.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (const char* name : {"mirror", "glass", "thin", "odd", "half", "map", "map2"})
        text += "usemtl " + std::string(name) + "\nf 1 2 3\n";
    spit(folder_.path() / "all.obj", text);
    const auto loaded = load_scene(folder_.file("all.obj"));
    ASSERT_TRUE(loaded.ok()) << loaded.error().str();
    const Scene& s = loaded->scene;
    const auto material = [&](size_t i) { return s.materials[index(s.instances[i].material)]; };
    EXPECT_EQ(std::get<MirrorMaterial>(material(0)).reflectance, (Rgb{0.9f, 0.8f, 0.7f}));
    EXPECT_EQ(std::get<GlassMaterial>(material(1)).eta, 1.33f);
    EXPECT_EQ(std::get<GlassMaterial>(material(1)).transmittance, (Rgb{0.5f, 0.6f, 0.7f}));
    EXPECT_EQ(std::get<GlassMaterial>(material(2)).eta, 1.5f);
    EXPECT_EQ(std::get<GlassMaterial>(material(3)).eta, 0.001f);
    const auto texture = [&](size_t i) {
        return s.textures[index(std::get<DiffuseMaterial>(material(i)).reflectance)];
    };
    EXPECT_EQ(std::get<ConstantTexture>(texture(4)).value, (Rgb{0.1f, 0.2f, 0.3f}));
    const auto map = std::get<ImageTexture>(texture(5));
    EXPECT_EQ(map.wrap_u, Wrap::clamp);
    EXPECT_EQ(map.color_space, ColorSpace::srgb);
    EXPECT_EQ(std::get<ImageTexture>(texture(6)).image, map.image);
    EXPECT_EQ(s.images.size(), 1u);
    // The index of refraction that was clamped and the half transparent material are told.
    EXPECT_EQ(loaded->diagnostics.warnings().size(), 2u);
}

TEST_F(SceneFiles, GoniometricLights) {
    spit(folder_.path() / "lamp.ies", "TILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 9\n0 180\n0\n50 50\n");
    const auto light = [&](std::string_view members) {
        return "{\"type\": \"goniometric\", \"path\": \"lamp.ies\", \"position\": [0, 3, 0]" + std::string(members) +
               "}";
    };
    const LoadedScene loaded = load(scene_with("\"lights\": [" + light("") + ", " +
                                               light(", \"look_at\": [2, 3, 0], \"rotation\": 30, \"intensity\": 2") +
                                               ", " + light(", \"direction\": [0, 5, 0], \"flux\": [1, 2, 4]") + "]"));
    EXPECT_EQ(loaded.scene.profiles.size(), 1u);  // of one file
    EXPECT_EQ(loaded.files.size(), 1u);
    const auto at = [&](size_t i) { return std::get<GoniometricLight>(loaded.scene.lights.at(i)); };
    EXPECT_EQ(at(0).direction, (Vec3{0, -1, 0}));
    EXPECT_EQ(at(0).intensity, (Rgb{1, 1, 1}));
    EXPECT_EQ(at(0).rotation, 0);
    EXPECT_EQ(at(1).direction, (Vec3{1, 0, 0}));
    EXPECT_EQ(at(1).rotation, 30);
    EXPECT_EQ(at(1).intensity, (Rgb{2, 2, 2}));
    EXPECT_EQ(at(2).direction, (Vec3{0, 5, 0}));
    EXPECT_FLOAT_EQ(at(2).intensity.g, static_cast<float>(2 / (4 * std::numbers::pi * 50)));

    refused(scene_with_light("§{\"type\": \"goniometric\", \"path\": \"lamp.ies\"}"), "missing key 'position'");
    refused(scene_with_light("§{\"type\": \"goniometric\", \"position\": [0, 0, 0]}"), "missing key 'path'");
    refused(scene_with_light(light(", \"intensity\": 1, §\"flux\": 1")), "either 'intensity' or 'flux'");
    refused(scene_with_light(light(", \"direction\": [1, 0, 0], §\"look_at\": [1, 1, 1]")),
            "either 'direction' or 'look_at'");
    refused(scene_with_light("{\"type\": \"goniometric\", \"position\": [0, 0, 0], \"path\": §\"none.ies\"}"),
            "none.ies: cannot open the file");
    spit(folder_.path() / "dark.ies", "TILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 9\n0 180\n0\n0 0\n");
    refused(
        scene_with_light("{\"type\": \"goniometric\", \"position\": [0, 0, 0], \"flux\": 1, \"path\": §\"dark.ies\"}"),
        "no flux to scale");
    // What is wrong in the file is shown there.
    spit(folder_.path() / "bad.ies", "TILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 9\n0 x\n0\n0 0\n");
    const auto bad =
        load_text(scene_with_light("{\"type\": \"goniometric\", \"position\": [0, 0, 0], \"path\": \"bad.ies\"}"),
                  folder_.path().string());
    ASSERT_FALSE(bad.ok());
    EXPECT_EQ(bad.error().where.line, 4u);
    EXPECT_EQ(bad.error().where.column, 3u);
    EXPECT_NE(bad.error().where.file.find("bad.ies"), std::string::npos);
    EXPECT_FALSE(bad.error().excerpt.empty());
}

TEST_F(SceneFiles, AMissingTextureIsReportedWhereTheMaterialNamesIt) {
    spit(folder_.path() / "bad.mtl", "newmtl a\nKd 1 1 1\nnewmtl b\n  map_Kd none.png\n");
    spit(folder_.path() / "bad.obj", "mtllib bad.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl b\nf 1 2 3\n");
    const auto loaded = load_scene(folder_.file("bad.obj"));
    ASSERT_FALSE(loaded.ok());
    EXPECT_EQ(loaded.error().where.file, folder_.file("bad.mtl"));
    EXPECT_EQ(loaded.error().where.line, 4u);
    EXPECT_EQ(loaded.error().where.column, 10u);
    EXPECT_NE(loaded.error().message.find("none.png"), std::string::npos) << loaded.error().str();
}

TEST_F(SceneFiles, TheFilesThatWereReadAreListed) {
    spit(folder_.path() / "map.mtl", "newmtl m\nmap_Kd image.png\n");
    spit(folder_.path() / "map.obj", "mtllib map.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    spit(folder_.path() / "scene.json", scene_with_object(R"({"type": "mesh", "path": "map.obj"})"));
    const auto loaded = load_scene(folder_.file("scene.json"));
    ASSERT_TRUE(loaded.ok()) << loaded.error().str();
    std::vector<std::string> expected;
    for (const char* name : {"scene.json", "map.obj", "map.mtl", "image.png"}) expected.push_back(folder_.file(name));
    EXPECT_EQ(loaded->files, expected);
}

}  // namespace
}  // namespace steradian::test
