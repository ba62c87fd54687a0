// What a build takes, known before it.
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

/// What Accel::build takes at most for these, on any number of workers, whatever the coordinates are; known from
/// numbers alone. The hierarchy takes 60 bytes a triangle at most in either layout (90 with BvhBuilder::high_quality,
/// which may have half as many again in its leaves), 96 (in the compact layout 64) for every shape and every instance
/// that is not in place, half a kilobyte, and what the object is without any: builders keep within these, see
/// tree_bytes.h. Before nodes are gathered there may be a leaf for every primitive, so `peak` is further off what
/// ordinary meshes take: up to 3.5 times.
BuildMemory build_memory(std::span<const Geometry> geometries, std::span<const GeometryInstance> instances,
                         const AccelOptions& options);

/// What it takes for ordinary meshes and scattered primitives: what is held then is at most 1.3 times more or less than
/// `result`, and 1.5 times than `peak` (tests/accel/memory_test.cpp). Opened instances (OpenInstances) are not
/// expected, but that it is tried. In the compact layout it matters how many vertices triangles share, so different
/// positions are counted, in one pass over them; indices are not looked at.
BuildMemory expected_build_memory(std::span<const Geometry> geometries, std::span<const GeometryInstance> instances,
                                  const AccelOptions& options);

}  // namespace steradian
