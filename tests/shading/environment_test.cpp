// The environment: orientation, interpolation, and samples that follow the stated density whatever the map.
#include "shading/environment.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "shading/bsdf.h"
#include "shading/light.h"
#include "shading/world.h"
#include "support/chi_square.h"
#include "support/support.h"

namespace steradian {
namespace {

Rgb environment_radiance(const ShadingScene& scene, Vec3 d) {
    return distant_radiance(scene, kEnvironmentSource, d, false).radiance;
}

using test::Random;

struct Sky {
    ShadingScene shading;
    Diagnostics diagnostics;
};

Sky sky(uint32_t width, uint32_t height, const std::vector<Rgb>& texels, float rotation = 0, Rgb scale = {1, 1, 1}) {
    Scene scene;
    RawImage image{width, height, 3, TexelFormat::f32, {}};
    image.data.resize(texels.size() * sizeof(Rgb));
    std::memcpy(image.data.data(), texels.data(), image.data.size());
    const ImageId id = add<ImageId>(scene.images, std::move(image));
    scene.lights.push_back(EnvironmentLight{scale, id, ColorSpace::linear, rotation, 3});
    Sky out;
    out.shading = std::move(make_shading_scene(std::move(scene), out.diagnostics)).value();
    return out;
}

std::vector<Rgb> filled(uint32_t width, uint32_t height, Rgb value) {
    return std::vector<Rgb>(size_t(width) * height, value);
}

const SurfacePoint kUp = test::receiver({}, {0, 1, 0});
/// To which the whole sky is seen, so that nothing is below a horizon.
const SurfacePoint kInSpace = test::receiver({}, {});

TEST(Environment, Orientation) {
    // One texel each, in the middle row of 8 × 5: the centre columns are 3 and 4.
    const auto with = [](uint32_t x0, uint32_t x1, float rotation) {
        std::vector<Rgb> texels = filled(8, 5, {});
        texels[2 * 8 + x0] = texels[2 * 8 + x1] = {1, 1, 1};
        return sky(8, 5, texels, rotation);
    };
    const auto seen = [](const Sky& s, Vec3 d) { return environment_radiance(s.shading, d).r; };
    const Vec3 minus_z{0, 0, -1}, plus_x{1, 0, 0}, minus_x{-1, 0, 0}, plus_z{0, 0, 1};
    const Sky centre = with(3, 4, 0);
    EXPECT_NEAR(seen(centre, minus_z), 1, 1e-6);
    for (const Vec3 d : {plus_x, minus_x, plus_z}) EXPECT_NEAR(seen(centre, d), 0, 1e-6);
    EXPECT_NEAR(seen(with(5, 6, 0), plus_x), 1, 1e-6);
    EXPECT_NEAR(seen(with(1, 2, 0), minus_x), 1, 1e-6);
    EXPECT_NEAR(seen(with(0, 7, 0), plus_z), 1, 1e-6);
    // Counter-clockwise seen from above: what was at -Z comes to -X, what was at +X to -Z.
    EXPECT_NEAR(seen(with(3, 4, 90), minus_x), 1, 1e-6);
    EXPECT_NEAR(seen(with(5, 6, 90), minus_z), 1, 1e-6);
    EXPECT_NEAR(seen(with(3, 4, -90), plus_x), 1, 1e-6);
    // The top row is +Y.
    std::vector<Rgb> top = filled(8, 5, {});
    for (size_t x = 0; x < 8; ++x) top[x] = {1, 0, 0};
    EXPECT_NEAR(seen(sky(8, 5, top), {0, 1, 0}), 1, 1e-6);
    EXPECT_NEAR(seen(sky(8, 5, top), {0, -1, 0}), 0, 1e-6);
}

TEST(Environment, InterpolatesBetweenTexelCentres) {
    const Sky s = sky(4, 2, {{1, 1, 1}, {2, 2, 2}, {4, 4, 4}, {8, 8, 8}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, 0,
                      {2, 1, 1});
    const auto direction = [](double column, double row) {
        const double phi = 2 * std::numbers::pi * (column / 4 - 0.5), theta = std::numbers::pi * row / 2;
        return static_cast<Vec3>(
            Vec3d{std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)});
    };
    const auto at = [&](double column, double row) { return environment_radiance(s.shading, direction(column, row)); };
    EXPECT_NEAR(at(0.5, 0.5).g, 1, 1e-5);
    EXPECT_NEAR(at(0.5, 0.5).r, 2, 1e-5);
    EXPECT_NEAR(at(2.5, 0.5).g, 4, 1e-5);
    EXPECT_NEAR(at(2, 0.5).g, 3, 1e-5);
    EXPECT_NEAR(at(0.001, 0.5).g, 4.5, 1e-2);  // wraps around
    EXPECT_NEAR(at(3.999, 0.5).g, 4.5, 1e-2);
    EXPECT_NEAR(at(2.5, 0.1).g, 4, 1e-5);  // continued at the pole
    EXPECT_NEAR(at(2.5, 1).g, 2, 1e-5);
}

struct Map {
    const char* name;
    uint32_t width, height;
    std::vector<Rgb> texels;
};

std::vector<Map> maps() {
    Random random(9);
    std::vector<Map> out;
    out.push_back({"one texel", 1, 1, {{0.3f, 0.3f, 0.3f}}});
    out.push_back({"one column", 1, 4, {{1, 1, 1}, {0, 0, 0}, {4, 4, 4}, {0.5f, 0, 0}}});
    out.push_back({"one row", 5, 1, {{1, 1, 1}, {0, 0, 0}, {0, 0, 1}, {0, 0, 0}, {0, 0, 0}}});
    Map noise{"noise", 16, 8, filled(16, 8, {})};
    for (Rgb& c : noise.texels) {
        const float r = random.uniform(), g = random.uniform();
        c = {r * r * 3, g * 0.1f, 0.2f};
    }
    out.push_back(noise);
    Map blue{"a patch of pure blue", 12, 6, filled(12, 6, {})};
    blue.texels[3 * 12 + 4] = {0, 0, 7};
    out.push_back(blue);
    Map sun{"a tiny sun", 64, 32, filled(64, 32, {0.1f, 0.1f, 0.1f})};
    sun.texels[6 * 64 + 20] = {5e4f, 4e4f, 3e4f};
    out.push_back(sun);
    return out;
}

/// Quarters of texels, cut in the middle of both angles: along their borders lie all steps of the density, and where
/// the interpolation reaches 0.
struct Quarters {
    const Map& map;
    double rotation;  ///< radians

