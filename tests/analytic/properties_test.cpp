// What holds between pictures of one scene rather than for one picture.
#include <gtest/gtest.h>

#include <cmath>

#include "analytic/check.h"
#include "analytic/compare.h"
#include "support/support.h"

namespace steradian::analytic {
namespace {

/// A room with coloured walls, a block, a mirror ball and a rectangular light, through the box filter.
SceneText room() {
    SceneText s;
    s.look({0, 1, 6.8}, {0, 1, 0}, 19.5).size(16, 16);
    s.material("red", diffuse({0.63, 0.065, 0.05}))
        .material("green", diffuse({0.14, 0.45, 0.091}))
        .material("white", diffuse({0.725, 0.71, 0.68}));
    s.material("mirror", mirror(0.9)).material("black", diffuse(0.0));
    s.object(ground({0, 0, 0}, 1, 1, "white"))
        .object(ceiling({0, 2, 0}, 1, 1, "white"))
        .object(rectangle({0, 1, -1}, {1, 0, 0}, {0, 1, 0}, "white"));
    s.object(rectangle({-1, 1, 0}, {0, 1, 0}, {0, 0, 1}, "red"))
        .object(rectangle({1, 1, 0}, {0, 0, 1}, {0, 1, 0}, "green"));
    s.object(sphere({-0.45, 0.4, -0.2}, 0.4, "mirror")).object(sphere({0.45, 0.3, 0.3}, 0.3, "white"));
    s.object(ceiling({0, 1.98, 0}, 0.25, 0.25, "black").set("light", emission({17, 12, 5})));
    return s.depth(4);
}

void expect_same_pixels(const Image& a, const Image& b) {
    ASSERT_EQ(a.width, b.width);
    ASSERT_EQ(a.height, b.height);
    EXPECT_EQ(image_hash(a), image_hash(b));
}

TEST(Pictures, ACropIsThatPartOfTheWhole) {
    const PreparedCase scene(room().filter("mitchell", 2).str(), {});
    const Image whole = scene.picture(7, 70);
    RenderSettings settings = scene.settings;
    settings.seed = 7;
    settings.samples_per_pixel = 70;
    for (const Crop crop : {Crop{0, 0, 1, 1}, Crop{3, 5, 14, 9}, Crop{15, 0, 16, 16}}) {
        settings.crop = crop;
        const Image part = scene.picture(settings);
        Image cut{crop.x1 - crop.x0, crop.y1 - crop.y0, whole.channels, {}, {}};
        for (uint32_t y = crop.y0; y < crop.y1; ++y)
            for (uint32_t x = crop.x0; x < crop.x1; ++x)
                for (size_t c = 0; c < 3; ++c)
                    cut.pixels.push_back(whole.pixels[(size_t(y) * whole.width + x) * 3 + c]);
        expect_same_pixels(cut, part);
    }
}

TEST(Pictures, WithoutSpecularSurfacesDepthOneEqualsAnyDepth) {
    const Case* rect = nullptr;
    const std::vector<Case> cases = area_light_cases();
    for (const Case& c : cases)
        if (c.id == "lights_of_four_kinds") rect = &c;
    ASSERT_NE(rect, nullptr);
    const PreparedCase scene(rect->scene, {});
    RenderSettings settings = scene.settings;
    settings.max_depth = 1;
    const Image one = scene.picture(settings);
    settings.max_depth = 16;
    expect_same_pixels(one, scene.picture(settings));
}

/// Luminance-free: the green channel's mean over the picture, for each of `seeds` seeds.
std::vector<double> means(const PreparedCase& scene, uint32_t seeds, uint64_t samples, SamplerKind sampler) {
    std::vector<double> out;
    for (uint32_t seed = 0; seed < seeds; ++seed) {
        RenderSettings settings = scene.settings;
        settings.seed = 1000 + seed;
        settings.samples_per_pixel = samples;
        settings.sampler = sampler;
        const Image image = scene.picture(settings);
        out.push_back(mean_over(image, {0, 0, image.width, image.height, {}, false}, 1));
    }
    return out;
}

/// n light samples cost n shadow rays, leave the mean alone and, with independent numbers, divide the variance by n.
TEST(LightSamples, KeepTheMeanAndLowerTheVariance) {
    const auto variance = [](const Estimate& e, uint32_t count) { return e.standard_error * e.standard_error * count; };
    // A ratio of two sample variances of 256 pictures each: its logarithm has a standard deviation of sqrt(2 · 2 /
    // 255).
    const uint32_t seeds = test::by_tier(256u, 1024u);
    const double spread = 4 * std::sqrt(4.0 / (seeds - 1));
    struct Light {
        const char* name;
        Object object;
        double form_factor;
    };
    const double tilt = parallel_disk_form_factor(1, 2, 1.5);
    const Light lights[] = {{"disk", disk({1.5, 2, 0}, {0, -1, 0}, 1, "black"), tilt},
                            {"mesh", polygon({{-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}}, "black"),
                             4 * parallel_corner_form_factor(1, 1, 2)}};
    for (const Light& light : lights) {
        SCOPED_TRACE(light.name);
        std::vector<Estimate> estimates;
        for (const int n : {1, 4, 16}) {
            Object shining = light.object;
            shining.set("light", emission(4).set("light_samples", n));
            const PreparedCase scene(floor_scene({-0.6, 0.9, 0.9}).object(shining).str(), {});
            estimates.push_back(estimate(means(scene, seeds, 1, SamplerKind::independent)));
            const Estimate& e = estimates.back();
            EXPECT_LE(std::abs(e.mean - 2 * light.form_factor), 4 * e.standard_error) << n;
            EXPECT_NEAR(std::log(variance(estimates[0], seeds) / variance(e, seeds)), std::log(n),
                        n == 1 ? 1e-12 : spread)
                << n;
            RenderSettings settings = scene.settings;
            settings.samples_per_pixel = 1;
            EXPECT_EQ(scene.render(settings).statistics.shadow_rays, 64u * static_cast<uint64_t>(n));
        }
    }
}

double log_variance(const SceneText& text, uint32_t seeds, uint64_t samples) {
    return 2 *
           std::log(
               estimate(means(PreparedCase(text.str(), {}), seeds, samples, SamplerKind::independent)).standard_error);
}

// Every number is used once: the light samples of different camera samples, and of different lights, are independent of
// each other. Logarithms of ratios of two sample variances, as above.
TEST(LightSamples, ShareNoNumbers) {
    const uint32_t seeds = test::by_tier(512u, 2048u);
    const double spread = 4 * std::sqrt(4.0 / (seeds - 1));
    const auto lamp = [](double x, int n) {
        return disk({x, 2, 0}, {0, -1, 0}, 0.34, "black").set("light", emission(4).set("light_samples", n));
    };
    const auto floor = [] { return floor_scene({-0.6, 0.9, 0.9}); };
    const double near = log_variance(floor().object(lamp(1.5, 1)), seeds, 1);
    EXPECT_NEAR(near - log_variance(floor().object(lamp(1.5, 4)), seeds, 4), std::log(16), spread);
    // Two lamps side by side, whose contributions rise and fall together with the position on each.
    const double far = log_variance(floor().object(lamp(2.2, 1)), seeds, 1);
    const double both = log_variance(floor().object(lamp(1.5, 1)).object(lamp(2.2, 1)), seeds, 1);
    EXPECT_NEAR(both - std::log(std::exp(near) + std::exp(far)), 0, spread);
}

TEST(LightSamples, OfTheEnvironmentKeepTheMean) {
    for (const int n : {1, 3, 8}) {
        const Object sky = environment({1, 2, 0.5}).set("light_samples", n);
        Case c = whole("env_samples", "ρ L (1 - r² / (r² + h²))",
                       floor_scene({1.5, 0.5, 0.9}).light(sky).object(disk({0, 2, 0}, {0, -1, 0}, 1, "black")),
                       Color{1, 2, 0.5} * 0.4);
        c.kind = CaseClass::stochastic;
        c.tolerance = 1e-3;
        for (const std::string& failure : judge(c).failures) ADD_FAILURE() << n << ": " << failure;
    }
}

/// The low-discrepancy sampler is worth its name: much less noise than the independent one at the same cost.
TEST(Samplers, SobolHasLessNoise) {
    const PreparedCase scene(
        floor_scene().object(disk({1.5, 2, 0}, {0, -1, 0}, 1, "black").set("light", emission(4))).str(), {});
    const Estimate sobol = estimate(means(scene, 64, 64, SamplerKind::sobol)),
                   independent = estimate(means(scene, 64, 64, SamplerKind::independent));
    EXPECT_LT(sobol.standard_error * 4, independent.standard_error);
}

TEST(Samplers, AgreeInEveryPixel) {
    const PreparedCase scene(room().str(), {});
    RenderSettings sobol = scene.settings, independent = scene.settings;
    sobol.sampler = SamplerKind::sobol;
    independent.sampler = SamplerKind::independent;
    expect_same_means(scene, sobol, independent);
}

/// A wrong value by a quarter of a percent is found: the bounds are not so wide that anything passes.
TEST(Judgement, FindsSmallErrors) {
    for (const Case& original : area_light_cases()) {
        if (original.id != "rect_offset" && original.id != "sphere_45deg" && original.id != "furnace_box_mesh")
            continue;
        Case wrong = original;
        wrong.expected[0].value = wrong.expected[0].value * 1.0025;
        EXPECT_FALSE(judge(wrong).failures.empty()) << original.id;
    }
    for (const Case& original : delta_light_cases()) {
        if (original.id != "point_oblique" && original.id != "spot_penumbra") continue;
        Case wrong = original;
        wrong.expected[0].value = wrong.expected[0].value * 1.00003;
        EXPECT_FALSE(judge(wrong).failures.empty()) << original.id;
    }
}

}  // namespace
}  // namespace steradian::analytic
