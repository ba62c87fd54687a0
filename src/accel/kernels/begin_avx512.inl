// From here to end_isa.inl functions are compiled for AVX-512. Its vectors are the first of them.

#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx512f,avx512vl,avx512bw,avx512dq,avx2,bmi,bmi2,popcnt"))), \
                             apply_to = function)
#else
#pragma GCC push_options
// GCC 12 takes its own headers' undefined registers for a mistake (bug 105593).
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC target("avx512f,avx512vl,avx512bw,avx512dq,avx2,bmi,bmi2,popcnt")
#endif

namespace steradian::avx512 {
namespace {
#include "accel/kernels/simd_avx512.inl"

#include "accel/kernels/compact_avx2.inl"
}  // namespace
}  // namespace steradian::avx512
