#include "accel/kernels/kernel_headers.h"

#include "accel/kernels/begin_scalar.inl"

namespace steradian::scalar {
#include "accel/kernels/layouts.inl"
}  // namespace steradian::scalar

namespace steradian {
const Kernels kScalarKernels = scalar::kFullKernels, kScalarCompactKernels = scalar::kCompactKernels;
}  // namespace steradian
