// Surfaces that are there for a part of the light only: as seen, in shadows, and as emitters.
#include "analytic/case.h"

namespace steradian::analytic {
namespace {

const V3 kLight{0, 2, 0};
const Color kGlow{3, 2, 1};
const double kSquare = 4 * parallel_corner_form_factor(1, 1, 2);

/// Black, so that what is seen is what passes.
Object sheet(const std::string& opacity) {
    return Object("open_pbr").set("base_weight", 0).set("specular_weight", 0).raw("geometry_opacity", opacity);
}
Object sheet(double opacity) { return sheet(text_of(opacity)); }

double overhead() { return kRho / kPi * 10 / 4; }

SceneText lit_floor() { return floor_scene().light(point_light(kLight, 10)).material("quarter", sheet(0.25)); }

void add_shadows(std::vector<Case>& out) {
    const auto lid = [](double height, const char* material) { return ground({0, height, 0}, 0.2, 0.2, material); };
    out.push_back(
        whole("opacity_shadow", "(1 - α) ρ/π I / d²", lit_floor().object(lid(1.5, "quarter")), 0.75 * overhead()));
    SceneText two = lit_floor().material("half", sheet(0.5)).object(lid(1.5, "quarter")).object(lid(1, "half"));
    out.push_back(whole("opacity_shadow_two_sheets", "(1 - α₁) (1 - α₂) ρ/π I / d²", two, 0.375 * overhead()));
    out.push_back(whole("opacity_shadow_sphere", "(1 - α)² ρ/π I / d²: the ray crosses it twice",
                        lit_floor().object(sphere({0, 1.5, 0}, 0.2, "quarter")), 0.5625 * overhead()));
    out.push_back(whole("opacity_shadow_blocked", "0: behind the sheet something is opaque",
                        lit_floor().object(lid(1.5, "quarter")).object(lid(1, "black")), 0.0));
    // Black squares are there, white ones are not; the ray to the light goes through one of each kind.
    const SceneText pattern = lit_floor().material(
        "squares", sheet(R"({"type": "checkerboard", "color0": 1, "color1": 0, "scale": [2, 2]})"));
    out.push_back(whole("opacity_texture_there", "0: the texture is 1 where the ray passes",
                        SceneText(pattern).object(ground({0.1, 1.5, 0.1}, 0.2, 0.2, "squares")), 0.0));
    out.push_back(whole("opacity_texture_hole", "ρ/π I / d²: the texture is 0 where the ray passes",
                        SceneText(pattern).object(ground({0.1, 1.5, -0.1}, 0.2, 0.2, "squares")), overhead()));
    SceneText mixed =
        lit_floor().material("mixed", Object("mix").raw("materials", R"(["quarter", "black"])").set("weight", 0.6));
    out.push_back(
        whole("opacity_shadow_mix", "(1 - 0.6 - 0.4 α) ρ/π I / d²", mixed.object(lid(1.5, "mixed")), 0.3 * overhead()));
}

void add_emitters(std::vector<Case>& out) {
    SceneText seen = empty_scene({0.25, 0.25, 3}, {0.1, 0.2, 0}).material("quarter", sheet(0.25));
    seen.integrator("path").depth(0);
    const Object lamp = rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, "black").set("light", emission(kGlow));
    out.push_back(
        noisy(whole("opacity_seen_through", "(1 - α)² L: to pass is no bounce",
                    SceneText(seen).object(lamp).object(sphere({0.1, 0.2, 1}, 0.5, "quarter")), kGlow * 0.5625)));
    const Object thin = rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, "quarter").set("light", emission(kGlow));
    out.push_back(noisy(whole("opacity_emitter_seen", "α L + (1 - α) of the sky",
                              SceneText(seen).object(thin).light(environment(0.5)), kGlow * 0.25 + Color(0.5) * 0.75)));
    for (const char* integrator : {"direct", "path"}) {
        SceneText lit = empty_scene({1.5, 0.5, 0.5}, {0, 0, 2}).material("quarter", sheet(0.25));
        lit.integrator(integrator).object(rectangle({0, 0, 2}, {-4, 0, 0}, {0, 4, 0}, "floor"));
        out.push_back(noisy(whole(std::string("opacity_emitter_lights_") + integrator, "α ρ L F",
                                  SceneText(lit).object(thin), kGlow * (0.25 * kRho * kSquare))));
    }
}

}  // namespace

std::vector<Case> opacity_cases() {
    std::vector<Case> out;
    add_shadows(out);
    add_emitters(out);
    return out;
}

}  // namespace steradian::analytic
