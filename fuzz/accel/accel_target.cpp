#include <cstdio>
#include <cstdlib>

#include "accel/hostile.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace steradian::test;
    HostileCounts counts;
    const std::string failure = check_hostile_case(hostile_case({data, size}), counts);
    if (failure.empty()) return 0;
    std::fprintf(stderr, "%s\n", failure.c_str());
    std::abort();
}
