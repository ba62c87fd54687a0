// Directional lights with an angular diameter, seen and as light, and with a straight edge in front.
#include "analytic/case.h"

namespace steradian::analytic {
namespace {

/// A sun of irradiance (4, 3, 2), or half of that.
Object sun(V3 direction, double diameter, double scale = 1) {
    return directional_light(direction, Color{4, 3, 2} * scale).set("angular_diameter", diameter);
}

/// Radiance of the disc: the cosine over it integrates to π sin².
Color disc_radiance(double diameter) {
    const double sine = std::sin(radians(diameter / 2));
    return Color{4, 3, 2} * (1 / (kPi * sine * sine));
}

void add_seen(std::vector<Case>& out) {
    for (const double diameter : {0.2, 20.0, 90.0}) {
        const std::string id = "sun_" + std::to_string(int(diameter)) + "_degrees";
        const V3 towards = normalized({-0.3, 1, 0.4});
        SceneText scene = empty_scene({0, 0, 0}, towards).light(sun(towards * -1.0, diameter)).depth(0);
        Case c = whole(id + "_seen", "E / (π sin²) of half the angle", scene, disc_radiance(diameter));
        c.expected[0].every_pixel = true;
        out.push_back(c);
    }
    // A picture across the edge: the left half of it looks 5.02° off the middle of a disc of 5°.
    SceneText edge = empty_scene()
                         .look({0, 0, 0}, {std::sin(radians(5)), 0, -std::cos(radians(5))}, kNarrow)
                         .light(sun({0, 0, 1}, 10))
                         .depth(0);
    Case c = whole("sun_edge", "left half E / (π sin² 5°), right half 0", edge, 0.0);
    c.expected = {{0, 0, 3, 8, disc_radiance(10), true}, {5, 0, 8, 8, 0.0, true}};
    out.push_back(c);
    SceneText mirrored = empty_scene({0.6, 0.9, 0.9}, {0, 0, 0})
                             .material("mirror", mirror())
                             .object(ground({0, 0, 0}, 1, 1, "mirror"))
                             .light(sun({0.6, -0.9, 0.9}, 2).set("visible_to_camera", false));
    out.push_back(whole("sun_hidden_in_mirror", "E / (π sin² 1°): a mirror shows it", mirrored, disc_radiance(2)));
    SceneText hidden = empty_scene({0, 0, 0}, {0, 0, -1})
                           .light(sun({0, 0, 1}, 10).set("visible_to_camera", false))
                           .light(environment(0.25))
                           .depth(0);
    out.push_back(whole("sun_hidden", "L of the sky behind it", hidden, 0.25));
    SceneText sky = empty_scene({0, 0, 0}, {0, 0, -1})
                        .light(sun({0, 0, 1}, 10))
                        .light(sun({0, 0, 1}, 20, 0.5))
                        .light(environment(1.0).set("visible_to_camera", false))
                        .depth(0);
    out.push_back(whole("sun_before_sun_before_hidden_sky", "the discs add up, the sky is black", sky,
                        disc_radiance(10) + disc_radiance(20) * 0.5));
}

void add_light(std::vector<Case>& out) {
    const Color facing = Color{4, 3, 2} * (kRho / kPi);
    // As long as the whole disc is above the horizon, by the cosine of its middle, however large it is.
    for (const double diameter : {0.5, 60.0}) {
        const std::string id = "sun_" + std::to_string(int(diameter * 2)) + "_halves_of_a_degree_floor";
        out.push_back(noisy(whole(id, "ρ/π E cos θ, as from a point",
                                  floor_scene().light(sun({0.6, -0.8, 0}, diameter)), facing * 0.8)));
    }
    // Straight above, half behind a plate whose edge is at an angle from the middle of the disc.
    for (const double edge : {-8.0, 0.0, 5.0}) {
        const std::string id = "sun_penumbra_" + std::to_string(int(edge) + 15) + "_degrees";
        SceneText scene = floor_scene({0.6, 0.9, 0.9})
                              .light(sun({0, -1, 0}, 30))
                              .object(ceiling({std::tan(radians(edge)) + 20, 1, 0}, 20, 40, "black"));
        out.push_back(noisy(whole(id, "ρ/π E times what is left of the disc in the projection along its axis", scene,
                                  facing * (1 - hidden_disc_share(15, edge)))));
    }
}

}  // namespace

std::vector<Case> sun_cases() {
    std::vector<Case> out;
    add_seen(out);
    add_light(out);
    return out;
}

}  // namespace steradian::analytic
