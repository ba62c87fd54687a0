// Ray throughput and build times beside Embree: the same meshes, the same recorded rays, in one process. Repetitions
// are interleaved (each engine once, then each again) and medians taken, because machines are shared and warm up; only
// ratios within one run mean much.
//
//     accel_bench [--repetitions N] [--size PIXELS] [MESH.ply | MESH.ply:SUBDIVISIONS]...
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <string_view>

#include "base/parallel.h"
#include "embree_scene.h"
#include "workload.h"

namespace steradian::bench {
namespace {

struct Options {
    int repetitions = 5;
    uint32_t size = 512;
    std::vector<std::string> meshes;
};

using Trace = std::function<void(std::span<const Ray>, std::span<Hit>)>;
using Occlude = std::function<void(std::span<const Ray>, std::span<uint8_t>)>;

struct Engine {
    std::string name;
    Trace intersect;
    Occlude occluded;
    std::function<double(uint32_t threads)> build;  ///< seconds
};

double clock_seconds(clockid_t clock) {
    timespec now;
    clock_gettime(clock, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

double seconds(uint32_t threads, const std::function<void()>& work) {
    const clockid_t clock = threads == 1 ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC;
    const double started = clock_seconds(clock);
    work();
    return clock_seconds(clock) - started;
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

struct Answers {
    std::vector<Hit> hits;
    std::vector<uint8_t> occluded;
};

void trace(const Engine& engine, const RaySet& set, Answers& answers, uint32_t threads) {
    const auto chunk = [&](size_t begin, size_t end) {
        const std::span<const Ray> rays = std::span(set.rays).subspan(begin, end - begin);
        if (set.any_hit) {
            engine.occluded(rays, std::span(answers.occluded).subspan(begin, end - begin));
        } else {
            engine.intersect(rays, std::span(answers.hits).subspan(begin, end - begin));
        }
    };
    if (threads == 1) return chunk(0, set.rays.size());
    with_threads(threads, [&] { parallel_for(set.rays.size(), 4096, chunk); });
}

/// A hit more or less, or a t that differs by more than 1e-4 of itself.
size_t disagreements(const RaySet& set, const Answers& a, const Answers& b) {
    size_t count = 0;
    for (size_t i = 0; i < set.rays.size(); ++i) {
        if (set.any_hit) {
            count += a.occluded[i] != b.occluded[i];
        } else if (a.hits[i].found() != b.hits[i].found()) {
            ++count;
        } else if (a.hits[i].found()) {
            count += std::fabs(a.hits[i].t - b.hits[i].t) > 1e-4f * std::fabs(a.hits[i].t);
        }
    }
    return count;
}

void measure_rays(const BenchMesh& mesh, const std::vector<Engine>& engines, const RaySet& set, uint32_t threads,
                  int repetitions) {
    std::vector<std::vector<double>> times(engines.size());
    std::vector<Answers> answers(engines.size(),
                                 {std::vector<Hit>(set.rays.size()), std::vector<uint8_t>(set.rays.size())});
    for (int r = 0; r < repetitions; ++r)
        for (size_t e = 0; e < engines.size(); ++e)
            times[e].push_back(seconds(threads, [&] { trace(engines[e], set, answers[e], threads); }));
    std::string row = fmt::format("| {} | {} | {} |", mesh.name, set.name, threads);
    const double ours = median(times[0]);
    for (size_t e = 0; e < engines.size(); ++e)
        row += fmt::format(" {:.2f} |", double(set.rays.size()) / median(times[e]) / 1e6);
    for (size_t e = 1; e < engines.size(); ++e) row += fmt::format(" {:.2f} |", median(times[e]) / ours);
    for (size_t e = 1; e < engines.size(); ++e) row += fmt::format(" {} |", disagreements(set, answers[0], answers[e]));
    fmt::print("{} {} |\n", row, set.rays.size());
}

void measure_build(const BenchMesh& mesh, const std::vector<Engine>& engines, uint32_t threads, int repetitions) {
    std::vector<std::vector<double>> times(engines.size());
    for (int r = 0; r < repetitions; ++r)
        for (size_t e = 0; e < engines.size(); ++e) times[e].push_back(engines[e].build(threads));
    std::string row = fmt::format("| {} | {} | {} |", mesh.name, mesh.triangles(), threads);
    for (const auto& t : times) row += fmt::format(" {:.0f} |", 1e3 * median(t));
    fmt::print("{}\n", row);
}

Result<Accel> build(const BenchMesh& mesh, BvhBuilder builder) {
    const Geometry geometry = mesh.geometry();
    const GeometryInstance instance;
    AccelOptions options;
    options.builder = builder;
    return Accel::build({&geometry, 1}, {&instance, 1}, options);
}

Engine steradian_engine(const BenchMesh& mesh, const Accel& accel, BvhBuilder builder) {
    Engine engine;
    engine.name = builder == BvhBuilder::sah ? "Steradian" : "Steradian median";
    engine.intersect = [&accel](std::span<const Ray> rays, std::span<Hit> hits) { accel.intersect(rays, hits); };
    engine.occluded = [&accel](std::span<const Ray> rays, std::span<uint8_t> out) { accel.occluded(rays, out); };
    engine.build = [&mesh, builder](uint32_t threads) {
        return seconds(threads, [&] { with_threads(threads, [&] { (void)build(mesh, builder); }); });
    };
    return engine;
}

Engine embree_engine(const BenchMesh& mesh, const EmbreeScene& scene, bool robust) {
    Engine engine;
    engine.name = robust ? "Embree robust" : "Embree";
    engine.intersect = [&scene](std::span<const Ray> rays, std::span<Hit> hits) { scene.intersect(rays, hits); };
    engine.occluded = [&scene](std::span<const Ray> rays, std::span<uint8_t> out) { scene.occluded(rays, out); };
    engine.build = [&mesh, robust](uint32_t threads) {
        return seconds(threads, [&] { EmbreeScene(mesh, robust, threads); });
    };
    return engine;
}

/// Prints the rows of one mesh into the tables that are open.
int measure(const BenchMesh& mesh, const Options& options, bool builds) {
    const uint32_t all = hardware_threads();
    Result<Accel> sah = build(mesh, BvhBuilder::sah);
    Result<Accel> by_median = build(mesh, BvhBuilder::median);
    if (!sah || !by_median) {
        fmt::print(stderr, "{}: {}\n", mesh.name, (sah ? by_median : sah).error().str());
        return 1;
    }
    const EmbreeScene plain(mesh, false, 0), robust(mesh, true, 0);
    const std::vector<Engine> engines = {steradian_engine(mesh, *sah, BvhBuilder::sah),
                                         embree_engine(mesh, plain, false), embree_engine(mesh, robust, true),
                                         steradian_engine(mesh, *by_median, BvhBuilder::median)};
    const std::vector<uint32_t> thread_counts = all > 1 ? std::vector<uint32_t>{1, all} : std::vector<uint32_t>{1};
    for (const uint32_t threads : thread_counts) {
        if (builds) {
            measure_build(mesh, engines, threads, options.repetitions);
        } else {
            for (const RaySet& set : record_rays(*sah, mesh, options.size))
                measure_rays(mesh, engines, set, threads, options.repetitions);
        }
    }
    if (builds) {
        const AccelStatistics& s = sah->statistics();
        fmt::print(stderr, "{}: {} nodes, {} leaves, depth {}, {:.1f} bytes a triangle\n", mesh.name, s.nodes, s.leaves,
                   s.depth, double(s.bytes) / double(mesh.triangles()));
    }
    return 0;
}

int run(const Options& options) {
    std::vector<BenchMesh> meshes;
    for (const std::string& argument : options.meshes) {
        Result<BenchMesh> mesh = load_mesh(argument);
        if (!mesh) {
            fmt::print(stderr, "{}\n", mesh.error().str());
            return 3;
        }
        meshes.push_back(std::move(*mesh));
    }
    if (meshes.empty()) meshes = generated_meshes();

    fmt::print(
        "Millions of rays per second; times the rate of Embree, of Embree robust, of our own median builder; rays "
        "that differ from each of the three.\n\n");
    fmt::print(
        "| mesh | rays | threads | Steradian | Embree | Embree robust | median | ÷ Embree | ÷ robust | ÷ median | "
        "differ | differ robust | differ median | of |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const BenchMesh& mesh : meshes)
        if (const int status = measure(mesh, options, false)) return status;
    fmt::print(
        "\nBuild, milliseconds.\n\n| mesh | triangles | threads | Steradian | Embree | Embree robust | median |\n"
        "|---|---|---|---|---|---|---|\n");
    for (const BenchMesh& mesh : meshes)
        if (const int status = measure(mesh, options, true)) return status;
    return 0;
}

}  // namespace
}  // namespace steradian::bench

int main(int argc, char** argv) {
    steradian::bench::Options options;
    for (int i = 1; i < argc; ++i) {
        const std::string_view word = argv[i];
        if (word == "--repetitions" && i + 1 < argc) {
            options.repetitions = std::max(1, std::atoi(argv[++i]));
        } else if (word == "--size" && i + 1 < argc) {
            options.size = static_cast<uint32_t>(std::clamp(std::atoi(argv[++i]), 1, 8192));
        } else if (word.starts_with("-")) {
            fmt::print(stderr, "usage: accel_bench [--repetitions N] [--size PIXELS] [MESH | MESH:SUBDIVISIONS]...\n");
            return 2;
        } else {
            options.meshes.emplace_back(word);
        }
    }
    return steradian::bench::run(options);
}
