#include "accel/kernels/kernel_headers.h"

namespace steradian {
namespace scalar {
// In cut_outs_scalar.cpp.
void occluded_or_cut_out(const World&, const Ray* rays, uint8_t* result, size_t count) noexcept;
namespace {
#include "accel/kernels/simd_scalar.inl"

#include "accel/kernels/kernel.inl"

#include "accel/kernels/entries.inl"

#include "accel/kernels/packet.inl"
}  // namespace
}  // namespace scalar
}  // namespace steradian

namespace steradian {
const Kernels kScalarKernels = {scalar::intersect,          scalar::occluded,          scalar::next_hit,
                                scalar::intersect_coherent, scalar::occluded_coherent, scalar::occluded_or_cut_out};
}
