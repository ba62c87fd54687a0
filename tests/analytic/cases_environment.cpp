// Environments: constant and latitude-longitude images, seen and as light.
#include <algorithm>
#include <functional>

#include "analytic/case.h"

namespace steradian::analytic {
namespace {

/// Texel (x, y) of a map of the sky.
using Sky = std::function<Color(uint32_t x, uint32_t y)>;

struct Map {
    uint32_t width = 64, height = 32;
    Sky texel;

    Image image() const {
        Image out{width, height, {"R", "G", "B"}, {}, {}};
        for (uint32_t y = 0; y < height; ++y)
            for (uint32_t x = 0; x < width; ++x)
                for (int c = 0; c < 3; ++c) out.pixels.push_back(static_cast<float>(texel(x, y)[c]));
        return out;
    }

    /// Radiance at (s, t) in [0, 1]², interpolated between texel centres, around at the sides, continued at the poles.
    Color at(double s, double t) const {
        const double fx = s * width - 0.5, fy = t * height - 0.5, x0 = std::floor(fx), y0 = std::floor(fy);
        const auto read = [&](double x, double y) {
            const double around = x < 0 ? x + width : x >= width ? x - width : x;
            return texel(static_cast<uint32_t>(around), static_cast<uint32_t>(std::clamp(y, 0.0, height - 1.0)));
        };
        const double wx = fx - x0, wy = fy - y0;
        return (read(x0, y0) * (1 - wx) + read(x0 + 1, y0) * wx) * (1 - wy) +
               (read(x0, y0 + 1) * (1 - wx) + read(x0 + 1, y0 + 1) * wx) * wy;
    }

