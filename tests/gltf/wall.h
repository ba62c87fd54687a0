// A wall that fills the picture, with a material of a glTF file.
#pragma once

#include <cmath>

#include "gltf_builder.h"
#include "image/samples.h"
#include "render/render_support.h"

namespace steradian::test {

/// Pictures of 2 × 1 texels: nothing on the left and everything on the right; red and white.
inline constexpr const char* kTextures =
    "\"samplers\": [{\"magFilter\": 9728}], \"textures\": [{\"source\": 0, \"sampler\": 0}, {\"source\": 1, "
    "\"sampler\": 0}], \"images\": [{\"uri\": \"data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAADklEQVR42mNgAIL/QAAACf8D/cvrD2EAAAAASUVORK5CYII="
    "\"}, {\"uri\": \"data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAAD0lEQVR42mP4z8Dw//9/AAv7A/1kbNMAAAAAAElFTkSuQmCC"
    "\"}]";

/// "textures" with one, of 8-bit RGBA in a row.
inline std::string texture_of(const std::vector<int>& rgba) {
    std::string row(1, '\0');
    for (const int x : rgba) row += static_cast<char>(x);
    return "\"samplers\": [{\"magFilter\": 9728}], \"textures\": [{\"source\": 0, \"sampler\": 0}], \"images\": "
           "[{\"uri\": \"data:image/png;base64," +
           base64(png_file(static_cast<uint32_t>(rgba.size() / 4), 1, 8, 6, row)) + "\"}]";
}

inline constexpr uint32_t kWidth = 16, kHeight = 8;

/// A wall of 2 by 1 m that fills the picture, below a white sky and before a lamp.
inline LoadedScene wall(const std::string& material, const std::string& textures = kTextures) {
    GltfBuilder b;
    const int p = b.floats("VEC3", 3, {-1, -.5f, 0, 1, -.5f, 0, 1, .5f, 0, -1, .5f, 0});
    const int n = b.floats("VEC3", 3, {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
    const int uv = b.floats("VEC2", 2, {0, 1, 1, 1, 1, 0, 0, 0});
    const int i = b.accessor<uint16_t>("SCALAR", 5123, 1, {0, 1, 2, 0, 2, 3});
    const auto number = [](int k) { return std::to_string(k); };
    LoadedScene out = good_gltf(
        b.text("\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": " + number(p) +
               ", \"NORMAL\": " + number(n) + ", \"TEXCOORD_0\": " + number(uv) + "}, \"indices\": " + number(i) +
               ", \"material\": 0}]}], \"nodes\": [{\"mesh\": 0}], \"materials\": [{" + material + "}], " + textures));
    for (const Warning& w : out.fidelity.warnings()) EXPECT_TRUE(w.message.starts_with("sheen is")) << w.message;
    out.scene.names = {};
    out.scene.cameras = {OrthographicCamera{.position = {0, 0, 2}, .look_at = {0, 0, 0}, .height = 1}};
    out.scene.lights = {EnvironmentLight{}, PointLight{{0.2f, 0.3f, 0.5f}, {2, 2, 2}}};
    return out;
}

inline std::vector<Rgb> picture(const std::string& material) {
    RenderSettings settings;
    settings.width = kWidth, settings.height = kHeight;
    settings.samples_per_pixel = 16;
    settings.filter = {FilterKind::box, 0.5f};
    const Image image = run(prepared(wall(material).scene), settings).image;
    std::vector<Rgb> out;
    for (size_t i = 0; i < image.pixels.size(); i += 3)
        out.push_back({image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]});
    return out;
}

/// The mean of columns of a wall, seen at a right angle, below a white sky; with the largest error of the mean.
struct Mean {
    Rgb color;
    double error = 0;
};
inline Mean under_a_white_sky(Scene scene, uint32_t first_column, uint32_t last_column) {
    scene.lights = {EnvironmentLight{}};
    RenderSettings settings;
    settings.width = kWidth, settings.height = kHeight;
    settings.samples_per_pixel = 1024;
    settings.filter = {FilterKind::box, 0.5f};
    const Image image = run(prepared(std::move(scene)), settings).image;
    double sum[3] = {}, squares[3] = {}, n = 0;
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = first_column; x < last_column; ++x, ++n)
            for (uint32_t c = 0; c < 3; ++c) {
                const double v = double(image.pixels[(y * kWidth + x) * 3 + c]);
                sum[c] += v, squares[c] += v * v;
            }
    Mean out;
    for (int c = 0; c < 3; ++c) {
        out.color[c] = static_cast<float>(sum[c] / n);
        out.error = std::max(out.error, std::sqrt(std::max(squares[c] / n - sum[c] * sum[c] / (n * n), 0.0) / n));
    }
    return out;
}

}  // namespace steradian::test
