#include "accel/kernels/kernel_headers.h"

#if defined(__aarch64__)

namespace steradian {
namespace neon {
namespace {
#include "accel/kernels/simd_neon.inl"

#include "accel/kernels/compact_lanes.inl"
}  // namespace
namespace full {
// In cut_outs_neon.cpp.
void occluded_or_cut_out(const World&, const Ray* rays, uint8_t* result, size_t count) noexcept;
namespace {
#include "accel/kernels/layout_full.inl"

#include "accel/kernels/kernel.inl"

#include "accel/kernels/entries.inl"

#include "accel/kernels/packet.inl"
}  // namespace
}  // namespace full
namespace compact {
// In cut_outs_neon.cpp.
void occluded_or_cut_out(const World&, const Ray* rays, uint8_t* result, size_t count) noexcept;
namespace {
#include "accel/kernels/layout_compact.inl"

#include "accel/kernels/kernel.inl"

#include "accel/kernels/entries.inl"
}  // namespace
}  // namespace compact
}  // namespace neon
}  // namespace steradian

namespace steradian {
const Kernels kNeonKernels = {neon::full::intersect,         neon::full::occluded,
                              neon::full::next_hit,          neon::full::intersect_coherent,
                              neon::full::occluded_coherent, neon::full::occluded_or_cut_out};
// Without packets: rays that go the same way are traced as any others.
const Kernels kNeonCompactKernels = {neon::compact::intersect, neon::compact::occluded,
                                     neon::compact::next_hit,  neon::compact::intersect,
                                     neon::compact::occluded,  neon::compact::occluded_or_cut_out};
}  // namespace steradian

#endif
