#include "accel/kernels/kernel_headers.h"

#if defined(__aarch64__)

namespace steradian {
namespace neon {
namespace {
#include "accel/kernels/simd_neon.inl"

#include "accel/kernels/kernel.inl"
}  // namespace
#include "accel/kernels/cut_outs.inl"
}  // namespace neon
}  // namespace steradian

#endif