    size_t count() const { return size_t(4) * map.width * map.height; }

    size_t of(Vec3 d) const {
        const double c = std::cos(rotation), s = std::sin(rotation);
        const double x = c * d.x - s * d.z, z = s * d.x + c * d.z;
        const double u = 0.5 + std::atan2(x, -z) / (2 * std::numbers::pi);
        const double v = std::atan2(std::hypot(x, z), static_cast<double>(d.y)) / std::numbers::pi;
        const auto column = min_of(static_cast<size_t>(u * 2 * map.width), size_t(2) * map.width - 1);
        const auto row = min_of(static_cast<size_t>(v * 2 * map.height), size_t(2) * map.height - 1);
        return row * 2 * map.width + column;
    }
    double theta(double row) const { return std::numbers::pi * row / (2.0 * map.height); }
    Vec3 middle(size_t i) const {
        const double t = theta(static_cast<double>(i / (2 * map.width)) + 0.5);
        const double phi =
            2 * std::numbers::pi * ((static_cast<double>(i % (2 * map.width)) + 0.5) / (2.0 * map.width) - 0.5);
        const double x = std::sin(t) * std::sin(phi), z = -std::sin(t) * std::cos(phi);
        const double c = std::cos(rotation), s = std::sin(rotation);
        return static_cast<Vec3>(Vec3d{c * x + s * z, std::cos(t), c * z - s * x});
    }
    double solid_angle(size_t i) const {
        const auto row = static_cast<double>(i / (2 * map.width));
        return (std::cos(theta(row)) - std::cos(theta(row + 1))) * std::numbers::pi / map.width;
    }
};

void samples_follow(EnvironmentDensity density, const SurfacePoint& from) {
    const int n = test::by_tier(100000, 3000000);
    for (const Map& map : maps())
        for (const float rotation : {0.0f, 33.0f}) {
            SCOPED_TRACE(map.name);
            const Sky s = sky(map.width, map.height, map.texels, rotation);
            const Quarters quarters{map, rotation * std::numbers::pi / 180};
            std::vector<double> expected(quarters.count() + 1), observed(quarters.count() + 1);
            double total = 0;
            for (size_t i = 0; i < quarters.count(); ++i) {
                const double p =
                    pdf_light(s.shading, 0, from, quarters.middle(i), nullptr, density) * quarters.solid_angle(i);
                total += p;
                // Directions from which nothing comes are no samples.
                expected[is_black(environment_radiance(s.shading, quarters.middle(i))) ? quarters.count() : i] += p * n;
            }
            EXPECT_NEAR(total, 1, 1e-6);
            for (double& e : expected) e /= total;
            Random random(6);
            int mismatched = 0;
            for (int i = 0; i < n; ++i) {
                const uint32_t choice = random.bits32();
                const auto l = sample_light(s.shading, 0, from, choice, random.uniform2(), density);
                const size_t cell = l ? quarters.of(l->wi) : quarters.count();
                ++observed[expected[cell] > 0 ? cell : quarters.count()];
                // A direction within rounding of a border between texels may be on the other side of it.
                if (!l) continue;
                const float pdf = pdf_light(s.shading, 0, from, l->wi, nullptr, density);
                mismatched += !(std::fabs(pdf / l->pdf - 1) < 1e-5f);
            }
            const test::ChiSquare result = test::chi_square(observed, expected);
            EXPECT_TRUE(result.passes()) << result;
            EXPECT_LE(mismatched, 1 + n / 10000);
        }
}

TEST(Environment, SamplesFollowTheDensity) { samples_follow(EnvironmentDensity::complete, kUp); }
TEST(Environment, SamplesFollowTheCompensatedDensity) { samples_follow(EnvironmentDensity::compensated, kInSpace); }
TEST(Environment, SamplesFollowWhatSuitsTheSurface) {
    for (const Vec3 n : {Vec3{0, 1, 0}, Vec3{0.6f, -0.8f, 0}})
        samples_follow(EnvironmentDensity::compensated, test::receiver({}, n));
}

/// What the complete density has above that of all directions alike; nothing is left out where nothing is above.
TEST(Environment, CompensationKeepsWhatLiesAboveTheMean) {
    constexpr double kUniform = 1 / (4 * std::numbers::pi);
    Random random(4);
    for (const Map& map : maps()) {
        const Sky s = sky(map.width, map.height, map.texels, 20);
        const auto densities = [&](Vec3 d) {
            return std::pair<double, double>(
                pdf_light(s.shading, 0, kInSpace, d, nullptr),
                pdf_light(s.shading, 0, kInSpace, d, nullptr, EnvironmentDensity::compensated));
        };
        double scale = 1;  // where it has most
        double most = 0;
        std::vector<std::pair<double, double>> all;
        const Quarters quarters{map, 20 * std::numbers::pi / 180};
        for (size_t i = 0; i < quarters.count(); ++i) all.push_back(densities(quarters.middle(i)));
        for (const auto& [complete, compensated] : all)
            if (complete > most) most = complete, scale = compensated / (complete - kUniform);
        if (map.name == std::string("one texel")) {
            for (const auto& [complete, compensated] : all) EXPECT_EQ(complete, compensated);
            continue;
        }
        EXPECT_GT(scale, 1) << map.name;
        for (const auto& [complete, compensated] : all)
            EXPECT_NEAR(compensated, scale * max_of(complete - kUniform, 0.0), 1e-5 * scale * (complete + kUniform))
                << map.name;
    }
}

/// By quadrature over parts of texels, the part of a surface's irradiance that comes from above the mean decides
/// which density there is. Normals where that changes within six degrees are not asked: a table answers.
TEST(Environment, CompensatesWhereWhatLiesAboveTheMeanIsSeen) {
    constexpr double kUniform = 1 / (4 * std::numbers::pi);
    constexpr double kLeastShare = 0.25;
    Random random(14);
    for (const Map& map : maps()) {
        SCOPED_TRACE(map.name);
        const float rotation = 70;
        const Sky s = sky(map.width, map.height, map.texels, rotation);
        // Of more texels where there are few, which would be too wide to be one direction each.
        const Map fine{map.name,
                       map.width * ((64 + map.width - 1) / map.width),
                       map.height * ((32 + map.height - 1) / map.height),
                       {}};
        const Quarters quarters{fine, rotation * std::numbers::pi / 180};
        std::vector<double> density(quarters.count());
        for (size_t i = 0; i < quarters.count(); ++i)
            density[i] = pdf_light(s.shading, 0, kInSpace, quarters.middle(i), nullptr);
        const auto pays = [&](Vec3 n, bool both_sides) {
            double all = 0, above = 0;
            for (size_t i = 0; i < quarters.count(); ++i) {
                const double towards = dot(n, quarters.middle(i));
                const double cosine = both_sides ? std::fabs(towards) : max_of(towards, 0.0);
                all += cosine * density[i] * quarters.solid_angle(i);
                above += cosine * max_of(density[i] - kUniform, 0.0) * quarters.solid_angle(i);
            }
            return !(above < kLeastShare * all);
        };
        // Where both densities differ most.
        Vec3 probe;
        double most = -1;
        const auto pdf = [&](const SurfacePoint& from, Vec3 d, EnvironmentDensity wanted) {
            return pdf_light(s.shading, 0, from, d, nullptr, wanted);
        };
        for (size_t i = 0; i < quarters.count(); ++i) {
            const Vec3 d = quarters.middle(i);
            const double difference = std::fabs(pdf(kInSpace, d, EnvironmentDensity::complete) -
                                                pdf(kInSpace, d, EnvironmentDensity::compensated));
            if (difference > most) most = difference, probe = d;
        }
        if (most == 0) continue;  // nothing is compensated
        int seen[2] = {}, asked = 0;
        constexpr int kNormals = 100;
        for (int i = 0; i < kNormals; ++i) {
            SurfacePoint from = test::receiver({}, static_cast<Vec3>(random.direction()));
            from.both_sides = i % 4 == 3;
            const bool expected = pays(from.ns, from.both_sides);
            const Frame frame = Frame::from_z(from.ns);
            bool sure = true;
            for (int k = 0; k < 6; ++k) {
                const double phi = std::numbers::pi * k / 3, theta = 6 * std::numbers::pi / 180;
                const Vec3d local{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
                sure = sure && pays(normalize(frame.to_world(Vec3(local))), from.both_sides) == expected;
            }
            if (!sure) continue;
            ++asked, ++seen[expected];
            EXPECT_EQ(pdf(from, probe, EnvironmentDensity::compensated),
                      pdf(kInSpace, probe, expected ? EnvironmentDensity::compensated : EnvironmentDensity::complete))
                << "normal " << from.ns.x << ' ' << from.ns.y << ' ' << from.ns.z << " both sides " << from.both_sides;
            EXPECT_EQ(pdf(from, probe, EnvironmentDensity::complete),
                      pdf(kInSpace, probe, EnvironmentDensity::complete));
        }
        EXPECT_GT(asked, kNormals / 2);
        if (map.name == std::string("a tiny sun")) {
            EXPECT_GT(seen[0], 10);
            EXPECT_GT(seen[1], 10);
        }
    }
}

TEST(Environment, ThereIsDensityWhereverThereIsRadiance) {
    Random random(12);
    for (const Map& map : maps()) {
        const Sky s = sky(map.width, map.height, map.texels, 20);
        for (int i = 0; i < 20000; ++i) {
            const Vec3 d = static_cast<Vec3>(random.direction());
            if (!is_black(environment_radiance(s.shading, d))) {
                ASSERT_GT(pdf_light(s.shading, 0, kUp, d, nullptr), 0) << map.name;
            }
        }
    }
}

/// E[radiance / pdf] is the integral of the radiance over the sphere, here by a fine midpoint rule.
TEST(Environment, EstimatesTheIntegral) {
    for (const Map& map : maps()) {
        const Sky s = sky(map.width, map.height, map.texels);
        double expected = 0;
        const int rows = 512, columns = 1024;
        for (int y = 0; y < rows; ++y)
            for (int x = 0; x < columns; ++x) {
                const double theta = std::numbers::pi * (y + 0.5) / rows,
                             phi = 2 * std::numbers::pi * (x + 0.5) / columns;
                const Vec3d d{std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
                expected += environment_radiance(s.shading, static_cast<Vec3>(d)).b * std::sin(theta);
            }
        expected *= 2 * std::numbers::pi * std::numbers::pi / (static_cast<double>(rows) * columns);
        Random random(8);
        double sum = 0, squares = 0;
        const int n = test::by_tier(100000, 2000000);
        for (int i = 0; i < n; ++i) {
            const uint32_t choice = random.bits32();
            const auto l = sample_light(s.shading, 0, kUp, choice, random.uniform2());
            const double x = l ? l->radiance.b / l->pdf : 0;
            sum += x, squares += x * x;
        }
        const double mean = sum / n, sigma = std::sqrt(max_of(squares / n - mean * mean, 0.0) / n);
        EXPECT_NEAR(mean, expected, 4.5 * sigma + 1e-4 * expected) << map.name;
    }
}

TEST(Environment, ConstantHasNoVariance) {
    Scene scene;
    scene.lights.push_back(EnvironmentLight{{2, 1, 1}, {}, ColorSpace::linear, 0, 4});
    Diagnostics diagnostics;
    const ShadingScene shading = std::move(make_shading_scene(std::move(scene), diagnostics)).value();
    EXPECT_EQ(light_sample_count(shading, 0), 4u);
    EXPECT_EQ(environment_radiance(shading, {0, 0, 1}), (Rgb{2, 1, 1}));
    Random random(3);
    for (int i = 0; i < 10000; ++i) {
        const SurfacePoint from = test::receiver({}, static_cast<Vec3>(random.direction()));
        const auto l = sample_light(shading, 0, from, 0, random.uniform2());
        ASSERT_TRUE(l);
        EXPECT_NEAR(l->radiance.g * dot(l->wi, from.ns) / l->pdf, std::numbers::pi, 1e-6);
        EXPECT_EQ(pdf_light(shading, 0, from, l->wi, nullptr), l->pdf);
        EXPECT_EQ(pdf_light(shading, 0, from, -l->wi, nullptr), 0);
    }
    // The back of a surface with two sides, once it is turned to the viewer.
    const Bsdf bsdf{DiffuseBsdf{{1, 1, 1}, true}, {0, 1, 0}, Frame::from_z({0, 1, 0})};
    for (int i = 0; i < 1000; ++i) {
        const Vec3 wo = static_cast<Vec3>(random.direction());
        const auto l = sample_light(shading, 0, facing(kUp, wo), 0, random.uniform2());
        ASSERT_TRUE(l);
        EXPECT_NEAR(l->radiance.g * eval(bsdf, wo, l->wi).f_cos.g / l->pdf, 1, 1e-6);
    }
    const auto sampled = [&](uint64_t) -> std::optional<Vec3> {
        const auto l = sample_light(shading, 0, test::receiver({}, {0, 0, 1}), 0, random.uniform2());
        return l ? std::optional(l->wi) : std::nullopt;
    };
    const auto density = [&](Vec3 d) {
        return double(pdf_light(shading, 0, test::receiver({}, {0, 0, 1}), d, nullptr));
    };
    const test::ChiSquare result = test::chi_square_directions(sampled, density, 50000, 10, 16);
    EXPECT_TRUE(result.passes()) << result;
}

TEST(Environment, BlackAndBroken) {
    const Sky black = sky(4, 2, filled(4, 2, {}));
    EXPECT_FALSE(sample_light(black.shading, 0, kUp, 0, {0.5f, 0.5f}));
    EXPECT_EQ(pdf_light(black.shading, 0, kUp, {0, 1, 0}, nullptr), 0);
    EXPECT_TRUE(black.diagnostics.empty());

    std::vector<Rgb> texels = filled(4, 2, {1, 1, 1});
    texels[1].g = std::numeric_limits<float>::quiet_NaN();
    texels[2] = {kInfinity, -kInfinity, 1};
    texels[5].b = -4;
    const Sky broken = sky(4, 2, texels);
    ASSERT_EQ(broken.diagnostics.warnings().size(), 1u);
    EXPECT_EQ(broken.diagnostics.warnings()[0].count, 3u);
    Random random(2);
    for (int i = 0; i < 1000; ++i) {
        const Rgb c = environment_radiance(broken.shading, static_cast<Vec3>(random.direction()));
        EXPECT_TRUE(is_finite(c) && c.r >= 0 && c.g >= 0 && c.b >= 0);
        const auto l = sample_light(broken.shading, 0, kUp, random.bits32(), random.uniform2());
        ASSERT_TRUE(l);
        EXPECT_TRUE(l->pdf > 0 && is_finite(l->pdf));
    }
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const Vec3 d : {Vec3{}, Vec3{nan, 0, 0}, Vec3{kInfinity, 0, 1}})
        EXPECT_TRUE(is_finite(environment_radiance(broken.shading, d)));
}

}  // namespace
}  // namespace steradian
