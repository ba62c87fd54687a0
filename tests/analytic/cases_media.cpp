// What fills glass: absorption, bodies within each other, and scattering.
#include <array>

#include "analytic/case.h"

namespace steradian::analytic {
namespace {

constexpr double kEta = 1.5;
const Color kAbsorbs{0.2, 0.7, 1.9};  ///< per metre

Object glow(Object shape, Color radiance) { return shape.set("light", emission(radiance)); }

Object absorbing(double eta, Color absorption) {
    return glass(eta).set("interior", Object().set("absorption", absorption));
}
Object scattering(double eta, Color absorption, Color coefficient, double anisotropy = 0) {
    return glass(eta).set(
        "interior",
        Object().set("absorption", absorption).set("scattering", coefficient).set("anisotropy", anisotropy));
}

Color passes(Color absorption, double distance) {
    return {std::exp(-absorption.r * distance), std::exp(-absorption.g * distance), std::exp(-absorption.b * distance)};
}

/// A plate between two heights, 2 × `half` wide: its two faces are one body.
SceneText& add_plate(SceneText& scene, double top, double bottom, std::string_view material, double half = 8) {
    scene.object(rectangle({0, 0, top}, {half, 0, 0}, {0, half, 0}, material));
    return scene.object(rectangle({0, 0, bottom}, {0, half, 0}, {half, 0, 0}, material));
}

/// Looks down at plates, with a bright wall of radiance 1 behind them and nothing above.
SceneText above_plates(V3 from = {0.37, 0.21, 3}, V3 at = {0.37, 0.21, 0}) {
    SceneText scene = empty_scene(from, at).depth(16);
    return scene.object(glow(rectangle({0, 0, -3}, {60, 0, 0}, {0, 60, 0}, "black"), 1));
}

/// Layers with plane boundaries, and what is left of light after once through each of them.
struct Layer {
    double eta;
    Color passes;
};

/// What a ray from above sees of a radiance of 1 below, in at most `depth` bounces: all ways that it can be reflected
/// and go on, counted boundary by boundary. cosine: to the normal, outside.
Color through_layers(const std::vector<Layer>& layers, int depth, double above = 0, double cosine = 1) {
    const size_t boundaries = layers.size() + 1;
    const auto eta = [&](size_t side) { return side == 0 || side == boundaries ? 1 : layers[side - 1].eta; };
    const auto cosine_in = [&](size_t side) { return std::sqrt(1 - (1 - cosine * cosine) / (eta(side) * eta(side))); };
    std::array<double, 3> sum{};
    for (size_t c = 0; c < 3; ++c) {
        const auto left = [&](size_t side) { return layers[side - 1].passes[int(c)]; };
        std::vector<double> down(boundaries, 0.0), up(boundaries, 0.0);
        down[0] = 1;
        for (int bounce = 0; bounce < depth; ++bounce) {
            std::vector<double> next_down(boundaries, 0.0), next_up(boundaries, 0.0);
            for (size_t i = 0; i < boundaries; ++i) {
                const double r = fresnel(cosine_in(i), eta(i + 1) / eta(i));
                const double rises = down[i] * r + up[i] * (1 - r), falls = down[i] * (1 - r) + up[i] * r;
                if (i == 0)
                    sum[c] += rises * above;
                else
                    next_up[i - 1] += rises * left(i);
                if (i + 1 == boundaries)
                    sum[c] += falls;
                else
                    next_down[i + 1] += falls * left(i + 1);
            }
            down = next_down, up = next_up;
        }
    }
    return {sum[0], sum[1], sum[2]};
}

void add_plates(std::vector<Case>& out) {
    SceneText clear = above_plates().material("it", absorbing(1, kAbsorbs));
    out.push_back(whole("absorbing_plate_index_1",
                        "exp(-σ d) per channel: a boundary without contrast reflects nothing",
                        add_plate(clear, 0.5, -0.5, "it"), passes(kAbsorbs, 1)));
    for (const char* integrator : {"direct", "path"}) {
        SceneText scene = above_plates().material("it", absorbing(kEta, kAbsorbs)).integrator(integrator);
        out.push_back(
            noisy(whole(std::string("absorbing_plate_") + integrator,
                        "(1 - R)² a Σ (R a)^(2j) with a = exp(-σ d), 2 + 2j up to the depth",
                        add_plate(scene, 0.5, -0.5, "it"), through_layers({{kEta, passes(kAbsorbs, 1)}}, 16))));
    }
    // Within a white sky, at 45°: what is reflected counts as well.
    const double cosine = std::cos(radians(45)), inside = std::sqrt(1 - 0.5 / (kEta * kEta));
    SceneText furnace =
        empty_scene({-1, 0, 1}, {0, 0, 0}).depth(16).material("it", absorbing(kEta, kAbsorbs)).light(environment(1));
    out.push_back(noisy(whole("absorbing_plate_furnace", "all reflections and passages, a = exp(-σ d / cos θt)",
                              add_plate(furnace, 0, -0.25, "it", 20),
                              through_layers({{kEta, passes(kAbsorbs, 0.25 / inside)}}, 16, 1, cosine))));
    Object open_pbr = Object("open_pbr")
                          .set("transmission_weight", 1)
                          .set("specular_roughness", 0)
                          .set("transmission_color", Color{0.9, 0.5, 0.2})
                          .set("transmission_depth", 2);
    SceneText layered = above_plates().material("it", open_pbr);
    const Color at_depth{std::sqrt(0.9), std::sqrt(0.5), std::sqrt(0.2)};
    Case c =
        noisy(whole("absorbing_plate_open_pbr", "the same with a = color^(d / transmission_depth)",
                    add_plate(layered.integrator("path"), 0.5, -0.5, "it"), through_layers({{kEta, at_depth}}, 16)));
    out.push_back(c);
}

/// R + (1 - R)² Σ R^k a^(k+1), k + 2 up to the depth; a along the chord.
Color sphere_radiance(double sine, Color absorption, int depth) {
    const double r = fresnel(std::sqrt(1 - sine * sine), kEta);
    const Color a = passes(absorption, 2 * std::sqrt(1 - sine * sine / (kEta * kEta)));
    Color sum = r, left = a;
    for (int k = 0; k + 2 <= depth; ++k) {
        sum = sum + left * ((1 - r) * (1 - r) * std::pow(r, k));
        left = left * a;
    }
    return sum;
}

void add_spheres(std::vector<Case>& out) {
    for (const int degrees : {0, 60}) {
        const double x = std::sin(radians(degrees));
        SceneText scene = empty_scene({x, 0, 4}, {x, 0, 0}).look({x, 0, 4}, {x, 0, 0}, 0.005).depth(16);
        scene.material("it", absorbing(kEta, kAbsorbs)).object(sphere({0, 0, 0}, 1, "it")).light(environment(1));
        out.push_back(
            noisy(whole("absorbing_sphere_" + std::to_string(degrees) + "deg",
                        "R + (1 - R)² Σ R^k a^(k+1), a along a chord", scene, sphere_radiance(x, kAbsorbs, 16))));
    }
    // The whole sphere in a picture; see furnace_glass_sphere for the integral.
    SceneText scene = empty_scene().look({0, 0, 4}, {0, 0, 0}, 40).size(32, 32).depth(16);
    scene.material("it", absorbing(kEta, kAbsorbs)).object(sphere({0, 0, 0}, 1, "it")).light(environment(1));
    const double film = 2 * std::tan(radians(20));
    std::array<double, 3> sums{};
    for (size_t c = 0; c < 3; ++c)
        sums[c] = integrate(
            [&](double angle) {
                const double sine = std::sin(angle), alpha = std::asin(sine / 4), t = std::tan(alpha);
                const double dt = (1 + t * t) / (4 * std::cos(alpha));
                return (1 - sphere_radiance(sine, kAbsorbs, 16)[int(c)]) * 2 * kPi * t * dt * std::cos(angle);
            },
            0, kPi / 2, 2048);
    const Color missing = Color{sums[0], sums[1], sums[2]} * (1 / (film * film));
    out.push_back(noisy(
        whole("absorbing_sphere_picture", "the same, integrated over the picture", scene, Color(1.0) + missing * -1)));
    // From the middle: half a chord, then whole ones.
    const Color half = passes(kAbsorbs, 1);
    Color seen = 0.0, left = half;
    for (int k = 0; k < 4; ++k) {
        seen = seen + left * (kEta * kEta * (1 - 0.04) * std::pow(0.04, k));
        left = left * half * half;
    }
    SceneText inside = empty_scene({0, 0, 0}, {0.6, 0.8, 0}).look({0, 0, 0}, {0.6, 0.8, 0}, 40).depth(4);
    inside.material("it", absorbing(kEta, kAbsorbs)).object(sphere({0, 0, 0}, 1, "it")).light(environment(1));
    out.push_back(noisy(
        whole("absorbing_sphere_from_inside", "η² (1 - R) Σ R^k a^(k + ½): the camera is in the body", inside, seen)));
    // A surface inside, its lamp, and glass that has none of it within.
    SceneText lit = empty_scene({0, 0, 1}, {0, 0, 0}).material("it", absorbing(1, kAbsorbs)).integrator("path");
    lit.object(sphere({0, 0, 0}, 5, "it"));
    lit.object(rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, "floor")).light(point_light({0, 0, 2}, 10));
    out.push_back(whole("absorbing_on_the_way_to_a_lamp", "ρ/π I / d² exp(-σ (1 + 2))", lit.depth(1),
                        passes(kAbsorbs, 3) * (kRho / kPi * 10 / 4)));
    SceneText hollow = above_plates().material("it", absorbing(1, kAbsorbs)).material("clear", glass(1));
    add_plate(hollow, 0.5, -0.5, "it");
    out.push_back(whole("absorbing_plate_with_a_void", "exp(-σ (d - hole))", add_plate(hollow, 0.3, 0, "clear"),
                        passes(kAbsorbs, 0.7)));
}

/// A plate of glass on one of water, in every way in which a file may say so.
void add_nested(std::vector<Case>& out) {
    constexpr double kWater = 1.33;
    const Color in_glass{0.1, 0.3, 0.2}, in_water{1.1, 0.4, 0.2};
    const auto body = [](double eta, Color absorption, int priority) {
        return absorbing(eta, absorption).set("priority", priority);
    };
    const Color expected = through_layers({{kEta, passes(in_glass, 0.5)}, {kWater, passes(in_water, 0.5)}}, 16);
    const std::string formula = "three boundaries: air to glass, glass to water, water to air; all ways through";
    struct Variant {
        const char* name;
        double water_top;
        int water, glass;
        bool water_first;
    };
    for (const Variant& v :
         {Variant{"overlap", 0.2, 1, 2, false}, Variant{"overlap_water_first", 0.2, 1, 2, true},
          Variant{"abutting", 0, 1, 2, false}, Variant{"abutting_water_first", 0, 1, 2, true},
          Variant{"abutting_water_above", 0, 2, 1, true}, Variant{"abutting_same_priority", 0, 1, 1, false},
          Variant{"same_priority_overlap", 0.2, 1, 1, false}}) {
        SceneText scene = above_plates();
        const auto add = [&](bool water) {
            const std::string_view name = water ? "water" : "glass";
            scene.material(name, water ? body(kWater, in_water, v.water) : body(kEta, in_glass, v.glass));
            add_plate(scene, water ? v.water_top : 0.5, water ? -0.5 : 0, name);
        };
        add(v.water_first);
        add(!v.water_first);
        out.push_back(noisy(whole(std::string("nested_") + v.name, formula, scene, expected)));
    }
    // Nearly touching, as two transforms put them: one boundary while a ray cannot tell the two apart, whichever comes
    // first; and never one that counts twice.
    for (int steps = 1; steps <= 3; ++steps)
        for (const bool gap : {true, false})
            for (const bool water_wins : {true, false}) {
                SceneText scene = above_plates({0.37, 0.21, 2}, {0.37, 0.21, 1});
                const double top = 1 + steps * (gap ? -0x1p-24 : 0x1p-23);
                scene.material("glass", body(kEta, in_glass, 2))
                    .material("water", body(kWater, in_water, water_wins ? 3 : 1));
                add_plate(add_plate(scene, 1.5, 1, "glass"), top, 0.5, "water");
                out.push_back(
                    noisy(whole("nested_" + std::to_string(steps) + (gap ? "_steps_of_gap" : "_steps_of_overlap") +
                                    (water_wins ? "_water_wins" : ""),
                                formula, scene, expected)));
            }
    SceneText reversed = above_plates();
    reversed.material("glass", body(kEta, in_glass, 1)).material("water", body(kWater, in_water, 2));
    add_plate(add_plate(reversed, 0.5, 0, "glass"), 0.2, -0.5, "water");
    out.push_back(noisy(whole("nested_water_wins", "the same, with the water up to where it says", reversed,
                              through_layers({{kEta, passes(in_glass, 0.3)}, {kWater, passes(in_water, 0.7)}}, 16))));
    // Ice in the water: bodies may be in others as a whole.
    SceneText ice = above_plates().material("water", body(kWater, in_water, 1)).material("ice", body(1.2, 0.0, 3));
    add_plate(add_plate(ice, 0.5, -0.5, "water"), 0.2, -0.1, "ice");
    out.push_back(noisy(
        whole("nested_inside", "four boundaries, each by the indices on its two sides", ice,
              through_layers({{kWater, passes(in_water, 0.3)}, {1.2, 1.0}, {kWater, passes(in_water, 0.4)}}, 16))));
    SceneText same = above_plates().material("glass", body(kEta, kAbsorbs, 5));
    add_plate(add_plate(same, 0.5, -0.2, "glass"), 0.1, -0.5, "glass");
    out.push_back(noisy(whole("nested_same_material", "one plate: two that overlap are their union", same,
                              through_layers({{kEta, passes(kAbsorbs, 1)}}, 16))));
    // Without priorities the index is that over what is around.
    SceneText plain = above_plates().material("water", absorbing(kWater, in_water)).material("void", glass(1 / kWater));
    add_plate(add_plate(plain, 0.5, -0.5, "water"), 0.2, -0.1, "void");
    out.push_back(
        noisy(whole("nested_without_priorities", "four boundaries; the inner index is 1 / η", plain,
                    through_layers({{kWater, passes(in_water, 0.3)}, {1, 1.0}, {kWater, passes(in_water, 0.4)}}, 16))));
}

/// E₂(x) = ∫ exp(-x / μ) dμ over [0, 1].
double e2(double x) {
    return integrate([&](double mu) { return mu > 0 ? std::exp(-x / mu) : 0.0; }, 0, 1, 64);
}

void add_scattering(std::vector<Case>& out) {
    // What absorbs nothing is as bright as what is around it.
    for (const double eta : {1.0, kEta})
        for (const double g : {0.0, 0.7}) {
            SceneText scene = empty_scene().look({0, 0, 4}, {0, 0, 0}, 40).size(16, 16).integrator("path").depth(4000);
            scene.material("it", scattering(eta, 0.0, 2.0, g)).object(sphere({0, 0, 0}, 1, "it"));
            const std::string id = std::string("white_medium_index_") + (eta == 1 ? "1" : "1.5");
            out.push_back(whole(id + (g == 0 ? "" : "_forward"), "1: nothing is lost", scene.light(environment(1)), 1));
        }
    SceneText colored = empty_scene().look({0, 0, 4}, {0, 0, 0}, 40).integrator("path").depth(4000);
    colored.material("it", scattering(1, 0.0, {0.5, 1, 3})).object(sphere({0, 0, 0}, 1, "it")).light(environment(1));
    out.push_back(noisy(whole("white_medium_by_channel", "1 in each channel, whatever its coefficient", colored, 1)));
    // Bounces: in, scattered, out. Isotropic, in a white sky.
    const Color absorbs{0.1, 0.2, 0.4}, scatters{0.6, 0.3, 0.2};
    constexpr double kThick = 0.5;
    SceneText slab = empty_scene({0, 0, 3}, {0, 0, 0}).integrator("path").depth(3);
    slab.material("it", scattering(1, absorbs, scatters)).light(environment(1));
    std::array<double, 3> once{};
    for (size_t c = 0; c < 3; ++c) {
        const double s = scatters[int(c)], t = s + absorbs[int(c)];
        once[c] = std::exp(-t * kThick) +
                  integrate([&](double z) { return s * std::exp(-t * z) * 0.5 * (e2(t * z) + e2(t * (kThick - z))); },
                            0, kThick, 64);
    }
    out.push_back(noisy(whole("scattered_once", "exp(-σt d) + ∫ σs exp(-σt z) ½ [E₂(σt z) + E₂(σt (d - z))] dz",
                              add_plate(slab, 0, -kThick, "it", 40), {once[0], once[1], once[2]})));
    // The glow around a lamp in fog, 1 m beside the ray: light samples at points in space, and the phase function.
    for (const double g : {0.0, 0.6}) {
        SceneText fog = empty_scene({0, 0, 2}, {0, 0, 0}).integrator("path").depth(1);
        fog.material("it", scattering(1, absorbs, scatters, g)).object(sphere({0, 0, 0}, 60, "it"));
        fog.light(point_light({1, 0, 0}, 10));
        std::array<double, 3> glows{};
        for (size_t c = 0; c < 3; ++c) {
            const double s = scatters[int(c)], t = s + absorbs[int(c)];
            glows[c] = integrate(
                [&](double way) {
                    const double z = 2 - way, d = std::sqrt(1 + z * z);
                    // Light travels from the lamp along (-1, 0, z), the ray looks along -z.
                    const double cosine = z / d, q = 1 + g * g - 2 * g * cosine;
                    const double phase = (1 - g * g) / (4 * kPi * q * std::sqrt(q));
                    return s * std::exp(-t * (way + d)) * phase * 10 / (d * d);
                },
                0, 62, 512);
        }
        out.push_back(noisy(whole(std::string("fog_around_a_lamp") + (g == 0 ? "" : "_forward"),
                                  "∫ σs exp(-σt (z + d)) p(cos θ) I / d² dz", fog, {glows[0], glows[1], glows[2]})));
    }
    // With `direct` what is scattered is lost.
    SceneText lost = above_plates().material("it", scattering(1, absorbs, scatters));
    out.push_back(whole("scattering_is_lost_in_direct", "exp(-σt d)", add_plate(lost, 0.5, -0.5, "it"),
                        passes(absorbs + scatters, 1)));
}

}  // namespace

std::vector<Case> medium_cases() {
    std::vector<Case> out;
    add_plates(out);
    add_spheres(out);
    add_nested(out);
    add_scattering(out);
    return out;
}

}  // namespace steradian::analytic
