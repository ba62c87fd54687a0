// The measurements of one mesh, added to a report.
#pragma once

#include <optional>

#include "options.h"
#include "report.h"

namespace steradian::bench {

/// Nothing when all went well.
std::optional<Error> measure_mesh(const BenchMesh& mesh, const Options& options, Report& report);

}  // namespace steradian::bench
