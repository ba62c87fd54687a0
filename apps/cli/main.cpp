// The steradian command: picks the subcommand, maps every failure to its exit code.
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/text.h"
#include "command.h"
#include "steradian/version.h"

namespace steradian::cli {
namespace {

constexpr const char* kAbout =
    "Steradian renders 3D scenes on the CPU. The same scene, settings and seed give the same bits on every machine,\n"
    "with any number of threads.";

constexpr const char* kExamples =
    "Examples:\n"
    "  steradian render scene.json -o picture.png            render with the settings of the scene\n"
    "  steradian render model.obj --spp 256 --size 1920x1080 a bare model gets a camera and a studio light\n"
    "  steradian render scene.json -o a.exr -o a.png --json  two files, statistics on standard output\n"
    "  steradian render model.glb --frames 1:48 -o f.####.png frames of an animation, each to its own file\n"
    "  steradian render model.glb --turntable 36             the model turned once, in 36 pictures\n"
    "  steradian replay scene.json --pixel 12,34 --sample 5  how one sample of one pixel came to its value\n"
    "  steradian info scene.json                             what is in a scene, or in a picture\n"
    "  steradian lint scene.json                             mistakes in a scene: open glass, lights in walls, …\n"
    "  steradian convert a.exr a.png --view agx              from linear light to something to look at\n"
    "  steradian diff a.exr b.exr                            how far two pictures are apart\n"
    "\n"
    "Each command has its own help: steradian render --help\n"
    "Exit codes: 0 done, 1 render failed, 2 usage, 3 bad scene or image, 4 disk, memory or a limit, 129/130/143 "
    "stopped.";

/// CLI11 would only say that a subcommand is required.
std::optional<Error> unknown_command(const CLI::App& app, std::string_view word) {
    if (word.starts_with('-')) return std::nullopt;
    std::vector<std::string_view> names;
    for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
    if (std::find(names.begin(), names.end(), word) != names.end()) return std::nullopt;
    return make_error(ErrorCode::usage, "unknown command '" + escape_for_display(word) + "'", suggestion(word, names));
}

/// "did you mean '--spp'?" for the first option that a command does not have; empty when none is close.
std::string option_hint(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    const std::vector<std::string_view> known(names.begin(), names.end());
    for (const std::string& word : command.remaining()) {
        if (!word.starts_with("--")) continue;
        const auto match = closest_match(word.substr(0, word.find('=')), known);
        return match ? "did you mean '" + *match + "'?" : std::string();
    }
    return {};
}

/// The arguments may hold foreign bytes, and CLI11 repeats them as they are.
Error wrong_arguments(const CLI::App& app, const CLI::ParseError& e) {
    if (const auto* wrong = dynamic_cast<const WrongText*>(&e))
        return usage_error(escape_for_display(e.what(), 4096), wrong->hint);
    const auto chosen = app.get_subcommands();
    if (!chosen.empty())
        if (std::string hint = option_hint(*chosen.front()); !hint.empty())
            return usage_error(escape_for_display(e.what(), 4096), std::move(hint));
    const std::string name = chosen.empty() ? "" : chosen.front()->get_name() + " ";
    return usage_error(escape_for_display(e.what(), 4096), "steradian " + name + "--help shows what there is");
}

int run(int argc, char** argv) {
    CLI::App app{kAbout, "steradian"};
    app.footer(kExamples);
    app.set_version_flag("--version", std::string("steradian ") + STERADIAN_VERSION, "Show the version");
    app.require_subcommand(1);
    Action action;
    add_render(app, action);
    add_replay(app, action);
    add_info(app, action);
    add_lint(app, action);
    add_convert(app, action);
    add_diff(app, action);
    if (argc <= 1) {
        std::cout << app.help();
        return kUsage;
    }
    // `steradian help` and `steradian help render` are what many type first.
    std::vector<std::string> arguments(argv + 1, argv + argc);
    if (arguments[0] == "help") arguments.erase(arguments.begin()), arguments.emplace_back("--help");
    if (const auto wrong = unknown_command(app, arguments[0])) return report(*wrong);
    try {
        std::reverse(arguments.begin(), arguments.end());  // as CLI11 takes a vector
        app.parse(std::move(arguments));
    } catch (const CLI::ParseError& e) {
        if (e.get_exit_code() != 0) return report(wrong_arguments(app, e));
        app.exit(e);  // help or version
        const Status status = finish_stdout();
        return status ? kDone : report(status.error());
    }
    return action();
}

}  // namespace
}  // namespace steradian::cli

int main(int argc, char** argv) {
    // A closed pipe or a file-size limit is an error of the write that meets it, not the end of the process.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    try {
        return steradian::cli::run(argc, argv);
    } catch (const std::bad_alloc&) {
        std::fputs("error: not enough memory\n", stderr);
        return steradian::cli::kResources;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "error: %s\n", e.what());
        return steradian::cli::kRenderFailed;
    }
}
