// Dispersion in pictures: what must have the same mean has it, and a spectrum lies where Snell's law puts it.
#include <gtest/gtest.h>

#include <cmath>

#include "analytic/compare.h"
#include "support/support.h"

namespace steradian::analytic {
namespace {

RenderSettings independent(const PreparedCase& scene) {
    RenderSettings out = scene.settings;
    out.sampler = SamplerKind::independent;
    return out;
}

/// Smooth and rough glass and OpenPBR side by side, before a coloured sky and over a lamp.
SceneText gems(double abbe) {
    SceneText s;
    s.camera(Object("orthographic").set("position", V3{0, 0.5, 9}).set("look_at", V3{0, 0, 0}).set("height", 2));
    s.size(18, 6).integrator("path").depth(4).light(environment({1, 0.7, 0.4}));
    s.material("floor", diffuse({0.3, 0.5, 0.7}, true)).material("black", diffuse(0.0));
    const auto with = [&](Object material) { return material.set("abbe", abbe); };
    s.material("smooth", with(glass(1.6)));
    s.material("frosted", with(glass(1.6).set("roughness", 0.6)));
    Object layered("open_pbr");
    layered.set("transmission_weight", 0.8).set("specular_roughness", 0.5).set("specular_ior", 1.6);
    if (abbe > 0) layered.set("transmission_dispersion_scale", 1).set("transmission_dispersion_abbe_number", abbe);
    s.material("layered", layered);
    s.object(ground({0, -1, 0}, 4, 2, "floor"));
    const char* const bodies[] = {"smooth", "frosted", "layered"};
    for (int i = 0; i < 3; ++i) s.object(sphere({2.0 * i - 2, 0, 0}, 0.8, bodies[i]));
    s.object(rectangle({0, 0.6, -2}, {3, 0, 0}, {0, 0.4, 0}, "black").set("light", emission({4, 5, 6}, true)));
    return s;
}

/// An Abbe number of a million is as good as none, though every path through the glass gets a wavelength.
TEST(Dispersion, WithoutBoundIsNone) {
    const PreparedCase faint(gems(1e6).str(), {}), none(gems(0).str(), {});
    expect_same_means(faint, independent(faint), none, independent(none));
    RenderSettings direct = independent(faint);
    direct.integrator = IntegratorKind::direct;
    expect_same_means(faint, direct, none, direct);
}

TEST(Dispersion, IsSeenByTheTestOfMeans) {
    const PreparedCase strong(gems(4).str(), {}), none(gems(0).str(), {});
    EXPECT_GT(different_means(strong, independent(strong), none, independent(none)), 2u);
}

/// Light samples and the BSDF's are weighed by densities for the path's wavelength.
TEST(Dispersion, EveryStrategyHasTheSameMean) {
    const PreparedCase scene(gems(3).depth(2).str(), {});
    expect_strategies_agree(scene, independent(scene));
}

TEST(Dispersion, AtDepthOneDirectLightIsThatOfPaths) {
    const PreparedCase scene(gems(3).depth(1).str(), {});
    RenderSettings path = independent(scene), direct = path;
    direct.integrator = IntegratorKind::direct;
    expect_same_means(scene, path, direct);
}

TEST(Dispersion, RussianRouletteKeepsTheMean) {
    const PreparedCase scene(gems(3).depth(8).str(), {});
    expect_roulette_keeps_the_mean(scene, independent(scene));
}

/// A prism whose first face lies across the rays of an orthographic camera turns light at the second one only, by δ =
/// asin(n sin A) - A.
struct Spectroscope {
    static constexpr double kIndex = 1.6, kAbbe = 12, kDistance = 4, kHeight = -1.35, kHalf = 0.02, kFilm = 3;
    static constexpr int kRows = 300;
    double apex = radians(25);

    /// Rays go along +x from the film. The second face is x = 2 - y tan A: the base is below.
    SceneText scene() const {
        SceneText s;
        s.camera(Object("orthographic").set("position", V3{-2, 0, 0}).set("look_at", V3{0, 0, 0}).set("height", kFilm));
        s.size(1, kRows).integrator("path").depth(2).material("black", diffuse(0.0));
        s.material("it", glass(kIndex).set("abbe", kAbbe));
        s.object(rectangle({0, 0, 0}, {0, 0, 1}, {0, 4, 0}, "it"));
        s.object(rectangle({2, 0, 0}, {0, 0, -1}, {-4 * std::tan(apex), 4, 0}, "it"));
        return s.object(rectangle({2 + kDistance, kHeight, 0}, {0, kHalf, 0}, {0, 0, -1}, "black")
                            .set("light", emission(1.0, true)));
    }
    /// By how much the height that is seen grows with the one that a ray starts at: 1 - tan A tan δ.
    double growth(double nm) const { return 1 - std::tan(apex) * std::tan(turned(nm)); }
    /// The height on the film at which the middle of the light is seen.
    double start(double nm) const { return (kHeight + kDistance * std::tan(turned(nm))) / growth(nm); }
    /// The mean height of what each channel shows of the light.
    Color centroid() const {
        const auto shown = [&](double nm) {
            return through_prism(apex, 0, cauchy_index(kIndex, kAbbe, nm)).passed / growth(nm);
        };
        const Color all = integrate_colors(shown);
        const Color moment = integrate_colors([&](double nm) { return shown(nm) * start(nm); });
        return {moment.r / all.r, moment.g / all.g, moment.b / all.b};
    }

private:
    double turned(double nm) const { return through_prism(apex, 0, cauchy_index(kIndex, kAbbe, nm)).deviated; }
};

/// Blue light is bent most and has to start highest. Within 4.5 standard errors of 16 pictures, and a hundredth of a
/// row for what rows do to a centroid.
TEST(Dispersion, ASpectrumLiesWhereSnellsLawPutsIt) {
    const Spectroscope it;
    const PreparedCase scene(it.scene().str(), {});
    RenderSettings settings = independent(scene);
    settings.samples_per_pixel = test::by_tier<uint64_t>(256, 4096);
    std::vector<double> found[3];
    for (uint64_t seed = 1; seed <= 16; ++seed) {
        settings.seed = seed;
        const Image image = scene.picture(settings);
        for (size_t c = 0; c < 3; ++c) {
            double sum = 0, moment = 0;
            for (int row = 0; row < Spectroscope::kRows; ++row) {
                const double y = Spectroscope::kFilm * (0.5 - (row + 0.5) / Spectroscope::kRows);
                sum += image.pixels[size_t(row) * 3 + c];
                moment += image.pixels[size_t(row) * 3 + c] * y;
            }
            found[c].push_back(moment / sum);
        }
    }
    const Color expected = it.centroid();
    const Estimate red = estimate(found[0]), green = estimate(found[1]), blue = estimate(found[2]);
    constexpr double kRow = Spectroscope::kFilm / Spectroscope::kRows;
    for (const auto& [e, value] :
         {std::pair(red, expected.r), std::pair(green, expected.g), std::pair(blue, expected.b)}) {
        EXPECT_NEAR(e.mean, value, 4.5 * e.standard_error + 0.01 * kRow);
        EXPECT_LT(e.standard_error, 0.1 * kRow);
    }
    EXPECT_GT(blue.mean, green.mean + 5 * kRow);
    EXPECT_GT(green.mean, red.mean + 2 * kRow);
}

}  // namespace
}  // namespace steradian::analytic
