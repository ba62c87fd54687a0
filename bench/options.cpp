#include "options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <functional>

#include "base/text.h"
#include "embree.h"
#include "ours.h"

namespace steradian::bench {
namespace {

struct Option {
    std::string_view name, argument, help;
    std::function<std::optional<Error>(Options&, const std::string&)> set;
};

Error usage(std::string message, std::string hint = {}) {
    return make_error(ErrorCode::usage, std::move(message), std::move(hint));
}

template <class T>
auto number(T Options::*field, T lowest, T highest) {
    return [=](Options& options, const std::string& word) -> std::optional<Error> {
        T value = 0;
        const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error == std::errc() && stop == word.data() + word.size() && value >= lowest && value <= highest) {
            options.*field = value;
            return {};
        }
        return usage(
            fmt::format("'{}': a whole number from {} to {} is expected", escape_for_display(word), lowest, highest));
    };
}

auto flag(bool Options::*field) {
    return [=](Options& options, const std::string&) -> std::optional<Error> {
        options.*field = true;
        return {};
    };
}

auto text(std::string Options::*field) {
    return [=](Options& options, const std::string& word) -> std::optional<Error> {
        if (word.empty()) return usage("a file name is expected");
        options.*field = word;
        return {};
    };
}

/// Names separated by commas, each of which must be known.
auto names(std::vector<std::string> Options::*field, std::vector<std::string> (*known)()) {
    return [=](Options& options, const std::string& word) -> std::optional<Error> {
        const std::vector<std::string> all = known();
        for (size_t begin = 0; begin <= word.size();) {
            const size_t end = std::min(word.find(',', begin), word.size());
            const std::string name = word.substr(begin, end - begin);
            if (std::find(all.begin(), all.end(), name) == all.end()) {
                const std::vector<std::string_view> candidates(all.begin(), all.end());
                return usage(fmt::format("there is no '{}'", escape_for_display(name)), suggestion(name, candidates));
            }
            (options.*field).push_back(name);
            begin = end + 1;
        }
        return {};
    };
}

std::vector<std::string> our_names() {
    std::vector<std::string> all;
    for (const OurSetting& setting : our_settings()) all.push_back(setting.name);
    return all;
}

const std::vector<Option>& table() {
    static const std::vector<Option> options = {
        {"--quick", "", "a short run to see that it works; its figures are noise", flag(&Options::quick)},
        {"--mesh", "MESH", "a generated mesh by name, or a file; again for more",
         [](Options& o, const std::string& word) -> std::optional<Error> {
             o.meshes.push_back(word);
             return {};
         }},
        {"--rays", "NAMES", "only these ray sets", names(&Options::rays, [] { return ray_set_names(); })},
        {"--ours", "NAMES", "trace with these settings of ours (the first listed)", names(&Options::ours, our_names)},
        {"--parts", "NAMES", "only these parts: rays, threads, trees, build",
         names(&Options::parts, [] { return part_names(); })},
        {"--size", "PIXELS", "side of the picture whose rays are recorded (512)",
         number<uint32_t>(&Options::size, 8, 8192)},
        {"--chunk", "RAYS", "rays handed over in one call (4096)", number<uint32_t>(&Options::chunk, 1, 1u << 20)},
        {"--repetitions", "N", "of every ray measurement (7)", number<int>(&Options::repetitions, 1, 1000)},
        {"--build-repetitions", "N", "of every build (3)", number<int>(&Options::build_repetitions, 1, 1000)},
        {"--trials", "N", "repetitions with which each setting of Embree is tried (3)",
         number<int>(&Options::trials, 1, 1000)},
        {"--builds", "NAMES", "build with these settings of ours (all)", names(&Options::builds, our_names)},
        {"--only-ours", "", "leave Embree out", flag(&Options::only_ours)},
        {"--json", "FILE", "write every figure there as well", text(&Options::json)},
        {"--study", "FILE", "instead: rays per second and build times over triangle counts, as CSV for plot.py",
         text(&Options::study)},
        {"--list", "", "say which meshes, ray sets and settings there are", flag(&Options::list)},
        {"--help", "", "say this", flag(&Options::help)}};
    return options;
}

std::optional<Error> set_option(Options& options, const std::vector<std::string>& words, size_t& at) {
    const std::string& word = words[at];
    for (const Option& option : table()) {
        if (option.name != word) continue;
        std::string argument;
        if (!option.argument.empty()) {
            if (at + 1 == words.size()) return usage(fmt::format("{} needs {}", word, option.argument));
            argument = words[++at];
        }
        std::optional<Error> error = option.set(options, argument);
        if (error) error->message = word + ": " + error->message;
        return error;
    }
    std::vector<std::string_view> known;
    for (const Option& option : table()) known.push_back(option.name);
    return usage(fmt::format("there is no option '{}'", escape_for_display(word)), suggestion(word, known));
}

void set_defaults(Options& o) {
    const auto unset = [](auto& field, auto value) {
        if (field == 0) field = value;
    };
    unset(o.repetitions, o.quick ? 3 : 7);
    unset(o.build_repetitions, o.quick ? 1 : 3);
    unset(o.trials, o.quick ? 2 : 3);
    unset(o.size, o.quick ? 128u : 512u);
    o.trial_chunks = std::max(1u, (o.quick ? 8192u : 65536u) / o.chunk);
    if (o.meshes.empty() && o.quick) o.meshes = {"sphere"};
    if (o.meshes.empty())
        for (const NamedMesh& mesh : generated_meshes()) o.meshes.push_back(mesh.name);
    if (o.ours.empty()) o.ours = {our_settings()[0].name};
}

}  // namespace

bool Options::has_part(const std::string& name) const {
    return parts.empty() || std::find(parts.begin(), parts.end(), name) != parts.end();
}

const std::vector<std::string>& part_names() {
    static const std::vector<std::string> parts = {"rays", "threads", "trees", "build"};
    return parts;
}

std::string help_text() {
    std::string text =
        "usage: accel_bench [OPTION]... [MESH]...\n\n"
        "Ray throughput, build times and memory beside Embree: the same meshes and the same recorded rays, in one\n"
        "process. MESH is a generated mesh by its name, or an OBJ or PLY file; \"model.ply:1\" divides every triangle\n"
        "into four once. Every setting of Embree is tried briefly for each kind of ray; the best few, and the best\n"
        "few robust ones, are then measured in repetitions that alternate with ours. Only ratios of one run mean\n"
        "much.\n\n";
    for (const Option& option : table())
        text += fmt::format("  {:<24} {}\n", fmt::format("{} {}", option.name, option.argument), option.help);
    return text;
}

std::string list_text() {
    std::string text = "meshes:\n";
    for (const NamedMesh& mesh : generated_meshes()) text += fmt::format("  {:<16} {}\n", mesh.name, mesh.description);
    text += fmt::format("ray sets: {}\n", fmt::join(ray_set_names(), ", "));
    text += fmt::format("our settings: {}\n", fmt::join(our_names(), ", "));
    text += fmt::format("parts: {}\n", fmt::join(part_names(), ", "));
    return text + fmt::format("instruction sets of Embree: {}\n", fmt::join(embree_isas(), ", "));
}

Result<Options> parse_options(const std::vector<std::string>& words) {
    Options options;
    for (size_t i = 0; i < words.size(); ++i) {
        if (!words[i].starts_with("-")) {
            options.meshes.push_back(words[i]);
        } else if (std::optional<Error> error = set_option(options, words, i)) {
            return *error;
        }
    }
    set_defaults(options);
    return options;
}

}  // namespace steradian::bench
