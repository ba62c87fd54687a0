#include "accel/kernels/kernel_headers.h"

#include "accel/kernels/begin_scalar.inl"

namespace steradian::scalar {
#include "accel/kernels/layouts_cut_outs.inl"
}  // namespace steradian::scalar
