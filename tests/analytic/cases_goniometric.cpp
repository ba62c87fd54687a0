// Lights with the intensities of photometric files, which are written here.
#include <cmath>
#include <functional>

#include "analytic/case.h"

namespace steradian::analytic {
namespace {

/// An IES file with these angles; value(vertical, horizontal) in candela.
std::string photometric(const std::vector<double>& vertical, const std::vector<double>& horizontal,
                        const std::function<double(double, double)>& value) {
    std::string out = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 " + std::to_string(vertical.size()) + " " +
                      std::to_string(horizontal.size()) + " 1 2 0 0 0\n1 1 0\n";
    for (const double v : vertical) out += text_of(v) + "\n";
    for (const double h : horizontal) out += text_of(h) + "\n";
    for (const double h : horizontal)
        for (const double v : vertical) out += text_of(value(v, h)) + "\n";
    return out;
}

Object light(V3 position) { return Object("goniometric").set("position", position); }

Color lit(V3 position, double intensity) { return point_irradiance(position, {}, kUp) * (kRho / kPi) * intensity; }

Case lamp(const std::string& id, std::string formula, Object light, const std::string& file, Color value) {
    const std::string name = id + ".ies";
    Case c = whole(id, std::move(formula), floor_scene().light(light.set("path", name)), value);
    c.files = {{name, {}, file}};
    return c;
}

}  // namespace

std::vector<Case> goniometric_cases() {
    std::vector<Case> out;
    const std::string isotropic = photometric({0, 45, 180}, {0}, [](double, double) { return 12.0; });
    const V3 at{0.5, 2, -0.25};
    out.push_back(lamp("ies_isotropic", "ρ/π I cos θ / d², as of a point", light(at), isotropic, lit(at, 12)));
    out.push_back(lamp("ies_flux", "I = Φ / 4π, then ρ/π I cos θ / d²", light(at).set("flux", Color{1, 2, 3}),
                       isotropic, Color{1, 2, 3} * lit(at, 1 / (4 * kPi))));
    // 60° off the vertical, between two angles of the table.
    const V3 aside{2 * std::tan(radians(60)), 2, 0};
    const std::string wide = photometric({0, 10, 50, 90}, {0}, [](double v, double) { return v > 10 ? 100 - v : 100; });
    out.push_back(lamp("ies_between_angles", "ρ/π I(60°) cos θ / d²", light(aside).set("intensity", Color{2, 1, 0.5}),
                       wide, Color{2, 1, 0.5} * lit(aside, 40)));
    out.push_back(lamp("ies_dark_above", "0: the floor is above the last vertical angle",
                       light({0.1, 2, 0}).set("direction", V3{0, 1, 0}), wide, 0.0));
    out.push_back(
        lamp("ies_aimed", "ρ/π I(0°) cos θ / d²", light(aside).set("look_at", V3{0, 0, 0}), wide, lit(aside, 100)));
    // Flat around what the pixel sees: averages over it are exact. Planes: 0 towards +X, 90 towards -Z of a light that
    // points down. Seen from the light, the origin is at the plane opposite to where the light is.
    const std::vector<double> around{0, 10, 80, 100, 170, 190, 260, 280, 350, 360};
    const auto steps = [](double, double h) { return 1 + 90 * std::fmod(std::floor((h + 10) / 90), 4); };
    const std::string planes = photometric({0, 90}, around, steps);
    struct Place {
        const char* name;
        V3 position;
        double rotation, candela;
    };
    for (const Place& p : {Place{"zero", {-1, 2, 0}, 0, 1},
                           {"quarter", {0, 2, 1}, 0, 91},
                           {"half", {1, 2, 0}, 0, 181},
                           {"three_quarters", {0, 2, -1}, 0, 271},
                           {"between", {-1, 2, 1}, 0, 46},
                           {"turned", {0, 2, 1}, 90, 1},
                           {"turned_back", {-1, 2, 0}, -45, 46}})
        out.push_back(lamp(std::string("ies_plane_") + p.name, "ρ/π I cos θ / d² of the plane towards the point",
                           light(p.position).set("rotation", p.rotation), planes, lit(p.position, p.candela)));
    // One that points to +X has turned about Z: its plane 0 is up, so that the origin is in the plane opposite.
    out.push_back(lamp("ies_plane_aside", "ρ/π I cos θ / d²: plane 0 has turned with the light",
                       light({-0.5, 1, 0}).set("direction", V3{1, 0, 0}), planes, lit({-0.5, 1, 0}, 181)));
    // One that points up is turned over about X: plane 90 is towards +Z then.
    const std::string upwards = photometric({0, 180}, around, steps);
    out.push_back(lamp("ies_plane_up", "ρ/π I cos θ / d²: turned over about X",
                       light({0, 1, -1}).set("direction", V3{0, 1, 0}), upwards, lit({0, 1, -1}, 91)));
    return out;
}

}  // namespace steradian::analytic
