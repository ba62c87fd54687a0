// A program of another project: renders a scene whose pixels are known and checks them.
#include <steradian/steradian.h>

#include <cmath>
#include <cstdio>

using namespace steradian;

/// A rectangle that fills the view and emits (1, 2, 3): every pixel is that, whatever the samples.
static Scene glowing_wall() {
    Scene scene;
    const auto grey = add<TextureId>(scene.textures, Texture{ConstantTexture{{0.5f, 0.5f, 0.5f}}});
    const auto material = add<MaterialId>(scene.materials, Material{DiffuseMaterial{grey}});
    const auto shape = add<ShapeId>(scene.shapes, Shape{Rectangle{{0, 0, -1}, {10, 0, 0}, {0, 10, 0}}});
    const auto wall = add<InstanceId>(scene.instances, Instance{shape, material, {}});
    scene.lights.push_back(AreaLight{wall, {1, 2, 3}});
    scene.cameras.push_back(PerspectiveCamera{});
    return scene;
}

int main() {
    RenderSettings settings;
    settings.width = 8;
    settings.height = 4;
    settings.samples_per_pixel = 4;
    const Result<RenderResult> result = render(glowing_wall(), settings);
    if (!result) {
        std::fprintf(stderr, "%s\n", result.error().str().c_str());
        return 1;
    }
    const Image& image = result->image;
    if (image.width != 8 || image.height != 4 || image.pixels.size() != 8u * 4u * 3u) return 2;
    for (size_t i = 0; i < image.pixels.size(); ++i) {
        const float expected = static_cast<float>(i % 3 + 1);
        if (!(std::fabs(image.pixels[i] - expected) <= 1e-5f * expected)) {
            std::fprintf(stderr, "value %zu is %g, expected %g\n", i, image.pixels[i], expected);
            return 3;
        }
    }
    std::printf("steradian %s: %s\n", STERADIAN_VERSION, image_hash(image).c_str());
    return 0;
}
