// Compilers must keep every rounding that is written. GCC 12 does not when it vectorises (docs/decisions/0007).
#include <gtest/gtest.h>

#include <cmath>

namespace steradian::test {
namespace {

struct Pair {
    float x, y;
};

[[gnu::noinline]] Pair divide_rounded(double a, double b, double length) {
    const float x = static_cast<float>(a), y = static_cast<float>(b);
    const double wide_x = x, wide_y = y;
    return {static_cast<float>(wide_x / length), static_cast<float>(wide_y / length)};
}

[[gnu::noinline]] void round_all(const double* in, double* out, int count) {
    for (int i = 0; i < count; ++i) out[i] = static_cast<double>(static_cast<float>(in[i]));
}

/// Through memory that the compiler must not see through.
double rounded(double x) {
    volatile float stored = static_cast<float>(x);
    return stored;
}

TEST(rounding, to_float_happens_in_straight_line_code) {
    for (int i = 1; i < 20000; ++i) {
        const double a = i * 0.1234567891234, b = i * 0.7654321987, length = std::sqrt(a * a + b * b);
        const Pair pair = divide_rounded(a, b, length);
        ASSERT_EQ(pair.x, static_cast<float>(rounded(a) / length)) << i;
        ASSERT_EQ(pair.y, static_cast<float>(rounded(b) / length)) << i;
    }
}

TEST(rounding, to_float_happens_in_loops) {
    double in[61], out[61];
    for (int i = 0; i < 61; ++i) in[i] = i * 0.123456789123;
    round_all(in, out, 61);
    for (int i = 0; i < 61; ++i) ASSERT_EQ(out[i], rounded(in[i])) << i;
}

}  // namespace
}  // namespace steradian::test
