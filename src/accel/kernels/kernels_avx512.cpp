#include "accel/kernels/kernel_headers.h"

#if defined(__x86_64__)

#include "accel/kernels/begin_avx512.inl"

namespace steradian::avx512 {
#include "accel/kernels/layouts.inl"
}  // namespace steradian::avx512

#include "accel/kernels/end_isa.inl"

namespace steradian {
const Kernels kAvx512Kernels = avx512::kFullKernels, kAvx512CompactKernels = avx512::kCompactKernels;
}  // namespace steradian

#endif
