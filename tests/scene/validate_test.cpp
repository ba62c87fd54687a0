#include "scene/validate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "math/transform.h"

namespace steradian {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

Scene good_scene() {
    Scene s;
    const auto texture = add<TextureId>(s.textures, Texture(ConstantTexture{}));
    const auto material = add<MaterialId>(s.materials, Material(DiffuseMaterial{texture}));
    const auto mesh = add<MeshId>(s.meshes, Mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {}, {0, 1, 2}});
    const auto shape = add<ShapeId>(s.shapes, Shape(mesh));
    add<ShapeId>(s.shapes, Shape(Sphere{{0, 0, 0}, 1}));
    s.instances.push_back({shape, material, {}});
    s.lights = {PointLight{}, EnvironmentLight{}, AreaLight{InstanceId{0}}};
    s.cameras = {PerspectiveCamera{}};
    s.names.materials = {"wood\x1b"};
    return s;
}

struct Fault {
    const char* expected;  ///< part of the message
    std::function<void(Scene&)> inject;
};

class ValidateFault : public testing::TestWithParam<Fault> {};

TEST_P(ValidateFault, IsNamed) {
    Scene s = good_scene();
    GetParam().inject(s);
    const Status status = validate(s);
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().code, ErrorCode::bad_input);
    EXPECT_NE(status.error().message.find(GetParam().expected), std::string::npos) << status.error().message;
}

