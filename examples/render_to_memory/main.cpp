// Builds a scene in C++, renders it to memory, prints the picture's hash and one pixel, and writes a PNG.
//
//     render_to_memory [picture.png]
#include <cstdio>
#include <string>

#include "steradian/steradian.h"

using namespace steradian;

namespace {

MaterialId diffuse(Scene& scene, Rgb reflectance) {
    const auto texture = add<TextureId>(scene.textures, Texture{ConstantTexture{reflectance}});
    return add<MaterialId>(scene.materials, Material{DiffuseMaterial{texture}});
}

InstanceId place(Scene& scene, Shape shape, MaterialId material, Affine world_from_object = {}) {
    const auto id = add<ShapeId>(scene.shapes, std::move(shape));
    return add<InstanceId>(scene.instances, Instance{id, material, world_from_object});
}

/// Lengths in metres, +Y up. Everything refers to everything else by id.
Scene make_scene() {
    Scene scene;
    // A checkered floor of 10 × 10 m whose normal, half_u × half_v, points up.
    const auto checks = add<TextureId>(
        scene.textures, Texture{CheckerTexture{{0.8f, 0.8f, 0.8f}, {0.25f, 0.25f, 0.3f}, {10, 10}, {0, 0}}});
    const auto floor = add<MaterialId>(scene.materials, Material{DiffuseMaterial{checks}});
    place(scene, Rectangle{{0, 0, 0}, {5, 0, 0}, {0, 0, -5}}, floor);

    // A clay ball, a glass one, and a tetrahedron from triangles, counter-clockwise seen from outside.
    place(scene, Sphere{{-1.1f, 0.5f, 0}, 0.5f}, diffuse(scene, {0.7f, 0.3f, 0.2f}));
    place(scene, Sphere{{0, 0.5f, 0.3f}, 0.5f}, add<MaterialId>(scene.materials, Material{GlassMaterial{1.5f}}));
    Mesh tetrahedron;
    tetrahedron.positions = {{0, 1, 0}, {0.6f, 0, 0.4f}, {-0.6f, 0, 0.4f}, {0, 0, -0.7f}};
    tetrahedron.indices = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    const auto mesh = add<MeshId>(scene.meshes, std::move(tetrahedron));
    place(scene, mesh, diffuse(scene, {0.2f, 0.4f, 0.7f}), translation(1.2, 0, 0) * rotation_degrees(20, {0, 1, 0}));

    // A square lamp that faces down, and a faint sky.
    const auto lamp = place(scene, Rectangle{{0, 3, 1}, {0.5f, 0, 0}, {0, 0, 0.5f}}, diffuse(scene, {0, 0, 0}));
    scene.lights.push_back(AreaLight{lamp, {18, 17, 15}});
    scene.lights.push_back(EnvironmentLight{{0.2f, 0.25f, 0.35f}, {}});

    scene.cameras.push_back(PerspectiveCamera{{0, 1.4f, 5}, {0, 0.5f, 0}, {0, 1, 0}, 32});
    return scene;
}

int fail(const Error& error) {
    std::fprintf(stderr, "%s\n", error.str().c_str());
    return 1;
}

}  // namespace

int main(int argc, char** argv) {
    RenderSettings settings;
    settings.width = 320;
    settings.height = 180;
    settings.samples_per_pixel = 16;

    const Result<RenderResult> result = render(make_scene(), settings);
    if (!result) return fail(result.error());

    const Image& image = result->image;
    const float* centre = &image.pixels[(size_t(image.height / 2) * image.width + image.width / 2) * 3];
    std::printf("%u x %u, hash %s, centre %g %g %g\n", image.width, image.height, image_hash(image).c_str(), centre[0],
                centre[1], centre[2]);

    const std::string path = argc > 1 ? argv[1] : "render_to_memory.png";
    if (const Status written = write_image(path, image); !written) return fail(written.error());
    std::printf("wrote %s\n", path.c_str());
    return 0;
}
