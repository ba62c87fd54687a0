#include <cstdlib>
#include <string>

#include "accel/kernels/kernels.h"

namespace steradian {

namespace {

struct Entry {
    Isa isa;
    const char* name;
    const Kernels* kernels;  ///< nullptr on machines of another kind
    bool supported;
};

/// Best first.
std::vector<Entry> entries() {
#if defined(__x86_64__)
    const bool bits = __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
    const bool avx2 = __builtin_cpu_supports("avx2") && bits;
    const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq");
    const bool sse4 = __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt");
    return {{Isa::avx512, "avx512", &kAvx512Kernels, avx512},
            {Isa::avx2, "avx2", &kAvx2Kernels, avx2},
            {Isa::sse4, "sse4", &kSse4Kernels, sse4},
            {Isa::neon, "neon", nullptr, false},
            {Isa::scalar, "scalar", &kScalarKernels, true}};
#elif defined(__aarch64__)
    return {{Isa::neon, "neon", &kNeonKernels, true},
            {Isa::avx512, "avx512", nullptr, false},
            {Isa::avx2, "avx2", nullptr, false},
            {Isa::sse4, "sse4", nullptr, false},
            {Isa::scalar, "scalar", &kScalarKernels, true}};
#else
    return {{Isa::avx512, "avx512", nullptr, false},
            {Isa::avx2, "avx2", nullptr, false},
            {Isa::sse4, "sse4", nullptr, false},
            {Isa::neon, "neon", nullptr, false},
            {Isa::scalar, "scalar", &kScalarKernels, true}};
#endif
}

std::string names_of_supported() {
    std::string names;
    for (const Entry& e : entries())
        if (e.supported) names += (names.empty() ? "" : ", ") + std::string(e.name);
    return names;
}

Error unusable(const std::string& what) {
    return {ErrorCode::usage, what, {}, {}, "this machine has " + names_of_supported()};
}

}  // namespace

std::vector<Isa> supported_isas() {
    std::vector<Isa> isas;
    for (const Entry& e : entries())
        if (e.supported) isas.push_back(e.isa);
    return isas;
}

Result<const Kernels*> select_kernels(Isa isa) {
    const char* wanted = isa == Isa::automatic ? std::getenv("STERADIAN_ISA") : nullptr;
    for (const Entry& e : entries()) {
        const bool meant = wanted && *wanted ? std::string(wanted) == e.name : isa == Isa::automatic || isa == e.isa;
        if (!meant) continue;
        if (e.supported) return e.kernels;
        if (wanted || isa != Isa::automatic)
            return unusable("this machine does not have the instruction set " + std::string(e.name));
    }
    return unusable("the environment variable STERADIAN_ISA names no instruction set: '" + std::string(wanted) + "'");
}

}  // namespace steradian
