// Point, spot and directional lights: nothing is random at a diffuse surface, so these have no variance.
#include "analytic/case.h"

namespace steradian::analytic {
namespace {

/// ρ/π I cos θ / d² at the floor's point p.
double lit(V3 light, V3 p = {}, double intensity = 10) {
    return kRho / kPi * intensity * point_irradiance(light, p, kUp);
}

void add_points(std::vector<Case>& out) {
    const V3 over{0, 2, 0}, oblique{1, 2, 0.5};
    out.push_back(as_in_catalogue(
        whole("point_overhead", "ρ/π I cos θ / d²", floor_scene().light(point_light(over, 10)), lit(over)),
        "A01_point_overhead"));
    out.push_back(as_in_catalogue(
        whole("point_oblique", "ρ/π I cos θ / d²", floor_scene().light(point_light(oblique, 10)), lit(oblique)),
        "A02_point_oblique"));
    SceneText four = floor_scene();
    for (int i = 0; i < 4; ++i) four.light(point_light(over, 2.5));
    out.push_back(as_in_catalogue(whole("point_four_lights", "4 ρ/π (I/4) cos θ / d²", four, lit(over)),
                                  "A03_point_four_lights"));
    out.push_back(as_in_catalogue(
        whole("point_below_horizon", "0: behind the surface", floor_scene().light(point_light({0, -2, 0}, 10)), 0.0),
        "A04_point_below_horizon"));
    const Color flux{17, 12, 5};
    const Object by_flux = Object("point").set("position", V3{0, 1.5, 0.5}).set("flux", flux);
    out.push_back(whole("point_flux", "ρ/π Φ/(4π) cos θ / d², per channel", floor_scene().light(by_flux),
                        flux * (lit({0, 1.5, 0.5}, {}, 1) / (4 * kPi))));
}

void add_directional(std::vector<Case>& out) {
    const auto slanted = [](double degrees, double azimuth) {
        const double s = std::sin(radians(degrees)), a = radians(azimuth);
        return V3{s * std::cos(a), -std::cos(radians(degrees)), s * std::sin(a)};
    };
    out.push_back(as_in_catalogue(
        whole("directional_60deg", "ρ/π E cos 60°", floor_scene().light(directional_light(slanted(60, 0), 3)),
              kRho / kPi * 3 * std::cos(radians(60))),
        "A05_directional_60deg"));
    out.push_back(whole("directional_not_normalised", "ρ/π E cos 30°: the length of the direction is of no account",
                        floor_scene().light(directional_light(slanted(30, 200) * 7.5, Color{3, 2, 1})),
                        Color{3, 2, 1} * (kRho / kPi * std::cos(radians(30)))));
    out.push_back(whole("directional_from_below", "0: behind the surface",
                        floor_scene().light(directional_light({0.2, 1, 0}, 3)), 0.0));
}

void add_spots(std::vector<Case>& out) {
    const V3 over{0, 2, 0};
    // The floor at an angle from the axis of a spot that looks straight down from 2 m.
    const auto at_angle = [&](const char* id, const char* formula, double angle, const char* catalogue) {
        const V3 p{2 * std::tan(radians(angle)), 0, 0};
        SceneText scene = floor_scene({p.x + 0.6, 0.9, 0.9}, p).light(spot_light(over, {0, -1, 0}, 10, 20, 40));
        out.push_back(
            as_in_catalogue(whole(id, formula, scene, lit(over, p) * spot_falloff(angle, 20, 40)), catalogue));
    };
    at_angle("spot_axis", "ρ/π I cos θ / d²", 0, "A06_spot_axis");
    at_angle("spot_inside_inner_cone", "ρ/π I cos θ / d²", 15, "");
    at_angle("spot_penumbra", "ρ/π I cos θ / d² · smoothstep of the cosine between those of 40° and 20°", 30,
             "A07_spot_30deg");
    at_angle("spot_outside", "0: outside the cone", 45, "A08_spot_outside_45deg");
    const Object aimed = Object("spot")
                             .set("position", V3{1, 2, 0.5})
                             .set("look_at", V3{0, 0, 0})
                             .set("flux", 8.0)
                             .set("inner_angle", 25.0)
                             .set("outer_angle", 25.0);
    out.push_back(whole("spot_hard_edge_flux", "I = Φ / (2π (1 - cos 25°)), then ρ/π I cos θ / d²",
                        floor_scene().light(aimed), lit({1, 2, 0.5}, {}, 8 / (2 * kPi * (1 - std::cos(radians(25)))))));
}

void add_shadows(std::vector<Case>& out) {
    const SceneText blocked =
        floor_scene({2, 0.4, 0.9}).light(point_light({0, 2, 0}, 10)).object(ceiling({0, 1, 0}, 0.5, 0.5, "black"));
    out.push_back(
        as_in_catalogue(whole("shadow_full", "0: the occluder covers the light", blocked, 0.0), "A09_shadow_full"));
    SceneText sun = floor_scene({2, 0.4, 0.9})
                        .light(directional_light({0, -1, 0}, 3))
                        .object(ceiling({0, 1, 0}, 0.5, 0.5, "black"));
    out.push_back(whole("shadow_directional", "0: the occluder covers the light", sun, 0.0));
    SceneText beyond = floor_scene().light(point_light({0, 2, 0}, 10)).object(ceiling({0, 2.5, 0}, 5, 5, "black"));
    out.push_back(whole("shadow_not_from_behind_the_light",
                        "ρ/π I cos θ / d²: what is behind the light does not block it", beyond, lit({0, 2, 0})));

    // The shadow's edge runs through the middle of the picture, seen from straight above; the right half is lit.
    const V3 light{0.3, 2, 0};
    SceneText edge = floor_scene({-0.3, 0.5, 0}, {-0.3, 0, 0})
                         .light(point_light(light, 10))
                         .object(ceiling({-4.5, 1, 0}, 4.5, 9, "black"));
    edge.look({-0.3, 0.5, 0}, {-0.3, 0, 0}, 0.2, {0, 0, -1});
    const double half = 0.5 * std::tan(radians(0.1));
    const double right = integrate(
                             [&](double x, double z) {
                                 return lit(light, {-0.3 + x, 0, z});
                             },
                             0, half, -half, half, 2) /
                         (2 * half * half);
    Case c = as_in_catalogue(
        whole("shadow_edge", "left half 0, right half the mean of ρ/π I cos θ / d² over its footprint", edge, 0.0),
        "A10_shadow_edge_half");
    c.expected = {{0, 0, 8, 8, right / 2, false}, {0, 0, 4, 8, 0.0, true}, {4, 0, 8, 8, right, false}};
    c.tolerance = 1e-3;  // a sample within a rounding error of the edge may fall on either side
    out.push_back(c);
}

}  // namespace

std::vector<Case> delta_light_cases() {
    std::vector<Case> out;
    add_points(out);
    add_directional(out);
    add_spots(out);
    add_shadows(out);
    return out;
}

}  // namespace steradian::analytic
