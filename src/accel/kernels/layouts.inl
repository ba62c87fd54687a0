// The kernels of an instruction set for both layouts, and the tables of them. Included in its namespace.

namespace full {
// In cut_outs_*.cpp.
void occluded_or_cut_out(const World&, const Ray* rays, uint8_t* result, size_t count) noexcept;
namespace {
#include "accel/kernels/layout_full.inl"

#include "accel/kernels/kernel.inl"

#include "accel/kernels/stream.inl"

#include "accel/kernels/stream_order.inl"

#include "accel/kernels/entries.inl"

#include "accel/kernels/packet.inl"
}  // namespace
}  // namespace full

namespace compact {
// In cut_outs_*.cpp.
void occluded_or_cut_out(const World&, const Ray* rays, uint8_t* result, size_t count) noexcept;
namespace {
#include "accel/kernels/layout_compact.inl"

#include "accel/kernels/kernel.inl"

#include "accel/kernels/stream.inl"

#include "accel/kernels/stream_order.inl"

#include "accel/kernels/entries.inl"

#include "accel/kernels/packet.inl"
}  // namespace
}  // namespace compact

namespace {
constexpr Kernels kFullKernels = {
    full::intersect,           full::occluded, full::next_hit, full::intersect_coherent, full::occluded_coherent,
    full::occluded_or_cut_out, full::visits};
constexpr Kernels kCompactKernels = {compact::intersect,
                                     compact::occluded,
                                     compact::next_hit,
                                     compact::intersect_coherent,
                                     compact::occluded_coherent,
                                     compact::occluded_or_cut_out,
                                     compact::visits};
}  // namespace
