#include <cstdlib>
#include <string>

#include "accel/kernels/kernels.h"
#include "base/names.h"
#include "base/text.h"

namespace steradian {

namespace {

struct Entry {
    Isa isa;
    const Kernels *full, *compact;
    bool supported;
};

/// Of this kind of machine, best first.
std::vector<Entry> entries() {
#if defined(__x86_64__)
    const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") &&
                      __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("popcnt");
    const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq");
    const bool sse4 = __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt");
    return {{Isa::avx512, &kAvx512Kernels, &kAvx512CompactKernels, avx512},
            {Isa::avx2, &kAvx2Kernels, &kAvx2CompactKernels, avx2},
            {Isa::sse4, &kSse4Kernels, &kSse4CompactKernels, sse4},
            {Isa::scalar, &kScalarKernels, &kScalarCompactKernels, true}};
#elif defined(__aarch64__)
    return {{Isa::neon, &kNeonKernels, &kNeonCompactKernels, true},
            {Isa::scalar, &kScalarKernels, &kScalarCompactKernels, true}};
#else
    return {{Isa::scalar, &kScalarKernels, &kScalarCompactKernels, true}};
#endif
}

Error unusable(const std::string& what) {
    std::string names;
    for (const Isa isa : supported_isas()) names += (names.empty() ? "" : ", ") + std::string(name_of(isa));
    return make_error(ErrorCode::usage, what, "this machine has " + names);
}

}  // namespace

std::vector<Isa> supported_isas() {
    std::vector<Isa> isas;
    for (const Entry& e : entries())
        if (e.supported) isas.push_back(e.isa);
    return isas;
}

Result<const Kernels*> select_kernels(Isa isa, BvhLayout layout) {
    if (isa == Isa::automatic) {
        const char* wanted = std::getenv("STERADIAN_ISA");
        const std::optional<Isa> named = find_name<Isa>(wanted && *wanted ? wanted : name_of(Isa::automatic));
        if (!named)
            return unusable("the environment variable STERADIAN_ISA is '" + escape_for_display(wanted) +
                            "', expected the name of an instruction set");
        isa = *named == Isa::automatic ? supported_isas().front() : *named;
    }
    for (const Entry& e : entries())
        if (e.isa == isa && e.supported) return layout == BvhLayout::compact ? e.compact : e.full;
    return unusable("this machine does not have the instruction set " + std::string(name_of(isa)));
}

}  // namespace steradian
