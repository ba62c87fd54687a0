// How many samples each cell of a picture needs, for the least work in all.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/error_estimate.h"

namespace steradian {

/// What one group tells of a cell.
struct CellError {
    uint64_t samples = 0;  ///< of each pixel in the group
    ErrorSums error;       ///< over the cell's pixels, as group_error() has it
};

/// Numbers of samples are `least` times a power of two, at most `most`.
struct SampleLimits {
    uint64_t least = 0, most = 0;
};

/// Samples of a pixel in each group, for every cell (row by row, so many `columns`), so that the picture's error will
/// be certified to be within `target`, as far as one group can tell; `most` where that does not suffice.
std::vector<uint64_t> allocate(std::span<const CellError> cells, size_t columns, double target, SampleLimits limits);

}  // namespace steradian
