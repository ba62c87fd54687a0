// Any hits where some primitives are cut-outs, for both layouts. Included in the namespace of an instruction set, in
// files of its own: one more user of what is in kernel.inl would change what compilers inline into the other kernels.

namespace full {
namespace {
#include "accel/kernels/layout_full.inl"

#include "accel/kernels/kernel.inl"

#include "accel/kernels/stream.inl"

#include "accel/kernels/stream_order.inl"
}  // namespace
#include "accel/kernels/cut_outs.inl"
}  // namespace full

namespace compact {
namespace {
#include "accel/kernels/layout_compact.inl"

#include "accel/kernels/kernel.inl"

#include "accel/kernels/stream.inl"

#include "accel/kernels/stream_order.inl"
}  // namespace
#include "accel/kernels/cut_outs.inl"
}  // namespace compact
