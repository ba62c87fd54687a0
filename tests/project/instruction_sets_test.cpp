// Only the kernels of an instruction set may use it. An inline function of a common header that is compiled for AVX in
// one file may be the one that the linker keeps for all, and then the program ends on machines without AVX.
#include <gtest/gtest.h>
#include <stdio.h>

#include <memory>
#include <set>
#include <sstream>
#include <string>

namespace steradian::test {
namespace {

/// Functions with instructions in VEX or EVEX encoding, by their demangled names.
std::set<std::string> functions_with_avx(std::istream& disassembly) {
    std::set<std::string> found;
    std::string function, line;
    while (std::getline(disassembly, line)) {
        // "0000000000000300 <name>:" and "     30a:\tvaddps %ymm0,%ymm1,%ymm2".
        if (!line.empty() && line.back() == ':' && line.find(" <") != std::string::npos)
            function = line.substr(line.find(" <") + 2);
        const size_t tab = line.find('\t');
        if (tab == std::string::npos || line.compare(tab + 1, 1, "v") != 0) continue;
        const std::string mnemonic = line.substr(tab + 1, line.find(' ', tab) - tab - 1);
        if (mnemonic != "verr" && mnemonic != "verw") found.insert(function);
    }
    return found;
}

TEST(instruction_sets, functions_are_recognised) {
    std::istringstream text(
        "0000000000000000 <steradian::avx2::f(int)>:\n   0:\tvaddps %ymm0,%ymm1,%ymm2\n   4:\tret\n\n"
        "0000000000000010 <steradian::g()>:\n  10:\taddps  %xmm0,%xmm1\n  14:\tret\n");
    EXPECT_EQ(functions_with_avx(text), (std::set<std::string>{"steradian::avx2::f(int)>:"}));
}

TEST(instruction_sets, stay_in_their_kernels) {
#if !defined(__x86_64__) || defined(__AVX__)
    GTEST_SKIP() << "nothing to keep apart on this machine";
#endif
    const std::string command = std::string("'") + STERADIAN_OBJDUMP + "' -d -C --no-show-raw-insn '" +
                                STERADIAN_ACCEL_LIBRARY + "' 2>/dev/null";
    const std::unique_ptr<FILE, int (*)(FILE*)> pipe(::popen(command.c_str(), "r"), &::pclose);
    ASSERT_TRUE(pipe);
    std::string text;
    char buffer[65536];
    for (size_t count; (count = std::fread(buffer, 1, sizeof buffer, pipe.get())) > 0;) text.append(buffer, count);
    std::istringstream lines(text);
    size_t kernels = 0;
    for (const std::string& function : functions_with_avx(lines)) {
        const bool own = function.find("steradian::avx2::") != std::string::npos ||
                         function.find("steradian::avx512::") != std::string::npos;
        EXPECT_TRUE(own) << function;
        kernels += own;
    }
    EXPECT_GE(kernels, 6u) << "the kernels were not found";
}

}  // namespace
}  // namespace steradian::test
