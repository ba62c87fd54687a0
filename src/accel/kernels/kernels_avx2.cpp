#include "accel/kernels/kernel_headers.h"

#if defined(__x86_64__)

// From here on functions are compiled for AVX2.
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2,bmi,bmi2,popcnt"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2,bmi,bmi2,popcnt")
#endif

namespace steradian {
namespace avx2 {
// In cut_outs_avx2.cpp.
void occluded_or_cut_out(const World&, const Ray* rays, uint8_t* result, size_t count) noexcept;
namespace {
#include "accel/kernels/simd_avx2.inl"

#include "accel/kernels/kernel.inl"

#include "accel/kernels/entries.inl"

#include "accel/kernels/packet.inl"
}  // namespace
}  // namespace avx2
}  // namespace steradian

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

namespace steradian {
const Kernels kAvx2Kernels = {avx2::intersect,          avx2::occluded,          avx2::next_hit,
                              avx2::intersect_coherent, avx2::occluded_coherent, avx2::occluded_or_cut_out};
}

#endif
