// Photometric files: what they mean, and where they are refused.
#include "formats/ies/ies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "math/elementary.h"
#include "scene/intensity_profile.h"

namespace steradian {
namespace {

IntensityProfile good(const std::string& text) {
    auto profile = parse_ies(text, "lamp.ies");
    if (!profile) {
        ADD_FAILURE() << profile.error().str();
        return {{0, 180}, {0}, {0, 0}};
    }
    return *std::move(profile);
}

/// The text of a file with these angles; the value at vertical angle v and plane h is value(v, h).
template <class Value>
std::string file(const std::vector<double>& verticals, const std::vector<double>& horizontals, Value value,
                 const std::string& head = "IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 ") {
    std::string out =
        head + std::to_string(verticals.size()) + " " + std::to_string(horizontals.size()) + " 1 2 0 0 0\n1 1 100\n";
    for (const double v : verticals) out += std::to_string(v) + " ";
    out += "\n";
    for (const double h : horizontals) out += std::to_string(h) + " ";
    out += "\n";
    for (const double h : horizontals) {
        for (const double v : verticals) out += std::to_string(value(v, h)) + " ";
        out += "\n";
    }
    return out;
}

TEST(Ies, IsotropicFilesHaveTheFluxOfAPoint) {
    for (const std::vector<double>& planes : {std::vector<double>{0}, {0, 90}, {0, 90, 180}, {0, 120, 240, 360}}) {
        const IntensityProfile p = good(file({0, 30, 90, 170, 180}, planes, [](double, double) { return 250.0; }));
        EXPECT_NEAR(total_flux(p), 4 * std::numbers::pi * 250, 1e-9 * 250);
        EXPECT_EQ(peak_intensity(p), 250);
    }
}

/// ∫ of the bilinear table by the midpoint rule, over angles written down a second time.
TEST(Ies, FluxIsTheIntegralOfTheIntensity) {
    const auto value = [](double v, double h) { return 100 + 0.5 * v + h * (200 - v) / 100; };
    for (const std::vector<double>& planes : {std::vector<double>{0}, {0, 20, 90}, {0, 70, 180}, {90, 100, 180, 270}}) {
        const IntensityProfile p = good(file({10, 40, 90, 150}, planes, value));
        constexpr int kVertical = 1700, kHorizontal = 720;
        double sum = 0;
        for (int i = 0; i < kVertical; ++i)
            for (int j = 0; j < kHorizontal; ++j) {
                const double v = 180 * (i + 0.5) / kVertical, h = 360 * (j + 0.5) / kHorizontal;
                sum += intensity_at(p, v, h) * std::sin(v * std::numbers::pi / 180);
            }
        sum *= 2 * std::numbers::pi * std::numbers::pi / (double(kVertical) * kHorizontal);
        EXPECT_NEAR(total_flux(p), sum, 2e-3 * sum) << planes.size();
    }
}

TEST(Ies, IsBilinearInTheAngles) {
    const IntensityProfile p =
        good(file({0, 60, 90}, {0, 90, 180, 270, 360}, [](double v, double h) { return v + 2 * h; }));
    EXPECT_NEAR(intensity_at(p, 60, 90), 60 + 180, 1e-4);
    EXPECT_NEAR(intensity_at(p, 15, 45), 15 + 90, 1e-4);
    EXPECT_NEAR(intensity_at(p, 75, 300), 75 + 600, 1e-4);
    EXPECT_NEAR(intensity_at(p, 90, 360), 90 + 720, 1e-4);
    EXPECT_EQ(intensity_at(p, 90.01, 10), 0);
    const IntensityProfile above = good(file({90, 120, 180}, {0}, [](double v, double) { return v; }));
    EXPECT_EQ(intensity_at(above, 89.99, 0), 0);
    EXPECT_NEAR(intensity_at(above, 150, 77), 150, 1e-4);
}

TEST(Ies, SymmetriesAreWrittenOut) {
    const auto value = [](double v, double h) { return 1000 - v + 3 * h; };
    const std::vector<double> verticals{0, 45, 90};
    // Of each kind, the plane that has the values of a horizontal angle.
    const auto all_alike = [](double) { return 0.0; };
    const auto half = [](double h) { return h <= 180 ? h : 360 - h; };
    const auto quarter = [&](double h) { return half(h) <= 90 ? half(h) : 180 - half(h); };
    const auto around = [](double h) { return h; };
    const auto about_quarter = [](double h) { return h < 90 ? 180 - h : h > 270 ? 540 - h : h; };
    struct Kind {
        std::vector<double> planes;
        std::function<double(double)> plane_of;
    };
    for (const Kind& kind : {Kind{{0}, all_alike},
                             {{0, 30, 90}, quarter},
                             {{0, 45, 180}, half},
                             {{0, 100, 250, 360}, around},
                             {{90, 150, 180, 270}, about_quarter}}) {
        const IntensityProfile p = good(file(verticals, kind.planes, value));
        for (double h = 0; h <= 360; h += 5)
            EXPECT_NEAR(intensity_at(p, 30, h), value(30, kind.plane_of(h)), 2e-3) << kind.planes.size() << " " << h;
    }
    // A file that ends before 360 degrees goes on to where it began.
    const IntensityProfile open = good(file(verticals, {0, 90, 180, 270}, value));
    EXPECT_NEAR(intensity_at(open, 0, 315), (value(0, 270) + value(0, 0)) / 2, 1e-3);
}

TEST(Ies, TheFactorOf2019IsACode) {
    const std::string numbers = "TILT= NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1.1 100\n0 180\n0\n100 200\n";
    EXPECT_FLOAT_EQ(good("IES:LM-63-2019\n" + numbers).candela[0], 100);
    EXPECT_FLOAT_EQ(good("IESNA:LM-63-2002\n" + numbers).candela[0], 110);
}

TEST(Ies, FactorsMultiply) {
    const std::string numbers = "1 1000 2.5 2 1 1 2 0 0 0\n0.8 0.5 100\n0 180\n0\n100 200\n";
    EXPECT_FLOAT_EQ(good("TILT=NONE\n" + numbers).candela[0], 100);
    EXPECT_FLOAT_EQ(good("IESNA91\n[X] TILT\nTILT=NONE  \r\n" + numbers).candela[1], 200);
    EXPECT_FLOAT_EQ(good("TILT=INCLUDE\n1\n3\n0 45 90\n0.9 0.5 0.1\n" + numbers).candela[0], 90);
    EXPECT_FLOAT_EQ(good("TILT=INCLUDE\n2 2 -30 60 0.6 0.9 " + numbers).candela[0], 70);
    EXPECT_FLOAT_EQ(good("TILT=INCLUDE\n3 2 10 60 0.6 0.9 " + numbers).candela[0], 60);
    EXPECT_FLOAT_EQ(good("TILT=INCLUDE\n3 2 -60 -10 0.6 0.9 " + numbers).candela[0], 90);
    EXPECT_FLOAT_EQ(good("TILT=NONE\n1,1000,2.5 2 1 1 2 0 0 0 0.8,0.5,100,0,180,0,100,200\n\x1a").candela[0], 100);
}

/// What is wrong, and the line and column of it, which § marks.
void refused(std::string text, const char* message) {
    const std::string mark = "§";
    const size_t at = text.find(mark);
    text.erase(at, mark.size());
    const auto result = parse_ies(text, "lamp.ies");
    ASSERT_FALSE(result) << message;
    const Error& error = result.error();
    EXPECT_NE(error.message.find(message), error.message.npos) << error.str();
    const auto line = static_cast<uint32_t>(1 + std::count(text.begin(), text.begin() + std::ptrdiff_t(at), '\n'));
    const size_t begin = text.rfind('\n', at == 0 ? 0 : at - 1);
    EXPECT_EQ(error.where.file, "lamp.ies");
    EXPECT_EQ(error.where.line, line) << error.str();
    EXPECT_EQ(error.where.column, at - (begin == text.npos || at == 0 ? 0 : begin + 1) + 1) << error.str();
}

TEST(Ies, WhatIsWrongIsSaidWithItsPlace) {
    const std::string head = "IESNA91\nTILT=NONE\n";
    refused("§", "no line with TILT=");
    refused("IESNA91\n[TEST] x\n§", "no line with TILT=");
    refused("IESNA91\n§TILT=lamp.tlt\n1", "TILT='lamp.tlt' is not supported");
    refused(head + "1 1000 §x", "expected the candela multiplier (a number), got 'x'");
    refused(head + "1 1000 §-1", "must not be negative");
    refused(head + "1 1000 1 §1 1", "number of vertical angles, a whole number from 2 to 10000");
    refused(head + "1 1000 1 §2.5 1", "a whole number");
    refused(head + "1 1000 1 §4000000000 1", "a whole number from 2 to 10000");
    refused(head + "1 1000 1 10000 §10000 1", "too many candela values");
    refused(head + "1 1000 1 2 1 §2 2", "photometric type B (2) is not supported");
    refused(head + "1 1000 1 2 1 §3 2", "photometric type A (3) is not supported");
    refused(head + "1 1000 1 2 1 1 2 0 0 0\n1 1 §nan", "the input watts");
    refused(head + "1 1000 1 2 1 1 2 0 0 0\n1 1 9 10 §5", "angles must increase: a vertical angle");
    refused(head + "1 1000 1 2 1 1 2 0 0 0\n1 1 9 10 §181", "from 0 to 180 degrees");
    refused(head + "1 1000 1 2 2 1 2 0 0 0\n1 1 9 0 90 0 §45\n1 2 3 4", "horizontal angles must go from 0");
    refused(head + "1 1000 1 2 2 1 2 0 0 0\n1 1 9 0 90 90 §270\n1 2 3 4", "must contain 180");
    refused(head + "1 1000 1 2 1 1 2 0 0 0\n1 1 9 0 90 0 1 §-1", "a candela value must not be negative");
    refused(head + "1 1000 1e12 2 1 1 2 0 0 0\n1e12 1e12 9 0 90 0 1 §1e12", "too large with its factors");
    refused(head + "1 1000 1 2 1 1 2 0 0 0\n1 1 9 0 90 0 1§", "the file ends before a candela value");
    refused(head + "1 1000 1 2 1 1 2 0 0 0\n1 1 9 0 90 0 1 2\n§3", "expected the end of the file");
    refused("TILT=INCLUDE\n§4", "the orientation of the lamp");
    refused("TILT=INCLUDE\n1 2 5 §5 1 1", "tilt angles must increase");
}

}  // namespace
}  // namespace steradian
