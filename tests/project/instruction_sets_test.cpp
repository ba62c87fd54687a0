// Only the kernels of an instruction set may use it. An inline function of a common header that is compiled for AVX in
// one file may be the one that the linker keeps for all, and then the program ends on machines without AVX.
#include <gtest/gtest.h>
#include <stdio.h>

#include <algorithm>
#include <map>
#include <memory>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace steradian::test {
namespace {

/// What a processor has to have, each with all before it. `baseline` is what every x86-64 has.
enum Needs { baseline, sse4, avx2, avx512 };

/// SSE3 to SSE4.2, and popcnt, which comes with the latter.
const std::set<std::string> kSse4 = {
    "addsubpd", "addsubps",  "haddpd",    "haddps",   "hsubpd",   "hsubps",    "lddqu",    "movddup",    "movshdup",
    "movsldup", "pabsb",     "pabsd",     "pabsw",    "palignr",  "phaddd",    "phaddsw",  "phaddw",     "phsubd",
    "phsubsw",  "phsubw",    "pmaddubsw", "pmulhrsw", "pshufb",   "psignb",    "psignd",   "psignw",     "blendpd",
    "blendps",  "blendvpd",  "blendvps",  "dppd",     "dpps",     "extractps", "insertps", "movntdqa",   "mpsadbw",
    "packusdw", "pblendvb",  "pblendw",   "pcmpeqq",  "pextrb",   "pextrd",    "pextrq",   "phminposuw", "pinsrb",
    "pinsrd",   "pinsrq",    "pmaxsb",    "pmaxsd",   "pmaxud",   "pmaxuw",    "pminsb",   "pminsd",     "pminud",
    "pminuw",   "pmovsxbd",  "pmovsxbq",  "pmovsxbw", "pmovsxdq", "pmovsxwd",  "pmovsxwq", "pmovzxbd",   "pmovzxbq",
    "pmovzxbw", "pmovzxdq",  "pmovzxwd",  "pmovzxwq", "pmuldq",   "pmulld",    "ptest",    "roundpd",    "roundps",
    "roundsd",  "roundss",   "crc32",     "crc32b",   "crc32l",   "crc32q",    "crc32w",   "pcmpestri",  "pcmpestrm",
    "pcmpgtq",  "pcmpistri", "pcmpistrm", "popcnt",   "popcntl",  "popcntq",   "popcntw"};
/// BMI, BMI2 and lzcnt. Not tzcnt: compilers write it as a bsf for every machine, as which older ones execute it.
const std::set<std::string> kBmi = {"andn", "bextr", "blsi", "blsmsk", "blsr", "bzhi", "lzcnt",
                                    "mulx", "pdep",  "pext", "rorx",   "sarx", "shlx", "shrx"};

Needs needs_of(const std::string& mnemonic, const std::string& operands) {
    if (mnemonic.front() == 'v' && mnemonic != "verr" && mnemonic != "verw") {
        // In EVEX encoding only: the widest registers, those from 16 on, and masks.
        static const std::regex evex("%zmm|%k[0-7]|%[xy]mm(1[6-9]|2[0-9]|3[01])");
        if (std::regex_search(operands, evex)) return avx512;
        return avx2;
    }
    // Operations on masks.
    if (mnemonic.front() == 'k' && operands.find("%k") != std::string::npos) return avx512;
    const bool sized = !mnemonic.empty() && std::string("lqw").find(mnemonic.back()) != std::string::npos;
    if (kBmi.count(mnemonic) || (sized && kBmi.count(mnemonic.substr(0, mnemonic.size() - 1)))) return avx2;
    return kSse4.count(mnemonic) ? sse4 : baseline;
}

/// The most that each function needs, by its demangled name; of those that need something.
std::map<std::string, Needs> needs_of_functions(std::istream& disassembly) {
    std::map<std::string, Needs> found;
    std::string function, line;
    while (std::getline(disassembly, line)) {
        // "0000000000000300 <name>:" and "     30a:\tvaddps %ymm0,%ymm1,%ymm2".
        if (!line.empty() && line.back() == ':' && line.find(" <") != std::string::npos)
            function = line.substr(line.find(" <") + 2);
        const size_t tab = line.find('\t');
        if (tab == std::string::npos) continue;
        std::istringstream words(line.substr(tab + 1));
        std::string mnemonic, operands;
        words >> mnemonic;
        std::getline(words, operands);
        if (mnemonic.empty()) continue;
        const Needs needs = needs_of(mnemonic, operands);
        if (needs != baseline) found[function] = std::max(found[function], needs);
    }
    return found;
}

Needs allowed(const std::string& function) {
    if (function.find("steradian::avx512::") != std::string::npos) return avx512;
    if (function.find("steradian::avx2::") != std::string::npos) return avx2;
    return function.find("steradian::sse4::") != std::string::npos ? sse4 : baseline;
}

TEST(instruction_sets, functions_are_recognised) {
    std::istringstream text(
        "0000000000000000 <steradian::avx2::f(int)>:\n   0:\tvaddps %ymm0,%ymm1,%ymm2\n   4:\tret\n\n"
        "0000000000000010 <steradian::g()>:\n  10:\taddps  %xmm0,%xmm1\n  14:\ttzcnt  %eax,%eax\n  18:\tret\n"
        "0000000000000020 <h()>:\n  20:\tblsr   %eax,%eax\n"
        "0000000000000030 <i()>:\n  30:\tpminsd %xmm0,%xmm1\n"
        "0000000000000040 <j()>:\n  40:\tshlx   %eax,%eax,%eax\n  44:\tvaddps %xmm17,%xmm1,%xmm2\n"
        "0000000000000050 <k()>:\n  50:\tkmovw  %k1,%eax\n"
        "0000000000000060 <l()>:\n  60:\tvaddps %xmm2,%xmm13,%xmm3\n  64:\tpopcnt %eax,%eax\n"
        "0000000000000070 <m()>:\n  70:\tandn   %eax,%eax,%eax\n  74:\tandnps %xmm0,%xmm1\n"
        "0000000000000080 <n()>:\n  80:\tpextrw $0x0,%xmm0,%eax\n  84:\tandnps %xmm0,%xmm1\n");
    EXPECT_EQ(needs_of_functions(text), (std::map<std::string, Needs>{{"steradian::avx2::f(int)>:", avx2},
                                                                      {"h()>:", avx2},
                                                                      {"i()>:", sse4},
                                                                      {"j()>:", avx512},
                                                                      {"k()>:", avx512},
                                                                      {"l()>:", avx2},
                                                                      {"m()>:", avx2}}));
}

TEST(instruction_sets, stay_in_their_kernels) {
#if !defined(__x86_64__) || defined(__SSE3__)
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
    std::map<Needs, size_t> kernels;
    for (const auto& [function, needs] : needs_of_functions(lines)) {
        EXPECT_LE(needs, allowed(function)) << function;
        ++kernels[needs];
    }
    // They were found, and every one of them is used.
    for (const Needs needs : {sse4, avx2, avx512}) EXPECT_GE(kernels[needs], 3u) << needs;
}

}  // namespace
}  // namespace steradian::test
