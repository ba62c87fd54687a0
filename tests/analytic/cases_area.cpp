// Area lights of radiance 4 over a floor of reflectance 1/2: ρ L F, F being the form factor.
#include <tuple>

#include "analytic/case.h"

namespace steradian::analytic {
namespace {

constexpr double kL = 4;

Object lit(Object shape, Color radiance = kL) { return shape.set("light", emission(radiance)); }

Case one_light(std::string id, std::string formula, const Object& light, double form_factor,
               V3 from = {0.6, 0.9, 0.9}) {
    return noisy(whole(std::move(id), "ρ L F, " + std::move(formula), floor_scene(from).object(lit(light)),
                       kRho * kL * form_factor));
}

void add_rectangles(std::vector<Case>& out) {
    const double centred = 4 * parallel_corner_form_factor(1, 1, 2);
    const double corner = parallel_corner_form_factor(2, 2, 2);
    out.push_back(as_in_catalogue(
        one_light("rect_centred", "F of four parallel corners", ceiling({0, 2, 0}, 1, 1, "black"), centred),
        "B01_rect_centred"));
    out.push_back(
        as_in_catalogue(one_light("rect_corner", "F of a parallel corner", ceiling({1, 2, 1}, 1, 1, "black"), corner),
                        "B02_rect_corner"));
    const double offset = 2 * (parallel_corner_form_factor(3, 1, 2) - parallel_corner_form_factor(1, 1, 2));
    out.push_back(as_in_catalogue(one_light("rect_offset", "F of parallel corners, added and subtracted",
                                            ceiling({2, 2, 0}, 1, 1, "black"), offset),
                                  "B03_rect_offset"));
    const auto wall = [](double y, double half_y) {
        return rectangle({1, y, 0}, {0, 0, 1}, {0, half_y, 0}, "black");
    };  // faces -X
    const double upright = 2 * perpendicular_corner_form_factor(1, 2, 1);
    out.push_back(as_in_catalogue(
        one_light("rect_perpendicular", "F of two perpendicular corners", wall(1, 1), upright, {-0.6, 0.9, 0.5}),
        "B04_rect_perpendicular"));
    const double raised = 2 * (perpendicular_corner_form_factor(1, 3, 1) - perpendicular_corner_form_factor(1, 1, 1));
    out.push_back(
        as_in_catalogue(one_light("rect_perpendicular_raised", "F of perpendicular corners, added and subtracted",
                                  wall(2, 1), raised, {-0.6, 0.5, 0.5}),
                        "B05_rect_perp_raised"));

    // Half of the light is below the horizon; the floor is small, so that it does not hide that half.
    SceneText half_set =
        empty_scene({-0.6, 0.9, 0.5}).object(ground({0, 0, 0}, 0.25, 0.25, "floor")).object(lit(wall(0, 2)));
    out.push_back(
        noisy(whole("rect_half_below_horizon", "ρ L F of the part above the horizon", half_set, kRho * kL * upright)));

    const std::vector<V3> slanted{{-0.75, 1.75, -1}, {1.25, 1.25, -1.5}, {1.25, 2.25, 1}, {-0.75, 2.75, 1.5}};
    const Object parallelogram = rectangle({0.25, 2, 0}, {1, -0.25, -0.25}, {0, 0.5, 1.25}, "black");
    out.push_back(one_light("rect_slanted_parallelogram", "F by Lambert's polygon formula", parallelogram,
                            polygon_form_factor(slanted, {}, kUp)));
    const Object thin = ceiling({0, 0.5, 0}, 20, 0.0009765625, "black");
    out.push_back(one_light("rect_thin_and_long", "F of four parallel corners", thin,
                            4 * parallel_corner_form_factor(20, 0.0009765625, 0.5), {0, 0.25, 0.9}));
    out.push_back(one_light("rect_very_near", "F of four parallel corners", ceiling({0, 0.015625, 0}, 1, 1, "black"),
                            4 * parallel_corner_form_factor(1, 1, 0.015625), {0.5, 0.0078125, 0}));
}

/// Light of two colours side by side: nearer to the floor's origin, and farther away from it.
void add_textured(std::vector<Case>& out) {
    const Color near{1, 0.5, 0}, far{0.125, 0.25, 2};
    const double near_factor = 2 * parallel_corner_form_factor(1, 1, 2),
                 far_factor = 2 * parallel_corner_form_factor(2, 1, 2) - near_factor;
    const Color value = (near * near_factor + far * far_factor) * (kRho * kL);
    const auto glowing = [&](bool two_sided) {
        return emission(kL, two_sided)
            .set("texture", Object("checkerboard").set("color0", near).set("color1", far).raw("scale", "[2, 0.5]"));
    };
    const auto add = [&](const char* id, const char* what, const Object& light) {
        out.push_back(noisy(
            whole(id, std::string("ρ (L₁ F₁ + L₂ F₂), ") + what, floor_scene({-0.6, 0.9, 0.9}).object(light), value)));
    };
    const Object sheet = rectangle({1, 2, 0}, {1, 0, 0}, {0, 0, 1}, "black");
    add("rect_textured", "by solid angle", Object(sheet).set("light", glowing(false)));
    add("rect_textured_two_sided", "by solid angle", Object(sheet).set("light", glowing(true)));
    // The border between the colours runs across both triangles.
    const std::vector<V3> square{{0, 2, -1}, {2, 2, -1}, {2, 2, 1}, {0, 2, 1}};
    add("mesh_textured", "a mesh of two triangles",
        polygon(square, "black").raw("uvs", "[[0, 0], [1, 0], [1, 1], [0, 1]]").set("light", glowing(false)));
    // Each triangle has one colour.
    const std::vector<V3> tiles{{0, 2, -1}, {1, 2, -1}, {1, 2, 1}, {0, 2, 1},
                                {1, 2, -1}, {2, 2, -1}, {2, 2, 1}, {1, 2, 1}};
    std::string places;
    for (int i = 0; i < 8; ++i) places += i == 0 ? "[[0.25, 0]" : i < 4 ? ", [0.25, 0]" : ", [0.75, 0]";
    add("mesh_textured_by_triangle", "a mesh of four triangles",
        mesh(tiles, {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}, "black")
            .raw("uvs", places + "]")
            .set("light", glowing(true)));
    // Seen: the colour of the place, on the back where there are two sides.
    for (const bool back : {false, true})
        for (const bool is_far : {false, true}) {
            const double x = is_far ? 1.5 : 0.5;
            const SceneText scene = empty_scene({x, back ? 4.0 : 0.0, 0.5}, {x, 2, 0.25})
                                        .object(Object(sheet).set("light", glowing(true)))
                                        .depth(0);
            out.push_back(whole(std::string("rect_textured_") + (back ? "back_" : "front_") + (is_far ? "far" : "near"),
                                "L of the place", scene, (is_far ? far : near) * kL));
        }
}

/// Flat lights of paper, askew, so that rounding has their own points before or behind them. Seen from above.
void add_own_points(std::vector<Case>& out) {
    const auto seen = [&](const std::string& id, const Object& light, double value) {
        SceneText scene = empty_scene({0.3, 2, 1.7}, {0, 0.5, 0}).material("paper", diffuse(kRho, true));
        out.push_back(whole(id, value == 0 ? "0: lit by nothing" : "L: lit by nothing", scene.object(light), value));
    };
    const Object sheet = rectangle({0, 0.5, 0}, {0.4, 0, 0}, {0, -0.3, 0.3}, "paper");
    const Object round = disk({0, 0.5, 0}, {0, -1, -1}, 0.4, "paper");
    seen("rect_own_back", Object(sheet).set("light", emission(kL)), 0);
    seen("rect_own_front", Object(sheet).set("light", emission(kL, true)), kL);
    seen("disk_own_back", Object(round).set("light", emission(kL)), 0);
    seen("disk_own_front", Object(round).set("light", emission(kL, true)), kL);
}

void add_meshes(std::vector<Case>& out) {
    const std::vector<V3> square{{-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}};
    out.push_back(as_in_catalogue(one_light("mesh_rect_centred", "F of four parallel corners; a mesh of two triangles",
                                            polygon(square, "black"), 4 * parallel_corner_form_factor(1, 1, 2)),
                                  "B01_rect_centred"));
    const std::vector<V3> triangle{{-1, 1, 0.5}, {0, 1.5, -1.5}, {1, 2, 0.5}};
    out.push_back(
        as_in_catalogue(one_light("triangle_tilted", "F by Lambert's polygon formula", polygon(triangle, "black"),
                                  polygon_form_factor(triangle, {}, kUp), {0.8, 0.5, 0.9}),
                        "B06_tilted_triangle"));
    // A closed box: what of its top and its sides is seen from below it, by one-sided emission.
    const std::vector<V3> corners{{-0.5, 1, -0.5}, {0.5, 1, -0.5}, {0.5, 1, 0.5}, {-0.5, 1, 0.5},
                                  {-0.5, 2, -0.5}, {0.5, 2, -0.5}, {0.5, 2, 0.5}, {-0.5, 2, 0.5}};
    const std::vector<std::vector<int>> outwards{{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}, {0, 5, 1}, {0, 4, 5},
                                                 {1, 6, 2}, {1, 5, 6}, {2, 7, 3}, {2, 6, 7}, {3, 4, 0}, {3, 7, 4}};
    out.push_back(one_light("mesh_box", "F of four parallel corners: of a box above only the lower face is seen",
                            mesh(corners, outwards, "black"), 4 * parallel_corner_form_factor(0.5, 0.5, 1)));
}

void add_round(std::vector<Case>& out) {
    out.push_back(
        as_in_catalogue(one_light("disk_centred", "F = r² / (r² + h²)", disk({0, 2, 0}, {0, -1, 0}, 1, "black"),
                                  parallel_disk_form_factor(1, 2, 0), {1.5, 0.5, 0.9}),
                        "B07_disk"));
    out.push_back(
        as_in_catalogue(one_light("disk_offset", "F of a parallel disk", disk({1.5, 2, 0}, {0, -1, 0}, 1, "black"),
                                  parallel_disk_form_factor(1, 2, 1.5), {-0.6, 0.9, 0.9}),
                        "B08_disk_offset"));
    out.push_back(one_light("disk_perpendicular", "F of a perpendicular disk",
                            disk({2, 1.5, 0}, {-1, 0, 0}, 1, "black"), perpendicular_disk_form_factor(1, 1.5, 2),
                            {-0.6, 0.9, 0.9}));
    out.push_back(as_in_catalogue(
        one_light("sphere_overhead", "F = sin² σ", sphere({0, 2, 0}, 0.5, "black"), sphere_form_factor(0.5, 2, 0)),
        "B09_sphere_overhead"));
    const double s = std::sqrt(2);
    out.push_back(as_in_catalogue(one_light("sphere_45deg", "F = sin² σ cos 45°", sphere({s, s, 0}, 0.5, "black"),
                                            sphere_form_factor(0.5, 2, 45), {-0.6, 0.9, 0.9}),
                                  "B10_sphere_45deg"));
    out.push_back(one_light("sphere_far_and_small", "F = sin² σ", sphere({0, 200, 0}, 0.5, "black"),
                            sphere_form_factor(0.5, 200, 0)));
    // The camera looks in from the side under the sphere, so that even a narrow view covers much of the floor.
    SceneText near =
        floor_scene().look({1.5, 0.0625, 0}, {0, 0, 0}, 0.002).object(lit(sphere({0, 1.03125, 0}, 1, "black")));
    out.push_back(
        noisy(whole("sphere_near", "ρ L F, F = sin² σ", near, kRho * kL * sphere_form_factor(1, 1.03125, 0))));
    SceneText setting = empty_scene({-0.6, 0.9, 0.9})
                            .object(ground({0, 0, 0}, 0.25, 0.25, "floor"))
                            .object(lit(sphere({2, 0, 0}, 0.5, "black")));
    out.push_back(noisy(whole("sphere_half_set", "ρ L (σ - sin σ cos σ) / π: centred on the horizon", setting,
                              kRho * kL * setting_sphere_form_factor(0.5, 2))));
    const Object ellipsoid =
        sphere({0, 0, 0}, 1, "black").raw("transform", steps({scale({1.25, 0.5, 1.25}), translate({0, 2, 0})}));
    out.push_back(one_light("ellipsoid_overhead", "F = a² / (a² + h² - b²), of its tangent cone", ellipsoid,
                            overhead_ellipsoid_form_factor(1.25, 0.5, 2), {1.5, 0.5, 0.9}));
    SceneText inside = floor_scene().object(sphere({0, 0.5, 0}, 5, "black").set("light", emission(kL, true)));
    out.push_back(noisy(whole("sphere_around_everything", "ρ L: the whole sky", inside, kRho * kL)));
}

/// Exactly half, or a quarter, of a symmetric light is hidden by a blocker that is symmetric about the same axis: as
/// the point moves, what appears on one side disappears on the other, so the mean over the footprint has no first-order
/// error.
void add_occluded(std::vector<Case>& out) {
    const auto hidden = [&](const char* id, const char* formula, const Object& light, double form_factor,
                            const Object& blocker, double share) {
        const SceneText scene = floor_scene().object(lit(light)).object(blocker);
        out.push_back(noisy(whole(id, formula, scene, kRho * kL * form_factor * share)));
    };
    const Object square = ceiling({0, 2, 0}, 1, 1, "black");
    const double f = 4 * parallel_corner_form_factor(1, 1, 2);
    hidden("rect_half_occluded", "ρ L F / 2: a half-plane hides x > 0", square, f, ceiling({4, 1, 0}, 4, 4, "black"),
           0.5);
    hidden("rect_quarter_left", "ρ L F / 4: an L-shaped blocker leaves one quadrant", square, f,
           mesh({{-4, 1, -4}, {0, 1, -4}, {4, 1, -4}, {4, 1, 0}, {4, 1, 4}, {0, 1, 4}, {0, 1, 0}, {-4, 1, 0}},
                {{0, 1, 6}, {0, 6, 7}, {1, 2, 3}, {1, 3, 6}, {6, 3, 4}, {6, 4, 5}}, "black"),
           0.25);
    hidden("disk_half_occluded", "ρ L F / 2", disk({0, 2, 0}, {0, -1, 0}, 1, "black"), 0.2,
           ceiling({4, 1, 0}, 4, 4, "black"), 0.5);
    hidden("sphere_half_occluded", "ρ L F / 2", sphere({0, 2, 0}, 0.5, "black"), sphere_form_factor(0.5, 2, 0),
           ceiling({4, 1, 0}, 4, 4, "black"), 0.5);
    // The umbra of a smaller square hides the same square scaled up: F of the light less F of the blocker as if it
    // shone.
    hidden("rect_ring", "ρ L (F of the light - F of the blocker)", square,
           f - 4 * parallel_corner_form_factor(0.25, 0.25, 1), ceiling({0, 1, 0}, 0.25, 0.25, "black"), 1);
    hidden("rect_ring_round", "ρ L (F of the light - F of a spherical blocker)", square,
           f - sphere_form_factor(0.125, 1, 0), sphere({0, 1, 0}, 0.125, "black"), 1);
}

/// Inside a closed box whose walls shine: every point sees radiance 1 all around, so direct light adds ρ.
void add_boxes(std::vector<Case>& out) {
    const Color rho{0.25, 0.5, 0.75}, radiance = 1.0;
    SceneText six = empty_scene().material("wall", diffuse(kRho)).look({0.1, 0.2, 0.3}, {0, 0, -1}, 60);
    for (const auto& [center, u, v] : std::vector<std::tuple<V3, V3, V3>>{{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                                                          {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                                                                          {{0, -1, 0}, {0, 0, 1}, {1, 0, 0}},
                                                                          {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
                                                                          {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}},
                                                                          {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}})
        six.object(lit(rectangle(center, u, v, "wall"), radiance));
    out.push_back(
        as_in_catalogue(noisy(whole("furnace_box_six_rectangles", "1 + ρ", six, 1 + kRho)), "D03_furnace_direct_only"));

    const std::vector<V3> corners{{-1, -1, -1}, {1, -1, -1}, {1, -1, 1}, {-1, -1, 1},
                                  {-1, 1, -1},  {1, 1, -1},  {1, 1, 1},  {-1, 1, 1}};
    const std::vector<std::vector<int>> inwards{{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
                                                {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
    SceneText box = empty_scene()
                        .material("wall", diffuse(rho))
                        .look({0.1, 0.2, 0.3}, {0, 0, -1}, 60)
                        .object(lit(mesh(corners, inwards, "wall"), radiance));
    out.push_back(noisy(whole("furnace_box_mesh", "1 + ρ per channel", box, Color(1.0) + rho)));
}

void add_many(std::vector<Case>& out) {
    SceneText colored = floor_scene();
    colored.object(lit(ceiling({-1, 2, 0}, 0.5, 0.5, "black"), Color{4, 0, 0}))
        .object(lit(sphere({1, 2, 0}, 0.25, "black"), Color{0, 8, 0}));
    colored.object(lit(disk({0, 2, 1}, {0, -1, 0}, 0.5, "black"), Color{0, 0, 16})).light(point_light({0, 2, 0}, 1.0));
    const double d = std::sqrt(5), point = kRho / kPi / 4;
    const double r = 2 * (parallel_corner_form_factor(1.5, 0.5, 2) - parallel_corner_form_factor(0.5, 0.5, 2));
    const Color value{kRho * 4 * r + point,
                      kRho * 8 * sphere_form_factor(0.25, d, std::acos(2 / d) * 180 / kPi) + point,
                      kRho * 16 * parallel_disk_form_factor(0.5, 2, 1) + point};
    out.push_back(noisy(whole("lights_of_four_kinds", "ρ L F per channel + ρ/π I / d²", colored, value)));
}

}  // namespace

std::vector<Case> area_light_cases() {
    std::vector<Case> out;
    add_rectangles(out);
    add_textured(out);
    add_own_points(out);
    add_meshes(out);
    add_round(out);
    add_occluded(out);
    add_boxes(out);
    add_many(out);
    return out;
}

}  // namespace steradian::analytic
