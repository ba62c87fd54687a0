#include "accel/kernels/kernel_headers.h"

#if defined(__x86_64__)

#include "accel/kernels/begin_sse4.inl"

namespace steradian::sse4 {
#include "accel/kernels/layouts_cut_outs.inl"
}  // namespace steradian::sse4

#include "accel/kernels/end_isa.inl"

#endif
