// The vectors of NEON, which every processor of this kind has.

namespace steradian::neon {
namespace {
#include "accel/kernels/simd_neon.inl"

#include "accel/kernels/compact_lanes.inl"
}  // namespace
}  // namespace steradian::neon
