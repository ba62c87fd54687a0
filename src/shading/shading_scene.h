// What shading may see: the scene's data and the tables that are derived from it. Immutable once made.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "math/transform.h"
#include "shading/dispersion.h"
#include "shading/interior.h"
#include "shading/light/emitter.h"
#include "shading/light_selection.h"
#include "steradian/result.h"
#include "steradian/scene.h"

namespace steradian {

struct OpenPbrTables;    // what the layers of such a material reflect, see open_pbr_tables.h
struct MipMap;           // an image at lower resolutions, see mip_map.h
class EnvironmentTable;  // the environment's radiance and its sampling distribution, see environment.h

inline constexpr uint32_t kNoLight = 0xffffffffu;
inline constexpr uint32_t kNoRelief = 0xffffffffu;

/// The axes of a goniometric light, unit and at right angles: vertical angle 0, horizontal angle 0 and 90 degrees.
struct LightAxes {
    Vec3d down{0, -1, 0}, zero{1, 0, 0}, quarter{0, 0, -1};
};

struct ShadingScene {
    Scene scene;

    struct TransformData {
        Affine object_from_world;
        bool identity = true;
        bool flips = false;  ///< the transform mirrors: orientation by winding turns around
        /// (|M| |M⁻¹|)² row by row, M the linear part of world_from_object: how much the rounding errors of going to
        /// the object's space and back are magnified at most.
        std::array<double, 9> round_trip{1, 0, 0, 0, 1, 0, 0, 0, 1};
    };
    struct InstanceData {
        uint32_t transform = 0;          ///< index into transforms
        uint32_t area_light = kNoLight;  ///< index into scene.lights
    };
    std::vector<InstanceData> instances;
    std::vector<TransformData> transforms{1};  ///< the identity, which all that have it share, then one per instance
    const TransformData& transform_of(uint32_t instance) const { return transforms[instances[instance].transform]; }

    struct LightData {
        double area = 0;                      ///< world-space, of the whole light; 0 for lights that are no area lights
        Emitter emitter;                      ///< for area lights: the surface in world space
        double mean_texture = 1;              ///< for area lights: TextureMeans::whole
        Vec3d direction;                      ///< for spots and directional lights: where they point, unit length
        double cos_inner = 1, cos_outer = 1;  ///< for spots
        LightAxes axes;                       ///< for goniometric lights
        double one_minus_cos = 0;             ///< for directional lights: of half the angular diameter
        Rgb radiance;                         ///< for directional lights with an angular diameter
        bool of_material = false;             ///< an area light that emits what its material does (emission.h)
    };
    std::vector<LightData> lights;
    LightSelection light_selection;  ///< how one of them is chosen

    struct NestedEnergy {
        float outer_index = 1;  ///< of what is around the body
        std::shared_ptr<const MicrofacetEnergy> energy;
    };
    /// What follows from a material alone; empty where its kind needs nothing.
    struct MaterialData {
        std::shared_ptr<const MicrofacetEnergy> energy;
        Rgb mean_fresnel;  ///< of metals with a complex index
        std::shared_ptr<const OpenPbrTables> open_pbr;
        uint32_t relief = kNoRelief;           ///< index into scene.reliefs
        bool cut_out = false;                  ///< surfaces of it may let rays pass (opacity.h)
        GlassIndex glass;                      ///< of a GlassMaterial
        bool disperses = false;                ///< surfaces of it may (bsdf.h)
        std::optional<Dielectric> dielectric;  ///< of what its surfaces enclose; of a mix that of the first such part
        /// Of rough dielectrics with a priority, where they border on others: `energy`, or of OpenPBR that of the
        /// glass.
        std::vector<NestedEnergy> nested;
    };
    std::vector<MaterialData> materials;  ///< parallel to scene.materials

    /// Parallel to scene.textures, empty where a texture has none; no elements at all where none has one.
    std::vector<std::shared_ptr<const MipMap>> mip_maps;
    /// Whether anything is looked up by how much of the surface a ray sees.
    bool uses_footprints() const { return !mip_maps.empty(); }

    uint32_t environment_light = kNoLight;
    std::vector<uint32_t> suns;    ///< directional lights with an angular diameter, ascending
    bool hides_instances = false;  ///< there is an area light that is not visible to the camera
    bool has_cut_outs = false;     ///< there is an instance of a material that is one
    bool is_cut_out(uint32_t instance) const { return materials[index(scene.instances[instance].material)].cut_out; }
    /// There is a body that absorbs, or one with a priority: paths keep track of what they are in.
    bool has_interiors = false;
    uint32_t material_of(uint32_t instance) const { return index(scene.instances[instance].material); }
    /// Null where the instance bounds no dielectric body.
    const Dielectric* dielectric(uint32_t instance) const {
        const auto& body = materials[material_of(instance)].dielectric;
        return body ? &*body : nullptr;
    }
    /// Whether the boundary may be one that is not there.
    bool has_priority(uint32_t instance) const {
        const Dielectric* body = dielectric(instance);
        return body && body->priority;
    }
    std::shared_ptr<const EnvironmentTable> environment;
    std::shared_ptr<const WavelengthSampler> wavelengths;  ///< null where no instance disperses
};

/// The scene must have passed validate() (scene/validate.h). Fails with `resources` when memory runs out. Texels that
/// are not finite (in environments also negative ones), which read as 0, are one counted warning per image.
Result<ShadingScene> make_shading_scene(Scene scene, Diagnostics& diagnostics);

}  // namespace steradian
