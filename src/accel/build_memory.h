// What a build takes at most, known from numbers alone.
#pragma once

#include <cstdint>
#include <span>

#include "accel/accel.h"

namespace steradian {

/// Bytes asked of the allocator, whose own rounding is not counted.
struct BuildMemory {
    uint64_t result = 0;  ///< held by the Accel
    uint64_t peak = 0;    ///< held at once during the build, what there is of the result included
};

/// What Accel::build takes at most for these, on any number of workers, whatever the coordinates are: there is room for
/// a leaf for every triangle and a node for every leaf. With some thousand primitives or more that is two to twenty
/// times what is really held (tests/accel/memory_test.cpp).
BuildMemory build_memory(std::span<const Geometry> geometries, std::span<const GeometryInstance> instances,
                         const AccelOptions& options);

}  // namespace steradian
