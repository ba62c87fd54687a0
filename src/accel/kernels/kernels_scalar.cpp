#include "accel/kernels/kernel_headers.h"

namespace steradian {
namespace scalar {
namespace {
#include "accel/kernels/simd_scalar.inl"

#include "accel/kernels/compact_lanes.inl"
}  // namespace
namespace full {
// In cut_outs_scalar.cpp.
void occluded_or_cut_out(const World&, const Ray* rays, uint8_t* result, size_t count) noexcept;
namespace {
#include "accel/kernels/layout_full.inl"

#include "accel/kernels/kernel.inl"

#include "accel/kernels/entries.inl"

#include "accel/kernels/packet.inl"
}  // namespace
}  // namespace full
namespace compact {
// In cut_outs_scalar.cpp.
void occluded_or_cut_out(const World&, const Ray* rays, uint8_t* result, size_t count) noexcept;
namespace {
#include "accel/kernels/layout_compact.inl"

#include "accel/kernels/kernel.inl"

#include "accel/kernels/entries.inl"
}  // namespace
}  // namespace compact
}  // namespace scalar
}  // namespace steradian

namespace steradian {
const Kernels kScalarKernels = {scalar::full::intersect,         scalar::full::occluded,
                                scalar::full::next_hit,          scalar::full::intersect_coherent,
                                scalar::full::occluded_coherent, scalar::full::occluded_or_cut_out};
// Without packets: rays that go the same way are traced as any others.
const Kernels kScalarCompactKernels = {scalar::compact::intersect, scalar::compact::occluded,
                                       scalar::compact::next_hit,  scalar::compact::intersect,
                                       scalar::compact::occluded,  scalar::compact::occluded_or_cut_out};
}  // namespace steradian
