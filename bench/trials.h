// Which setting of Embree is the fastest for a set of rays: all of them run, nobody guesses.
#pragma once

#include "embree.h"
#include "report.h"

namespace steradian::bench {

struct Trial {
    EmbreeBuild build;
    EmbreeFeed feed;
    Lane embree, ours;  ///< from the same race

    /// Embree's time over ours. Times of different races are not comparable, these are.
    double relative() const { return embree.seconds.lowest / ours.seconds.lowest; }
    size_t differ() const { return count_different(ours.answers, embree.answers); }
};

/// Every instruction set, build quality and robustness.
std::vector<EmbreeBuild> all_embree_builds();

/// For each of the sets, every build with every feed. One scene is held at a time.
std::vector<std::vector<Trial>> try_settings(const BenchMesh& mesh, const Accel& ours, const std::vector<RaySet>& sets,
                                             const std::vector<EmbreeBuild>& builds, const RaceOptions& options);

enum class Rays : uint8_t { any, single };
/// The best few of the trials for a longer race, best first: trials are short, so the first is not always the fastest.
/// At least one of them hands over single rays. Only robust ones (if asked); only single rays (if asked).
std::vector<const Trial*> finalists(const std::vector<Trial>& trials, bool robust, Rays rays);

TriedRow row_of(const Trial& trial, const BenchMesh& mesh, const RaySet& set);

}  // namespace steradian::bench