INSTANTIATE_TEST_SUITE_P(
    All, ValidateFault,
    testing::Values(
        Fault{"material 'wood\\x1b': refers to texture 7, but there are 1",
              [](Scene& s) { std::get<DiffuseMaterial>(s.materials[0]).reflectance = TextureId{7}; }},
        Fault{"the roughness must be between 0 and 1",
              [](Scene& s) {
                  s.materials[0] = ConductorMaterial{ComplexIndex{}, {{0, kNan}, true, std::nullopt}};
              }},
        Fault{"the roughness must be between 0 and 1",
              [](Scene& s) { std::get<DiffuseMaterial>(s.materials[0]).roughness = 1.5f; }},
        Fault{"refers to texture 1",
              [](Scene& s) {
                  s.materials[0] = ConductorMaterial{ComplexIndex{}, {{0, 0}, true, TextureId{1}}};
              }},
        Fault{"coefficients of a medium must be finite",
              [](Scene& s) {
                  s.materials[0] = GlassMaterial{1.5f, {1, 1, 1}, {1, 1, 1}, {}, 0, {{-1, 0, 0}, {}, 0}};
              }},
        Fault{"at most 1e9 per metre",
              [](Scene& s) {
                  s.materials[0] = GlassMaterial{1.5f, {1, 1, 1}, {1, 1, 1}, {}, 0, {{}, {2e9f, 0, 0}, 0}};
              }},
        Fault{"the anisotropy of a medium",
              [](Scene& s) {
                  s.materials[0] = GlassMaterial{1.5f, {1, 1, 1}, {1, 1, 1}, {}, 0, {{}, {}, 1}};
              }},
        Fault{"neither holes nor thin walls",
              [](Scene& s) {
                  OpenPbrMaterial m;
                  m.priority = 1;
                  m.geometry_thin_walled = true;
                  s.materials[0] = m;
              }},
        Fault{"a mix of a body with a priority and of holes",
              [](Scene& s) {
                  GlassMaterial glass;
                  glass.priority = 1;
                  OpenPbrMaterial hole;
                  hole.geometry_opacity = {0.5f};
                  s.materials = {hole, glass, MixMaterial{MaterialId{1}, MaterialId{0}},
                                 MixMaterial{MaterialId{2}, MaterialId{1}}};
              }},
        Fault{"the surface of a body with a priority emits nothing",
              [](Scene& s) {
                  GlassMaterial glass;
                  glass.priority = 0;
                  s.materials[0] = glass;
                  s.materials.push_back(MixMaterial{MaterialId{0}, MaterialId{0}});
                  s.instances[0].material = MaterialId{1};
                  s.lights = {AreaLight{InstanceId{0}, {1, 1, 1}}};
              }},
        Fault{"relief 0: refers to material 5",
              [](Scene& s) {
                  s.reliefs = {{MaterialId{5}, NormalMap{}}};
              }},
        Fault{"relief 0: refers to texture 3",
              [](Scene& s) {
                  s.reliefs = {{MaterialId{0}, BumpMap{TextureId{3}}}};
              }},
        Fault{"the strength must be between -100 and 100",
              [](Scene& s) {
                  s.reliefs = {{MaterialId{0}, NormalMap{TextureId{0}, kNan}}};
              }},
        Fault{"the scale of heights",
              [](Scene& s) {
                  s.reliefs = {{MaterialId{0}, BumpMap{TextureId{0}, 2e6f}}};
              }},
        Fault{"material 1 mixes one that does not come before it",
              [](Scene& s) {
                  s.materials.push_back(MixMaterial{MaterialId{0}, MaterialId{1}});
              }},
        Fault{"refers to material 9",
              [](Scene& s) {
                  s.materials.push_back(MixMaterial{MaterialId{0}, MaterialId{9}});
              }},
        Fault{"material 3 is a mix of 8, expected at most 4",
              [](Scene& s) {
                  for (uint32_t i = 0; i < 3; ++i) s.materials.push_back(MixMaterial{MaterialId{i}, MaterialId{i}});
              }},
        Fault{"relief belongs to what is mixed",
              [](Scene& s) {
                  s.materials.push_back(MixMaterial{});
                  s.reliefs = {{MaterialId{1}, NormalMap{}}};
              }},
        Fault{"one colour per position",
              [](Scene& s) {
                  s.meshes[0].colors = {{1, 1, 1}};
              }},
        Fault{"one alpha per position", [](Scene& s) { s.meshes[0].alphas = {1}; }},
        Fault{"the alphas of vertices must be between 0 and 1",
              [](Scene& s) {
                  s.meshes[0].alphas = {1, 2, 1};
              }},
        Fault{"one tangent per position", [](Scene& s) { s.meshes[0].tangents.resize(2); }},
        Fault{"one uv per position",
              [](Scene& s) {
                  s.meshes[0].more_uvs = {{}, {{0, 0}}};
              }},
        Fault{"too many sets of texture coordinates", [](Scene& s) { s.meshes[0].more_uvs.resize(kMaxUvSets); }},
        Fault{"a number from 0 to 7",
              [](Scene& s) {
                  s.images = {{1, 1, 1, TexelFormat::u8, std::vector<std::byte>(1)}};
                  ImageTexture texture;
                  texture.uv_set = kMaxUvSets;
                  s.textures.push_back(texture);
              }},
        Fault{"a product of textures is not made of products",
              [](Scene& s) {
                  s.textures.push_back(ProductTexture{TextureId{0}, TextureId(uint32_t(s.textures.size()))});
              }},
        Fault{"not products of textures",
              [](Scene& s) {
                  s.textures.push_back(ProductTexture{TextureId{0}, TextureId{0}});
                  s.reliefs = {{MaterialId{0}, NormalMap{TextureId(uint32_t(s.textures.size() - 1))}}};
              }},
        Fault{"the colours of vertices",
              [](Scene& s) {
                  s.meshes[0].colors = {{1, 1, 1}, {1, -1, 1}, {1, 1, 1}};
              }},
        Fault{"has two reliefs",
              [](Scene& s) {
                  s.reliefs = {{MaterialId{0}, NormalMap{}}, {MaterialId{0}, BumpMap{}}};
              }},
        Fault{"their texture must be linear",
              [](Scene& s) {
                  s.images = {{1, 1, 1, TexelFormat::u8, std::vector<std::byte>(1)}};
                  s.textures.push_back(ImageTexture{});
                  s.reliefs = {{MaterialId{0}, NormalMap{TextureId{1}}}};
              }},
        Fault{"rotation must be finite",
              [](Scene& s) {
                  s.textures.push_back(CheckerTexture{});
                  std::get<CheckerTexture>(s.textures.back()).rotation = kNan;
              }},
        Fault{"n must be finite and positive",
              [](Scene& s) {
                  s.materials[0] = ConductorMaterial{ComplexIndex{{1, 0, 1}, {}}, {}};
              }},
        Fault{"k must be finite and not negative",
              [](Scene& s) {
                  s.materials[0] = ConductorMaterial{ComplexIndex{{1, 1, 1}, {-1, 0, 0}}, {}};
              }},
        Fault{"refers to texture 2",
              [](Scene& s) {
                  s.materials[0] = ConductorMaterial{SchlickReflectance{TextureId{2}}, {}};
              }},
        Fault{"the reflectance at the edge",
              [](Scene& s) {
                  s.materials[0] = ConductorMaterial{SchlickReflectance{TextureId{0}, {kInf, 0, 0}}, {}};
              }},
        Fault{"object 0: refers to shape 9", [](Scene& s) { s.instances[0].shape = ShapeId{9}; }},
        Fault{"object 0: refers to material 3", [](Scene& s) { s.instances[0].material = MaterialId{3}; }},
        Fault{"shape 0: refers to mesh 1", [](Scene& s) { s.shapes[0] = MeshId{1}; }},
        Fault{"mesh 0: an index refers to a vertex", [](Scene& s) { s.meshes[0].indices[1] = 3; }},
        Fault{"multiple of three", [](Scene& s) { s.meshes[0].indices.push_back(0); }},
        Fault{"one normal per position", [](Scene& s) { s.meshes[0].normals.resize(2); }},
        Fault{"one uv per position", [](Scene& s) { s.meshes[0].uvs.resize(4); }},
        Fault{"not finite or beyond 1e15", [](Scene& s) { s.meshes[0].positions[0].x = 2e15f; }},
        Fault{"radius must be positive",
              [](Scene& s) {
                  s.shapes[1] = Sphere{{}, 0};
              }},
        Fault{"radius must be positive",
              [](Scene& s) {
                  s.shapes[1] = Sphere{{}, kNan};
              }},
        Fault{"centre must be finite",
              [](Scene& s) {
                  s.shapes[1] = Rectangle{{kInf, 0, 0}, {1, 0, 0}, {0, 1, 0}};
              }},
        Fault{"normal must be finite and not zero",
              [](Scene& s) {
                  s.shapes[1] = Disk{{}, {0, 0, 0}, 1};
              }},
        Fault{"singular", [](Scene& s) { s.instances[0].world_from_object = scaling(1, 0, 1); }},
        Fault{"beyond 1e30", [](Scene& s) { s.instances[0].world_from_object = scaling(1e31, 1, 1); }},
        Fault{"singular or not finite", [](Scene& s) { s.instances[0].world_from_object = translation(kNan, 0, 0); }},
        Fault{"eta must be between", [](Scene& s) { s.materials.push_back(GlassMaterial{0}); }},
        Fault{"eta must be between", [](Scene& s) { s.materials.push_back(RefractionMaterial{-1}); }},
        Fault{"Abbe number must be at least 1",
              [](Scene& s) {
                  s.materials.push_back(GlassMaterial{1.5f, {1, 1, 1}, {1, 1, 1}, {}, 0.5f});
              }},
        Fault{"Abbe number must be at least 1",
              [](Scene& s) {
                  s.materials.push_back(GlassMaterial{1.5f, {1, 1, 1}, {1, 1, 1}, {}, float(kNan)});
              }},
        Fault{"transmission_dispersion_abbe_number must be at least 1",
              [](Scene& s) {
                  OpenPbrMaterial m;
                  m.transmission_dispersion_abbe_number = 0;
                  s.materials.push_back(m);
              }},
        Fault{"transmission_dispersion_scale must be",
              [](Scene& s) {
                  OpenPbrMaterial m;
                  m.transmission_dispersion_scale = 1.5f;
                  s.materials.push_back(m);
              }},
        Fault{"not negative",
              [](Scene& s) {
                  s.textures[0] = ConstantTexture{{-1, 0, 0}};
              }},
        Fault{"refers to image 0", [](Scene& s) { s.textures[0] = ImageTexture{}; }},
        Fault{"size that its header says",
              [](Scene& s) {
                  s.images.push_back({2, 2, 3, TexelFormat::u8, std::vector<std::byte>(11)});
              }},
        Fault{"light 0: the intensity", [](Scene& s) { s.lights[0] = PointLight{{}, {kNan, 0, 0}}; }},
        Fault{"inner angle", [](Scene& s) { s.lights[0] = SpotLight{{}, {0, -1, 0}, {1, 1, 1}, 50, 45}; }},
        Fault{"outer angle", [](Scene& s) { s.lights[0] = SpotLight{{}, {0, -1, 0}, {1, 1, 1}, 0, 181}; }},
        Fault{"direction must be finite and not zero", [](Scene& s) { s.lights[0] = DirectionalLight{{0, 0, 0}}; }},
        Fault{"angular diameter", [](Scene& s) { s.lights[0] = DirectionalLight{{0, -1, 0}, {1, 1, 1}, 91}; }},
        Fault{"angular diameter", [](Scene& s) { s.lights[0] = DirectionalLight{{0, -1, 0}, {1, 1, 1}, kNan}; }},
        Fault{"refers to texture 77", [](Scene& s) { std::get<AreaLight>(s.lights[2]).texture = TextureId{77}; }},
        Fault{"refers to profile 0", [](Scene& s) { s.lights[0] = GoniometricLight{}; }},
        Fault{"two vertical angles", [](Scene& s) { s.profiles = {{{0}, {0}, {1}}}; }},
        Fault{"two vertical angles", [](Scene& s) { s.profiles = {{{0, 181}, {0}, {1, 1}}}; }},
        Fault{"two vertical angles", [](Scene& s) { s.profiles = {{{0, kNan}, {0}, {1, 1}}}; }},
        Fault{"horizontal angles must ascend", [](Scene& s) { s.profiles = {{{0, 90}, {0, 180}, {1, 1, 1, 1}}}; }},
        Fault{"horizontal angles must ascend", [](Scene& s) { s.profiles = {{{0, 90}, {}, {}}}; }},
        Fault{"a value for each pair", [](Scene& s) { s.profiles = {{{0, 90}, {0, 360}, {1, 1}}}; }},
        Fault{"finite and not negative", [](Scene& s) { s.profiles = {{{0, 90}, {0}, {1, -1}}}; }},
        Fault{"refers to object 5", [](Scene& s) { s.lights[2] = AreaLight{InstanceId{5}}; }},
        Fault{"light samples", [](Scene& s) { s.lights[2] = AreaLight{InstanceId{0}, {1, 1, 1}, false, 0}; }},
        Fault{"two area lights", [](Scene& s) { s.lights.push_back(AreaLight{InstanceId{0}}); }},
        Fault{"an area light and a material that emits",
              [](Scene& s) {
                  OpenPbrMaterial m;
                  m.emission_luminance = 1;
                  const InstanceId lit = std::get<AreaLight>(s.lights[2]).instance;
                  s.materials[index(s.instances[index(lit)].material)] = m;
              }},
        Fault{"two environment lights", [](Scene& s) { s.lights.push_back(EnvironmentLight{}); }},
        Fault{"camera 0: the field of view",
              [](Scene& s) { std::get<PerspectiveCamera>(s.cameras[0]).vertical_fov = 180; }},
        Fault{"radius must be between 0",
              [](Scene& s) { std::get<PerspectiveCamera>(s.cameras[0]).aperture_radius = -1; }},
        Fault{"focus distance", [](Scene& s) { std::get<PerspectiveCamera>(s.cameras[0]).focus_distance = 0.0f; }},
        Fault{"3 to 64 blades", [](Scene& s) { std::get<PerspectiveCamera>(s.cameras[0]).aperture_blades = 2; }},
        Fault{"3 to 64 blades", [](Scene& s) { std::get<PerspectiveCamera>(s.cameras[0]).aperture_blades = 65; }},
        Fault{"rotation must be finite",
              [](Scene& s) { std::get<PerspectiveCamera>(s.cameras[0]).aperture_rotation = kNan; }},
        Fault{"height must be positive",
              [](Scene& s) { s.cameras[0] = OrthographicCamera{{}, {0, 0, 1}, {0, 1, 0}, 0}; }},
        Fault{"position must be finite", [](Scene& s) { s.cameras[0] = PanoramaCamera{{kNan, 0, 0}}; }},
        Fault{"(0, 360]", [](Scene& s) { s.cameras[0] = FisheyeCamera{{}, {0, 0, 1}, {0, 1, 0}, 361}; }},
        Fault{"camera 0: up", [](Scene& s) { std::get<PerspectiveCamera>(s.cameras[0]).up = {}; }}));

