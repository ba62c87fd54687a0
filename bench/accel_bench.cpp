// Ray throughput, build times and memory beside Embree; `accel_bench --help` says how.
#include <fmt/format.h>

#include <exception>
#include <fstream>

#include "measure.h"
#include "study.h"

namespace steradian::bench {
namespace {

int fail(const Error& error) {
    fmt::print(stderr, "accel_bench: {}\n", error.str());
    return static_cast<int>(error.code) + 1;
}

std::optional<Error> write_file(const std::string& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    file << text;
    file.close();
    if (!file) return make_error(ErrorCode::resources, path + ": cannot be written");
    return {};
}

int measure_all(const Options& options, Report report) {
    for (const std::string& name : options.meshes) {
        const Result<BenchMesh> mesh = make_mesh(name);
        if (!mesh) return fail(mesh.error());
        fmt::print(stderr, "{}: {} triangles\n", mesh->name, mesh->triangles());
        if (const std::optional<Error> error = measure_mesh(*mesh, options, report)) return fail(*error);
    }
    print_tables(report);
    if (options.json.empty()) return 0;
    const std::optional<Error> error = write_file(options.json, to_json(report));
    return error ? fail(*error) : 0;
}

int run(const std::vector<std::string>& words) {
    const Result<Options> options = parse_options(words);
    if (!options) return fail(options.error());
    if (options->help || options->list) {
        fmt::print("{}", options->help ? help_text() : list_text());
        return 0;
    }
    if (options->study.empty()) return measure_all(*options, new_report(words));
    const std::optional<Error> error = study_sizes(*options);
    return error ? fail(*error) : 0;
}

}  // namespace
}  // namespace steradian::bench

int main(int argc, char** argv) {
    try {
        return steradian::bench::run({argv + 1, argv + argc});
    } catch (const std::exception& problem) {
        fmt::print(stderr, "accel_bench: {}\n", problem.what());
        return 4;
    }
}
