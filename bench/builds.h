// Build times and memory.
#pragma once

#include <optional>

#include "options.h"
#include "report.h"

namespace steradian::bench {

/// All our settings and Embree's two qualities, on one thread and on all. Needs the memory of one result at a time.
std::optional<Error> measure_builds(const BenchMesh& mesh, const Options& options, std::vector<BuildRow>& rows);

}  // namespace steradian::bench