TEST(Validate, AcceptsAGoodScene) {
    const Status status = validate(good_scene());
    EXPECT_TRUE(status.ok()) << status.error().message;
    EXPECT_TRUE(validate(Scene{}).ok());
}

TEST(Sanitize, DropsTrianglesWithUnusableVerticesAndCountsThem) {
    Scene s = good_scene();
    Mesh& m = s.meshes[0];
    m.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {kNan, 0, 0}, {0, 2e15f, 0}};
    m.uvs = {{0, 0}, {kInf, 0}, {0, 0}, {0, 0}, {0, 0}};
    m.normals = {{0, 0, 1}, {0, 0, 1}, {kNan, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    m.indices = {0, 1, 3, 0, 1, 2, 2, 1, 4, 3, 3, 4};
    Diagnostics diagnostics;
    sanitize(s, diagnostics);
    EXPECT_EQ(m.indices, (std::vector<uint32_t>{0, 1, 2}));
    ASSERT_EQ(diagnostics.warnings().size(), 3u);
    EXPECT_EQ(diagnostics.warnings()[0].count, 3u);
    EXPECT_TRUE(validate(s).ok());
    EXPECT_EQ(m.normals[2], Vec3{});
}

TEST(BakeTransforms, MovesAMeshThatIsUsedOnceAndKeepsOutsideOutside) {
    Scene s = good_scene();
    s.meshes[0].normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    s.instances[0].world_from_object = translation(10, 0, 0) * scaling(2, 2, -2);
    bake_transforms(s);
    const Mesh& m = s.meshes[0];
    EXPECT_TRUE(is_identity(s.instances[0].world_from_object));
    EXPECT_EQ(m.positions[1], (Vec3{12, 0, 0}));
    EXPECT_EQ(m.normals[0], (Vec3{0, 0, -1}));
    const Vec3 p0 = m.positions[m.indices[0]], p1 = m.positions[m.indices[1]], p2 = m.positions[m.indices[2]];
    EXPECT_LT(cross(p1 - p0, p2 - p0).z, 0);  // the mirrored object's outside is where its normals point
}

TEST(BakeTransforms, LeavesSharedMeshesAlone) {
    Scene s = good_scene();
    s.instances[0].world_from_object = translation(10, 0, 0);
    s.instances.push_back(s.instances[0]);
    bake_transforms(s);
    EXPECT_EQ(s.meshes[0].positions[1], (Vec3{1, 0, 0}));
    EXPECT_FALSE(is_identity(s.instances[0].world_from_object));
}

TEST(ValidateSettings, RangesAreThoseOfTheDocumentation) {
    const auto code = [](const std::function<void(RenderSettings&)>& change) -> std::optional<ErrorCode> {
        RenderSettings settings;
        change(settings);
        const Status status = validate(settings);
        if (status) return std::nullopt;
        return status.error().code;
    };
    using S = RenderSettings;
    for (const std::function<void(S&)>& good : std::vector<std::function<void(S&)>>{
             [](S&) {}, [](S& s) { s.width = s.height = 1; }, [](S& s) { s.width = kMaxResolution, s.height = 1024; },
             [](S& s) {
                 s.crop = Crop{511, 511, 512, 512};
             },
             [](S& s) { s.samples_per_pixel = kMaxSamplesPerPixel; }, [](S& s) { s.filter.radius = 0.01f; },
             [](S& s) { s.filter.radius = 32; }, [](S& s) { s.max_depth = 0; }})
        EXPECT_EQ(code(good), std::nullopt);
    for (const std::function<void(S&)>& wrong : std::vector<std::function<void(S&)>>{
             [](S& s) { s.width = 0; }, [](S& s) { s.height = 0; },
             [](S& s) {
                 s.crop = Crop{5, 5, 5, 9};
             },
             [](S& s) {
                 s.crop = Crop{9, 5, 8, 9};
             },
             [](S& s) {
                 s.crop = Crop{0, 0, 513, 5};
             },
             [](S& s) { s.samples_per_pixel = 0; }, [](S& s) { s.samples_per_pixel = kMaxSamplesPerPixel + 1; },
             [](S& s) { s.max_depth = kMaxDepth + 1; }, [](S& s) { s.filter.radius = 0; },
             [](S& s) { s.filter.radius = -1; }, [](S& s) { s.filter.radius = kNan; },
             [](S& s) { s.filter.radius = kInf; }})
        EXPECT_EQ(code(wrong), ErrorCode::usage);
    EXPECT_EQ(code([](S& s) { s.width = kMaxResolution + 1; }), ErrorCode::resources);
    EXPECT_EQ(code([](S& s) { s.width = s.height = 32769; }), ErrorCode::resources);
}

}  // namespace
}  // namespace steradian
