// What looking for mistakes takes of memory, beside the scene.
#include "image/samples.h"
#include "lint_scene.h"

namespace steradian::test {
namespace {

/// Bodies of every kind of optics, which touch each other; every rule has to look at all of them.
LintScene large(uint32_t n) {
    LintScene t;
    const MaterialId materials[] = {t.material(GlassMaterial{}), MaterialId{0}, t.grey(false)};
    double x = 2;
    for (const MaterialId m : materials) t.place(slab(n), m, translation(x += 1, 0, 0));
    return t;
}

constexpr uint32_t kSide = 400;
int make(const void* n) { return large(*static_cast<const uint32_t*>(n)).s.instances.empty() ? 1 : 0; }
int make_and_look(const void* n) {
    const LintScene t = large(*static_cast<const uint32_t*>(n));
    return lint(t.s, t.settings).ok() ? 0 : 1;
}

TEST(LintCost, MemoryIsBoundedByTheTriangles) {
    const Cost scene = cost_of(make, &kSide), both = cost_of(make_and_look, &kSide);
    ASSERT_EQ(scene.exit_code, 0);
    ASSERT_EQ(both.exit_code, 0);
    const uint64_t triangles = 3 * (4 * uint64_t(kSide) * kSide + 8 * kSide);
    // What is kept of all triangles for comparing them, and the edges of one mesh at a time.
    const uint64_t most = 32 * triangles + 72 * triangles / 3 + (uint64_t(16) << 20);
    EXPECT_GT(scene.peak_bytes, 12 * triangles);
    EXPECT_LT(both.peak_bytes, scene.peak_bytes + most);
}

/// A grid of millions of pieces in one plane is left alone instead of being compared.
TEST(LintCost, AGridInOnePlane) {
    const auto make_grids = [](const void*) {
        LintScene t;
        Mesh m = slab(300);
        for (Vec3& p : m.positions) p.z = 0;
        t.place(m, MaterialId{0}, translation(2, 0, 0)), t.place(m, t.grey(), translation(2.3, 0.1, 0));
        LintOptions options;
        options.disabled = {"coincident-surfaces", "degenerate-triangles", "duplicate-triangles"};
        return lint(t.s, t.settings, options).ok() ? 0 : 1;
    };
    const Cost cost = cost_of(+make_grids, nullptr);
    EXPECT_EQ(cost.exit_code, 0);
    EXPECT_LT(cost.peak_bytes, uint64_t(160) << 20);
}

}  // namespace
}  // namespace steradian::test
