// From here to end_isa.inl functions are compiled for AVX2. Its vectors are the first of them.

#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2,bmi,bmi2,popcnt"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2,bmi,bmi2,popcnt")
#endif

namespace steradian::avx2 {
namespace {
#include "accel/kernels/simd_avx2.inl"

#include "accel/kernels/compact_avx2.inl"
}  // namespace
}  // namespace steradian::avx2
