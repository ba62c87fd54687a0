#include "base/text.h"

#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include "support/support.h"

namespace steradian {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

TEST(EscapeForDisplay, PassesTextAndEscapesTheRest) {
    EXPECT_EQ(escape_for_display("plain ä € 😀"), "plain ä € 😀");
    EXPECT_EQ(escape_for_display(std::string("\0\a\n\x1b\x7f", 5)), "\\x00\\x07\\x0a\\x1b\\x7f");
    EXPECT_EQ(escape_for_display("\xff\xc3("), "\\xff\\xc3(");
    EXPECT_EQ(escape_for_display("\xc0\x80"), "\\xc0\\x80") << "overlong";
    EXPECT_EQ(escape_for_display("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "surrogate";
    EXPECT_EQ(escape_for_display("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond Unicode";
    EXPECT_EQ(escape_for_display("\xc2\x9b"), "\\xc2\\x9b") << "C1 control sequence introducer";
    EXPECT_EQ(escape_for_display("\xe2\x82"), "\\xe2\\x82") << "cut short";
}

TEST(EscapeForDisplay, Cuts) {
    EXPECT_EQ(escape_for_display("abcdef", 3), "abc…");
    EXPECT_EQ(escape_for_display("abc", 3), "abc");
    EXPECT_LE(escape_for_display(std::string(100000, '\x01')).size(), 220u);
}

// No byte below 0x20, no DEL, no invalid UTF-8 and no C1 control ever comes out, whatever goes in.
TEST(EscapeForDisplay, NeverLetsABadByteThrough) {
    std::mt19937 random(1);
    for (int round = 0; round < test::by_tier(20000, 2000000); ++round) {
        std::string in;
        for (unsigned n = random() % 8; n-- > 0;) in += static_cast<char>(random());
        const std::string out = escape_for_display(in);
        EXPECT_EQ(escape_for_display(out, 1000), out);
    }
}

TEST(ClosestMatch, FindsTyposOnly) {
    const std::string_view names[] = {"radius", "radiance", "center", "x"};
    EXPECT_EQ(closest_match("raduis", names), "radius");
    EXPECT_EQ(closest_match("RADIUS", names), "radius");
    EXPECT_EQ(closest_match("centre", names), "center");
    EXPECT_EQ(closest_match("flux", names), std::nullopt);
    EXPECT_EQ(closest_match("q", names), std::nullopt) << "every letter wrong";
    EXPECT_EQ(closest_match("X", names), "x");
    EXPECT_EQ(closest_match("", names), std::nullopt);
    EXPECT_EQ(closest_match(std::string(100000, 'r'), names), std::nullopt);
    EXPECT_EQ(suggestion("raduis", names), "did you mean 'radius'?");
    EXPECT_EQ(suggestion("flux", names), "expected one of radius, radiance, center, x");
    EXPECT_EQ(suggestion("flux", {}), "");
}

void expect_position(std::string_view text, size_t offset, uint32_t line, uint32_t column, std::string_view excerpt) {
    const TextPosition at = locate(text, offset);
    EXPECT_EQ(at.line, line) << offset;
    EXPECT_EQ(at.column, column) << offset;
    EXPECT_EQ(at.excerpt, excerpt) << offset;
}

TEST(Locate, KnowsAllLineEnds) {
    for (const std::string_view text : {"ab\ncd\nef", "ab\rcd\ref"}) {
        expect_position(text, 0, 1, 1, "ab");
        expect_position(text, 2, 1, 3, "ab");
        expect_position(text, 3, 2, 1, "cd");
        expect_position(text, 7, 3, 2, "ef");
        expect_position(text, 8, 3, 3, "ef");
        expect_position(text, 999, 3, 3, "ef");
    }
    expect_position("ab\r\ncd", 2, 1, 3, "ab");
    expect_position("ab\r\ncd", 3, 1, 4, "ab");
    expect_position("ab\r\ncd", 4, 2, 1, "cd");
    expect_position("", 0, 1, 1, "");
    expect_position("a\n", 2, 2, 1, "");
    expect_position("a\r", 2, 2, 1, "");
}

TEST(Locate, CutsLongLinesAroundThePlace) {
    std::string text(100000, '.');
    text[50000] = '#';
    const TextPosition at = locate(text, 50000);
    EXPECT_EQ(at.column, 50001u);
    EXPECT_EQ(at.excerpt.size(), kExcerptWidth);
    EXPECT_EQ(at.excerpt[kExcerptMargin], '#');
}

TEST(ParseDouble, TakesWholeNumbersOnly) {
    EXPECT_EQ(parse_double("1.5"), 1.5);
    EXPECT_EQ(parse_double("+1e3"), 1000);
    EXPECT_EQ(parse_double(".5"), 0.5);
    EXPECT_EQ(parse_double("5."), 5.0);
    EXPECT_TRUE(std::signbit(parse_double("-0").value()));
    EXPECT_TRUE(std::isnan(parse_double("nan").value()));
    EXPECT_EQ(parse_double("-inf"), -kInf);
    for (const char* bad :
         {"", "+", "-", "++1", "+-1", "-+1", "1.2.3", "1e", "1 ", " 1", "1,5", "0x10", "1f", "e5", "."})
        EXPECT_EQ(parse_double(bad), std::nullopt) << bad;
}

TEST(ParseDouble, OutOfRangeGoesToTheRightSide) {
    const std::string zeros(400, '0');
    EXPECT_EQ(parse_double("1e999"), kInf);
    EXPECT_EQ(parse_double("-1e999"), -kInf);
    EXPECT_EQ(parse_double("1e-999"), 0.0);
    EXPECT_TRUE(std::signbit(parse_double("-1e-999").value()));
    EXPECT_EQ(parse_double("1" + zeros), kInf);
    EXPECT_EQ(parse_double("0." + zeros + "1"), 0.0);
    EXPECT_EQ(parse_double("0." + zeros + "1e10"), 0.0) << "a positive exponent does not make it large";
    EXPECT_EQ(parse_double("1" + zeros + "e-10"), kInf) << "a negative exponent does not make it small";
    EXPECT_EQ(parse_double("1e99999999999999999999999"), kInf);
    EXPECT_EQ(parse_double("1e-99999999999999999999999"), 0.0);
    EXPECT_EQ(parse_double("0e999"), 0.0);
    EXPECT_EQ(parse_double("0" + zeros + "e" + zeros + "1"), 0.0);
    EXPECT_EQ(parse_double("5e-324"), 5e-324);
    EXPECT_EQ(parse_double("1.7976931348623157e308"), std::numeric_limits<double>::max());
    EXPECT_EQ(parse_double(std::string(1000000, '9')), kInf);
}

// strtod in the C locale is the oracle, on numbers of every size.
TEST(ParseDouble, AgreesWithStrtod) {
    std::mt19937 random(2);
    for (int round = 0; round < test::by_tier(100000, 5000000); ++round) {
        std::string text = random() % 2 ? "-" : "";
        for (unsigned n = 1 + random() % 20; n-- > 0;) text += static_cast<char>('0' + random() % 10);
        text += '.';
        for (unsigned n = random() % 20; n-- > 0;) text += static_cast<char>('0' + random() % 10);
        text.append("e").append(std::to_string(static_cast<int>(random() % 800) - 400));
        const double expected = std::strtod(text.c_str(), nullptr);
        const auto value = parse_double(text);
        ASSERT_TRUE(value) << text;
        ASSERT_EQ(*value, expected) << text;
        ASSERT_EQ(std::signbit(*value), std::signbit(expected)) << text;
    }
}

TEST(ExtensionOf, OfTheLastComponent) {
    EXPECT_EQ(extension_of("a/b.EXR"), ".exr");
    EXPECT_EQ(extension_of("a.b/c"), "");
    EXPECT_EQ(extension_of(".hidden"), "");
    EXPECT_EQ(extension_of("a.tar.gz"), ".gz");
    EXPECT_EQ(extension_of("a."), ".");
    EXPECT_EQ(extension_of(""), "");
    EXPECT_TRUE(iequals("AbC", "aBc"));
    EXPECT_FALSE(iequals("ab", "abc"));
}

}  // namespace
}  // namespace steradian
