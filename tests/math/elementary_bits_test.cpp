// The bits of the elementary functions over fixed arguments. They must be the same with every compiler, at every level
// of optimisation and on every machine; a change here changes pictures.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <functional>

#include "base/hash.h"
#include "math/elementary.h"

namespace steradian {
namespace {

std::string hash_of(double a, double b, const std::function<double(double)>& f) {
    constexpr int kCount = 20'000;
    Hasher hasher;
    for (int i = 0; i <= kCount; ++i) hasher.value(f(a + (b - a) * i / kCount));
    return hasher.hex();
}

struct Case {
    const char* name;
    double a, b;
    double (*f)(double);
    const char* hash;
};

constexpr Case kCases[] = {
    {"sin", -20, 20, [](double x) { return math::sin(x); }, "f9b351d3263bcf482de2e0b0b41d501f"},
    {"sin, large", 1e6, 1e15, [](double x) { return math::sin(x); }, "ba2dc46ad349cfdda4199e0a39aa8cd5"},
    {"cos", -20, 20, [](double x) { return math::cos(x); }, "4f410f269a3b855fb2ef66e4b1f1f1c0"},
    {"tan", -1.57, 1.57, [](double x) { return math::tan(x); }, "07824e484871175432ea4c206caae443"},
    {"exp", -746, 710, [](double x) { return math::exp(x); }, "5edaff30188d87142c7651496e5c09be"},
    {"log", 1e-3, 10, [](double x) { return math::log(x); }, "792f689bf988979a58407a2835d858fd"},
    {"log2", 1e-3, 10, [](double x) { return math::log2(x); }, "a98ddc33a30f720beda76d79dcda7043"},
    {"pow 2.4", 0, 2, [](double x) { return math::pow(x, 2.4); }, "bcdb3c23b6cf30ad5d45e0ca4d225f29"},
    {"pow 1/2.4", 0, 2, [](double x) { return math::pow(x, 1 / 2.4); }, "3ee16f24b44362a4844fdecf882be9b9"},
    {"pow of 1.7", -1000, 1000, [](double x) { return math::pow(1.7, x); }, "f7984b220615d39003bcd0419a890a36"},
    {"atan2 around", -3.2, 3.2, [](double x) { return math::atan2(x, 1 - x * x); }, "1e7293ab70bcbcc613f7f2f5da5e088e"},
    {"acos", -1, 1, [](double x) { return math::acos(x); }, "68ea8b5ff7d18ef8b0e69185107c1194"},
    {"asin", -1, 1, [](double x) { return math::asin(x); }, "17b17da0b9eacd7ba5ef3863cdafc0f2"},
};

TEST(ElementaryBits, AreWhatTheyWere) {
    for (const Case& c : kCases) EXPECT_EQ(hash_of(c.a, c.b, c.f), c.hash) << c.name;
}

TEST(ElementaryBits, SineAndCosineTogetherAreThoseApart) {
    for (const double scale : {1e-300, 1e-8, 1e-4, 0.1, 1.0, 1e3, 1e6, 1e12})
        for (int i = -2000; i <= 2000; ++i) {
            const double x = scale * i / 97;
            const math::SinCos both = math::sin_cos(x);
            ASSERT_EQ(std::bit_cast<uint64_t>(both.sin), std::bit_cast<uint64_t>(math::sin(x))) << x;
            ASSERT_EQ(std::bit_cast<uint64_t>(both.cos), std::bit_cast<uint64_t>(math::cos(x))) << x;
        }
    EXPECT_TRUE(std::isnan(math::sin_cos(0x1p53).sin) && std::isnan(math::sin_cos(0x1p53).cos));
}

}  // namespace
}  // namespace steradian
