#include "accel/kernels/kernel_headers.h"

#if defined(__x86_64__)

// From here on functions are compiled for SSE4.2.
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("sse4.1,sse4.2,popcnt"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("sse4.1,sse4.2,popcnt")
#endif

namespace steradian {
namespace sse4 {
namespace {
#include "accel/kernels/simd_sse4.inl"

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
}  // namespace sse4
}  // namespace steradian

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

#endif
