// Thin films against sums of partial waves and integrals over the spectrum that are computed another way.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>

#include "math/warp.h"
#include "shading/fresnel.h"
#include "shading/spectrum.h"
#include "shading/thin_film.h"
#include "shading/world.h"
#include "support/support.h"

namespace steradian {
namespace {

using Complex = std::complex<double>;

struct Wave {
    Complex r, t;
};
/// Fresnel's amplitudes by the cosines on both sides.
Wave boundary(bool s, Complex n1, Complex c1, Complex n2, Complex c2) {
    const Complex sum = s ? n1 * c1 + n2 * c2 : n2 * c1 + n1 * c2;
    return {(s ? n1 * c1 - n2 * c2 : n2 * c1 - n1 * c2) / sum, 2.0 * n1 * c1 / sum};
}

/// Adds what leaves after each bounce within the film, until there is no more.
double by_partial_waves(double mu, const FilmIndices& n, double thickness, double wavelength) {
    const Complex n1 = n.outside, n2 = n.film, n3(n.base, n.base_k);
    const double sine = n.outside * std::sqrt(1 - mu * mu);
    const auto cosine = [&](Complex index) { return std::sqrt(1.0 - sine * sine / (index * index)); };
    const Complex c1 = mu, c2 = cosine(n2), c3 = cosine(n3);
    const Complex phase = std::exp(Complex(0, 4 * M_PI * thickness / wavelength) * n2 * c2);
    double out = 0;
    for (const bool s : {true, false}) {
        const Wave in = boundary(s, n1, c1, n2, c2), back = boundary(s, n2, c2, n1, c1);
        const Complex below = boundary(s, n2, c2, n3, c3).r;
        Complex sum = in.r, wave = in.t * below * phase;
        for (int i = 0; i < 2000; ++i, wave *= back.r * below * phase) sum += wave * back.t;
        out += std::norm(sum) / 2;
    }
    return out;
}

const FilmIndices kStacks[] = {{1, 1.4, 1.5, 0},   {1, 1.33, 1, 0},  {1, 2.2, 1.5, 0},
                               {1.6, 1.3, 1.5, 0}, {1, 1.5, 0.2, 3}, {1, 1.4, 2.9, 3}};

TEST(ThinFilm, IsTheSumOfItsPartialWaves) {
    for (const FilmIndices& n : kStacks)
        for (const double mu : {1.0, 0.7, 0.3, 0.05}) {
            if (n.outside * std::sqrt(1 - mu * mu) > n.film) continue;  // nothing gets in
            for (const double thickness : {0.0, 0.1, 0.45, 1.3})
                for (const double wavelength : {0.42, 0.55, 0.69})
                    EXPECT_NEAR(film_reflectance(mu, n, thickness, wavelength),
                                by_partial_waves(mu, n, thickness, wavelength), 1e-9);
        }
}

/// Between two beams that both are weak there is nothing but their interference.
TEST(ThinFilm, OfWeakBoundariesIsTwoBeams) {
    const FilmIndices n{1, 1.02, 1.05, 0};
    const double r12 = (1 - 1.02) / 2.02, r23 = (1.02 - 1.05) / 2.07;
    for (const double thickness : {0.05, 0.13, 0.4}) {
        const double phase = 4 * M_PI * 1.02 * thickness / 0.55;
        const double two = r12 * r12 + r23 * r23 + 2 * r12 * r23 * std::cos(phase);
        EXPECT_NEAR(film_reflectance(1, n, thickness, 0.55), two, 2e-3 * two);
    }
}

TEST(ThinFilm, WithoutAThicknessIsTheBoundary) {
    for (const double mu : {1.0, 0.6, 0.2, 0.01}) {
        EXPECT_NEAR(film_reflectance(mu, {1, 1.4, 1.5, 0}, 0, 0.5), fresnel_dielectric(mu, 1.5), 1e-12);
        EXPECT_NEAR(film_reflectance(mu, {1, 1.4, 0.2, 3}, 0, 0.5), fresnel_conductor(mu, 0.2, 3), 1e-12);
        // Nor does one of the index of either side, whatever its thickness.
        EXPECT_NEAR(film_reflectance(mu, {1, 1.5, 1.5, 0}, 0.7, 0.5), fresnel_dielectric(mu, 1.5), 1e-12);
        EXPECT_NEAR(film_reflectance(mu, {1, 1, 1.5, 0}, 0.7, 0.5), fresnel_dielectric(mu, 1.5), 1e-12);
    }
}

/// Light that is totally reflected by the film gets through one that is thin.
TEST(ThinFilm, LetsLightTunnel) {
    const FilmIndices n{1.5, 1, 1.5, 0};
    EXPECT_NEAR(film_reflectance(0.5, n, 5, 0.5), 1, 1e-6);
    EXPECT_LT(film_reflectance(0.5, n, 0.02, 0.5), 0.2);
}

/// The colour matching functions of Wyman et al., to XYZ first, in 1 nm steps.
Rgb by_spectrum(double mu, const FilmIndices& n, double thickness) {
    const auto piece = [](double x, double middle, double below, double above) {
        return std::exp(-0.5 * std::pow((x - middle) / (x < middle ? below : above), 2));
    };
    double film[3] = {}, white[3] = {};
    for (int nm = 380; nm <= 730; ++nm) {
        const double x = 1.056 * piece(nm, 599.8, 37.9, 31.0) + 0.362 * piece(nm, 442, 16, 26.7) -
                         0.065 * piece(nm, 501.1, 20.4, 26.2);
        const double y = 0.821 * piece(nm, 568.8, 46.9, 40.5) + 0.286 * piece(nm, 530.9, 16.3, 31.1);
        const double z = 1.217 * piece(nm, 437, 11.8, 36) + 0.681 * piece(nm, 459, 26, 13.8);
        const double r = by_partial_waves(mu, n, thickness, nm * 1e-3);
        const double xyz[] = {x, y, z};
        for (int i = 0; i < 3; ++i) film[i] += xyz[i] * r, white[i] += xyz[i];
    }
    const auto rgb = [](const double* v) {
        return Vec3d{3.2406 * v[0] - 1.5372 * v[1] - 0.4986 * v[2], -0.9689 * v[0] + 1.8758 * v[1] + 0.0415 * v[2],
                     0.0557 * v[0] - 0.2040 * v[1] + 1.0570 * v[2]};
    };
    const Vec3d a = rgb(film), b = rgb(white);
    const auto channel = [](double v) { return static_cast<float>(std::clamp(v, 0.0, 1.0)); };
    return {channel(a.x / b.x), channel(a.y / b.y), channel(a.z / b.z)};
}

TEST(ThinFilm, TablesAreTheIntegralOverTheSpectrum) {
    for (const double thickness : {0.08, 0.3, 0.6, 2.0})
        for (const FilmIndices& n : {kStacks[0], kStacks[1], kStacks[2]}) {
            const FilmOnDielectric table(n, FilmThicknesses(n.film, thickness, thickness), false);
            for (const double mu : {1.0, 0.83, 0.5, 0.21, 0.04})
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(table.reflectance(mu)[c], by_spectrum(mu, n, thickness)[c], 5e-3)
                        << thickness << " " << mu << " " << c;
        }
}

TEST(ThinFilm, OnMetalIsThatOfItsIndex) {
    for (const double thickness : {0.0, 0.2, 0.5}) {
        const FilmOnMetal table(1, 1.4, FilmThicknesses(1.4, thickness, thickness), {1, 0.8f, 0.8f});
        for (const float normal : {0.5f, 0.875f})  // entries of the table, so that only the cosine is interpolated
            for (const double mu : {1.0, 0.7, 0.3})
                for (int c = 0; c < 3; ++c) {
                    const double at_82 = (c ? 0.8f : 1.0f) * (normal + (1 - normal) * std::pow(6 / 7.0, 5));
                    const MetalIndex m = metal_index_of(normal, at_82);
                    const Rgb expected = by_spectrum(mu, {1, 1.4, m.n, m.k}, thickness);
                    EXPECT_NEAR(table.reflectance(mu, {normal, normal, normal})[c], expected[c], 1e-2);
                }
    }
}

/// What is to be interpolated: the integral over the spectrum of Airy's formula, at one angle.
struct Fringe {
    Rgb exact;
    std::array<bool, 3> clamped;
    double contrast;  ///< between the brightest and the darkest phase
};
Fringe fringe_of(double mu, const FilmIndices& n, double thickness) {
    Fringe out{};
    Vec3d sum, white;
    for (double nm = kShortestWavelength * 1000 + 0.25; nm < kLongestWavelength * 1000; nm += 0.5) {
        const Vec3d w = rgb_response(nm / 1000);
        sum = sum + w * film_reflectance(mu, n, thickness, nm / 1000), white = white + w;
    }
    const double channels[] = {sum.x / white.x, sum.y / white.y, sum.z / white.z};
    for (size_t c = 0; c < 3; ++c) {
        out.clamped[c] = channels[c] < 0.01 || channels[c] > 0.99;
        out.exact[int(c)] = static_cast<float>(std::clamp(channels[c], 0.0, 1.0));
    }
    const double sine2 = n.outside * n.outside * (1 - mu * mu) / (n.film * n.film);
    double least = 1, most = 0;
    for (int i = 0; i < 64; ++i) {  // once through all phases
        const double r = film_reflectance(mu, n, i / 64.0 * 0.5 / (2 * n.film * std::sqrt(1 - sine2)), 0.5);
        least = std::min(least, r), most = std::max(most, r);
    }
    out.contrast = most - least;
    return out;
}

/// Linear interpolation errs by (2π/24)²/8 = 0.9 % of a wave's amplitude, half of the contrast. Colours beyond the
/// gamut make it up to 1.4 times as much, and what bounces more than once within the film has shorter fringes: 1.5 % of
/// the contrast. Where a channel is clamped there is an edge, and the error a quarter of the slope times the distance:
/// 5 %.
double tolerance(const Fringe& f, int channel) {
    return (f.clamped[size_t(channel)] ? 0.05 : 0.015) * f.contrast + 1e-4;
}

TEST(ThinFilm, ThicknessesAreInterpolated) {
    test::Random random(71);
    const int tables = test::by_tier(12, 400);
    for (int i = 0; i < tables; ++i) {
        const FilmIndices n{1, random.between(1.1, 2.2), random.between(1, 2.5), 0};
        const double thick = i % 4 == 0 ? 10 : i % 4 == 1 ? 3 : 0.8, thin = i % 3 == 0 ? 0 : 0.1 * thick;
        const FilmThicknesses thicknesses(n.film, thick, thin);
        EXPECT_LE(thicknesses.count(), 321u);
        const FilmOnDielectric table(n, thicknesses, false);
        for (int k = 0; k < 40; ++k) {
            // An entry of the table, so that only the thickness is interpolated.
            const double t =
                std::floor(random.between(40, FilmOnDielectric::kCosines)) / (FilmOnDielectric::kCosines - 1);
            const double thickness = random.between(thin, k % 2 ? thick : std::min(thick, 1.0));
            const Fringe expected = fringe_of(t * t, n, thickness);
            const Rgb found = table.reflectance(t * t, thicknesses.place(thickness));
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(found[c], expected.exact[c], tolerance(expected, c))
                    << "film " << n.film << " on " << n.base << ", " << thickness << " um, cosine " << t * t;
        }
    }
}

TEST(ThinFilm, ThicknessesOnMetalAreInterpolated) {
    test::Random random(72);
    const double thin = 0.1, thick = 0.9, film = 1.45;
    const FilmThicknesses thicknesses(film, thin, thick);
    const FilmOnMetal table(1, film, thicknesses, {1, 1, 1});
    for (int i = 0; i < 200; ++i) {
        const float normal = i % 2 ? 0.5f : 0.875f;  // entries of the table
        const MetalIndex m = metal_index_of(normal, normal + (1 - normal) * std::pow(6 / 7.0, 5));
        const double t = std::floor(random.between(20, 96)) / 95, thickness = random.between(thin, thick);
        const Fringe expected = fringe_of(t * t, {1, film, m.n, m.k}, thickness);
        const Rgb found = table.reflectance(t * t, {normal, normal, normal}, thicknesses.place(thickness));
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found[c], expected.exact[c], tolerance(expected, c)) << thickness << " " << t * t;
    }
}

TEST(ThinFilm, ThicknessesHaveTheirEnds) {
    for (const auto& [a, b] : {std::pair(0.1, 0.4), {0.4, 0.1}, {0.0, 10.0}, {9.0, 10.0}, {0.0, 1e-6}}) {
        const FilmThicknesses films(1.3, a, b);
        ASSERT_GE(films.count(), 2u);
        EXPECT_EQ(films[0], std::min(a, b));
        EXPECT_EQ(films[films.count() - 1], std::max(a, b));
        double before = -1;
        for (size_t i = 0; i < films.count(); ++i) {
            EXPECT_GT(films[i], before);
            before = films[i];
            const FilmPlace place = films.place(films[i]);
            EXPECT_NEAR(place.first + double(place.f), double(i), 1e-4);
            EXPECT_LT(place.first + 1, films.count());
        }
        EXPECT_EQ(films.place(std::min(a, b)).f, 0);
        EXPECT_EQ(films.place(std::max(a, b)).f, 1);
        EXPECT_EQ(films.place(-1).first + films.place(-1).f, 0);
        EXPECT_EQ(films.place(99).first + 2, films.count());
    }
    EXPECT_EQ(FilmThicknesses(1.3, 0.2, 0.2).count(), 1u);
}

/// Where fringes of colours have faded the sum is that of intensities.
TEST(ThinFilm, ThickOnesAreTheMeanOverPhases) {
    for (const FilmIndices& n : {kStacks[0], kStacks[2]})
        for (const double thickness : {5.2, 8.0, 10.0}) {
            const FilmOnDielectric table(n, FilmThicknesses(n.film, thickness, thickness), false);
            for (const double mu : {1.0, 0.49})
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(table.reflectance(mu)[c], fringe_of(mu, n, thickness).exact[c], 1e-3);
        }
}

TEST(ThinFilm, MetalsHaveAnIndex) {
    for (const double normal : {0.1, 0.5, 0.9, 0.97})
        for (const double tint : {1.0, 0.9}) {
            const bool exists = tint == 1 || (normal > 0.1 && normal < 0.97);
            const double at_82 = tint * (normal + (1 - normal) * std::pow(6 / 7.0, 5));
            const MetalIndex m = metal_index_of(normal, at_82);
            EXPECT_NEAR(fresnel_conductor(1, m.n, m.k), normal, 1e-9);
            // What no index has is come as near to as possible.
            EXPECT_NEAR(fresnel_conductor(1 / 7.0, m.n, m.k), at_82, exists ? 1e-3 : 0.025) << normal << " " << tint;
        }
}

}  // namespace
}  // namespace steradian
