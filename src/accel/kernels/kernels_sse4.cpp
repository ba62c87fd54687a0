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
// In cut_outs_sse4.cpp.
void occluded_or_cut_out(const World&, const Ray* rays, uint8_t* result, size_t count) noexcept;
namespace {
#include "accel/kernels/simd_sse4.inl"

#include "accel/kernels/kernel.inl"

#include "accel/kernels/entries.inl"

#include "accel/kernels/packet.inl"
}  // namespace
}  // namespace sse4
}  // namespace steradian

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

namespace steradian {
const Kernels kSse4Kernels = {sse4::intersect,          sse4::occluded,          sse4::next_hit,
                              sse4::intersect_coherent, sse4::occluded_coherent, sse4::occluded_or_cut_out};
}

#endif
