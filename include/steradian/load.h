// From files to a Scene.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "steradian/image.h"
#include "steradian/result.h"
#include "steradian/scene.h"
#include "steradian/settings.h"

namespace steradian {

struct LoadOptions {
    uint64_t max_file_bytes = uint64_t(4) << 30;  ///< of one file
    ImageLimits images{};
    uint32_t max_depth = 256;  ///< of nested JSON
    /// Assets may be named by absolute paths or leave the scene's folder through "..".
    bool allow_outside_paths = true;
};

/// What a file says: the scene, and the settings that it asks for (defaults where it is silent).
struct LoadedScene {
    Scene scene;
    RenderSettings settings;
    Diagnostics diagnostics;
    /// Every file that was read, the scene itself first: outputs must not be among them.
    std::vector<std::string> files;
};

/// By extension: .json (Steradian's own format and the course vocabulary), .obj, .ply. A bare model gets a camera that
/// frames it and a neutral studio light.
Result<LoadedScene> load_scene(const std::string& path, const LoadOptions& options = {});

/// A JSON scene from memory; relative paths resolve against `base_folder`. `name` stands for the file in messages.
Result<LoadedScene> load_scene_json(std::string_view text, const std::string& name, const std::string& base_folder,
                                    const LoadOptions& options = {});

}  // namespace steradian
