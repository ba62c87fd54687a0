// Glass that disperses: white light through a prism, and bodies in a white sky.
#include "analytic/case.h"

namespace steradian::analytic {
namespace {

constexpr double kIndex = 1.6, kAbbe = 15;

Object dispersive(double eta = kIndex, double abbe = kAbbe) { return glass(eta).set("abbe", abbe); }

Color times(Color c, Color l) { return {c.r * l.r, c.g * l.g, c.b * l.b}; }

/// Two faces that meet at (0, 0.866) under 60°, seen along a ray that meets the first at (-0.5, 0) and is deviated
/// least at 587.56 nm. The light stands upright at x = 3.
struct Prism {
    static constexpr double kApex = kPi / 3, kScreen = 3;
    double incident = std::asin(kIndex * std::sin(kApex / 2));

    PrismRay ray(double nanometres) const {
        return through_prism(kApex, incident, cauchy_index(kIndex, kAbbe, nanometres));
    }
    /// Where light of a wavelength meets the screen.
    double height(double nanometres) const {
        const PrismRay r = ray(nanometres);
        // From (-0.5, 0) under the angle within, to the second face, x = 0.5 - t sin 30°, y = t cos 30°.
        const double slope = std::tan(r.inside - kApex / 2);
        const double t = slope / (std::cos(kApex / 2) + slope * std::sin(kApex / 2));
        const double x = 0.5 - t * std::sin(kApex / 2), y = t * std::cos(kApex / 2);
        return y + (kScreen - x) * std::tan(kApex / 2 - r.leaves);
    }
    SceneText scene(double bottom, double top, const Object& material, Color radiance) const {
        const double angle = incident - kApex / 2, c = std::cos(kApex / 2), s = std::sin(kApex / 2);
        const V3 entry{-0.5, 0, 0}, from = entry - V3{std::cos(angle), std::sin(angle), 0} * 1.5;
        SceneText out;
        out.look(from, entry, 0.005, {0, 0, 1}).material("black", diffuse(0.0)).material("it", material).depth(2);
        out.object(rectangle(entry, V3{s, c, 0} * 0.9, {0, 0, -1}, "it"))
            .object(rectangle({0.5, 0, 0}, V3{-s, c, 0} * 0.9, {0, 0, 1}, "it"));
        return out.object(rectangle({kScreen, (bottom + top) / 2, 0}, {0, (top - bottom) / 2, 0}, {0, 0, -1}, "black")
                              .set("light", emission(radiance, true)));
    }
};

void add_prism(std::vector<Case>& out) {
    const Prism prism;
    const auto passed = [&](double nm) { return prism.ray(nm).passed; };
    const Color light{3, 4, 5};
    const std::string formula = "L ∫ (1 - R₁) (1 - R₂) w dλ";
    for (const char* integrator : {"direct", "path"})
        out.push_back(noisy(whole(std::string("prism_all_by_") + integrator, formula + ", R by Fresnel and Cauchy",
                                  prism.scene(-6, 6, dispersive(), light).integrator(integrator),
                                  times(integrate_colors(passed), light))));
    // Longer waves are bent less: they arrive higher. Each band gives a channel a good part of its light, or none.
    const auto band = [&](const std::string& name, int from, int to, const char* integrator) {
        const double bottom = from > 390 ? prism.height(from) : -6, top = to < 680 ? prism.height(to) : 6;
        out.push_back(
            noisy(whole("prism_" + name,
                        formula + " from " + std::to_string(from) + " to " + std::to_string(to) + " nm, by Snell's law",
                        prism.scene(bottom, top, dispersive(), light).integrator(integrator),
                        times(integrate_colors(passed, from, to), light))));
    };
    band("long_waves", 580, 680, "direct");
    band("middle_waves", 480, 540, "path");
    band("short_waves", 390, 500, "path");
    // Of glass that does not disperse, all goes where light of 587.56 nm does.
    const double d = prism.height(587.56);
    out.push_back(
        noisy(whole("prism_without_dispersion", "L (1 - R₁) (1 - R₂)",
                    prism.scene(d - 0.001, d + 0.001, dispersive(kIndex, 0), light), light * passed(587.56))));
}

void add_white_skies(std::vector<Case>& out) {
    const auto sky = [](const Object& material, int depth) {
        return empty_scene({0, 0, 4}, {0, 0, 0})
            .look({0, 0, 4}, {0, 0, 0}, 30)
            .material("it", material)
            .object(sphere({0, 0, 0}, 1, "it"))
            .light(environment(1.0))
            .depth(depth);
    };
    // Two bounces show what is reflected and what goes straight through.
    const double x = std::sin(radians(70));
    for (const int depth : {2, 16}) {
        SceneText scene = sky(dispersive(), depth);
        scene.look({x, 0, 4}, {x, 0, 0}, 0.005);
        out.push_back(noisy(whole("dispersive_sphere_70deg_depth_" + std::to_string(depth),
                                  "∫ (1 - (1 - R) R^(depth-1)) w dλ", scene, integrate_colors([&](double nm) {
                                      return glass_sphere_radiance(std::cos(radians(70)),
                                                                   cauchy_index(kIndex, kAbbe, nm), depth);
                                  }))));
    }
    const auto furnace = [&](const std::string& name, const Object& material) {
        out.push_back(noisy(whole("furnace_dispersive_" + name, "1: weights sum to white, nothing is lost",
                                  sky(material, 256).integrator("path"), 1.0)));
    };
    furnace("glass", dispersive(1.5, 3));
    furnace("bubble", dispersive(0.7, 20));
    furnace("open_pbr", Object("open_pbr")
                            .set("transmission_weight", 1)
                            .set("specular_roughness", 0)
                            .set("transmission_dispersion_scale", 0.8)
                            .set("transmission_dispersion_abbe_number", 10));
}

}  // namespace

std::vector<Case> dispersion_cases() {
    std::vector<Case> out;
    add_prism(out);
    add_white_skies(out);
    return out;
}

}  // namespace steradian::analytic
