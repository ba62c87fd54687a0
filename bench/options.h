// What the command line of accel_bench asks for.
#pragma once

#include <string>
#include <vector>

#include "steradian/result.h"

namespace steradian::bench {

struct Options {
    std::vector<std::string> meshes;  ///< names or files; empty: all generated ones
    std::vector<std::string> rays;    ///< names of ray sets; empty: all
    std::vector<std::string> ours;    ///< names of our settings; empty: the default one
    std::vector<std::string> builds;  ///< those of our settings that are built for their times; empty: all
    std::vector<std::string> parts;   ///< of part_names; empty: all
    int repetitions = 0, build_repetitions = 0, trials = 0;
    uint32_t size = 0;      ///< of the picture, pixels
    uint32_t chunk = 4096;  ///< rays handed over in one call
    uint32_t trial_chunks = 0;
    bool quick = false, only_ours = false, list = false, help = false;
    std::string json, study;

    bool has_part(const std::string& name) const;
};

/// rays, threads, trees, build.
const std::vector<std::string>& part_names();

/// The usage text for --help.
std::string help_text();
/// What exists: meshes, ray sets, our settings, instruction sets of Embree.
std::string list_text();

/// `usage` for what does not exist or is out of range.
Result<Options> parse_options(const std::vector<std::string>& words);

}  // namespace steradian::bench
