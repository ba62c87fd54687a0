// What shading may see: the scene's data and the tables that are derived from it. Immutable once made.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "math/transform.h"
#include "steradian/result.h"
#include "steradian/scene.h"

namespace steradian {

class EnvironmentTable;  // the environment's radiance and its sampling distribution, see environment.h

inline constexpr uint32_t kNoLight = 0xffffffffu;

struct ShadingScene {
    Scene scene;

    struct InstanceData {
        Affine object_from_world;
        bool identity = true;
        bool flips = false;             ///< the transform mirrors: orientation by winding turns around
        uint32_t area_light = kNoLight; ///< index into scene.lights
    };
    std::vector<InstanceData> instances;

    /// For area lights on meshes: cumulative world-space triangle areas, ascending by index; empty for other lights.
    struct LightData {
        std::vector<double> cumulative_area;
        double area = 0;                ///< world-space, of the whole light
    };
    std::vector<LightData> lights;

    uint32_t environment_light = kNoLight;
    std::shared_ptr<const EnvironmentTable> environment;
};

/// The scene must have passed validate() (scene/validate.h).
Result<ShadingScene> make_shading_scene(Scene scene, Diagnostics& diagnostics);

}  // namespace steradian
