#include "accel/kernels/kernel_headers.h"

#if defined(__x86_64__)

#include "accel/kernels/begin_avx2.inl"

namespace steradian::avx2 {
#include "accel/kernels/layouts.inl"
}  // namespace steradian::avx2

#include "accel/kernels/end_isa.inl"

namespace steradian {
const Kernels kAvx2Kernels = avx2::kFullKernels, kAvx2CompactKernels = avx2::kCompactKernels;
}  // namespace steradian

#endif
