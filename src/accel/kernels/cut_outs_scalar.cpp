#include "accel/kernels/kernel_headers.h"

namespace steradian {
namespace scalar {
namespace {
#include "accel/kernels/simd_scalar.inl"

#include "accel/kernels/kernel.inl"
}  // namespace
#include "accel/kernels/cut_outs.inl"
}  // namespace scalar
}  // namespace steradian
