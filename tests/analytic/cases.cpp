#include "analytic/case.h"

#include <array>
#include <charconv>
#include <iterator>

namespace steradian::analytic {

Case whole(std::string id, std::string formula, const SceneText& scene, Color value) {
    Case c;
    c.id = std::move(id);
    c.formula = std::move(formula);
    c.scene = scene.str();
    c.expected = {{0, 0, 0, 0, value, false}};
    return c;
}

SceneText empty_scene(V3 from, V3 at) {
    SceneText scene;
    scene.look(from, at, kNarrow).material("floor", diffuse(kRho)).material("black", diffuse(0.0));
    return scene;
}

SceneText floor_scene(V3 from, V3 at) { return empty_scene(from, at).object(ground({0, 0, 0}, 20, 20, "floor")); }

Case noisy(Case c) {
    c.kind = CaseClass::stochastic;
    c.tolerance = 1e-3;
    return c;
}

Case as_in_catalogue(Case c, std::string id) {
    c.catalogue = std::move(id);
    return c;
}

std::vector<Case> all_cases() {
    std::vector<Case> out;
    for (const auto family : {delta_light_cases, area_light_cases, emitter_side_cases, environment_cases, sun_cases,
                              goniometric_cases, specular_cases, dispersion_cases, path_cases, medium_cases,
                              opacity_cases, emission_cases, surface_cases, camera_cases, transform_cases}) {
        std::vector<Case> cases = family();
        out.insert(out.end(), std::make_move_iterator(cases.begin()), std::make_move_iterator(cases.end()));
    }
    return out;
}

namespace {

std::string six_digits(double value) {
    std::array<char, 32> buffer;
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::general, 6);
    return {buffer.data(), end.ptr};
}

}  // namespace

std::string table_row(const Case& c) {
    const Color v = c.expected[0].value;
    std::string value = "by region";
    if (c.expected.size() == 1) {
        value = six_digits(v.r);
        if (v.g != v.r || v.b != v.r)
            for (const double channel : {v.g, v.b}) {
                value += ' ';
                value += six_digits(channel);
            }
    }
    std::string out = "| `";
    for (const std::string& cell :
         {c.id + "`", value, std::string(c.kind == CaseClass::zero_variance ? "exact" : "statistics"), c.formula}) {
        out += cell;
        out += " | ";
    }
    out.pop_back();
    return out;
}

}  // namespace steradian::analytic
