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
namespace {
#include "accel/kernels/simd_avx2.inl"

#include "accel/kernels/compact_avx2.inl"
}  // namespace
namespace full {
// In cut_outs_avx2.cpp.
void occluded_or_cut_out(const World&, const Ray* rays, uint8_t* result, size_t count) noexcept;
namespace {
#include "accel/kernels/layout_full.inl"

#include "accel/kernels/kernel.inl"

#include "accel/kernels/entries.inl"

#include "accel/kernels/packet.inl"
}  // namespace
}  // namespace full
namespace compact {
// In cut_outs_avx2.cpp.
void occluded_or_cut_out(const World&, const Ray* rays, uint8_t* result, size_t count) noexcept;
namespace {
#include "accel/kernels/layout_compact.inl"

#include "accel/kernels/kernel.inl"

#include "accel/kernels/entries.inl"
}  // namespace
}  // namespace compact
}  // namespace avx2
}  // namespace steradian

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

namespace steradian {
const Kernels kAvx2Kernels = {avx2::full::intersect,         avx2::full::occluded,
                              avx2::full::next_hit,          avx2::full::intersect_coherent,
                              avx2::full::occluded_coherent, avx2::full::occluded_or_cut_out};
// Without packets: rays that go the same way are traced as any others.
const Kernels kAvx2CompactKernels = {avx2::compact::intersect, avx2::compact::occluded,
                                     avx2::compact::next_hit,  avx2::compact::intersect,
                                     avx2::compact::occluded,  avx2::compact::occluded_or_cut_out};
}  // namespace steradian

#endif
