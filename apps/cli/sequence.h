// Pictures in a row: the frames of an animation, or a model turned in steps; each goes to a file with its number.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "settings_options.h"

namespace steradian::cli {

struct SequenceOptions {
    std::string frames;             ///< "1:24"; empty: none
    std::optional<double> fps;      ///< frames a second
    std::optional<uint32_t> turns;  ///< pictures of a whole turn
};
void add_sequence_options(CLI::App* c, SequenceOptions& options);

/// One of them. Alone it is the picture of --frame-time or --turn.
struct Shot {
    uint32_t number = 0;
    std::optional<double> time;  ///< seconds
    std::optional<double> turn;  ///< degrees

    /// "frame 12, 0.5 s (3 of 10)"
    std::string describe(size_t which, size_t count) const;
};

/// Empty where one picture is wanted. Fails where options contradict each other.
Result<std::vector<Shot>> parse_sequence(const SequenceOptions& options, const SettingsOptions& settings);

/// The options of that picture alone.
SettingsOptions settings_of(const Shot& shot, const SettingsOptions& settings);

/// A file's name with a number in it: in place of the last run of '#', with at least as many digits, or else as _0012
/// before the extension.
std::string numbered(const std::string& path, uint32_t number);

}  // namespace steradian::cli
