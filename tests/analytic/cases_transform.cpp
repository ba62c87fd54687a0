// The same scenes placed, turned, mirrored and scaled: by transforms, by instances, and as a whole, from millimetres to
// thousands of kilometres. The values do not change.
#include "analytic/case.h"

namespace steradian::analytic {
namespace {

constexpr double kL = 4;

Object lit(Object shape) { return shape.set("light", emission(kL)); }
Object moved(Object shape, const std::vector<Object>& by) { return shape.raw("transform", steps(by)); }

/// Every way of getting the square of B01, 2 × 2 at y = 2 facing down, out of something else.
void add_transformed(std::vector<Case>& out) {
    const double f = 4 * parallel_corner_form_factor(1, 1, 2);
    const auto square = [&](const char* id, const char* formula, const Object& object) {
        out.push_back(noisy(whole(std::string("transform_") + id, std::string("ρ L F of the square, ") + formula,
                                  floor_scene().object(lit(object)), kRho * kL * f)));
    };
    const Object unit = rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, "black");  // faces +Z
    square("rect_rotated", "turned and moved", moved(unit, {rotate({1, 0, 0}, 90), translate({0, 2, 0})}));
    square("rect_scaled", "from a smaller one",
           moved(rectangle({0, 0, 0}, {0.25, 0, 0}, {0, 0.5, 0}, "black"),
                 {scale({4, 2, 1}), rotate({1, 0, 0}, 90), translate({0, 2, 0})}));
    // A mirror image of a rectangle still shines outwards from the same side: +Z becomes +Z.
    square("rect_mirrored", "mirrored in x",
           moved(unit, {scale({-1, 1, 1}), rotate({1, 0, 0}, 90), translate({0, 2, 0})}));
    square("rect_mirrored_in_its_normal", "mirrored in z, so that it is turned around",
           moved(unit, {scale({1, 1, -1}), rotate({1, 0, 0}, -90), translate({0, 2, 0})}));
    square("rect_by_matrix", "by a matrix",
           Object(unit).raw("transform", "[[1, 0, 0, 0], [0, 0, -1, 2], [0, 1, 0, 0]]"));
    square("rect_by_look_at", "by look_at, +Z towards the target",
           Object(unit).set(
               "transform",
               Object().set("look_at",
                            Object().set("origin", V3{0, 2, 0}).set("target", V3{0, 0, 0}).set("up", V3{0, 0, 1}))));
    square("rect_sheared_back", "a parallelogram sheared into the square",
           Object(rectangle({0, 2, 0}, {1, 0, 0}, {1, 0, 1}, "black"))
               .raw("transform", "[[1, 0, -1, 0], [0, 1, 0, 0], [0, 0, 1, 0]]"));
    const std::vector<V3> flat{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    square("mesh_rotated", "turned and moved; a mesh of its own",
           moved(polygon(flat, "black"), {rotate({1, 0, 0}, 90), translate({0, 2, 0})}));
    square("mesh_mirrored", "mirrored in x",
           moved(polygon(flat, "black"), {scale({-1, 1, 1}), rotate({1, 0, 0}, 90), translate({0, 2, 0})}));
}

/// Four quarters of the square as instances of one shared mesh, placed, turned and mirrored.
void add_instances(std::vector<Case>& out) {
    const double f = 4 * parallel_corner_form_factor(1, 1, 2);
    const Object quarter_mesh = polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, "");  // faces +Z
    const Object quarter_rect =
        Object("rectangle").set("center", V3{0.5, 0.5, 0}).set("half_u", V3{0.5, 0, 0}).set("half_v", V3{0, 0.5, 0});
    for (const auto& [name, shape] : {std::pair("mesh", quarter_mesh), std::pair("rectangle", quarter_rect)}) {
        for (const bool mirrored : {false, true}) {
            SceneText scene = floor_scene().shape("quarter", shape);
            for (int i = 0; i < 4; ++i) {
                const Object place =
                    mirrored ? scale({i % 2 ? -1.0 : 1.0, i / 2 ? -1.0 : 1.0, 1}) : rotate({0, 0, 1}, 90.0 * i);
                scene.object(lit(moved(Object("instance").set("shape", "quarter").set("material", "black"),
                                       {place, rotate({1, 0, 0}, 90), translate({0, 2, 0})})));
            }
            out.push_back(noisy(whole(std::string("instances_") + name + (mirrored ? "_mirrored" : "_turned"),
                                      "ρ L F of the square in four instances of a quarter", scene, kRho * kL * f)));
        }
    }
    // The floor and a blocker are instances of one square; the blocker hides half of the light.
    SceneText shared = empty_scene().shape("square", polygon({{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}}, ""));
    shared.object(moved(Object("instance").set("shape", "square").set("material", "floor"), {scale({20, 1, 20})}));
    shared.object(moved(Object("instance").set("shape", "square").set("material", "black"),
                        {scale({4, 1, -4}), rotate({0, 1, 0}, 90), translate({4, 1, 0})}));
    shared.object(lit(moved(Object("instance").set("shape", "square").set("material", "black"),
                            {rotate({1, 0, 0}, 180), translate({0, 2, 0})})));
    out.push_back(noisy(
        whole("instances_floor_light_blocker", "ρ L F / 2: all three share one mesh", shared, kRho * kL * f / 2)));
}

void add_round(std::vector<Case>& out) {
    const auto one = [&](const char* id, const char* formula, const Object& object, double f, V3 from) {
        out.push_back(
            noisy(whole(id, std::string("ρ L F, ") + formula, floor_scene(from).object(lit(object)), kRho * kL * f)));
    };
    one("transform_sphere_scaled", "scaled, turned and moved",
        moved(sphere({0, 1, 0}, 2, "black"), {scale({0.25, 0.25, 0.25}), rotate({1, 2, 3}, 77), translate({0, 2, 0})}),
        [] {
            // Where the centre (0, 1/4, 0) goes by the rotation about (1, 2, 3)/√14 (Rodrigues), then 2 m up.
            const V3 axis = normalized({1, 2, 3}), c{0, 0.25, 0};
            const double a = radians(77);
            const V3 turned =
                c * std::cos(a) + cross(axis, c) * std::sin(a) + axis * (dot(axis, c) * (1 - std::cos(a)));
            const V3 at = turned + V3{0, 2, 0};
            return 0.25 * at.y / std::pow(length(at), 3);
        }(),
        {-0.6, 0.9, 0.9});
    one("transform_disk_scaled", "scaled, turned and moved",
        moved(disk({0, 0, 0}, {0, 0, 1}, 4, "black"),
              {scale({0.25, 0.25, 7}), rotate({1, 0, 0}, 90), translate({1.5, 2, 0})}),
        parallel_disk_form_factor(1, 2, 1.5), {-0.6, 0.9, 0.9});
    one("transform_disk_mirrored", "mirrored", moved(disk({1.5, -2, 0}, {0, 1, 0}, 1, "black"), {scale({1, -1, 1})}),
        parallel_disk_form_factor(1, 2, 1.5), {-0.6, 0.9, 0.9});
    one("transform_sphere_mirrored", "mirrored", moved(sphere({-1, 2, 0}, 0.5, "black"), {scale({-1, 1, 1})}),
        sphere_form_factor(0.5, std::sqrt(5), std::acos(2 / std::sqrt(5)) * 180 / kPi), {-0.6, 0.9, 0.9});
}

/// The scene of one unit, all lengths times s and moved by `by`. Lights at a point keep their irradiance by s².
void add_scaled(std::vector<Case>& out, const std::string& name, double s, V3 by) {
    const auto at = [&](double x, double y, double z) { return V3{x, y, z} * s + by; };
    const auto scene = [&] {
        return empty_scene(at(0.5, 0.875, 1), at(0, 0, 0)).object(ground(at(0, 0, 0), 16 * s, 16 * s, "floor"));
    };
    const auto add = [&](const char* id, const char* formula, SceneText text, double value, bool is_noisy) {
        const Case c = whole(std::string(id) + "_" + name, formula, text, value);
        out.push_back(is_noisy ? noisy(c) : c);
    };
    add("point", "ρ/π I cos θ / d²", scene().light(point_light(at(0, 2, 0), 10 * s * s)), kRho / kPi * 10 / 4, false);
    add("furnace", "ρ L: nothing shadows itself", scene().light(environment(1.0)), kRho, false);
    const double f = 4 * parallel_corner_form_factor(1, 1, 2);
    add("rect", "ρ L F", scene().object(lit(ceiling(at(0, 2, 0), s, s, "black"))), kRho * kL * f, true);
    add("mesh", "ρ L F",
        scene().object(lit(polygon({at(-1, 2, -1), at(1, 2, -1), at(1, 2, 1), at(-1, 2, 1)}, "black"))), kRho * kL * f,
        true);
    add("sphere", "ρ L F", scene().object(lit(sphere(at(0, 2, 0), 0.5 * s, "black"))),
        kRho * kL * sphere_form_factor(0.5, 2, 0), true);
    add("disk", "ρ L F", scene().object(lit(disk(at(0, 2, 0), {0, -1, 0}, s, "black"))), kRho * kL * 0.2, true);
    // A convex mesh in a white sky: an error of the offset of a ray's origin would show as dark spots.
    SceneText octahedron = empty_scene()
                               .look(at(0.5, 0.75, 4), at(0, 0, 0), 40)
                               .size(16, 16)
                               .material("it", diffuse(1.0))
                               .light(environment(1.0));
    octahedron.object(mesh({at(1, 0, 0), at(-1, 0, 0), at(0, 1, 0), at(0, -1, 0), at(0, 0, 1), at(0, 0, -1)},
                           {{4, 0, 2}, {4, 2, 1}, {4, 1, 3}, {4, 3, 0}, {5, 2, 0}, {5, 1, 2}, {5, 3, 1}, {5, 0, 3}},
                           "it"));
    Case body = whole("octahedron_" + name, "1: a white convex body in a white sky", octahedron, 1.0);
    body.expected[0].every_pixel = true;
    out.push_back(body);
    SceneText ball = empty_scene()
                         .look(at(0.5, 0.75, 4), at(0, 0, 0), 40)
                         .size(16, 16)
                         .material("it", diffuse(1.0))
                         .light(environment(1.0));
    ball.object(sphere(at(0, 0, 0), s, "it"));
    Case white = whole("ball_" + name, "1: a white convex body in a white sky", ball, 1.0);
    white.expected[0].every_pixel = true;
    out.push_back(white);
}

}  // namespace

std::vector<Case> transform_cases() {
    std::vector<Case> out;
    add_transformed(out);
    add_instances(out);
    add_round(out);
    // Powers of two near the decimal ones keep the coordinates exact; the decimal ones are among them as well.
    add_scaled(out, "millimetre", 1e-3, {});
    add_scaled(out, "kilometre", 1e3, {});
    add_scaled(out, "megametre", 1e6, {});
    // Coordinates with multiples of 1/8 stay exact here; what a hit's position loses is 2^-24 of 4096 m, 0.25 mm.
    add_scaled(out, "four_km_from_origin", 1, {4096, -2048, 4096});
    add_scaled(out, "far_and_large", 1024, {4194304, -2097152, 4194304});
    return out;
}

}  // namespace steradian::analytic
