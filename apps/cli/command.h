// What the subcommands share.
#pragma once

#include <rapidjson/prettywriter.h>
#include <rapidjson/stringbuffer.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "steradian/image_io.h"
#include "steradian/result.h"

namespace steradian::cli {

/// docs/conventions.md, "exit codes". `diff` has its own: 0 same within the bound, 1 different, 2 trouble. A command
/// that a signal stopped ends with 128 + its number.
enum ExitCode : int {
    kDone = 0,
    kRenderFailed = 1,
    kUsage = 2,
    kBadInput = 3,
    kResources = 4,
};

int exit_code(ErrorCode code);
/// Prints the error to standard error and returns its exit code.
int report(const Error& error);
void report(const Diagnostics& diagnostics);
/// Flushes standard output; an error when any of it could not be written. Call it after the last line.
Status finish_stdout();

// --- Options ---------------------------------------------------------------------------------------------------

Error usage_error(std::string message, std::string hint = {});

/// A whole decimal number from `lowest` to `highest`: no sign, no 0x, no exponent. Throws CLI::ValidationError, which
/// names the option.
uint64_t parse_count(const std::string& option, const std::string& text, uint64_t lowest, uint64_t highest);
/// A finite number from `lowest` to `highest`; throws as above.
double parse_real(const std::string& option, const std::string& text, double lowest, double highest);

/// An option with a whole number. `names` is as for add_option, the long name last; `value` is a T or std::optional<T>.
template <class T, class Value>
CLI::Option* add_count(CLI::App* c, const std::string& names, Value& value, T lowest, T highest,
                       const std::string& help) {
    const auto set = [&value, name = names.substr(names.rfind(',') + 1), lowest, highest](const std::string& text) {
        value = static_cast<T>(parse_count(name, text, lowest, highest));
    };
    return c->add_option_function<std::string>(names, set, help)->type_name("COUNT");
}

/// An option with a finite number from `lowest` to `highest`; `names` as above, `value` a float, double or an optional.
template <class Value>
CLI::Option* add_real(CLI::App* c, const std::string& names, Value& value, double lowest, double highest,
                      const std::string& help) {
    const auto set = [&value, name = names.substr(names.rfind(',') + 1), lowest, highest](const std::string& text) {
        value = parse_real(name, text, lowest, highest);
    };
    return c->add_option_function<std::string>(names, set, help)->type_name("FLOAT");
}

/// What an option cannot take, and what to do about it.
struct WrongText : CLI::ValidationError {
    WrongText(const std::string& option, const std::string& problem, std::string what_to_do)
        : CLI::ValidationError(option, problem), hint(std::move(what_to_do)) {}
    std::string hint;
};

/// A word that is none of those an option knows; the hint says which one may have been meant.
struct UnknownChoice : WrongText {
    UnknownChoice(const std::string& option, const std::string& word, std::span<const std::string_view> choices);
};

/// An option with a text. An empty one, as scripts pass it by mistake, is an error: it would count as not given.
/// `hint` says what could stand there.
CLI::Option* add_text(CLI::App* c, const std::string& name, std::string& value, const std::string& hint,
                      const std::string& help);

/// An option with one of `choices`; the chosen one goes to `value`, a std::string or an optional one.
template <class Value>
CLI::Option* add_choice(CLI::App* c, const std::string& name, Value& value, std::span<const std::string_view> choices,
                        const std::string& help) {
    const auto set = [&value, name, choices](const std::string& word) {
        if (std::find(choices.begin(), choices.end(), word) == choices.end()) throw UnknownChoice(name, word, choices);
        value = word;
    };
    return c->add_option_function<std::string>(name, set, help)->type_name("NAME");
}

/// How pictures are to be written; one set of options for all commands that choose it.
struct PictureOptions {
    std::optional<double> exposure;
    std::optional<std::string> view;
    bool half = false;

    ImageWriteOptions write() const;
};
void add_picture_options(CLI::App* c, PictureOptions& options, const std::string& group);

// --- Files -----------------------------------------------------------------------------------------------------

inline constexpr std::string_view kWritablePictures[] = {".exr", ".hdr", ".pfm", ".png"};

/// By the file's content where it can be read, else by its name.
bool is_picture(const std::string& path);

/// Whether two paths lead to one file, be it there already or not.
bool same_file(const std::string& a, const std::string& b);

/// Everything about outputs that can be known before the work: formats, duplicates, places, options without effect.
Status check_outputs(std::span<const std::string> outputs, const PictureOptions& options);
/// No output may replace something that was read.
Status check_not_inputs(std::span<const std::string> outputs, std::span<const std::string> inputs);

// --- JSON ------------------------------------------------------------------------------------------------------

using JsonWriter = rapidjson::PrettyWriter<rapidjson::StringBuffer>;

/// JSON is UTF-8; bytes that are not, as file names may have, appear as \xNN.
void write_text(JsonWriter& w, std::string_view text);
void write_field(JsonWriter& w, const char* key, std::string_view text);

// ---------------------------------------------------------------------------------------------------------------

/// Every subcommand registers itself and, when chosen, leaves what is to be run in `action`.
using Action = std::function<int()>;

/// A subcommand that, when chosen, leaves `run` with its options to be called. Declare its options on what this
/// returns.
template <class Options>
CLI::App* add_command(CLI::App& app, Action& action, const std::string& name, const std::string& about,
                      const std::shared_ptr<Options>& options, int (*run)(const Options&)) {
    CLI::App* c = app.add_subcommand(name, about);
    c->callback([options, run, &action] { action = [options, run] { return run(*options); }; });
    return c;
}

void add_render(CLI::App& app, Action& action);
void add_replay(CLI::App& app, Action& action);
void add_info(CLI::App& app, Action& action);
void add_lint(CLI::App& app, Action& action);
void add_convert(CLI::App& app, Action& action);
void add_diff(CLI::App& app, Action& action);

}  // namespace steradian::cli
