// From here to end_isa.inl functions are compiled for SSE4.2. Its vectors are the first of them.

#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("sse4.1,sse4.2,popcnt"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("sse4.1,sse4.2,popcnt")
#endif

namespace steradian::sse4 {
namespace {
#include "accel/kernels/simd_sse4.inl"

#include "accel/kernels/compact_lanes.inl"
}  // namespace
}  // namespace steradian::sse4
