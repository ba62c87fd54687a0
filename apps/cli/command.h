// What the subcommands share.
#pragma once

#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include "steradian/result.h"

namespace steradian::cli {

/// docs/conventions.md, "exit codes". `diff` has its own: 0 same within the bound, 1 different, 2 trouble.
enum ExitCode : int {
    kDone = 0,
    kRenderFailed = 1,
    kUsage = 2,
    kBadInput = 3,
    kResources = 4,
    kInterrupted = 130,
    kTerminated = 143,
};

int exit_code(ErrorCode code);
/// Prints the error to standard error and returns its exit code.
int report(const Error& error);
void report(const Diagnostics& diagnostics);

/// Every subcommand registers itself and, when chosen, leaves what is to be run in `action`.
using Action = std::function<int()>;
void add_render(CLI::App& app, Action& action);
void add_info(CLI::App& app, Action& action);
void add_convert(CLI::App& app, Action& action);
void add_diff(CLI::App& app, Action& action);

}  // namespace steradian::cli
