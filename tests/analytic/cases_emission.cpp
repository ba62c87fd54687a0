// Materials that emit: they are lights like any other.
#include "analytic/case.h"

namespace steradian::analytic {
namespace {

const Color kGlow{3, 1.5, 0.75};
const double kSquare = 4 * parallel_corner_form_factor(1, 1, 2);

/// Reflects nothing.
Object glowing(double luminance = 3, const std::string& color = "[1, 0.5, 0.25]") {
    return Object("open_pbr")
        .set("base_weight", 0)
        .set("specular_weight", 0)
        .set("emission_luminance", luminance)
        .raw("emission_color", color);
}

Object lamp() { return rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, "lamp"); }
SceneText wall() {
    return empty_scene({1.5, 0.5, 0.5}, {0, 0, 2}).object(rectangle({0, 0, 2}, {-4, 0, 0}, {0, 4, 0}, "floor"));
}

}  // namespace

std::vector<Case> emission_cases() {
    std::vector<Case> out;
    const auto seen = [](double z, const Object& material) {
        return empty_scene({0.25, 0.25, z}, {0.1, 0.2, 0}).depth(0).material("lamp", material).object(lamp());
    };
    out.push_back(whole("emission_seen", "L", seen(3, glowing()), kGlow));
    out.push_back(whole("emission_from_behind", "0: a body shines outwards", seen(-3, glowing()), 0.0));
    out.push_back(
        whole("emission_thin_wall_from_behind", "L", seen(-3, glowing().set("geometry_thin_walled", true)), kGlow));
    const Object coated = glowing().set("coat_weight", 1).set("coat_color", Color{1, 0.25, 0.25});
    Case coat = whole("emission_under_coat", "(1 - F) √c L, head-on",
                      empty_scene({0, 0, 3}, {0, 0, 0}).depth(0).material("lamp", coated).object(lamp()),
                      Color{3, 0.75, 0.375} * (1 - 0.36 / 6.76));
    coat.tolerance = 5e-4;
    out.push_back(coat);
    for (const char* integrator : {"direct", "path"}) {
        const std::string end = std::string("_") + integrator;
        const auto lit = [&](const Object& material) {
            return wall().integrator(integrator).material("lamp", material).object(lamp());
        };
        out.push_back(noisy(whole("emission_lights" + end, "ρ L F", lit(glowing()), kGlow * (kRho * kSquare))));
        const Object halves = glowing(2, R"({"type": "checkerboard", "color0": 1, "color1": 0.5, "scale": [2, 1]})");
        out.push_back(noisy(whole("emission_texture_lights" + end, "ρ (L₁ + L₂) / 2 F: a half each", lit(halves),
                                  1.5 * kRho * kSquare)));
    }
    SceneText mixed = wall().material("glow", glowing()).object(lamp());
    mixed.material("lamp", Object("mix").raw("materials", R"(["glow", "black"])").set("weight", 0.25));
    out.push_back(noisy(whole("emission_of_a_mix_lights", "ρ ¾ L F", mixed, kGlow * (0.75 * kRho * kSquare))));
    SceneText part = wall().material("lamp", glowing().set("geometry_opacity", 0.25)).object(lamp());
    out.push_back(noisy(whole("emission_with_opacity_lights", "α ρ L F", part, kGlow * (0.25 * kRho * kSquare))));
    return out;
}

}  // namespace steradian::analytic
