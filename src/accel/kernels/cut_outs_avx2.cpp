#include "accel/kernels/kernel_headers.h"

#if defined(__x86_64__)

#include "accel/kernels/begin_avx2.inl"

namespace steradian::avx2 {
#include "accel/kernels/layouts_cut_outs.inl"
}  // namespace steradian::avx2

#include "accel/kernels/end_isa.inl"

#endif
