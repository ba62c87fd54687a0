#include "accel/kernels/kernel_headers.h"

#if defined(__aarch64__)

namespace steradian {
namespace neon {
// In cut_outs_neon.cpp.
void occluded_or_cut_out(const World&, const Ray* rays, uint8_t* result, size_t count) noexcept;
namespace {
#include "accel/kernels/simd_neon.inl"

#include "accel/kernels/kernel.inl"

#include "accel/kernels/entries.inl"

#include "accel/kernels/packet.inl"
}  // namespace
}  // namespace neon
}  // namespace steradian

namespace steradian {
const Kernels kNeonKernels = {neon::intersect,          neon::occluded,          neon::next_hit,
                              neon::intersect_coherent, neon::occluded_coherent, neon::occluded_or_cut_out};
}

#endif
