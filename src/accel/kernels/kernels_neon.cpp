#include "accel/kernels/kernel_headers.h"

#if defined(__aarch64__)

namespace steradian {
namespace neon {
namespace {
#include "accel/kernels/simd_neon.inl"

#include "accel/kernels/kernel.inl"
#include "accel/kernels/packet.inl"
}  // namespace
}  // namespace neon
}  // namespace steradian

namespace steradian {
const Kernels kNeonKernels = {neon::intersect, neon::occluded, neon::next_hit, neon::intersect_coherent,
                              neon::occluded_coherent};
}

#endif
