// The rule that includes point from higher layers to lower ones only, as a check that reads the include lines.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace steradian::test {

/// One line per include that points against the layers, "file:line: what is wrong"; empty when all is well.
/// Reads include/steradian, src and apps under `root`.
std::vector<std::string> layering_faults(const std::filesystem::path& root);

}  // namespace steradian::test
