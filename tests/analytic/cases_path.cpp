// Light that takes more than one bounce.
#include "analytic/case.h"

namespace steradian::analytic {
namespace {

const Color kAlbedo{0.1, 0.3, 0.5};

Object lit(Object shape, Color radiance, bool two_sided = false) {
    return shape.set("light", emission(radiance, two_sided));
}

/// Σ ρ^k from k = 0 to `bounces`, per channel.
Color geometric_sum(Color rho, int bounces) {
    Color sum = 0.0, power = 1.0;
    for (int k = 0; k <= bounces; ++k) {
        sum = sum + power;
        power = power * rho;
    }
    return sum;
}

SceneText closed(const Object& wall) {
    return empty_scene().material("wall", wall).look({0.1, 0.2, 0.3}, {0, 0, -1}, 60).integrator("path");
}

/// A closed body whose walls emit E = 1 and reflect ρ: the radiance is the same everywhere.
void add_furnaces(std::vector<Case>& out) {
    SceneText box = closed(diffuse(kAlbedo));
    for (const auto& [center, u, v] : {std::array<V3, 3>{{{0, -1, 0}, {1, 0, 0}, {0, 0, -1}}},
                                       {{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}}},
                                       {{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                                       {{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}}},
                                       {{{0, 0, -1}, {1, 0, 0}, {0, 1, 0}}},
                                       {{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}}})
        box.object(lit(rectangle(center, u, v, "wall"), 1));
    for (const int depth : {0, 1, 2, 8}) {
        Case c = whole("path_furnace_box_depth_" + std::to_string(depth), "E Σ ρ^k up to the depth, per channel",
                       box.depth(depth), geometric_sum(kAlbedo, depth));
        out.push_back(depth == 0 ? c : noisy(c));
    }
    for (const char* strategy : {"light", "bsdf"})
        out.push_back(noisy(whole(std::string("path_furnace_box_by_") + strategy, "E (1 + ρ + ρ²) per channel",
                                  box.depth(2).light_sampling(strategy), geometric_sum(kAlbedo, 2))));

    SceneText hollow = closed(diffuse(kAlbedo, true));
    hollow.object(lit(sphere({0, 0, 0}, 1, "wall"), 1, true));
    for (const int depth : {1, 2, 8})
        out.push_back(
            noisy(whole("path_furnace_sphere_depth_" + std::to_string(depth), "E Σ ρ^k up to the depth, per channel",
                        hollow.depth(depth), geometric_sum(kAlbedo, depth))));

    const std::vector<V3> corners{{-1, -1, -1}, {1, -1, -1}, {1, -1, 1}, {-1, -1, 1},
                                  {-1, 1, -1},  {1, 1, -1},  {1, 1, 1},  {-1, 1, 1}};
    const std::vector<std::vector<int>> inwards{{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
                                                {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
    SceneText triangles = closed(diffuse(kAlbedo)).object(lit(mesh(corners, inwards, "wall"), 1)).depth(4);
    out.push_back(noisy(
        whole("path_furnace_mesh", "E Σ ρ^k up to the depth, per channel", triangles, geometric_sum(kAlbedo, 4))));
}

/// Seen from its outside, a convex body that emits on both sides does not light itself.
void add_convex_emitters(std::vector<Case>& out) {
    for (const char* integrator : {"direct", "path"})
        for (const bool two_sided : {false, true}) {
            SceneText ball = empty_scene({0, 0, 5}).material("it", diffuse(kAlbedo, true)).integrator(integrator);
            ball.object(lit(sphere({0, 0, 0}, 1, "it"), Color{3, 2, 1}, two_sided)).depth(3);
            out.push_back(whole(std::string(integrator) + "_convex_emitter" + (two_sided ? "_two_sided" : ""),
                                "L: it does not light itself", ball, Color{3, 2, 1}));
        }
}

/// Whatever stands in a sky of radiance 1 and absorbs nothing is not to be seen, once all paths have left.
void add_white_skies(std::vector<Case>& out) {
    const auto under_sky = [](const SceneText& scene) {
        return SceneText(scene).integrator("path").depth(64).light(environment(1.0));
    };
    SceneText corner = empty_scene().material("white", diffuse(1.0, true)).object(ground({0, 0, 0}, 3, 3, "white"));
    corner.object(rectangle({0, 1, -0.5}, {3, 0, 0}, {0, 1, 0}, "white"));
    out.push_back(noisy(whole("path_furnace_corner", "1: nothing is lost", under_sky(corner), 1.0)));
    SceneText ball = empty_scene({0.6, 0.9, 2}).material("white", diffuse(1.0, true)).material("glass", glass(1.5));
    ball.object(ground({0, 0, 0}, 3, 3, "white")).object(sphere({0, 0.6, 0.2}, 0.5, "glass"));
    out.push_back(noisy(whole("path_furnace_below_glass", "1: nothing is lost", under_sky(ball), 1.0)));
    SceneText mirrors = corner;
    mirrors.material("mirror", mirror()).object(sphere({-0.4, 0.4, 0.2}, 0.3, "mirror"));
    out.push_back(noisy(whole("path_furnace_beside_mirror", "1: nothing is lost", under_sky(mirrors), 1.0)));
}

/// The indirect light in a hollow sphere is the same everywhere, wherever its source is: Φ / (4π R²) is the mean
/// irradiance from outside, and each bounce multiplies by ρ.
void add_integrating_sphere(std::vector<Case>& out) {
    const double radius = 2, intensity = 10;
    const V3 light{0.5, 0.25, -0.75}, seen{0, 0, -2};
    const double direct = intensity * point_irradiance(light, seen, {0, 0, 1}), mean = intensity / (radius * radius);
    for (const int depth : {1, 2, 3, 8}) {
        SceneText scene = empty_scene({0, 0, 1}, seen).material("wall", diffuse(kAlbedo, true)).integrator("path");
        scene.object(sphere({0, 0, 0}, radius, "wall")).light(point_light(light, intensity)).depth(depth);
        const Color later = geometric_sum(kAlbedo, depth - 1) + Color(-1.0);
        Case c = whole("path_integrating_sphere_depth_" + std::to_string(depth),
                       "ρ/π (I cos θ / d² + I / R² Σ ρ^k), k from 1 up to the depth - 1", scene,
                       kAlbedo * (1 / kPi) * (Color(direct) + later * mean));
        out.push_back(depth == 1 ? c : noisy(c));
    }
}

/// A mirror beside a light shows the floor a second one.
void add_caustics(std::vector<Case>& out) {
    SceneText scene = floor_scene({0.6, 0.9, 0.9}).integrator("path").depth(2);
    scene.object(lit(ceiling({0.2, 2, 0}, 0.5, 0.5, "black"), 4));
    scene.material("mirror", mirror(0.8)).object(rectangle({-1, 2, 0}, {0, 0, 3}, {0, -3, 0}, "mirror"));
    const auto form_factor = [](double x) {  // of a square with its centre above (x, 0)
        return 2 * (parallel_corner_form_factor(x + 0.5, 0.5, 2) - parallel_corner_form_factor(x - 0.5, 0.5, 2));
    };
    const double own = 2 * (parallel_corner_form_factor(0.7, 0.5, 2) + parallel_corner_form_factor(0.3, 0.5, 2));
    out.push_back(noisy(whole("path_light_in_mirror", "ρ L (F + r F of the mirror image)", scene,
                              kRho * 4 * (own + 0.8 * form_factor(2.2)))));
    scene.depth(1);
    out.push_back(noisy(whole("path_light_in_mirror_depth_1", "ρ L F: the mirror is a bounce", scene, kRho * 4 * own)));
}

/// So many lights that one of them is chosen.
void add_many_lights(std::vector<Case>& out) {
    SceneText scene = floor_scene().integrator("path").depth(1);
    for (int i = 0; i < 5; ++i)
        for (int j = 0; j < 5; ++j)
            scene.object(lit(ceiling({-0.4 + 0.2 * i, 2, -0.4 + 0.2 * j}, 0.1, 0.1, "black"), 4));
    out.push_back(noisy(whole("path_many_lights", "ρ L F of the 25 squares together", scene,
                              kRho * 4 * 4 * parallel_corner_form_factor(0.5, 0.5, 2))));
}

}  // namespace

std::vector<Case> path_cases() {
    std::vector<Case> out;
    add_furnaces(out);
    add_convex_emitters(out);
    add_white_skies(out);
    add_integrating_sphere(out);
    add_caustics(out);
    add_many_lights(out);
    return out;
}

}  // namespace steradian::analytic
