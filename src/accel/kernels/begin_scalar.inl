// What stands for vectors on any machine.

namespace steradian::scalar {
namespace {
#include "accel/kernels/simd_scalar.inl"

#include "accel/kernels/compact_lanes.inl"
}  // namespace
}  // namespace steradian::scalar
