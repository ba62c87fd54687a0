#include "accel/kernels/kernel_headers.h"

#if defined(__x86_64__)

// From here on functions are compiled for AVX-512.
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx512f,avx512vl,avx512bw,avx512dq,avx2,bmi,bmi2,popcnt"))), \
                             apply_to = function)
#else
#pragma GCC push_options
// GCC 12 takes its own headers' undefined registers for a mistake (bug 105593).
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC target("avx512f,avx512vl,avx512bw,avx512dq,avx2,bmi,bmi2,popcnt")
#endif

namespace steradian {
namespace avx512 {
namespace {
#include "accel/kernels/simd_avx512.inl"

#include "accel/kernels/compact_avx2.inl"
}  // namespace
namespace full {
// In cut_outs_avx512.cpp.
void occluded_or_cut_out(const World&, const Ray* rays, uint8_t* result, size_t count) noexcept;
namespace {
#include "accel/kernels/layout_full.inl"

#include "accel/kernels/kernel.inl"

#include "accel/kernels/entries.inl"

#include "accel/kernels/packet.inl"
}  // namespace
}  // namespace full
namespace compact {
// In cut_outs_avx512.cpp.
void occluded_or_cut_out(const World&, const Ray* rays, uint8_t* result, size_t count) noexcept;
namespace {
#include "accel/kernels/layout_compact.inl"

#include "accel/kernels/kernel.inl"

#include "accel/kernels/entries.inl"
}  // namespace
}  // namespace compact
}  // namespace avx512
}  // namespace steradian

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

namespace steradian {
const Kernels kAvx512Kernels = {avx512::full::intersect,         avx512::full::occluded,
                                avx512::full::next_hit,          avx512::full::intersect_coherent,
                                avx512::full::occluded_coherent, avx512::full::occluded_or_cut_out};
// Without packets: rays that go the same way are traced as any others.
const Kernels kAvx512CompactKernels = {avx512::compact::intersect, avx512::compact::occluded,
                                       avx512::compact::next_hit,  avx512::compact::intersect,
                                       avx512::compact::occluded,  avx512::compact::occluded_or_cut_out};
}  // namespace steradian

#endif
