// Steradian's side of the benchmark: which settings take part, and how rays are handed to it. The only file that calls
// Accel to be measured.
#pragma once

#include "race.h"

namespace steradian::bench {

struct OurSetting {
    std::string name;
    AccelOptions options;
};
/// The first is the default, with which everything else is compared.
const std::vector<OurSetting>& our_settings();

Result<Accel> build_ours(const BenchMesh& mesh, const OurSetting& setting);

/// Batches of a chunk. The Accel must outlive the tracer.
MakeTracer our_batches(const Accel& accel);
MakeTracer our_single_rays(const Accel& accel);

}  // namespace steradian::bench
