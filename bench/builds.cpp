#include "builds.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "base/parallel.h"
#include "clock.h"
#include "counting_new.h"
#include "embree.h"
#include "ours.h"

namespace steradian::bench {
namespace {

struct Built {
    double seconds = 0;
    int64_t bytes = 0, counted = 0, peak = 0;
};

struct Builder {
    std::string name;
    std::function<Result<Built>(uint32_t threads)> build;
};

Builder our_builder(const BenchMesh& mesh, const OurSetting& setting) {
    return {setting.name, [&](uint32_t threads) -> Result<Built> {
                std::optional<Error> error;
                Built built;
                double (*const clock)() = threads == 1 ? process_seconds : wall_seconds;
                with_threads(threads, [&] {
                    reset_memory_use();
                    const double started = clock();
                    const Result<Accel> accel = build_ours(mesh, setting);
                    built.seconds = clock() - started;
                    if (!accel)
                        error = accel.error();
                    else
                        built.bytes = static_cast<int64_t>(accel->statistics().bytes);
                    built.counted = memory_use().held;
                    built.peak = memory_use().peak;
                });
                if (error) return *error;
                return built;
            }};
}

Builder embree_builder(const BenchMesh& mesh, const std::string& name, const EmbreeBuild& build) {
    return {name, [&mesh, build](uint32_t threads) -> Result<Built> {
                const EmbreeScene scene(mesh, build, threads);
                return Built{threads == 1 ? scene.cpu_build_seconds() : scene.wall_build_seconds(), scene.bytes(),
                             scene.bytes(), scene.peak_bytes()};
            }};
}

}  // namespace

std::optional<Error> measure_builds(const BenchMesh& mesh, const Options& options, std::vector<BuildRow>& rows) {
    std::vector<Builder> builders;
    for (const OurSetting& setting : our_settings())
        if (options.builds.empty() ||
            std::find(options.builds.begin(), options.builds.end(), setting.name) != options.builds.end())
            builders.push_back(our_builder(mesh, setting));
    if (!options.only_ours) {
        // With the instruction set that Embree itself chooses.
        builders.push_back(embree_builder(mesh, "Embree medium", {"default", false, false}));
        builders.push_back(embree_builder(mesh, "Embree high", {"default", true, false}));
    }
    std::vector<uint32_t> thread_counts = {1};
    if (hardware_threads() > 1) thread_counts.push_back(hardware_threads());
    for (const uint32_t threads : thread_counts) {
        fmt::print(stderr, "{}: builds on {} threads\n", mesh.name, threads);
        std::vector<std::vector<double>> times(builders.size());
        std::vector<Built> last(builders.size());
        for (int repetition = 0; repetition < options.build_repetitions; ++repetition)
            for (size_t i = 0; i < builders.size(); ++i) {
                const size_t b = (i + size_t(repetition)) % builders.size();
                const Result<Built> built = builders[b].build(threads);
                if (!built) return built.error();
                times[b].push_back(built->seconds);
                last[b] = *built;
            }
        for (size_t b = 0; b < builders.size(); ++b)
            rows.push_back({mesh.name, mesh.triangles(), threads, builders[b].name, spread_of(times[b]), last[b].bytes,
                            last[b].counted, last[b].peak});
    }
    return {};
}

}  // namespace steradian::bench
