#include "accel/kernels/kernel_headers.h"

#if defined(__aarch64__)

#include "accel/kernels/begin_neon.inl"

namespace steradian::neon {
#include "accel/kernels/layouts.inl"
}  // namespace steradian::neon

namespace steradian {
const Kernels kNeonKernels = neon::kFullKernels, kNeonCompactKernels = neon::kCompactKernels;
}  // namespace steradian

#endif
