// Files around a glTF file, and the environment that the caller chooses.
#include <filesystem>

#include "gltf_builder.h"
#include "support/support.h"

namespace steradian {
namespace {

using namespace test;

void write(const std::string& path, std::string_view bytes) { std::ofstream(path, std::ios::binary) << bytes; }

std::string with_buffer(const std::string& uri) {
    return "{\"asset\": {\"version\": \"2.0\"}, \"buffers\": [{\"byteLength\": 36, \"uri\": \"" + uri +
           "\"}], \"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36}], \"accessors\": [{\"bufferView\": 0, "
           "\"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\"}], " +
           one_mesh(0) + "}";
}

class GltfFiles : public ::testing::Test {
protected:
    GltfFiles() {
        std::filesystem::create_directory(folder_.path() / "scene");
        const std::string_view bytes(reinterpret_cast<const char*>(kTriangle.data()), 36);
        write(folder_.file("scene/a b.bin"), bytes);
        write(folder_.file("outside.bin"), bytes);
        std::filesystem::create_symlink(folder_.path() / "outside.bin", folder_.path() / "scene" / "link.bin");
    }
    Result<LoadedScene> load(const std::string& uri, const LoadOptions& options = {}) {
        write(folder_.file("scene/m.gltf"), with_buffer(uri));
        return load_scene(folder_.file("scene/m.gltf"), options);
    }
    TemporaryFolder folder_;
};

TEST_F(GltfFiles, NamesInsideTheFolderAreRead) {
    const auto loaded = load("a%20b.bin");
    ASSERT_TRUE(loaded.ok()) << loaded.error().str();
    EXPECT_EQ(loaded->files.size(), 2u);
    EXPECT_TRUE(load("a b.bin").ok());
    // A model that nothing shines on, without a camera: it gets both, and a floor.
    EXPECT_EQ(loaded->scene.cameras.size(), 1u);
    EXPECT_EQ(loaded->scene.lights.size(), 3u);
}

/// A picture of one pixel.
constexpr const char* kPixel =
    "data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP438AAAAQBAYDFKhhdAAAAAElFTkSuQmCC";

/// They multiply the radiance; a model with nothing else that shines is lit by the studio as well.
TEST_F(GltfFiles, EmissiveTexturesShine) {
    const auto with_material = [&](const std::string& material) {
        std::string text = with_buffer("a b.bin");
        const std::string there = "\"attributes\"";
        text.insert(text.find(there), "\"material\": 0, ");
        text.pop_back();
        text += ", \"materials\": [{" + material + "}], \"textures\": [{\"source\": 0}], \"images\": [{\"uri\": \"" +
                kPixel + "\"}]}";
        write(folder_.file("scene/m.gltf"), text);
        auto loaded = load_scene(folder_.file("scene/m.gltf"));
        if (!loaded) throw std::runtime_error(loaded.error().str());
        return std::move(loaded).value();
    };
    const auto check = [&](const LoadedScene& loaded, Rgb radiance) {
        const auto& light = std::get<AreaLight>(loaded.scene.lights.at(0));
        EXPECT_EQ(light.radiance, radiance);
        ASSERT_TRUE(light.texture);
        const auto& texture = std::get<ImageTexture>(loaded.scene.textures.at(index(*light.texture)));
        EXPECT_EQ(texture.color_space, ColorSpace::srgb);
        EXPECT_EQ(loaded.scene.lights.size(), 4u);
        EXPECT_TRUE(loaded.fidelity.empty());
    };
    check(with_material("\"emissiveFactor\": [1, 0.5, 0], \"emissiveTexture\": {\"index\": 0}"), {1, 0.5f, 0});
    check(with_material(
              "\"pbrMetallicRoughness\": {\"baseColorFactor\": [1, 0.5, 0, 1], \"baseColorTexture\": {\"index\": "
              "0}}, \"extensions\": {\"KHR_materials_unlit\": {}}"),
          {1, 0.5f, 0});
    EXPECT_EQ(with_material("\"emissiveFactor\": [1, 1, 1]").scene.lights.size(), 1u);
}

/// What a file has of its own is told from the studio around it; lamps without strength do not keep that away.
TEST_F(GltfFiles, DarkModelsStandInAStudio) {
    const auto lit_by = [&](const std::string& light) {
        std::string text = with_buffer("a b.bin");
        text.insert(text.find("\"mesh\": 0"), "\"extensions\": {\"KHR_lights_punctual\": {\"light\": 0}}, ");
        text.pop_back();
        write(folder_.file("scene/m.gltf"),
              text + ", \"extensions\": {\"KHR_lights_punctual\": {\"lights\": [" + light + "]}}}");
        return load_scene(folder_.file("scene/m.gltf")).value();
    };
    const LoadedScene lit = lit_by("{\"type\": \"point\", \"intensity\": 1e-3}");
    EXPECT_EQ(lit.scene.lights.size(), 1u);
    EXPECT_FALSE(lit.before_studio);
    for (const char* dark :
         {"{\"type\": \"point\", \"intensity\": 0}", "{\"type\": \"directional\", \"color\": [0, 0, 0]}"}) {
        const LoadedScene loaded = lit_by(dark);
        EXPECT_EQ(loaded.scene.lights.size(), 4u) << dark;
        ASSERT_TRUE(loaded.before_studio) << dark;
        EXPECT_EQ(loaded.before_studio->lights, 1u);
        EXPECT_EQ(loaded.before_studio->instances, lit.scene.instances.size());
        EXPECT_EQ(loaded.before_studio->shapes, lit.scene.shapes.size());
        EXPECT_EQ(loaded.before_studio->materials, lit.scene.materials.size());
        EXPECT_EQ(loaded.before_studio->textures, lit.scene.textures.size());
    }
}

/// Without room for a camera and lamps the message is of the model, not of what would have been put there.
TEST_F(GltfFiles, ModelsAsLargeAsAllSpaceAreRefused) {
    for (const auto& [place, accepted] :
         {std::pair("\"scale\": [1e13, 1e13, 1e13]", true), std::pair("\"scale\": [1e20, 1e20, 1e20]", false),
          std::pair("\"translation\": [0, 1e25, 0]", false)}) {
        std::string text = with_buffer("a b.bin");
        text.insert(text.find("\"mesh\": 0"), std::string(place) + ", ");
        write(folder_.file("scene/m.gltf"), text);
        const auto loaded = load_scene(folder_.file("scene/m.gltf"));
        ASSERT_EQ(loaded.ok(), accepted) << place;
        if (accepted) continue;
        EXPECT_TRUE(loaded.error().message.starts_with("the model is ")) << loaded.error().str();
        EXPECT_EQ(loaded.error().where.file, folder_.file("scene/m.gltf"));
    }
}

TEST_F(GltfFiles, NamesOutsideAreRefusedUnlessAllowed) {
    const std::string outside = folder_.file("outside.bin");
    for (const std::string& uri : {std::string("../outside.bin"), std::string("%2e%2e/outside.bin"), outside,
                                   std::string("link.bin"), std::string("x/../../outside.bin")}) {
        const auto loaded = load(uri);
        ASSERT_FALSE(loaded.ok()) << uri;
        EXPECT_EQ(loaded.error().where.pointer, "/buffers/0/uri") << loaded.error().str();
    }
    LoadOptions options;
    options.allow_outside_paths = true;
    EXPECT_TRUE(load("../outside.bin", options).ok());
    for (const char* uri : {"http://host/a.bin", "https://host/a.bin", "file:///etc/passwd", "ftp://host/x"})
        EXPECT_FALSE(load(uri, options).ok()) << uri;
}

TEST_F(GltfFiles, TheCallerChoosesTheEnvironment) {
    LoadOptions options;
    options.environment.replace = Rgb{1, 2, 3};
    options.environment.rotation = 30;
    options.environment.scale = 2;
    const auto loaded = load("a b.bin", options);
    ASSERT_TRUE(loaded.ok());
    ASSERT_EQ(loaded->scene.lights.size(), 1u);
    const auto& light = std::get<EnvironmentLight>(loaded->scene.lights[0]);
    EXPECT_EQ(light.radiance, (Rgb{2, 4, 6}));
    EXPECT_EQ(light.rotation, 30);
    EXPECT_EQ(loaded->scene.instances.size(), 1u);  // no floor
    options.environment = {.replace = EnvironmentOptions::None{}};
    EXPECT_TRUE(load("a b.bin", options)->scene.lights.empty());
    options.environment = {.replace = folder_.file("nothing.hdr")};
    EXPECT_FALSE(load("a b.bin", options).ok());
}

}  // namespace
}  // namespace steradian
