// Diffuse surfaces: their sides, their shading normals and their textures.
#include "analytic/case.h"

namespace steradian::analytic {
namespace {

const V3 kLight{0, 2, 0};
const V3 kDark{0, -2, 0};

double overhead() { return kRho / kPi * 10 / 4; }

void add_sides(std::vector<Case>& out) {
    struct Side {
        const char* name;
        bool two_sided, from_above, lit_from_above;
    };
    // The floor's normal points up. What is lit is the side that is looked at, or nothing.
    const Side sides[] = {{"one_sided_front", false, true, true},
                          {"one_sided_back", false, false, false},
                          {"two_sided_front", true, true, true},
                          {"two_sided_back", true, false, false},
                          {"one_sided_through", false, false, true},
                          {"two_sided_through", true, false, true},
                          {"two_sided_through_downwards", true, true, false}};
    for (const Side& s : sides) {
        SceneText scene = empty_scene({0.6, s.from_above ? 0.9 : -0.9, 0.9})
                              .material("it", diffuse(kRho, s.two_sided))
                              .object(ground({0, 0, 0}, 20, 20, "it"));
        scene.light(point_light(s.lit_from_above ? kLight : kDark, 10));
        const bool same_side = s.from_above == s.lit_from_above;
        const bool seen = same_side && (s.two_sided || s.from_above);
        out.push_back(whole(std::string("diffuse_") + s.name,
                            seen ? "ρ/π I cos θ / d²" : "0: that side is not lit, or does not reflect", scene,
                            seen ? overhead() : 0.0));
    }
}

void add_shading_normals(std::vector<Case>& out) {
    const V3 tilted = normalized({0.25, 1, 0.125});
    const auto floor_mesh = [](const char* normals) {
        return polygon({{-20, 0, 20}, {20, 0, 20}, {20, 0, -20}, {-20, 0, -20}}, "floor").raw("normals", normals);
    };
    const std::string n = text_of(V3{0.25, 1, 0.125} * 3);  // not of unit length
    SceneText scene = empty_scene()
                          .object(floor_mesh(("[" + n + ", " + n + ", " + n + ", " + n + "]").c_str()))
                          .light(point_light(kLight, 10));
    out.push_back(whole("shading_normal_tilted", "ρ/π I (n · ω) / d² with the given normal", scene,
                        kRho / kPi * 10 * tilted.y / 4));
    // Normals that lean inwards along x: interpolated and normalised they are up in the middle.
    SceneText mixed = empty_scene()
                          .object(floor_mesh("[[1, 1, 0], [-1, 1, 0], [-1, 1, 0], [1, 1, 0]]"))
                          .light(point_light(kLight, 10));
    out.push_back(whole("shading_normal_interpolated", "ρ/π I / d²: up in the middle", mixed, overhead()));
}

/// A square metre in a white sky, straight from above, filling the picture: each pixel shows its reflectance.
SceneText tile_scene(const Object& texture, double side_in_view = 1) {
    SceneText scene = empty_scene()
                          .texture("map", texture)
                          .material("tile", Object("diffuse").set("reflectance", "map"))
                          .light(environment(1.0));
    scene.look({0, 0, 1}, {0, 0, 0}, 2 * std::atan(side_in_view / 2) * 180 / kPi);
    return scene.object(rectangle({0, 0, 0}, {0.5, 0, 0}, {0, 0.5, 0}, "tile"));
}

/// 2 × 2 texels: red, green above blue, white; all of reflectance 3/4.
Image four_texels() {
    return {2, 2, {"R", "G", "B"}, {0.75f, 0, 0, 0, 0.75f, 0, 0, 0, 0.75f, 0.75f, 0.75f, 0.75f}, {}};
}

void add_textures(std::vector<Case>& out) {
    const Color red{0.75, 0, 0}, green{0, 0.75, 0}, blue{0, 0, 0.75}, white = 0.75;
    const auto quadrants = [](Case c, Color top_left, Color top_right, Color bottom_left, Color bottom_right) {
        c.expected = {{0, 0, 4, 4, top_left, true},
                      {4, 0, 8, 4, top_right, true},
                      {0, 4, 4, 8, bottom_left, true},
                      {4, 4, 8, 8, bottom_right, true}};
        return c;
    };
    const Object checker =
        Object("checkerboard").set("color0", Color{0.5, 0.25, 0.125}).set("color1", 0.75).raw("scale", "[2, 2]");
    out.push_back(
        quadrants(whole("texture_checkerboard", "color0 where floor(2u) + floor(2v) is even", tile_scene(checker), 0.0),
                  {0.5, 0.25, 0.125}, 0.75, 0.75, {0.5, 0.25, 0.125}));
    const auto image = [](const char* filter) {
        return Object("image").set("path", "four.pfm").set("filter", filter).set("color_space", "linear");
    };
    Case nearest =
        quadrants(whole("texture_image_nearest", "the texels, top row at the top", tile_scene(image("nearest")), 0.0),
                  red, green, blue, white);
    nearest.files = {{"four.pfm", four_texels()}};
    out.push_back(nearest);
    Case shifted = quadrants(whole("texture_image_offset", "shifted by one texel to the left, repeated",
                                   tile_scene(image("nearest").raw("offset", "[0.5, 0]")), 0.0),
                             green, red, white, blue);
    shifted.files = nearest.files;
    out.push_back(shifted);
    // In the very middle of the four texels each counts a quarter.
    Case middle = whole("texture_image_bilinear", "the mean of four texels at their common corner",
                        tile_scene(image("bilinear"), 1.0 / 1024), (red + green + blue + white) * 0.25);
    middle.files = nearest.files;
    out.push_back(noisy(middle));
    // sRGB: PNG stores code values; the picture is written through the same curve, to 8 bits, so a grey of a whole
    // code.
    const double code = 188, linear = std::pow((code / 255 + 0.055) / 1.055, 2.4);
    const auto grey = static_cast<float>(linear);
    Case srgb = whole("texture_srgb_png", "((c/255 + 0.055) / 1.055)^2.4 for c = 188",
                      tile_scene(Object("image").set("path", "grey.png")), linear);
    srgb.files = {{"grey.png", Image{2, 2, {"R", "G", "B"}, std::vector<float>(12, grey), {}}}};
    srgb.expected[0].every_pixel = true;
    out.push_back(srgb);
}

}  // namespace

std::vector<Case> surface_cases() {
    std::vector<Case> out;
    add_sides(out);
    add_shading_normals(out);
    add_textures(out);
    return out;
}

}  // namespace steradian::analytic