    /// Irradiance on a surface with normal n, the map not rotated: ∫ L cos dω, the quadrature aligned with the pieces
    /// on which the interpolation is smooth. For normals along an axis also the clamped cosine is smooth on each piece.
    Color irradiance(V3 n) const {
        Color sum;
        for (uint32_t y = 0; y < 2 * height; ++y)
            for (uint32_t x = 0; x < 2 * width; ++x) sum = sum + piece(n, 0.5 * x / width, 0.5 * y / height);
        return sum;
    }

private:
    /// Three by three nodes of Gauss and Legendre on a quarter of a texel.
    Color piece(V3 n, double s0, double t0) const {
        static constexpr double kNode[] = {-0.774596669241483377, 0, 0.774596669241483377},
                                kWeight[] = {5.0 / 9, 8.0 / 9, 5.0 / 9};
        const double hs = 0.25 / width, ht = 0.25 / height;
        Color sum;
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i) {
                const double s = s0 + hs * (1 + kNode[i]), t = t0 + ht * (1 + kNode[j]), phi = 2 * kPi * (s - 0.5),
                             theta = kPi * t;
                const V3 d{std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
                // dω = sin θ dθ dφ = 2π² sin θ ds dt
                sum = sum + at(s, t) * (kWeight[i] * kWeight[j] * hs * ht * std::max(0.0, dot(d, n)) * std::sin(theta) *
                                        2 * kPi * kPi);
            }
        return sum;
    }
};

Object image_environment(std::string_view path, double rotation = 0, Color radiance = 1.0) {
    return Object("environment")
        .set("path", path)
        .set("rotation", rotation)
        .set("radiance", radiance)
        .set("color_space", "linear");
}

void add_constant(std::vector<Case>& out) {
    const Color sky{1, 2, 0.5};
    SceneText visible = empty_scene().light(environment(1.0)).depth(0);
    out.push_back(as_in_catalogue(whole("env_visible", "L", visible, 1.0), "C01_env_visible"));
    out.push_back(whole("env_visible_color", "L per channel", empty_scene().light(environment(sky)).depth(0), sky));
    out.push_back(as_in_catalogue(whole("env_floor", "ρ L: sampled by the cosine, so without variance",
                                        floor_scene().light(environment(1.0)), kRho),
                                  "C02_env_floor"));
    // What is in the way of the sky is black; the floor sees the rest.
    SceneText under =
        floor_scene({1.5, 0.5, 0.9}).light(environment(sky)).object(disk({0, 2, 0}, {0, -1, 0}, 1, "black"));
    out.push_back(noisy(whole("env_floor_under_disk", "ρ L (1 - r² / (r² + h²))", under, sky * (kRho * 0.8))));
    SceneText corner = floor_scene({-0.6, 0.9, 0.5})
                           .light(environment(sky))
                           .object(rectangle({1, 1, 0}, {0, 0, 1}, {0, 1, 0}, "black"));
    out.push_back(noisy(whole("env_floor_beside_wall", "ρ L (1 - F of a perpendicular rectangle)", corner,
                              sky * (kRho * (1 - 2 * perpendicular_corner_form_factor(1, 2, 1))))));
}

void add_furnaces(std::vector<Case>& out) {
    const auto furnace = [&](const char* id, const char* formula, const Object& material, const char* catalogue) {
        SceneText scene = empty_scene()
                              .look({0, 0, 4}, {0, 0, 0}, 40)
                              .size(32, 32)
                              .material("it", material)
                              .object(sphere({0, 0, 0}, 1, "it"))
                              .light(environment(1.0));
        Case c = as_in_catalogue(whole(id, formula, scene, 1.0), catalogue);
        c.expected[0].every_pixel = true;
        out.push_back(c);
    };
    furnace("furnace_diffuse_sphere", "1: a white convex body in a white sky is not to be seen", diffuse(1.0),
            "C03_white_furnace_diffuse_sphere");
    furnace("furnace_mirror_sphere", "1", mirror(), "C04_white_furnace_mirror_sphere");
    furnace("furnace_diffuse_two_sided_sphere", "1", diffuse(1.0, true), "");
    const SceneText below = SceneText()
                                .look({0.3, -2, 0.5}, {0, 0, 0}, 20)
                                .size(16, 16)
                                .material("it", diffuse(0.5, true))
                                .object(ground({0, 0, 0}, 20, 20, "it"))
                                .light(environment(1.0));
    Case back = whole("furnace_diffuse_two_sided_back", "ρ L: the side that is seen is lit", below, 0.5);
    back.expected[0].every_pixel = true;
    out.push_back(back);
}

/// Blocks of colour around the six axes: −Z in the middle column, +X a quarter to its right, +Y on top.
Map compass() {
    return {64, 32, [](uint32_t x, uint32_t y) -> Color {
                if (y < 6) return {1, 1, 0};
                if (y >= 26) return {0, 1, 1};
                static const Color quarters[4] = {{1, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // -X, -Z, +X, +Z
                return quarters[((x + 56) % 64) / 16];
            }};
}

void add_compass(std::vector<Case>& out) {
    struct Look {
        const char* name;
        V3 direction;
        Color plain, turned;  ///< not rotated, and by 90° counter-clockwise seen from above: what was at -Z is at -X
    };
    const Color red{1, 0, 0}, green{0, 1, 0}, blue{0, 0, 1}, magenta{1, 0, 1}, yellow{1, 1, 0}, cyan{0, 1, 1};
    const Look looks[] = {{"minus_z", {0, 0, -1}, red, green},   {"plus_x", {1, 0, 0}, green, blue},
                          {"plus_z", {0, 0, 1}, blue, magenta},  {"minus_x", {-1, 0, 0}, magenta, red},
                          {"plus_y", {0, 1, 0}, yellow, yellow}, {"minus_y", {0, -1, 0}, cyan, cyan}};
    for (const char* extension : {"pfm", "hdr", "exr"}) {
        const std::string file = std::string("compass.") + extension;
        for (const Look& l : looks) {
            for (const bool turned : {false, true}) {
                if (turned && file != "compass.pfm") continue;
                SceneText scene = empty_scene()
                                      .look({0, 0, 0}, l.direction, kNarrow, {0.25, 0.5, 0.125})
                                      .depth(0)
                                      .light(image_environment(file, turned ? 90 : 0, 2.0));
                Case c =
                    whole(std::string("env_") + extension + (turned ? "_turned_" : "_") + l.name,
                          "the texel in that direction, times the scale", scene, (turned ? l.turned : l.plain) * 2);
                c.expected[0].every_pixel = true;
                c.files = {{file, compass().image()}};
                out.push_back(c);
            }
        }
    }
}

void add_light_case(std::vector<Case>& out, std::string id, std::string formula, const std::string& file,
                    const Map& map, Object light, V3 normal, Color irradiance) {
    // A small tile at the origin with the given normal, seen along it.
    const V3 u = normalized(cross(std::abs(normal.y) > 0.5 ? V3{1, 0, 0} : V3{0, 1, 0}, normal)), v = cross(normal, u);
    SceneText scene = empty_scene(normal * 2 + u * 0.5, {0, 0, 0})
                          .look(normal * 2 + u * 0.5, {0, 0, 0}, kNarrow, v)
                          .object(rectangle({0, 0, 0}, u, v, "floor"))
                          .light(light);
    Case c = noisy(whole(std::move(id), std::move(formula), scene, irradiance * (kRho / kPi)));
    c.files = {{file, map.image()}};
    out.push_back(c);
}

void add_image_light(std::vector<Case>& out) {
    // White where x > 0. The interpolation's ramps are symmetric about both borders, so half of the hemisphere is
    // white.
    const Map half{64, 32, [](uint32_t x, uint32_t) -> Color { return x >= 32 ? 1.0 : 0.0; }};
    add_light_case(out, "env_half_sky_floor", "ρ L / 2", "half_sky.exr", half, image_environment("half_sky.exr"), kUp,
                   kPi / 2);
    add_light_case(out, "env_half_sky_wall", "ρ/π ∫ L cos: faces the white half", "half_sky.exr", half,
                   image_environment("half_sky.exr"), {1, 0, 0}, half.irradiance({1, 0, 0}));
    add_light_case(out, "env_half_sky_turned_wall", "ρ/π ∫ L cos: turned by 90°, what was at +X is at -Z",
                   "half_sky.exr", half, image_environment("half_sky.exr", 90), {0, 0, -1}, half.irradiance({1, 0, 0}));
    const Map zenith{64, 32, [](uint32_t, uint32_t y) -> Color {
                         return {y < 8 ? 1.0 : 0.0, y >= 8 && y < 16 ? 1.0 : 0.0, y < 24 ? 0.25 : 1.0};
                     }};
    add_light_case(out, "env_bands_floor", "ρ/π ∫ L cos over bands of latitude, per channel", "bands.pfm", zenith,
                   image_environment("bands.pfm"), kUp, zenith.irradiance(kUp));
    // One texel of 4096 in a dim sky: a sun 5.6° across.
    const Map sun{64, 32, [](uint32_t x, uint32_t y) -> Color {
                      return x == 40 && y == 7 ? Color{4096, 2048, 1024} : Color{0.125, 0.25, 0.5};
                  }};
    add_light_case(out, "env_sun_floor", "ρ/π ∫ L cos: a sun of one texel in a dim sky", "sun.hdr", sun,
                   image_environment("sun.hdr"), kUp, sun.irradiance(kUp));
    add_light_case(out, "env_sun_wall", "ρ/π ∫ L cos", "sun.hdr", sun, image_environment("sun.hdr"), {1, 0, 0},
                   sun.irradiance({1, 0, 0}));
    add_light_case(out, "env_sun_behind_wall", "ρ/π ∫ L cos: the sun is behind the surface", "sun.hdr", sun,
                   image_environment("sun.hdr"), {-1, 0, 0}, sun.irradiance({-1, 0, 0}));
    const Map tiny{1, 1, [](uint32_t, uint32_t) -> Color { return {1, 0.5, 0.25}; }};
    add_light_case(out, "env_one_texel", "ρ L per channel", "one_texel.pfm", tiny,
                   image_environment("one_texel.pfm", 30, 2.0), kUp, Color{1, 0.5, 0.25} * (2 * kPi));
}

}  // namespace

std::vector<Case> environment_cases() {
    std::vector<Case> out;
    add_constant(out);
    add_furnaces(out);
    add_compass(out);
    add_image_light(out);
    return out;
}

}  // namespace steradian::analytic
