// Area lights: samples are distributed as pdf_light says, whatever the shape and its transform.
#include <gtest/gtest.h>

#include "shading/area_lights.h"
#include "support/chi_square.h"
#include "support/support.h"

namespace steradian {
namespace {

using test::AreaLightCase;
using test::LightSurface;
using test::Random;
using test::World;

/// Receiving points: near and far, above sides and corners, grazing, and inside of what is hollow.
struct Receiver {
    const char* name;
    Vec3 p;
};
constexpr Receiver kReceivers[] = {{"beside", {1.3f, 1.1f, -0.4f}},   {"below", {0.2f, -1.4f, 0.3f}},
                                   {"close", {0.25f, 0.85f, -0.15f}}, {"grazing", {2.5f, 0.31f, 1.2f}},
                                   {"far away", {30, 50, -20}},       {"in the middle", {0.15f, 0.05f, 0.2f}}};

constexpr int kSide = 10;

/// Probability of one of the kSide × kSide cells of a patch, from pdf_light by the midpoint rule.
struct Cell {
    double mass = 0;
    bool visible = true;  ///< all of it, as far as can be seen
};

std::vector<Cell> expected_masses(const World& world, const LightSurface& surface, const SurfacePoint& from) {
    constexpr int kSub = 16;
    std::vector<Cell> cells;
    const double step = 1.0 / (kSide * kSub);
    for (uint32_t patch = 0; patch < surface.patches(); ++patch)
        for (int cell = 0; cell < kSide * kSide; ++cell) {
            Cell sum;
            for (int i = 0; i < kSub * kSub; ++i) {
                const double a = ((cell / kSide) * kSub + i / kSub + 0.5) * step;
                const double b = ((cell % kSide) * kSub + i % kSub + 0.5) * step;
                const LightSurface::Element e = surface.at(patch, a, b);
                const Vec3d d = Vec3d(e.point.p) - Vec3d(from.p);
                const double distance = length(d);
                const Vec3 wi = static_cast<Vec3>(normalize(d));
                const Hit first = world.accel.intersect(Ray{from.p, 0, wi, kInfinity});
                const double pdf = pdf_light(world.shading, 0, from, wi, &e.point);
                // What is hidden behind the shape itself is not seen along wi.
                if (pdf == 0 || (first.found() && first.t < distance - 1e-3))
                    sum.visible = false;
                else
                    sum.mass +=
                        pdf * std::fabs(dot(Vec3d(e.point.ng), d)) / std::pow(distance, 3) * e.area * step * step;
            }
            cells.push_back(sum);
        }
    return cells;
}

void check(const AreaLightCase& light, const Receiver& at) {
    SCOPED_TRACE(light.name + ", receiver " + at.name);
    const World world(light.scene);
    const LightSurface surface(world);
    const SurfacePoint from = test::receiver(at.p, {0, 1, 0});
    const std::vector<Cell> cells = expected_masses(world, surface, from);
    const int n = test::by_tier(20000, 1000000);
    std::vector<double> observed(cells.size(), 0.0);
    double nothing = 0;
    Random random(5);
    int astray = 0, mismatched = 0;
    for (int i = 0; i < n; ++i) {
        const uint32_t choice = random.bits32();
        const auto sample = sample_light(world.shading, 0, from, choice, random.uniform2());
        if (!sample) {
            ++nothing;
            continue;
        }
        EXPECT_NEAR(length(sample->wi), 1, 1e-6);
        const Ray ray{from.p, 0, sample->wi, kInfinity};
        const Hit hit = world.accel.intersect(ray);
        if (!hit.found()) {  // within rounding of an edge
            ++astray;
            continue;
        }
        const SurfacePoint point = surface_at(world.shading, ray, hit);
        const double pdf = pdf_light(world.shading, 0, from, sample->wi, &point);
        // At the rim of a sphere the cosine is all rounding.
        if (std::fabs(dot(sample->wi, point.ng)) > 0.1) mismatched += !(std::fabs(pdf / sample->pdf - 1) < 5e-3);
        const auto [a, b] = surface.of(hit, point);
        const int row = min_of(static_cast<int>(a * kSide), kSide - 1),
                  column = min_of(static_cast<int>(b * kSide), kSide - 1);
        ++observed[hit.prim * kSide * kSide + static_cast<size_t>(row * kSide + column)];
    }
    // wi is rounded to 2^-24; at the far receiver that is 1e-5 of the light's size, for each of its up to nine edges,
    // beside which a ray may miss or find the neighbouring face. A curved surface that is sampled by area has the
    // square root of that, 3e-3, within rounding of its rim.
    const bool curved = std::holds_alternative<EllipsoidEmitter>(world.shading.lights[0].emitter);
    EXPECT_LE(astray + mismatched, 1 + (curved ? n / 300 : n / 10000));

    // Cells that are in sight as a whole, and one bin for everything else.
    const double counted = n - astray;
    std::vector<double> seen, expected;
    double total = 0, rest = nothing, in_sight = 0;
    for (size_t i = 0; i < cells.size(); ++i) {
        total += cells[i].mass;
        if (!cells[i].visible) {
            rest += observed[i];
            continue;
        }
        seen.push_back(observed[i]);
        expected.push_back(cells[i].mass * counted);
        in_sight += cells[i].mass;
    }
    seen.push_back(rest);
    expected.push_back(max_of(1 - in_sight, 0.0) * counted);
    double sum = 0;
    for (const double e : expected) sum += e;
    for (double& e : expected) e *= counted / sum;
    EXPECT_LT(in_sight, 1 + 1e-5);
    const test::ChiSquare result = test::chi_square(seen, expected);
    EXPECT_TRUE(result.passes()) << result << ", in sight " << in_sight;
    // Over everything, the rims known to about 1e-2 of what the cells there hold: samples come as often as they should.
    const double rim = total - in_sight;
    EXPECT_NEAR(nothing / counted, 1 - total, 5 * std::sqrt(0.25 / n) + 0.03 * rim + 1e-5);
}

class AreaSampling : public testing::TestWithParam<int> {};

TEST_P(AreaSampling, FollowsThePdf) {
    const AreaLightCase light = test::area_light_cases()[static_cast<size_t>(GetParam())];
    for (const Receiver& at : kReceivers) check(light, at);
}

INSTANTIATE_TEST_SUITE_P(Lights, AreaSampling, testing::Range(0, static_cast<int>(test::area_light_cases().size())));

}  // namespace
}  // namespace steradian
