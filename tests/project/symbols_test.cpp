// The C library's elementary functions differ between machines and versions, so the libraries must not call them, nor
// anything else that gives other numbers elsewhere. What they do call is read from their symbol tables.
#include <gtest/gtest.h>
#include <stdio.h>

#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "support/support.h"

namespace steradian::test {
namespace {

/// Names without the suffixes f (float) and l (long double). Square roots, rounding, remainders, scaling by powers of
/// two and classification are exact or correctly rounded by IEEE 754 and are therefore not in the list.
const std::set<std::string> kForbidden = {
    "sin",   "cos",   "tan",   "asin",  "acos",  "atan",  "atan2",  "sincos",  "sinh",   "cosh",
    "tanh",  "asinh", "acosh", "atanh", "exp",   "exp2",  "exp10",  "expm1",   "log",    "log2",
    "log10", "log1p", "pow",   "cbrt",  "hypot", "fma",   "lgamma", "tgamma",  "erf",    "erfc",
    "j0",    "j1",    "y0",    "y1",    "rand",  "srand", "random", "drand48", "rand_r",
};

bool is_forbidden(std::string symbol) {
    symbol = symbol.substr(0, symbol.find('@'));  // symbol versions
    // -ffinite-math variants and vectorised variants of the C library: __exp_finite, _ZGVbN2v_sin.
    if (symbol.rfind("_ZGV", 0) == 0 && symbol.find('_', 4) != std::string::npos)
        symbol = symbol.substr(symbol.find('_', 4) + 1);
    if (symbol.rfind("__", 0) == 0 && symbol.size() > 9 && symbol.substr(symbol.size() - 7) == "_finite")
        symbol = symbol.substr(2, symbol.size() - 9);
    if (kForbidden.count(symbol)) return true;
    const char last = symbol.empty() ? '\0' : symbol.back();
    return (last == 'f' || last == 'l') && kForbidden.count(symbol.substr(0, symbol.size() - 1));
}

/// Undefined symbols that are forbidden, as "archive member: symbol". `listing` is what `nm --undefined-only` prints.
std::vector<std::string> forbidden_symbols(const std::string& listing) {
    std::vector<std::string> found;
    std::string member, line;
    std::istringstream lines(listing);
    while (std::getline(lines, line)) {
        if (!line.empty() && line.back() == ':') member = line;
        const size_t name = line.find_last_of(' ');
        if (name == std::string::npos || line.find(" U ") == std::string::npos) continue;
        if (is_forbidden(line.substr(name + 1))) found.push_back(member + " " + line.substr(name + 1));
    }
    return found;
}

std::string nm_undefined(const std::string& archive) {
    const std::string command = std::string("'") + STERADIAN_NM + "' --undefined-only '" + archive + "' 2>/dev/null";
    const std::unique_ptr<FILE, int (*)(FILE*)> pipe(::popen(command.c_str(), "r"), &::pclose);
    std::string text;
    if (!pipe) return text;
    char buffer[4096];
    for (size_t count; (count = std::fread(buffer, 1, sizeof buffer, pipe.get())) > 0;) text.append(buffer, count);
    return text;
}

TEST(symbols, libraries_do_not_call_the_c_librarys_functions) {
    std::istringstream archives(STERADIAN_LIBRARIES);
    int count = 0;
    for (std::string archive; std::getline(archives, archive, '|'); ++count) {
        const std::string listing = nm_undefined(archive);
        EXPECT_NE(listing.find(" U "), std::string::npos) << "nm says nothing about " << archive;
        for (const std::string& symbol : forbidden_symbols(listing)) ADD_FAILURE() << archive << ": " << symbol;
    }
    EXPECT_GE(count, 8);
}

TEST(symbols, forbidden_ones_are_recognised) {
    for (const char* name : {"sin", "sinf", "cosl", "sincosf", "pow@GLIBC_2.29", "exp2", "exp2f", "log10l", "atan2f",
                             "hypot", "fma", "fmaf", "rand", "__exp_finite", "_ZGVbN2v_sin", "_ZGVdN8v_cosf"})
        EXPECT_TRUE(is_forbidden(name)) << name;
    for (const char* name : {"sqrt", "sqrtf", "floor", "memcpy", "_ZN9steradian4math3sinEd", "fmod", "ldexp", "stof",
                             "f", "l", "", "operator", "__cxa_throw", "nearbyintf"})
        EXPECT_FALSE(is_forbidden(name)) << name;
}

TEST(symbols, listings_are_read) {
    const std::string listing =
        "\nfirst.o:\n                 U memcpy\n                 U powf\n\nsecond.o:\n                 U sqrt\n        "
        "         U sin\n";
    EXPECT_EQ(forbidden_symbols(listing), (std::vector<std::string>{"first.o: powf", "second.o: sin"}));
}

}  // namespace
}  // namespace steradian::test
