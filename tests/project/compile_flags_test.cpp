// Every file of the libraries must be compiled for IEEE arithmetic as written, and for the baseline of the machine.
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "support/support.h"

namespace steradian::test {
namespace {

/// What is wrong with one compiler command; empty when nothing is.
std::string fault_of(const std::string& command) {
    const std::string words = " " + command + " ";
    for (const char* flag : {"-ffast-math", "-Ofast", "-funsafe-math-optimizations", "-ffinite-math-only",
                             "-fassociative-math", "-freciprocal-math", "-ffp-contract=fast", "-ffp-contract=on",
                             "-fsingle-precision-constant", "-frounding-math", "-mfma", "-march=", "-mfpmath=387"}) {
        // Flags that are complete must end there: -ffast-math, but not -fno-fast-math.
        const std::string start = std::string(" ") + flag;
        const bool prefix = start.back() == '=';
        if (words.find(prefix ? start : start + " ") != std::string::npos) return std::string("has ") + flag;
    }
    if (words.find(" -ffp-contract=off ") == std::string::npos) return "lacks -ffp-contract=off";
    return {};
}

/// Text after `"key": "` on a line of compile_commands.json, as CMake writes it: one member a line.
std::string member(const std::string& line, const std::string& key) {
    const std::string start = "\"" + key + "\": \"";
    const size_t begin = line.find(start);
    if (begin == std::string::npos) return {};
    const size_t end = line.rfind('"');
    return line.substr(begin + start.size(), end - begin - start.size());
}

TEST(compile_flags, of_every_library_source_keep_arithmetic_as_written) {
    std::ifstream file(STERADIAN_COMPILE_COMMANDS);
    ASSERT_TRUE(file) << STERADIAN_COMPILE_COMMANDS;
    const std::string sources = (source_folder() / "src").string() + "/";
    int checked = 0;
    std::string command;
    for (std::string line; std::getline(file, line);) {
        if (const std::string text = member(line, "command"); !text.empty()) command = text;
        const std::string source = member(line, "file");
        if (source.rfind(sources, 0) != 0) continue;
        ++checked;
        EXPECT_EQ(fault_of(command), "") << source;
    }
    EXPECT_GE(checked, 20) << "compile_commands.json was not understood";
}

TEST(compile_flags, faults_are_recognised) {
    EXPECT_EQ(fault_of("c++ -O2 -ffp-contract=off -fno-fast-math -c a.cpp"), "");
    EXPECT_EQ(fault_of("c++ -O2 -c a.cpp"), "lacks -ffp-contract=off");
    EXPECT_EQ(fault_of("c++ -ffp-contract=off -ffast-math -c a.cpp"), "has -ffast-math");
    EXPECT_EQ(fault_of("c++ -Ofast -ffp-contract=off -c a.cpp"), "has -Ofast");
    EXPECT_EQ(fault_of("c++ -march=native -ffp-contract=off -c a.cpp"), "has -march=");
}

}  // namespace
}  // namespace steradian::test
