#include "accel/kernels/kernel_headers.h"

#if defined(__aarch64__)

namespace steradian {
namespace neon {
namespace {
#include "accel/kernels/simd_neon.inl"

#include "accel/kernels/compact_lanes.inl"
}  // namespace
namespace full {
namespace {
#include "accel/kernels/layout_full.inl"

#include "accel/kernels/kernel.inl"
}  // namespace
#include "accel/kernels/cut_outs.inl"
}  // namespace full
namespace compact {
namespace {
#include "accel/kernels/layout_compact.inl"

#include "accel/kernels/kernel.inl"
}  // namespace
#include "accel/kernels/cut_outs.inl"
}  // namespace compact
}  // namespace neon
}  // namespace steradian

#endif
