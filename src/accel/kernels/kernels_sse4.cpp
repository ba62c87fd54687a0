#include "accel/kernels/kernel_headers.h"

#if defined(__x86_64__)

#include "accel/kernels/begin_sse4.inl"

namespace steradian::sse4 {
#include "accel/kernels/layouts.inl"
}  // namespace steradian::sse4

#include "accel/kernels/end_isa.inl"

namespace steradian {
const Kernels kSse4Kernels = sse4::kFullKernels, kSse4CompactKernels = sse4::kCompactKernels;
}  // namespace steradian

#endif
