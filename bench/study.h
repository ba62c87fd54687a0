// How rays per second and build times grow with the number of triangles.
#pragma once

#include <optional>

#include "options.h"

namespace steradian::bench {

/// Bumpy spheres of 10³ to 10⁷ triangles (10⁵ with `quick`). Writes options.study as CSV:
/// triangles,measure,series,value,lowest,highest, where measure is a set of rays (millions per second and thread),
/// "build" (processor milliseconds on one thread) or "build all" (milliseconds on all).
std::optional<Error> study_sizes(const Options& options);

}  // namespace steradian::bench
