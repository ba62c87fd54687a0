// What fills bodies, and which of them counts where several are.
#include <cmath>

#include "formats/scene_test.h"

namespace steradian::test {
namespace {

TEST(NativeScene, InteriorsAndPriorities) {
    const LoadedScene loaded = load_good(scene_with(R"("materials": {
        "plain": {"type": "glass"},
        "set": {"type": "glass", "priority": 7, "interior": {"absorption": [1, 2, 3], "scattering": 4, "anisotropy": -0.5}},
        "deep": {"type": "open_pbr", "transmission_weight": 1, "transmission_color": [1, 0.25, 0], "transmission_depth": 2,
                 "transmission_scatter": [0, 0.5, 1], "transmission_scatter_anisotropy": 1, "priority": 0},
        "tinted": {"type": "open_pbr", "transmission_color": [1, 0.25, 0], "transmission_scatter": 1},
        "murky": {"type": "open_pbr", "transmission_color": [1, 0.25, 0.5], "transmission_depth": 1, "transmission_scatter": 1}})"));
    const auto glass = [&](size_t i) { return std::get<GlassMaterial>(loaded.scene.materials[i]); };
    const auto open_pbr = [&](size_t i) { return std::get<OpenPbrMaterial>(loaded.scene.materials[i]); };
    EXPECT_EQ(glass(0).interior, Medium{});
    EXPECT_FALSE(glass(0).priority);
    EXPECT_EQ(glass(1).interior, (Medium{{1, 2, 3}, {4, 4, 4}, -0.5f}));
    EXPECT_EQ(glass(1).priority, 7u);
    const Medium deep = open_pbr(2).interior;
    EXPECT_EQ(open_pbr(2).transmission_color.value, (Rgb{1, 1, 1}));
    EXPECT_EQ(open_pbr(2).priority, 0u);
    EXPECT_EQ(deep.scattering, (Rgb{0, 0.25f, 0.5f}));
    EXPECT_EQ(deep.absorption.r, 0);
    EXPECT_NEAR(deep.absorption.g, std::log(4.0) / 2 - 0.25, 1e-6);
    EXPECT_NEAR(deep.absorption.b, 30 * std::log(10.0) / 2 - 0.5, 1e-4);  // as good as opaque
    EXPECT_EQ(deep.anisotropy, kMaxAnisotropy);
    EXPECT_EQ(open_pbr(3).transmission_color.value, (Rgb{1, 0.25f, 0}));
    EXPECT_EQ(open_pbr(3).interior, Medium{});
    // More is scattered than is missing: absorption is raised by the same amount in all channels.
    const Medium murky = open_pbr(4).interior;
    EXPECT_EQ(murky.absorption.r, 0);
    EXPECT_NEAR(murky.absorption.g, std::log(4.0), 1e-6);
    EXPECT_NEAR(murky.absorption.b, std::log(2.0), 1e-6);

    const auto with = [](const std::string& material) {
        return scene_with("\"materials\": {\"m\": {" + material + "}}");
    };
    expect_error(with(R"("type": "glass", "interior": {§"colour": 1})"), "colour");
    expect_error(with(R"("type": "glass", "interior": {"absorption": §-1})"), "absorption");
    expect_error(with(R"("type": "glass", "interior": {"anisotropy": §1})"), "anisotropy");
    expect_error(with(R"("type": "glass", "priority": §-1)"), "priority");
    expect_error(with(R"("type": "glass", "priority": §0.5)"), "priority");
    expect_error(
        with(R"("type": "open_pbr", §"transmission_depth": 1, "transmission_color": {"type": "checkerboard"})"),
        "texture");
    expect_error(with(R"("type": "open_pbr", §"transmission_depth": 1, "geometry_thin_walled": true)"), "thin wall");
}

}  // namespace
}  // namespace steradian::test
