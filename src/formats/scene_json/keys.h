// Every key that a scene file may have, object by object. docs/scene.schema.json says the same to editors; a test
// compares the two.
#pragma once

#include <span>
#include <string_view>

#include "formats/json/reader.h"

namespace steradian::scene_json {

namespace keys {
using Key = std::string_view;

inline constexpr Key kScene[] = {"$schema", "version",  "comment",   "render", "film",    "camera",
                                 "cameras", "textures", "materials", "shapes", "objects", "lights"};
inline constexpr Key kRender[] = {"integrator",  "max_depth",      "spp",          "sampler",        "seed",
                                  "camera",      "light_sampling", "light_choice", "roulette_depth", "clamp",
                                  "ao_distance", "target_error"};
inline constexpr Key kFilm[] = {"resolution", "filter", "crop", "aovs"};
inline constexpr Key kFilter[] = {"type", "radius"};
inline constexpr Key kPerspectiveCamera[] = {
    "type",           "position",        "look_at",          "up", "vertical_fov", "aperture_radius",
    "focus_distance", "aperture_blades", "aperture_rotation"};
inline constexpr Key kOrthographicCamera[] = {"type", "position", "look_at", "up", "height"};
inline constexpr Key kPanoramaCamera[] = {"type", "position", "look_at", "up"};
inline constexpr Key kFisheyeCamera[] = {"type", "position", "look_at", "up", "fov", "projection"};

inline constexpr Key kConstantTexture[] = {"type", "color"};
inline constexpr Key kImageTexture[] = {"type", "path", "color_space", "wrap", "filter", "scale", "offset", "rotation"};
inline constexpr Key kCheckerboardTexture[] = {"type", "color0", "color1", "scale", "offset", "rotation"};

inline constexpr Key kVertexColorTexture[] = {"type"};

inline constexpr Key kDiffuse[] = {"type", "reflectance", "two_sided", "roughness", "normal_map", "bump_map"};
inline constexpr Key kRefraction[] = {"type", "eta", "normal_map", "bump_map"};
inline constexpr Key kGlass[] = {"type", "eta",      "reflectance", "transmittance", "roughness", "alpha",
                                 "abbe", "interior", "priority",    "normal_map",    "bump_map"};
inline constexpr Key kMedium[] = {"absorption", "scattering", "anisotropy"};
inline constexpr Key kMirror[] = {"type", "reflectance", "normal_map", "bump_map"};
inline constexpr Key kThinGlass[] = {"type", "eta", "transmittance", "normal_map", "bump_map"};
inline constexpr Key kDiffuseTransmission[] = {"type", "reflectance", "transmittance", "normal_map", "bump_map"};
inline constexpr Key kOpenPbr[] = {"type",
                                   "base_weight",
                                   "base_color",
                                   "base_metalness",
                                   "base_diffuse_roughness",
                                   "specular_weight",
                                   "specular_color",
                                   "specular_roughness",
                                   "specular_ior",
                                   "specular_roughness_anisotropy",
                                   "geometry_tangent",
                                   "geometry_tangent_rotation",
                                   "transmission_weight",
                                   "transmission_color",
                                   "transmission_depth",
                                   "transmission_scatter",
                                   "transmission_scatter_anisotropy",
                                   "transmission_dispersion_scale",
                                   "transmission_dispersion_abbe_number",
                                   "subsurface_weight",
                                   "subsurface_color",
                                   "subsurface_scatter_anisotropy",
                                   "fuzz_weight",
                                   "fuzz_color",
                                   "fuzz_roughness",
                                   "coat_weight",
                                   "coat_color",
                                   "coat_roughness",
                                   "coat_roughness_anisotropy",
                                   "coat_ior",
                                   "coat_darkening",
                                   "geometry_coat_normal",
                                   "thin_film_weight",
                                   "thin_film_thickness",
                                   "thin_film_ior",
                                   "emission_luminance",
                                   "emission_color",
                                   "geometry_opacity",
                                   "geometry_thin_walled",
                                   "priority",
                                   "normal_map",
                                   "bump_map"};
inline constexpr Key kConductor[] = {"type",      "metal", "n",    "k",          "reflectance", "edge_reflectance",
                                     "roughness", "alpha", "tint", "normal_map", "bump_map"};

inline constexpr Key kMix[] = {"type", "materials", "weight"};

inline constexpr Key kFilmThickness[] = {"texture", "minimum", "maximum"};
inline constexpr Key kNormalMap[] = {"texture", "strength", "flip_y"};
inline constexpr Key kBumpMap[] = {"texture", "scale"};

inline constexpr Key kMeshShape[] = {"type",      "path",    "color_space", "vertices",
                                     "triangles", "normals", "uvs",         "colors"};
inline constexpr Key kSphereShape[] = {"type", "center", "radius"};
inline constexpr Key kRectangleShape[] = {"type", "center", "half_u", "half_v"};
inline constexpr Key kDiskShape[] = {"type", "center", "normal", "radius"};

inline constexpr Key kMeshObject[] = {"type",        "name",     "material",  "transform", "light", "path",
                                      "color_space", "vertices", "triangles", "normals",   "uvs",   "colors"};
inline constexpr Key kSphereObject[] = {"type", "name", "material", "transform", "light", "center", "radius"};
inline constexpr Key kRectangleObject[] = {"type",  "name",   "material", "transform",
                                           "light", "center", "half_u",   "half_v"};
inline constexpr Key kDiskObject[] = {"type", "name", "material", "transform", "light", "center", "normal", "radius"};
inline constexpr Key kInstanceObject[] = {"type", "name", "material", "transform", "light", "shape"};
inline constexpr Key kObjectLight[] = {"type",      "radiance",      "texture",
                                       "two_sided", "light_samples", "visible_to_camera"};

inline constexpr Key kTransform[] = {"translate", "rotate", "scale", "matrix", "look_at"};
inline constexpr Key kRotate[] = {"axis", "angle"};
inline constexpr Key kLookAt[] = {"origin", "target", "up"};

inline constexpr Key kPointLight[] = {"type", "name", "position", "intensity", "flux"};
inline constexpr Key kSpotLight[] = {"type",      "name", "position",    "direction",  "look_at",
                                     "intensity", "flux", "inner_angle", "outer_angle"};
inline constexpr Key kGoniometricLight[] = {"type",    "name",     "path",      "position", "direction",
                                            "look_at", "rotation", "intensity", "flux"};
inline constexpr Key kDirectionalLight[] = {
    "type", "name", "direction", "irradiance", "angular_diameter", "visible_to_camera"};
inline constexpr Key kAreaLight[] = {"type",    "name",      "object",        "radiance",
                                     "texture", "two_sided", "light_samples", "visible_to_camera"};
inline constexpr Key kEnvironmentLight[] = {
    "type", "name", "radiance", "path", "color_space", "rotation", "scale", "light_samples", "visible_to_camera"};
}  // namespace keys

using json::ObjectSpec;

inline constexpr ObjectSpec kSceneSpec{"scene", keys::kScene};
inline constexpr ObjectSpec kRenderSpec{"render", keys::kRender};
inline constexpr ObjectSpec kFilmSpec{"film", keys::kFilm};
inline constexpr ObjectSpec kFilterSpec{"filter", keys::kFilter};
inline constexpr ObjectSpec kCameraSpecs[] = {{"perspective_camera", keys::kPerspectiveCamera},
                                              {"orthographic_camera", keys::kOrthographicCamera},
                                              {"panorama_camera", keys::kPanoramaCamera},
                                              {"fisheye_camera", keys::kFisheyeCamera}};
inline constexpr ObjectSpec kTextureSpecs[] = {{"constant_texture", keys::kConstantTexture},
                                               {"image_texture", keys::kImageTexture},
                                               {"checkerboard_texture", keys::kCheckerboardTexture},
                                               {"vertex_color_texture", keys::kVertexColorTexture}};
inline constexpr ObjectSpec kMaterialSpecs[] = {{"diffuse_material", keys::kDiffuse},
                                                {"refraction_material", keys::kRefraction},
                                                {"glass_material", keys::kGlass},
                                                {"mirror_material", keys::kMirror},
                                                {"conductor_material", keys::kConductor},
                                                {"thin_glass_material", keys::kThinGlass},
                                                {"diffuse_transmission_material", keys::kDiffuseTransmission},
                                                {"open_pbr_material", keys::kOpenPbr},
                                                {"mix_material", keys::kMix}};
inline constexpr ObjectSpec kMediumSpec{"medium", keys::kMedium};
inline constexpr ObjectSpec kFilmThicknessSpec{"film_thickness", keys::kFilmThickness};
inline constexpr ObjectSpec kNormalMapSpec{"normal_map", keys::kNormalMap};
inline constexpr ObjectSpec kBumpMapSpec{"bump_map", keys::kBumpMap};
inline constexpr ObjectSpec kShapeSpecs[] = {{"mesh_shape", keys::kMeshShape},
                                             {"sphere_shape", keys::kSphereShape},
                                             {"rectangle_shape", keys::kRectangleShape},
                                             {"disk_shape", keys::kDiskShape}};
inline constexpr ObjectSpec kObjectSpecs[] = {{"mesh_object", keys::kMeshObject},
                                              {"sphere_object", keys::kSphereObject},
                                              {"rectangle_object", keys::kRectangleObject},
                                              {"disk_object", keys::kDiskObject},
                                              {"instance_object", keys::kInstanceObject}};
inline constexpr ObjectSpec kObjectLightSpec{"object_light", keys::kObjectLight};
inline constexpr ObjectSpec kTransformSpec{"transform_step", keys::kTransform};
inline constexpr ObjectSpec kRotateSpec{"rotate", keys::kRotate};
inline constexpr ObjectSpec kLookAtSpec{"look_at", keys::kLookAt};
inline constexpr ObjectSpec kLightSpecs[] = {{"point_light", keys::kPointLight},
                                             {"spot_light", keys::kSpotLight},
                                             {"directional_light", keys::kDirectionalLight},
                                             {"area_light", keys::kAreaLight},
                                             {"environment_light", keys::kEnvironmentLight},
                                             {"goniometric_light", keys::kGoniometricLight}};

// The values of "type", in the order of the specifications above and of the enumerations that the readers use.
inline constexpr std::string_view kTextureTypes[] = {"constant", "image", "checkerboard", "vertex_color"};
inline constexpr std::string_view kMaterialTypes[] = {
    "diffuse", "refraction", "glass", "mirror", "conductor", "thin_glass", "diffuse_transmission", "open_pbr", "mix"};
inline constexpr std::string_view kShapeTypes[] = {"mesh", "sphere", "rectangle", "disk"};
inline constexpr std::string_view kObjectTypes[] = {"mesh", "sphere", "rectangle", "disk", "instance"};
inline constexpr std::string_view kLightTypes[] = {"point", "spot",        "directional",
                                                   "area",  "environment", "goniometric"};

inline constexpr std::string_view kCameraTypes[] = {"perspective", "orthographic", "panorama", "fisheye"};
inline constexpr std::string_view kFisheyeProjections[] = {"equidistant", "equisolid"};
inline constexpr std::string_view kColorSpaces[] = {"linear", "srgb"};
inline constexpr std::string_view kWraps[] = {"repeat", "clamp", "mirror", "black"};
inline constexpr std::string_view kTextureFilters[] = {"nearest", "bilinear", "trilinear"};

}  // namespace steradian::scene_json
