// From files to a Scene.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "steradian/image.h"
#include "steradian/result.h"
#include "steradian/scene.h"
#include "steradian/settings.h"

namespace steradian {

/// What shines from far away. All of it applies to scenes of every format alike.
struct EnvironmentOptions {
    struct None {};
    /// In place of what the scene has, and of the studio that a bare model gets: nothing, a constant radiance, or a
    /// latitude-longitude picture (a path that is relative to the working folder). Not set: as the scene has it.
    std::optional<std::variant<None, Rgb, std::string>> replace = std::nullopt;
    float rotation = 0;  ///< degrees about +Y, added to what the scene says; counter-clockwise seen from above
    float scale = 1;     ///< of the radiance, >= 0
};

/// How the numbers of lights in glTF files are meant: as W/sr and W/m² in place of candela and lux, or as 683 times
/// that, which is what exporters write that turn watts into lumens.
enum class GltfLightUnits : uint8_t { radiometric, photometric };

struct LoadOptions {
    /// Degrees by which the scene is turned as on a turntable: about the vertical through the middle of its bounds,
    /// counter-clockwise seen from above, before a camera that stands still and frames every angle alike (added to
    /// those of the scene, and chosen by its settings). What shines from far away and a bare model's studio stand still
    /// too.
    std::optional<double> turn = std::nullopt;
    /// Width over height of the picture, for the camera of a model that has none and for that of `turn`: their model
    /// spans the shorter side. Not set: of the scene's own settings.
    std::optional<double> aspect = std::nullopt;
    uint64_t max_file_bytes = uint64_t(4) << 30;  ///< of one file
    ImageLimits images{};
    uint32_t max_depth = 256;  ///< of nested JSON
    /// Whether assets may be named by absolute paths or leave the scene's folder through "..". Not set: as the format
    /// has it, which is not in glTF and yes in all others.
    std::optional<bool> allow_outside_paths = std::nullopt;
    EnvironmentOptions environment{};
    /// What a glTF file may make of itself, geometry and texels together, even where that is more than 256 times the
    /// bytes of it that are in use; and what may be made of none, as zeros are. At most as much again is taken for a
    /// while to decode its pictures.
    uint64_t gltf_free_bytes = uint64_t(320) << 20;
    GltfLightUnits gltf_light_units = GltfLightUnits::radiometric;
    std::string gltf_variant = {};  ///< of KHR_materials_variants, by name; empty: none
    /// Which of a glTF file's animations moves it, by name or by number from 0. Empty: the first one where a time is
    /// given, else none, so that the scene stands as the file has it.
    std::string animation = {};
    /// The moment of the animation, in seconds; before its first keyframe and after its last one it stands still. Not
    /// set: 0.
    std::optional<double> frame_time = std::nullopt;
    /// Whether LoadedScene::locations is filled, and all warnings about JSON have a JSON pointer. Takes about a hundred
    /// bytes for each element of the scene.
    bool locations = false;
};

/// Where the elements of a scene stand in its files. Empty, or beside each array of the scene a list that may be
/// shorter than that.
struct SceneLocations {
    std::string file;  ///< the scene itself; stands for an empty SourceLocation::file
    std::array<std::vector<SourceLocation>, kElementKinds> places;
    /// Elements that the reader itself has made use of: what they say stands elsewhere in the scene as well.
    std::vector<Element> consumed;

    /// The file alone for what no file says, such as the studio light of a bare model.
    SourceLocation of(Element element) const;
};

/// What a file says: the scene, and the settings that it asks for (defaults where it is silent).
struct LoadedScene {
    Scene scene;
    RenderSettings settings;
    Diagnostics diagnostics;
    /// What the file asks for and the picture will not show, or show differently.
    Diagnostics fidelity;
    /// What the file has and nothing in it uses or what changes nothing (with the rule of lint, lint.h, that says so);
    /// of glTF files looked for where LoadOptions::locations asks for that. Of what is in the scene as well, lint says
    /// it.
    Diagnostics unused = {};
    /// Where LoadOptions::locations asked for them.
    SceneLocations locations = {};
    std::vector<std::string> animations = {};  ///< their names, or "animation 3"
    std::vector<std::string> variants = {};    ///< of KHR_materials_variants, as LoadOptions::gltf_variant takes them
    /// Where a bare model was given a studio: how many elements of the scene are its own. Those behind are the studio.
    struct OwnElements {
        size_t instances, shapes, materials, textures, lights;
    };
    std::optional<OwnElements> before_studio = std::nullopt;
    /// Every file that was read, the scene itself first: outputs must not be among them.
    std::vector<std::string> files;
};

/// By extension: .json (Steradian's own format and the course vocabulary), .gltf, .glb, .obj, .ply. A model without a
/// camera gets one that frames it; where nothing but textures shines there is a neutral studio light.
Result<LoadedScene> load_scene(const std::string& path, const LoadOptions& options = {});

/// A JSON scene from memory; relative paths resolve against `base_folder`. `name` stands for the file in messages.
Result<LoadedScene> load_scene_json(std::string_view text, const std::string& name, const std::string& base_folder,
                                    const LoadOptions& options = {});

}  // namespace steradian
