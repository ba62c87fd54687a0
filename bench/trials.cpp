#include "trials.h"

#include <algorithm>

#include "ours.h"

namespace steradian::bench {
namespace {

constexpr ptrdiff_t kFinalists = 3;

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

std::vector<const Trial*> finalists(const std::vector<Trial>& trials, bool robust, Rays rays) {
    const auto is_single = [](const Trial* trial) { return trial->feed.kind == EmbreeFeed::Kind::single; };
    std::vector<const Trial*> ranked;
    for (const Trial& trial : trials)
        if (!robust || trial.build.robust)
            if (rays == Rays::any || is_single(&trial)) ranked.push_back(&trial);
    std::stable_sort(ranked.begin(), ranked.end(),
                     [](const Trial* a, const Trial* b) { return a->relative() < b->relative(); });
    const auto few = ranked.begin() + std::min(kFinalists, ranked.end() - ranked.begin());
    const auto single = std::find_if(ranked.begin(), ranked.end(), is_single);
    std::vector<const Trial*> best(ranked.begin(), few);
    if (single >= few && single != ranked.end()) best.push_back(*single);
    return best;
}

TriedRow row_of(const Trial& trial, const BenchMesh& mesh, const RaySet& set) {
    return {mesh.name,          set.name,        trial.build.str(),
            trial.feed.str(),   set.rays.size(), trial.embree.seconds,
            trial.ours.seconds, trial.differ()};
}

}  // namespace steradian::bench
