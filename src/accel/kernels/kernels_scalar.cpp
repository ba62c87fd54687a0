#include "accel/kernels/kernel_headers.h"

namespace steradian {
namespace scalar {
namespace {
#include "accel/kernels/simd_scalar.inl"

#include "accel/kernels/kernel.inl"
#include "accel/kernels/packet.inl"
}  // namespace
}  // namespace scalar
}  // namespace steradian

namespace steradian {
const Kernels kScalarKernels = {scalar::intersect, scalar::occluded, scalar::next_hit, scalar::intersect_coherent,
                                scalar::occluded_coherent};
}
