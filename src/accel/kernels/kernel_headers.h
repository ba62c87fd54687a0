// What the kernels use of the rest of the project. Included before an instruction set is switched on, so that whatever
// of it is not inlined is compiled for every machine.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <new>
#include <utility>

#include "accel/bvh.h"
#include "accel/compact_block.h"
#include "accel/compact_node.h"
#include "accel/kernels/kernels.h"
#include "accel/planar.h"
#include "accel/sphere.h"
#include "accel/triangle.h"
#include "accel/triangle_block.h"
#include "accel/world.h"

#if defined(__x86_64__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif
