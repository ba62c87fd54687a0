#include "trials.h"

#include "ours.h"

namespace steradian::bench {
namespace {

/// One race of ours against all feeds of one scene.
void try_feeds(const EmbreeScene& scene, const EmbreeBuild& build, const Accel& ours, const RaySet& set,
               const RaceOptions& options, std::vector<Trial>& trials) {
    const std::vector<EmbreeFeed> feeds = scene.feeds(set.coherent);
    std::vector<Entrant> entrants = {{our_batches(ours)}};
    for (const EmbreeFeed& feed : feeds) entrants.push_back({scene.tracer(feed)});
    std::vector<Lane> lanes = race(set, entrants, options);
    for (size_t i = 0; i < feeds.size(); ++i) trials.push_back({build, feeds[i], std::move(lanes[i + 1]), lanes[0]});
}

}  // namespace

std::vector<EmbreeBuild> all_embree_builds() {
    std::vector<EmbreeBuild> builds;
    for (const std::string& isa : embree_isas())
        for (const bool high : {false, true})
            for (const bool robust : {false, true}) builds.push_back({isa, high, robust});
    return builds;
}

std::vector<std::vector<Trial>> try_settings(const BenchMesh& mesh, const Accel& ours, const std::vector<RaySet>& sets,
                                             const std::vector<EmbreeBuild>& builds, const RaceOptions& options) {
    std::vector<std::vector<Trial>> trials(sets.size());
    for (const EmbreeBuild& build : builds) {
        const EmbreeScene scene(mesh, build);
        for (size_t i = 0; i < sets.size(); ++i) try_feeds(scene, build, ours, sets[i], options, trials[i]);
    }
    return trials;
}

const Trial* fastest(const std::vector<Trial>& trials, bool robust, Rays rays) {
    const Trial* best = nullptr;
    for (const Trial& trial : trials) {
        if (robust && !trial.build.robust) continue;
        if (rays == Rays::single && trial.feed.kind != EmbreeFeed::Kind::single) continue;
        if (!best || trial.relative() < best->relative()) best = &trial;
    }
    return best;
}

TriedRow row_of(const Trial& trial, const BenchMesh& mesh, const RaySet& set) {
    return {mesh.name,          set.name,        trial.build.str(),
            trial.feed.str(),   set.rays.size(), trial.embree.seconds,
            trial.ours.seconds, trial.differ()};
}

}  // namespace steradian::bench
