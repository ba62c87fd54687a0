// One table of functions for each instruction set and layout. All of them compute the same bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "accel/world.h"
#include "steradian/result.h"
#include "steradian/settings.h"

namespace steradian {

/// Rays are canonicalised inside. `hits` and `result` have as many entries as there are rays.
struct Kernels {
    void (*intersect)(const World&, const Ray* rays, Hit* hits, size_t count) noexcept;
    /// 1 where anything is met, else 0.
    void (*occluded)(const World&, const Ray* rays, uint8_t* result, size_t count) noexcept;
    void (*next_hit)(const World&, const Ray* rays, const Hit* after, Hit* hits, size_t count) noexcept;
    void (*intersect_coherent)(const World&, const Ray* rays, Hit* hits, size_t count) noexcept;
    void (*occluded_coherent)(const World&, const Ray* rays, uint8_t* result, size_t count) noexcept;
    /// Accel::Occlusion, where the world has cut-outs.
    void (*occluded_or_cut_out)(const World&, const Ray* rays, uint8_t* result, size_t count) noexcept;
    /// `instances` of the items are instances.
    RayVisits (*visits)(const World&, const Ray& ray, uint32_t& instances) noexcept;
};

extern const Kernels kScalarKernels, kScalarCompactKernels;
#if defined(__x86_64__)
extern const Kernels kSse4Kernels, kAvx2Kernels, kAvx512Kernels;
extern const Kernels kSse4CompactKernels, kAvx2CompactKernels, kAvx512CompactKernels;
#elif defined(__aarch64__)
extern const Kernels kNeonKernels, kNeonCompactKernels;
#endif

/// Those that this machine has, best first; the last one is Isa::scalar.
std::vector<Isa> supported_isas();
/// `usage` when the machine lacks the instruction set. For Isa::automatic what the environment variable STERADIAN_ISA
/// names (`usage` when it names none), without one the best.
Result<const Kernels*> select_kernels(Isa isa, BvhLayout layout = BvhLayout::full);

}  // namespace steradian
