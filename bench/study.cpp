#include "study.h"

#include <fmt/format.h>

#include <fstream>

#include "builds.h"
#include "ours.h"
#include "trials.h"

namespace steradian::bench {
namespace {

/// Instruction sets and feeds are tried; the quality stays medium, in which the largest can be built in seconds.
std::vector<EmbreeBuild> study_builds() {
    std::vector<EmbreeBuild> builds;
    for (const std::string& isa : embree_isas())
        if (isa != "sse4.2" && isa != "avx") builds.push_back({isa, false, false});
    if (builds.empty()) builds = {{embree_isas().back(), false, false}};
    return builds;
}

class Csv {
public:
    explicit Csv(std::ofstream& file) : file_(file) { file_ << "triangles,measure,series,value,lowest,highest\n"; }
    void add(size_t triangles, const std::string& measure, const std::string& series, double value, double low,
             double high) {
        file_ << fmt::format("{},{},{},{:.6g},{:.6g},{:.6g}\n", triangles, measure, series, value, low, high);
        file_.flush();
    }
    void add_rays(size_t triangles, const RaySet& set, const std::string& series, const Spread& s) {
        const size_t n = set.rays.size();
        add(triangles, set.name, series, mega_per_second(n, s.median), mega_per_second(n, s.highest),
            mega_per_second(n, s.lowest));
    }

private:
    std::ofstream& file_;
};

void study_rays(const BenchMesh& mesh, const Accel& ours, const Options& options, Csv& csv) {
    const std::vector<RaySet> sets = record_rays(ours, mesh, options.size, options.rays);
    std::vector<RaySet> samples;
    for (const RaySet& set : sets) samples.push_back(sample(set, options.chunk, options.trial_chunks));
    const RaceOptions trials{options.trials, options.chunk, false}, races{options.repetitions, options.chunk, false};
    std::vector<std::vector<Trial>> tried(sets.size());
    if (!options.only_ours) tried = try_settings(mesh, ours, samples, study_builds(), trials);
    for (size_t i = 0; i < sets.size(); ++i) {
        std::vector<Entrant> entrants = {{our_batches(ours)}};
        std::optional<EmbreeScene> scene;
        if (const auto ranked = finalists(tried[i], false, Rays::any); !ranked.empty())
            entrants.push_back({scene.emplace(mesh, ranked[0]->build).tracer(ranked[0]->feed)});
        const std::vector<Lane> lanes = race(sets[i], entrants, races);
        csv.add_rays(mesh.triangles(), sets[i], "Steradian", lanes[0].seconds);
        if (scene) csv.add_rays(mesh.triangles(), sets[i], "Embree", lanes[1].seconds);
    }
}

std::optional<Error> study_builds_of(const BenchMesh& mesh, const Options& options, Csv& csv) {
    std::vector<BuildRow> rows;
    if (std::optional<Error> error = measure_builds(mesh, options, rows)) return error;
    for (const BuildRow& row : rows)
        csv.add(row.triangles, row.threads == 1 ? "build" : "build all",
                row.setting.starts_with("Embree") ? row.setting : "Steradian " + row.setting, 1e3 * row.seconds.median,
                1e3 * row.seconds.lowest, 1e3 * row.seconds.highest);
    return {};
}

}  // namespace

std::optional<Error> study_sizes(const Options& options) {
    std::ofstream file(options.study);
    if (!file) return make_error(ErrorCode::resources, options.study + ": cannot be written");
    Csv csv(file);
    const std::vector<size_t> counts = {1'000,   3'000,     10'000,    30'000,    100'000,
                                        300'000, 1'000'000, 3'000'000, 10'000'000};
    for (const size_t count : counts) {
        if (options.quick && count > 100'000) break;
        const BenchMesh mesh = bumpy_sphere(count);
        fmt::print(stderr, "{} triangles\n", mesh.triangles());
        const Result<Accel> ours = build_ours(mesh, our_settings()[0]);
        if (!ours) return ours.error();
        study_rays(mesh, *ours, options, csv);
        if (std::optional<Error> error = study_builds_of(mesh, options, csv)) return error;
    }
    file.close();
    if (!file) return make_error(ErrorCode::resources, options.study + ": cannot be written");
    return {};
}

}  // namespace steradian::bench
