#include "measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/parallel.h"
#include "builds.h"
#include "ours.h"
#include "trees.h"
#include "trials.h"

namespace steradian::bench {
namespace {

/// The scenes of Embree that some set of rays is measured with, each built once.
class Scenes {
public:
    explicit Scenes(const BenchMesh& mesh) : mesh_(mesh) {}
    MakeTracer tracer(const Trial& trial) {
        std::unique_ptr<EmbreeScene>& scene = scenes_[trial.build];
        if (!scene) scene = std::make_unique<EmbreeScene>(mesh_, trial.build);
        return scene->tracer(trial.feed);
    }
    /// Between races: lets go of what was built when it is much, to be built again if needed.
    void limit_memory() {
        int64_t bytes = 0;
        for (const auto& [build, scene] : scenes_) bytes += scene->bytes();
        if (bytes > kMostBytesKept) scenes_.clear();
    }

private:
    static constexpr int64_t kMostBytesKept = int64_t(4) << 30;

    const BenchMesh& mesh_;
    std::map<EmbreeBuild, std::unique_ptr<EmbreeScene>> scenes_;
};

struct Contender {
    std::string name;
    Accel accel;
};

/// Everything that the races of one mesh share.
struct Course {
    const BenchMesh& mesh;
    const Options& options;
    const std::vector<Contender>& ours;
    Scenes& scenes;
    Report& report;

    RaceOptions race_options(bool wall) const { return {options.repetitions, options.chunk, wall}; }
};

std::string setting_of(const Trial& trial) { return trial.build.str() + ", " + trial.feed.str(); }

/// The entrant with the best median among `lanes` from `first` on.
size_t winner(const std::vector<Lane>& lanes, size_t first, size_t count) {
    const auto begin = lanes.begin() + ptrdiff_t(first);
    const auto best = std::min_element(begin, begin + ptrdiff_t(count), [](const Lane& a, const Lane& b) {
        return a.seconds.median < b.seconds.median;
    });
    return size_t(best - lanes.begin());
}

/// One race: all our settings, the finalists of Embree and those of its robust mode. Returns the winner of Embree's.
const Trial* race_one_thread(Course& course, const RaySet& set, const std::vector<Trial>& trials, Rays rays) {
    const bool single = rays == Rays::single;
    std::vector<const Trial*> embree = finalists(trials, false, rays);
    const std::vector<const Trial*> robust = finalists(trials, true, rays);
    embree.insert(embree.end(), robust.begin(), robust.end());
    std::vector<Entrant> entrants;
    for (const Contender& c : course.ours)
        entrants.push_back({single ? our_single_rays(c.accel) : our_batches(c.accel)});
    for (const Trial* trial : embree) entrants.push_back({course.scenes.tracer(*trial)});
    const std::vector<Lane> lanes = race(set, entrants, course.race_options(false));

    const size_t ours = course.ours.size();
    const auto entry = [&](size_t lane) {
        const std::string setting = lane < ours ? course.ours[lane].name : setting_of(*embree[lane - ours]);
        return Entry{setting, lanes[lane].seconds, count_different(lanes[0].answers, lanes[lane].answers)};
    };
    const size_t best = winner(lanes, ours, embree.size());
    const size_t best_robust = winner(lanes, lanes.size() - robust.size(), robust.size());
    for (size_t i = 0; i < ours; ++i) {
        RayRow row{course.mesh.name, set.name, single, set.rays.size(), entry(i), {}, {}};
        if (!embree.empty()) row.fastest = entry(best);
        if (!robust.empty()) row.robust = entry(best_robust);
        course.report.rays.push_back(std::move(row));
    }
    return embree.empty() ? nullptr : embree[best - ours];
}

/// One race: ours and a setting of Embree, each on one thread and on all.
void race_threads(Course& course, const RaySet& set, const Trial* best) {
    const uint32_t all = hardware_threads();
    const Contender& ours = course.ours[0];
    std::vector<Entrant> entrants = {{our_batches(ours.accel), 1}, {our_batches(ours.accel), all}};
    if (best)
        for (const uint32_t threads : {1u, all}) entrants.push_back({course.scenes.tracer(*best), threads});
    const std::vector<Lane> lanes = race(set, entrants, course.race_options(true));

    const auto entry = [&](size_t lane, const std::string& setting) {
        return Entry{setting, lanes[lane].seconds, count_different(lanes[0].answers, lanes[lane].answers)};
    };
    ThreadRow row{course.mesh.name, set.name, set.rays.size(), all, entry(0, ours.name), entry(1, ours.name), {}, {}};
    if (best) {
        row.embree_one = entry(2, setting_of(*best));
        row.embree_all = entry(3, setting_of(*best));
    }
    course.report.threads.push_back(std::move(row));
}

std::vector<std::vector<Trial>> trials_for(Course& course, const std::vector<RaySet>& sets) {
    const Options& options = course.options;
    if (options.only_ours) return std::vector<std::vector<Trial>>(sets.size());
    std::vector<RaySet> samples;
    for (const RaySet& set : sets) samples.push_back(sample(set, options.chunk, options.trial_chunks));
    fmt::print(stderr, "{}: trying the settings of Embree\n", course.mesh.name);
    std::vector<std::vector<Trial>> trials = try_settings(course.mesh, course.ours[0].accel, samples,
                                                          all_embree_builds(), {options.trials, options.chunk, false});
    for (size_t i = 0; i < sets.size(); ++i)
        for (const Trial& trial : trials[i]) course.report.tried.push_back(row_of(trial, course.mesh, samples[i]));
    return trials;
}

void measure_rays(Course& course) {
    const std::vector<RaySet> sets =
        record_rays(course.ours[0].accel, course.mesh, course.options.size, course.options.rays);
    const std::vector<std::vector<Trial>> trials = trials_for(course, sets);
    for (size_t i = 0; i < sets.size(); ++i) {
        fmt::print(stderr, "{}: {}, {} rays\n", course.mesh.name, sets[i].name, sets[i].rays.size());
        course.scenes.limit_memory();
        const std::vector<const Trial*> ranked = finalists(trials[i], false, Rays::any);
        const Trial* best = ranked.empty() ? nullptr : ranked[0];
        if (course.options.has_part("rays")) {
            best = race_one_thread(course, sets[i], trials[i], Rays::any);
            race_one_thread(course, sets[i], trials[i], Rays::single);
        }
        if (course.options.has_part("threads") && hardware_threads() > 1) race_threads(course, sets[i], best);
    }
}

Result<std::vector<Contender>> build_contenders(const BenchMesh& mesh, const Options& options) {
    std::vector<Contender> ours;
    for (const std::string& name : options.ours)
        for (const OurSetting& setting : our_settings()) {
            if (setting.name != name) continue;
            Result<Accel> accel = build_ours(mesh, setting);
            if (!accel) return accel.error();
            ours.push_back({name, std::move(*accel)});
        }
    return ours;
}

}  // namespace

std::optional<Error> measure_mesh(const BenchMesh& mesh, const Options& options, Report& report) {
    if (options.has_part("rays") || options.has_part("threads")) {
        const Result<std::vector<Contender>> ours = build_contenders(mesh, options);
        if (!ours) return ours.error();
        Scenes scenes(mesh);
        Course course{mesh, options, *ours, scenes, report};
        measure_rays(course);
    }
    if (options.has_part("trees"))
        if (std::optional<Error> error = measure_trees(mesh, options, report)) return error;
    if (options.has_part("build")) return measure_builds(mesh, options, report.builds);
    return {};
}

}  // namespace steradian::bench
