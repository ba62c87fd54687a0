#include "accel/kernels/kernel_headers.h"

#if defined(__x86_64__)

// From here on functions are compiled for SSE4.2.
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("sse4.1,sse4.2,popcnt"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("sse4.1,sse4.2,popcnt")
#endif

namespace steradian {
namespace sse4 {
namespace {
#include "accel/kernels/simd_sse4.inl"

#include "accel/kernels/compact_lanes.inl"
}  // namespace
namespace full {
// In cut_outs_sse4.cpp.
void occluded_or_cut_out(const World&, const Ray* rays, uint8_t* result, size_t count) noexcept;
namespace {
#include "accel/kernels/layout_full.inl"

#include "accel/kernels/kernel.inl"

#include "accel/kernels/entries.inl"

#include "accel/kernels/packet.inl"
}  // namespace
}  // namespace full
namespace compact {
// In cut_outs_sse4.cpp.
void occluded_or_cut_out(const World&, const Ray* rays, uint8_t* result, size_t count) noexcept;
namespace {
#include "accel/kernels/layout_compact.inl"

#include "accel/kernels/kernel.inl"

#include "accel/kernels/entries.inl"
}  // namespace
}  // namespace compact
}  // namespace sse4
}  // namespace steradian

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

namespace steradian {
const Kernels kSse4Kernels = {sse4::full::intersect,         sse4::full::occluded,
                              sse4::full::next_hit,          sse4::full::intersect_coherent,
                              sse4::full::occluded_coherent, sse4::full::occluded_or_cut_out};
// Without packets: rays that go the same way are traced as any others.
const Kernels kSse4CompactKernels = {sse4::compact::intersect, sse4::compact::occluded,
                                     sse4::compact::next_hit,  sse4::compact::intersect,
                                     sse4::compact::occluded,  sse4::compact::occluded_or_cut_out};
}  // namespace steradian

#endif
