// The formulas themselves, against brute-force quadrature of what they stand for: a wrong formula must not pass because
// the renderer makes the same mistake.
#include <gtest/gtest.h>

#include "analytic/formulas.h"

namespace steradian::analytic {
namespace {

constexpr V3 kUp{0, 1, 0};

/// ∫ cos θ cos θ' / (π d²) dA over the surface point(a, b), with area element and normal from differences of the map.
double form_factor(const std::function<V3(double, double)>& point, double a0, double a1, double b0, double b1) {
    const auto f = [&](double a, double b) {
        constexpr double h = 1e-5;
        const V3 du = (point(a + h, b) - point(a - h, b)) * (0.5 / h),
                 dv = (point(a, b + h) - point(a, b - h)) * (0.5 / h);
        const V3 n = cross(du, dv), d = point(a, b);
        const double d2 = dot(d, d);
        // Half of a closed surface is turned away and hidden; only what faces the element counts.
        return std::max(0.0, dot(d, kUp)) * std::max(0.0, -dot(d, n)) / (kPi * d2 * d2);
    };
    return integrate(f, a0, a1, b0, b1, 48);
}

TEST(Formulas, RectanglesAgreeWithPolygonsAndQuadrature) {
    const std::vector<V3> above{{0, 2, 0}, {1, 2, 0}, {1, 2, 3}, {0, 2, 3}};
    EXPECT_NEAR(parallel_corner_form_factor(1, 3, 2), polygon_form_factor(above, {}, kUp), 1e-14);
    EXPECT_NEAR(form_factor(
                    [](double x, double z) {
                        return V3{x, 2, z};
                    },
                    0, 1, 0, 3),
                polygon_form_factor(above, {}, kUp), 1e-9);
    const std::vector<V3> wall{{2, 0, 0}, {2, 0, 1}, {2, 3, 1}, {2, 3, 0}};
    EXPECT_NEAR(perpendicular_corner_form_factor(1, 3, 2), polygon_form_factor(wall, {}, kUp), 1e-14);
    EXPECT_NEAR(form_factor(
                    [](double z, double y) {
                        return V3{2, y, z};
                    },
                    0, 1, 0, 3),
                polygon_form_factor(wall, {}, kUp), 1e-9);
}

/// Snell's law for directions: the part along the face grows by the ratio of the indices.
V3 refracted(V3 d, V3 normal, double eta) {
    const double cosine = -dot(d, normal);
    const V3 along = (d + normal * cosine) * (1 / eta);
    return along - normal * std::sqrt(1 - dot(along, along));
}

TEST(Formulas, PrismsRefractAsDirectionsDo) {
    const double apex = radians(50), incident = radians(40), eta = 1.6;
    const V3 first{-std::cos(apex / 2), std::sin(apex / 2), 0}, second{std::cos(apex / 2), std::sin(apex / 2), 0};
    const double angle = incident - apex / 2;
    const V3 d{std::cos(angle), std::sin(angle), 0};
    const V3 within = refracted(d, first, eta), out = refracted(within, second * -1, 1 / eta);
    const PrismRay ray = through_prism(apex, incident, eta);
    EXPECT_NEAR(-dot(within, first), std::cos(ray.inside), 1e-14);
    EXPECT_NEAR(dot(out, second), std::cos(ray.leaves), 1e-14);
    EXPECT_NEAR(std::acos(dot(out, d)), ray.deviated, 1e-12);
    EXPECT_LT(out.y, d.y);  // towards the base
    // At the least deviation both sides are alike, and sin((A + δ) / 2) = n sin(A / 2).
    const PrismRay least = through_prism(apex, std::asin(eta * std::sin(apex / 2)), eta);
    EXPECT_NEAR(std::sin((apex + least.deviated) / 2), eta * std::sin(apex / 2), 1e-14);
    EXPECT_LT(least.deviated, ray.deviated);
}

TEST(Formulas, ColorsOfTheSpectrumAreWhiteTogether) {
    const auto one = [](double) { return 1.0; };
    const Color all = integrate_colors(one), low = integrate_colors(one, 390, 541),
                high = integrate_colors(one, 541, 680);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(all[c], 1, 1e-12);
        EXPECT_NEAR(low[c] + high[c], 1, 1e-7);  // the kinks do not lie where the panels end
    }
    EXPECT_NEAR((cauchy_index(1.5, 30, 486.13) - cauchy_index(1.5, 30, 656.27)) * 30, 0.5, 1e-14);
    EXPECT_NEAR(cauchy_index(1.5, 30, 587.56), 1.5, 1e-15);
}

TEST(Formulas, PolygonsAreClippedAtTheHorizon) {
    const std::vector<V3> wall{{2, 0, 0}, {2, 0, 1}, {2, 3, 1}, {2, 3, 0}};
    const std::vector<V3> sunk{{2, -5, 0}, {2, -5, 1}, {2, 3, 1}, {2, 3, 0}};
    EXPECT_NEAR(polygon_form_factor(sunk, {}, kUp), polygon_form_factor(wall, {}, kUp), 1e-14);
    EXPECT_EQ(polygon_form_factor({{0, -1, 0}, {1, -1, 0}, {0, -1, 1}}, {}, kUp), 0);
}

TEST(Formulas, DisksAgreeWithQuadrature) {
    const auto parallel = [](double r, double phi) { return V3{1.5 + r * std::cos(phi), 2, r * std::sin(phi)}; };
    EXPECT_NEAR(form_factor(parallel, 0, 1, 0, 2 * kPi), parallel_disk_form_factor(1, 2, 1.5), 1e-8);
    EXPECT_NEAR(parallel_disk_form_factor(1, 2, 0), 1.0 / 5, 1e-15);
    const auto perpendicular = [](double phi, double r) { return V3{2, 1.5 + r * std::cos(phi), r * std::sin(phi)}; };
    EXPECT_NEAR(std::max(form_factor(perpendicular, 0, 2 * kPi, 0, 1),
                         form_factor([&](double r, double phi) { return perpendicular(phi, r); }, 0, 1, 0, 2 * kPi)),
                perpendicular_disk_form_factor(1, 1.5, 2), 1e-8);
}

/// The cone or half cone that a sphere fills, integrated over directions: cos θ / π dω.
TEST(Formulas, SpheresAgreeWithQuadratureOverTheirCones) {
    const auto cone = [](V3 axis, double sigma) {
        const V3 side = normalized(cross(axis, V3{0.3, 0.2, 0.9})), other = cross(axis, side);
        return integrate(
            [&](double theta, double phi) {
                const V3 d = axis * std::cos(theta) + side * (std::sin(theta) * std::cos(phi)) +
                             other * (std::sin(theta) * std::sin(phi));
                return std::max(0.0, d.y) * std::sin(theta) / kPi;
            },
            0, sigma, 0, 2 * kPi, 64);
    };
    const double sigma = std::asin(0.25);
    EXPECT_NEAR(cone({0, 1, 0}, sigma), sphere_form_factor(0.5, 2, 0), 1e-10);
    EXPECT_NEAR(cone({std::sqrt(0.5), std::sqrt(0.5), 0}, sigma), sphere_form_factor(0.5, 2, 45), 1e-10);
    EXPECT_NEAR(cone({1, 0, 0}, sigma), setting_sphere_form_factor(0.5, 2), 1e-6);
    const auto ellipsoid = [](double phi, double theta) {
        return V3{1.2 * std::sin(theta) * std::cos(phi), 2 + 0.5 * std::cos(theta),
                  1.2 * std::sin(theta) * std::sin(phi)};
    };
    EXPECT_NEAR(std::max(form_factor(ellipsoid, 0, 2 * kPi, 0, kPi),
                         form_factor([&](double t, double p) { return ellipsoid(p, t); }, 0, kPi, 0, 2 * kPi)),
                overhead_ellipsoid_form_factor(1.2, 0.5, 2), 1e-4);
}

TEST(Formulas, DiscsBehindAnEdgeAgreeWithQuadrature) {
    for (const double edge : {-14.0, -8.0, 0.0, 5.0, 14.0}) {
        // Directions (θ, φ) about the axis; what has tan of its angle in the plane across the edge beyond the edge's.
        const auto part = [&](double theta, double phi) {
            const bool hidden = std::sin(theta) * std::cos(phi) > std::tan(radians(edge)) * std::cos(theta);
            return hidden ? std::cos(theta) * std::sin(theta) : 0;
        };
        const double s = std::sin(radians(15));
        EXPECT_NEAR(integrate(part, 0, radians(15), 0, 2 * kPi, 400) / (kPi * s * s), hidden_disc_share(15, edge), 2e-4)
            << edge;
    }
}

TEST(Formulas, InterfacesConserveEnergy) {
    EXPECT_NEAR(fresnel(1, 1.5), 0.04, 1e-15);
    EXPECT_EQ(fresnel(std::cos(radians(42)), 1 / 1.5), 1);
    // Reciprocity: the same share is reflected on both sides of the refracted ray.
    const double inside = std::sqrt(1 - std::pow(std::sin(radians(60)) / 1.5, 2));
    EXPECT_NEAR(fresnel(std::cos(radians(60)), 1.5), fresnel(inside, 1 / 1.5), 1e-15);
    EXPECT_NEAR(glass_sphere_radiance(0.5, 1.5, 200), 1, 1e-12);
    EXPECT_NEAR(slab_transmission(1.5, 2), 0.9216, 1e-15);
    EXPECT_NEAR(slab_transmission(1.5, 200), 0.96 / 1.04, 1e-15);
}

TEST(Formulas, FiltersIntegrateToOne) {
    for (const auto cdf : {tent_cdf, gaussian_cdf, mitchell_cdf}) {
        EXPECT_NEAR(cdf(-1.5, 1.5), 0, 1e-15);
        EXPECT_NEAR(cdf(0, 1.5), 0.5, 1e-12);
        EXPECT_NEAR(cdf(1.5, 1.5), 1, 1e-12);
    }
    EXPECT_GT(mitchell_cdf(1.1, 2), 1);  // the negative lobe is still to come
}

}  // namespace
}  // namespace steradian::analytic
