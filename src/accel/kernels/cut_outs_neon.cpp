#include "accel/kernels/kernel_headers.h"

#if defined(__aarch64__)

#include "accel/kernels/begin_neon.inl"

namespace steradian::neon {
#include "accel/kernels/layouts_cut_outs.inl"
}  // namespace steradian::neon

#endif
