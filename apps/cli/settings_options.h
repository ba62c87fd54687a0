// What the command line says about the picture: options that `render` and `replay` share.
#pragma once

#include <optional>
#include <string>

#include "command.h"
#include "steradian/load.h"
#include "steradian/render.h"

namespace steradian::cli {

inline constexpr uint32_t kMaxThreads = 1024;

struct SettingsOptions {
    std::optional<uint64_t> spp, seed;
    std::optional<uint32_t> max_depth, roulette_depth;
    std::optional<float> clamp, ao_distance, target_error;
    std::string size, camera, integrator, light_sampling, light_choice, filter, sampler, crop;
    std::string environment;
    std::optional<double> environment_rotation, environment_scale;
    bool allow_outside_paths = false;
    std::optional<uint64_t> gltf_memory;  ///< MiB
    std::string variant, light_units, animation;
    std::optional<double> frame_time;  ///< seconds
    std::optional<double> turn;        ///< degrees
    std::string aovs;                  ///< an option of `render` alone
};
void add_settings_options(CLI::App* c, SettingsOptions& options);
/// Of these, the one that lint has as well.
CLI::Option* add_variant_option(CLI::App* c, SettingsOptions& options);

/// The same, read. It wins over what the scene says.
struct Overrides {
    std::optional<uint32_t> width, height;
    std::optional<Crop> crop;
    bool whole = false;  ///< --crop all
    std::optional<Filter> filter;
    std::optional<AovSet> aovs;
};

/// Whole numbers between separators, exactly `count` of them.
std::optional<std::vector<uint32_t>> parse_numbers(std::string_view text, char separator, size_t count);

/// How the scene is to be loaded. Refuses options that have no effect on files of its kind.
Result<LoadOptions> load_options(const SettingsOptions& options, const std::string& scene);

/// Parses, and refuses what no scene could make right: loading one may take long.
Result<Overrides> parse_overrides(const SettingsOptions& options, const Execution& execution);

/// The scene's settings with the command line's, checked before anything is derived from the scene. Refuses options for
/// what the scene lacks.
Result<RenderSettings> settings_for(const SettingsOptions& options, const Overrides& said, const LoadedScene& loaded);

/// The command that replays a sample of a picture that was rendered with these options.
std::string replay_command(const std::string& scene, const SettingsOptions& options, const PixelSample& sample);

}  // namespace steradian::cli
