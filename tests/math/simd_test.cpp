// Four floats at a time: every lane is what the scalar expression gives, to the bit, also for what is no number.
#include "math/simd.h"

#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <vector>

#include "math/vector.h"

namespace steradian {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

const std::vector<float> kValues{0.0f,      -0.0f,      1,    -1,   1e-45f, -1e-38f, 3e38f,  -3e38f,
                                 kInfinity, -kInfinity, kNan, 0.5f, 0.3f,   -77.7f,  1e-20f, 123456.789f};

/// NaNs have many forms, and which one comes out is no promise.
void expect_same(float a, float b, const char* what, float x, float y) {
    if (std::isnan(a) && std::isnan(b)) return;
    EXPECT_EQ(std::bit_cast<uint32_t>(a), std::bit_cast<uint32_t>(b)) << what << " of " << x << " and " << y;
}

TEST(Float4, EveryLaneIsTheScalarExpression) {
    const std::vector<float>& all = kValues;
    ASSERT_EQ(all.size() % 4, 0u);
    for (size_t i = 0; i < all.size(); i += 4)
        for (size_t shift = 0; shift < all.size(); ++shift) {
            alignas(16) float a[4], b[4], out[4];
            for (size_t k = 0; k < 4; ++k) a[k] = all[i + k], b[k] = all[(i + k + shift) % all.size()];
            const Float4 x = Float4::load(a), y = Float4::load(b);
            const auto check = [&](Float4 got, const char* what, auto expected) {
                got.store(out);
                for (int k = 0; k < 4; ++k) expect_same(out[k], expected(a[k], b[k]), what, a[k], b[k]);
            };
            check(x + y, "sum", [](float p, float q) { return p + q; });
            check(x - y, "difference", [](float p, float q) { return p - q; });
            check(x * y, "product", [](float p, float q) { return p * q; });
            check(x / y, "quotient", [](float p, float q) { return p / q; });
            check(larger(x, y), "larger", [](float p, float q) { return max_of(p, q); });
            check(smaller(x, y), "smaller", [](float p, float q) { return min_of(p, q); });
            check(sqrt(x), "root", [](float p, float) { return std::sqrt(p); });
            check(abs(x), "absolute value", [](float p, float) { return std::fabs(p); });
            check(select(x < y, x, y), "less", [](float p, float q) { return p < q ? p : q; });
            check(select(x < y && y < Float4::all(1), Float4::all(2), x), "both",
                  [](float p, float q) { return p < q && q < 1 ? 2 : p; });
        }
}

}  // namespace
}  // namespace steradian
