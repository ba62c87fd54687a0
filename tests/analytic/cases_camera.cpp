// Where things are in the picture: coverage, orientation, aspect, filters.
#include <algorithm>
#include <functional>

#include "analytic/case.h"

namespace steradian::analytic {
namespace {

/// Looks along -Z from the origin with a field of view of 90°: at z = -1 the picture's height spans y from -1 to 1.
SceneText straight(int width, int height) {
    return empty_scene().look({0, 0, 0}, {0, 0, -1}, 90).size(width, height).depth(0).samples(64);
}

/// Emitter in the plane z = -1 over [x0, x1] × [y0, y1].
Object patch(double x0, double x1, double y0, double y1, Color radiance) {
    const V3 center{(x0 + x1) / 2, (y0 + y1) / 2, -1};
    return rectangle(center, {(x1 - x0) / 2, 0, 0}, {0, (y1 - y0) / 2, 0}, "black").set("light", emission(radiance));
}

void add_layout(std::vector<Case>& out) {
    Case quarter = as_in_catalogue(whole("pixels_quarter_cover", "L in the central quarter, else 0",
                                         straight(16, 16).object(patch(-0.5, 0.5, -0.5, 0.5, 2)), 0.5),
                                   "G01_quarter_cover");
    quarter.expected = {{0, 0, 0, 0, 0.5, false},   {4, 4, 12, 12, 2, true},  {0, 0, 16, 4, 0.0, true},
                        {0, 12, 16, 16, 0.0, true}, {0, 4, 4, 12, 0.0, true}, {12, 4, 16, 12, 0.0, true}};
    out.push_back(quarter);

    const Color red{1, 0, 0}, green{0, 1, 0}, blue{0, 0, 1}, white = 1.0;
    SceneText corners = straight(16, 16)
                            .object(patch(-1, 0, 0, 1, red))
                            .object(patch(0, 1, 0, 1, green))
                            .object(patch(-1, 0, -1, 0, blue))
                            .object(patch(0, 1, -1, 0, white));
    Case four = as_in_catalogue(whole("pixels_orientation", "red and green above blue and white", corners, 0.5),
                                "G02_orientation");
    four.expected = {{0, 0, 0, 0, 0.5, false},
                     {0, 0, 8, 8, red, true},
                     {8, 0, 16, 8, green, true},
                     {0, 8, 8, 16, blue, true},
                     {8, 8, 16, 16, white, true}};
    out.push_back(four);

    Case wide = as_in_catalogue(whole("pixels_aspect_2_to_1", "the left half is lit: the field of view is vertical",
                                      straight(32, 16).object(patch(-2, 0, -1, 1, 1)), 0.5),
                                "G03_aspect_2to1");
    wide.expected = {{0, 0, 0, 0, 0.5, false}, {0, 0, 16, 16, 1, true}, {16, 0, 32, 16, 0.0, true}};
    out.push_back(wide);
    Case tall =
        whole("pixels_aspect_1_to_2", "the upper half is lit", straight(8, 16).object(patch(-0.5, 0.5, 0, 1, 1)), 0.5);
    tall.expected = {{0, 0, 8, 8, 1, true}, {0, 8, 8, 16, 0.0, true}};
    out.push_back(tall);
    // On its side: with up = +X, what is at +X is at the top of the picture, and +Y is at the left.
    SceneText rolled = corners;
    rolled.look({0, 0, 0}, {0, 0, -1}, 90, {1, 0, 0});
    Case roll = whole("pixels_rolled_camera", "turned by 90°", rolled, 0.5);
    roll.expected = {
        {0, 0, 8, 8, green, true}, {8, 0, 16, 8, white, true}, {0, 8, 8, 16, red, true}, {8, 8, 16, 16, blue, true}};
    out.push_back(roll);
    // An `up` that is not perpendicular to the view gives the same picture.
    SceneText leaning = corners;
    leaning.look({0, 0, 0}, {0, 0, -1}, 90, {0, 0.25, -3});
    Case lean = four;
    lean.id = "pixels_leaning_up";
    lean.formula = "as with an upright `up`";
    lean.catalogue.clear();
    lean.scene = leaning.str();
    out.push_back(lean);
}

/// ∫ g(v) f(v) dv for the filter whose integral is `cdf`, by differences of the integral: f itself is not needed.
double filtered(const std::function<double(double)>& g, const std::function<double(double)>& cdf, double radius) {
    constexpr int kSteps = 1024;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double a = radius * (2.0 * i / kSteps - 1), b = radius * (2.0 * (i + 1) / kSteps - 1);
        sum += g((a + b) / 2) * (cdf(b) - cdf(a));
    }
    return sum;
}

/// Columns of a picture of 16 × 4 pixels across a slanted edge, the emitter on its left: x = 8.25 + (y - 2) / 4. Both
/// directions of the filter count. (A straight edge would be hit by the same number of a pixel's low-discrepancy
/// samples nearly always: its standard error says nothing.)
void add_filters(std::vector<Case>& out) {
    struct Row {
        const char* name;
        double radius;
        std::function<double(double)>
            cdf;  ///< of the filter's profile, from its left end to x pixels right of the centre
    };
    const Row rows[] = {{"box", 0.5, [](double x) { return std::clamp(x + 0.5, 0.0, 1.0); }},
                        {"box", 2, [](double x) { return std::clamp(x / 4 + 0.5, 0.0, 1.0); }},
                        {"tent", 1, [](double x) { return tent_cdf(x, 1); }},
                        {"gaussian", 1.5, [](double x) { return gaussian_cdf(x, 1.5); }},
                        {"gaussian", 3, [](double x) { return gaussian_cdf(x, 3); }},
                        {"mitchell", 2, [](double x) { return mitchell_cdf(x, 2); }}};
    const std::vector<V3> left{{-4, -4, -1}, {1.03125, -4, -1}, {-0.96875, 4, -1}, {-4, 4, -1}};
    for (const Row& row : rows) {
        SceneText scene =
            straight(16, 4).look({0, 0, 0}, {0, 0, -1}, 2 * std::atan(0.25) * 180 / kPi).filter(row.name, row.radius);
        scene.object(polygon(left, "black").set("light", emission(1.0)));
        Case c = noisy(whole(std::string("filter_") + row.name + "_" + text_of(row.radius),
                             "the filter's integral up to a slanted edge, column by column", scene, 0.0));
        c.expected.clear();
        for (uint32_t x = 0; x < 16; ++x) {
            double mean = 0;
            for (int y = 0; y < 4; ++y)
                mean += filtered([&](double v) { return row.cdf(8.25 + (y + 0.5 + v - 2) / 4 - (x + 0.5)); }, row.cdf,
                                 row.radius) /
                        4;
            // A column that one sample in more than ten thousand tells from black or white has no standard error yet.
            const double from_plain = std::abs(mean - std::round(mean));
            if (from_plain > 1e-12 && from_plain < 1e-4) continue;
            c.expected.push_back({x, 0, x + 1, 4, mean, false});
        }
        out.push_back(c);
    }
}

Object camera_of(std::string_view type, V3 from = {0, 0, 0}, V3 at = {0, 0, -1}) {
    return Object(type).set("position", from).set("look_at", at);
}

/// Kinds of cameras by what share of the picture an emitter of a known angle or size fills.
void add_projections(std::vector<Case>& out) {
    const auto scene = [](int width, int height, const Object& camera) {
        return straight(width, height).camera(camera);
    };
    // 3 m away and 1 m high in a picture that is 4 m high and 8 m wide; distance is of no account.
    const SceneText plan =
        scene(32, 16, camera_of("orthographic").set("height", 4.0))
            .object(rectangle({1, 0.5, -3}, {1, 0, 0}, {0, 0.5, 0}, "black").set("light", emission(1.0)));
    Case ortho = whole("camera_orthographic", "L where the rectangle is, whatever its distance", plan, 2.0 / 32);
    ortho.expected = {{0, 0, 0, 0, 2.0 / 32, false},
                      {16, 4, 24, 8, 1, true},
                      {0, 0, 16, 16, 0.0, true},
                      {16, 8, 32, 16, 0.0, true},
                      {24, 0, 32, 16, 0.0, true}};
    out.push_back(ortho);

    // A cap of 45° about the zenith fills the upper quarter.
    Case cap = whole("camera_panorama_zenith", "the rows that are within 45° of up",
                     scene(32, 16, camera_of("panorama", {0, 0, 0}, {1, 0, -1}))
                         .object(disk({0, 2, 0}, {0, -1, 0}, 2, "black").set("light", emission(1.0))),
                     0.25);
    cap.expected = {{0, 0, 32, 4, 1, true}, {0, 4, 32, 16, 0.0, true}};
    out.push_back(cap);
    // The walls of a room, seen from its middle: red at +X, green at -Z, blue at -X, white at +Z.
    SceneText room = scene(32, 16, camera_of("panorama"));
    const auto wall = [&](V3 center, V3 along, Color color) {
        room.object(rectangle(center, along, {0, 9, 0}, "black").set("light", emission(color, true)));
    };
    const Color red{1, 0, 0}, green{0, 1, 0}, blue{0, 0, 1}, white = 1.0;
    wall({1, 0, 0}, {0, 0, 1}, red), wall({0, 0, -1}, {1, 0, 0}, green);
    wall({-1, 0, 0}, {0, 0, 1}, blue), wall({0, 0, 1}, {1, 0, 0}, white);
    Case walls = whole("camera_panorama_walls", "a quarter of the picture for each wall, in their order", room, 0.0);
    walls.expected = {{0, 6, 4, 10, white, true},
                      {4, 6, 12, 10, blue, true},
                      {12, 6, 20, 10, green, true},
                      {20, 6, 28, 10, red, true},
                      {28, 6, 32, 10, white, true}};
    out.push_back(walls);

    // A sphere of half angle 30° in a fisheye of half angle 90°; an eighth of the samples of a pixel at its edge.
    const auto ball = [&](const char* projection) {
        return scene(16, 16, camera_of("fisheye").set("projection", projection))
            .object(sphere({0, 0, -2}, 1, "black").set("light", emission(1.0)));
    };
    out.push_back(noisy(whole("camera_fisheye_equidistant", "L π/4 (30°/90°)²", ball("equidistant"), kPi / 36)));
    const double s = std::sin(kPi / 12) / std::sin(kPi / 4);
    out.push_back(
        noisy(whole("camera_fisheye_equisolid", "L π/4 (sin 15° / sin 45°)²", ball("equisolid"), kPi / 4 * s * s)));
    SceneText sky = scene(16, 16, camera_of("fisheye").set("fov", 360.0));
    sky.light(environment(1.0));
    Case circle = noisy(whole("camera_fisheye_circle", "L π/4: black outside the circle", sky, kPi / 4));
    circle.expected.push_back({0, 0, 2, 2, 0.0, true});
    circle.expected.push_back({4, 4, 12, 12, 1, true});
    out.push_back(circle);
}

/// Focused at 1 m, the edge of an emitter at 2 m: what the lens sees of it through one point. A ray from (x, y) on the
/// lens through (0, 0, -1) meets the emitter's plane at (-x, -y).
void add_lenses(std::vector<Case>& out) {
    const auto edge = [](double at, const Object& lens) {
        Object camera = lens;
        camera.set("position", V3{0, 0, 0}).set("look_at", V3{0, 0, -1}).set("vertical_fov", kNarrow);
        return empty_scene().camera(camera).depth(0).samples(64).object(
            rectangle({at + 2, 0, -2}, {2, 0, 0}, {0, 2, 0}, "black").set("light", emission(1.0)));
    };
    const auto lens = [] { return Object().set("aperture_radius", 0.1).set("focus_distance", 1.0); };
    out.push_back(noisy(whole("camera_lens_edge", "the segment of a circle beyond half its radius", edge(0.05, lens()),
                              (kPi / 3 - std::sqrt(3) / 4) / kPi)));
    out.push_back(noisy(whole("camera_lens_far_focus", "the same with a circle of r (d - f) / f, a quarter as large",
                              edge(0.0125, Object().set("aperture_radius", 0.1).set("focus_distance", 1.6)),
                              (kPi / 3 - std::sqrt(3) / 4) / kPi)));
    const Object square = lens().set("aperture_blades", 4).set("aperture_rotation", 45.0);
    const double half = 0.1 * std::sqrt(0.5);
    out.push_back(noisy(whole("camera_lens_square", "the part of a square aperture beyond the edge", edge(0.02, square),
                              (half - 0.02) / (2 * half))));
    // A triangle with a corner to the right sees through the point what is to the left: -x > -0.05 is all of it but
    // the tip, a triangle of a third of its height.
    const Object triangle = lens().set("aperture_blades", 3);
    out.push_back(noisy(
        whole("camera_lens_triangle", "a triangular aperture without its tip", edge(-0.05, triangle), 1 - 1.0 / 9)));
}

}  // namespace

std::vector<Case> camera_cases() {
    std::vector<Case> out;
    add_layout(out);
    add_projections(out);
    add_lenses(out);
    add_filters(out);
    return out;
}

}  // namespace steradian::analytic
