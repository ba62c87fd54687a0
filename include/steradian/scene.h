// A scene as plain data: arrays and ids, no pointers, closed sets of kinds as variants.
// A Scene can be built by hand, hashed, printed and sent. Lengths are metres, angles degrees, colours linear Rec. 709.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "steradian/image.h"
#include "steradian/vec.h"

namespace steradian {

enum class ImageId : uint32_t {};
enum class TextureId : uint32_t {};
enum class MaterialId : uint32_t {};
enum class MeshId : uint32_t {};
enum class ShapeId : uint32_t {};
enum class InstanceId : uint32_t {};
enum class ProfileId : uint32_t {};

template <class Id>
requires std::is_enum_v<Id>
constexpr uint32_t index(Id id) { return static_cast<uint32_t>(id); }

// --- Textures --------------------------------------------------------------------------------------------------

struct ConstantTexture {
    Rgb value{0.5f, 0.5f, 0.5f};
};

enum class Wrap : uint8_t { repeat, clamp, mirror, black };
enum class ColorSpace : uint8_t { linear, srgb };  ///< how texel values are to be read

// Where a texture is looked up: (u, v) * scale, turned by `rotation`, + offset. v runs downwards from the top row, as
// in glTF; `rotation` is in degrees and takes u to -v (counter-clockwise in the image, so the image appears clockwise).

/// Bilinear lookup.
struct ImageTexture {
    ImageId image{};
    ColorSpace color_space = ColorSpace::srgb;
    Wrap wrap_u = Wrap::repeat;
    Wrap wrap_v = Wrap::repeat;
    bool bilinear = true;  ///< false: nearest texel
    /// With bilinear: between the two levels of a MIP map that fit how much of the surface the ray sees. The picture
    /// then converges to one of a blurred texture.
    bool mip_map = false;
    Vec2 scale{1, 1};
    Vec2 offset{0, 0};
    float rotation = 0;
    uint32_t uv_set = 0;  ///< which of a mesh's sets of texture coordinates; where it has no such set, the first
};

/// Squares of side 1; `even` where floor(u) + floor(v) is even.
struct CheckerTexture {
    Rgb even{0.8f, 0.8f, 0.8f};
    Rgb odd{0.2f, 0.2f, 0.2f};
    Vec2 scale{1, 1};
    Vec2 offset{0, 0};
    float rotation = 0;
};

/// The colours of a mesh's vertices, or their alphas, blended over each triangle; white on what has none.
struct VertexColorTexture {
    bool alpha = false;
};

/// One texture times another, channel by channel. Neither is a product itself.
struct ProductTexture {
    TextureId first{}, second{};
};

using Texture = std::variant<ConstantTexture, ImageTexture, CheckerTexture, VertexColorTexture, ProductTexture>;

// --- Materials -------------------------------------------------------------------------------------------------

/// Of a microfacet distribution of Trowbridge and Reitz (GGX). 0 on both axes is perfectly smooth; else α is at least
/// 1e-4.
struct Roughness {
    Vec2 value{0, 0};                                 ///< along u and across, [0, 1]
    bool squared = true;                              ///< α = value², as most scenes have it; otherwise α = value
    std::optional<TextureId> texture = std::nullopt;  ///< its first channel, clamped to [0, 1], multiplies `value`
};

/// n + ik of a metal over the index of what surrounds it, for red, green and blue.
struct ComplexIndex {
    Rgb n{1, 1, 1};  ///< > 0
    Rgb k{0, 0, 0};  ///< >= 0
};
/// By name: silver, gold, copper, aluminium, iron, steel, chromium, titanium, nickel, brass. Nothing for others.
std::optional<ComplexIndex> metal_index(std::string_view name);
/// All names, for messages.
std::span<const std::string_view> metal_names();

/// Schlick's approximation: from one colour at normal incidence to another at 90 degrees.
struct SchlickReflectance {
    TextureId normal{};
    Rgb grazing{1, 1, 1};
};

/// Lambert, f = reflectance / π, or with a roughness the energy-preserving model of Oren and Nayar (EON). One-sided
/// with respect to the shading normal unless two_sided.
struct DiffuseMaterial {
    TextureId reflectance{};
    bool two_sided = false;
    float roughness = 0;  ///< in [0, 1], 0: Lambert
};

/// Perfect refraction that passes radiance on unchanged; total internal reflection reflects. It never blends.
struct RefractionMaterial {
    float eta = 1.5f;  ///< index inside over outside, > 0
};

/// What fills a closed body, the same everywhere in it.
struct Medium {
    Rgb absorption{0, 0, 0};  ///< coefficient per metre, 0 … kMaxMediumCoefficient
    Rgb scattering{0, 0, 0};  ///< likewise
    /// g of Henyey and Greenstein: the mean cosine between the directions before and after, from back to forward;
    /// within ± kMaxAnisotropy.
    float anisotropy = 0;
    bool operator==(const Medium&) const = default;
};
inline constexpr double kMaxMediumCoefficient = 1e9;
inline constexpr float kMaxAnisotropy = 0.999f;

/// Of a body that overlaps or touches others: where several are, there is the one with the highest priority, and of
/// equal priorities that whose material comes first (Schmidt & Budge 2002, "Simple Nested Dielectrics in Ray Traced
/// Images"). The surfaces of one material bound one body, which is their union. Its index is then that over vacuum.
/// Bodies without a priority are wholly inside or outside of each other. What has one neither emits nor has holes, in a
/// mix either.
using Priority = std::optional<uint32_t>;

/// Dielectric: Fresnel reflection and refraction, radiance scaled by (η_i/η_t)² at each interface. Where it is rough,
/// of microfacets with all bounces between them; an index within 1e-3 of 1 is smooth whatever the roughness.
struct GlassMaterial {
    float eta = 1.5f;            ///< index inside over outside, > 0; with a priority over vacuum
    Rgb reflectance{1, 1, 1};    ///< tint of the reflected part
    Rgb transmittance{1, 1, 1};  ///< tint of the transmitted part
    Roughness roughness{};
    /// Abbe number V_d, at least 1: eta is the index at 587.56 nm, and others follow by Cauchy's formula with two
    /// terms. 0 or infinite: no dispersion. With eta < 1, a bubble, that of the glass around it.
    float abbe = 0;
    Medium interior{};
    Priority priority = std::nullopt;
};

/// A thin sheet of glass as one surface: all reflections inside it are summed, what passes goes straight on.
struct ThinGlassMaterial {
    float eta = 1.5f;            ///< index of the sheet over that around it, > 0
    Rgb transmittance{1, 1, 1};  ///< of the sheet, once through, at any angle; at most 1
};

/// Perfect mirror, both sides.
struct MirrorMaterial {
    Rgb reflectance{1, 1, 1};
};

/// Metal, both sides: microfacets with all bounces between them, so that roughness does not darken it.
struct ConductorMaterial {
    std::variant<ComplexIndex, SchlickReflectance> reflectance;
    Roughness roughness;
    Rgb tint{1, 1, 1};  ///< multiplies whatever is reflected: 1 for a real metal
};

/// A thin sheet that scatters light back and through by Lambert's law, both sides alike: leaves, paper. The two
/// together are at most 1 where no energy is added.
struct DiffuseTransmissionMaterial {
    TextureId reflectance{};
    TextureId transmittance{};
};

/// A number, times the first channel of a texture, clamped to [0, 1].
struct FloatInput {
    float value = 0;
    std::optional<TextureId> texture = std::nullopt;
};
/// A colour, times a texture.
struct ColorInput {
    Rgb value{1, 1, 1};
    std::optional<TextureId> texture = std::nullopt;
};

/// A length by a texture: from `minimum` where its first channel is 0 to `maximum` where it is 1 (either may be the
/// larger). Without one it is `maximum`.
struct FilmThickness {
    float maximum = 0.5f;
    std::optional<TextureId> texture = std::nullopt;
    float minimum = 0;
};

/// Normals in tangent space: with (r, g, b) of the texture, 2 r - 1 is along u, 2 g - 1 along -v (up in the image, as
/// in glTF) and 2 b - 1 along the surface's own normal. Need not be unit length. Where a mesh has tangents, they stand
/// for u and -v.
struct NormalMap {
    TextureId texture{};  ///< linear
    float strength = 1;   ///< multiplies the first two, -100 … 100
    bool flip_y = false;  ///< 2 g - 1 is along v instead
};

/// Where the grain of a surface runs: `rotation` degrees from u towards -v, and with a texture as much from the
/// direction of (2 r - 1, 2 g - 1) along the two. Where a mesh has tangents, they stand for u and -v.
struct GrainDirection {
    float rotation = 0;
    std::optional<TextureId> texture = std::nullopt;  ///< linear
};

/// How an anisotropy a and a roughness r say how rough a surface is: α along the grain and across it.
enum class GrainShape : uint8_t {
    open_pbr,  ///< r² √(2 / (1 + (1 - a)²)), and 1 - a of that: the highlight becomes longer and narrower
    gltf,      ///< r² (1 - a²) + a², and r²: it becomes longer
};

/// OpenPBR Surface 1.1, both sides: a matte, glassy or metallic base below a coat and fuzz. Names, meaning and defaults
/// are those of the specification; weights, roughnesses and anisotropies are in [0, 1]. Subsurface scattering is
/// diffuse. Transmission is tinted at the surface by its colour, and by what the interior absorbs: where the
/// specification has a transmission_depth, that is open_pbr_interior() and the colour is white. A roughness of 0 counts
/// as α = 1e-4. Instances of a material that emits are lights (see add_emission in scene/emission.h), one-sided unless
/// the wall is thin.
struct OpenPbrMaterial {
    float base_weight = 1;
    ColorInput base_color{{0.8f, 0.8f, 0.8f}};
    FloatInput base_metalness{0};
    float base_diffuse_roughness = 0;
    float specular_weight = 1;    ///< at most 10: scales the reflectance at normal incidence
    ColorInput specular_color{};  ///< of metals: at 82 degrees; at most 1
    FloatInput specular_roughness{0.3f};
    float specular_ior = 1.5f;  ///< inside over outside, > 0
    FloatInput specular_roughness_anisotropy{0};
    GrainShape specular_grain_shape = GrainShape::open_pbr;
    GrainDirection geometry_tangent{};  ///< of the base
    FloatInput transmission_weight{0};
    ColorInput transmission_color{};
    float transmission_dispersion_scale = 0;         ///< divides the Abbe number; 0: no dispersion. In [0, 1]
    float transmission_dispersion_abbe_number = 20;  ///< V_d, as GlassMaterial::abbe; at least 1
    FloatInput subsurface_weight{0};
    ColorInput subsurface_color{{0.8f, 0.8f, 0.8f}};
    float subsurface_scatter_anisotropy = 0;  ///< in [-1, 1]; of thin walls: from what is reflected to what passes
    FloatInput fuzz_weight{0};
    ColorInput fuzz_color{};
    FloatInput fuzz_roughness{0.5f};
    float coat_weight = 0;
    ColorInput coat_color{};  ///< of what passes the coat twice at normal incidence; at most 1
    FloatInput coat_roughness{0};
    float coat_roughness_anisotropy = 0;
    float coat_ior = 1.6f;  ///< at least 1
    float coat_darkening = 1;
    /// Turns the normal of the coat, which has that of the surface otherwise: a Relief turns all other layers.
    std::optional<NormalMap> geometry_coat_normal = std::nullopt;
    FloatInput thin_film_weight{0};
    FilmThickness thin_film_thickness{};  ///< micrometres, 0 … 10
    float thin_film_ior = 1.4f;           ///< 1 … 3
    float emission_luminance = 0;         ///< W/(m² sr), as nits are taken for, in [0, 1e9]
    ColorInput emission_color{};
    FloatInput geometry_opacity{1};
    float geometry_opacity_cutoff = 0;  ///< above 0: an opacity below it counts as 0, any other as 1
    bool geometry_thin_walled = false;  ///< a sheet without an inside, instead of the boundary of a body
    Medium interior{};                  ///< of what transmits and is not thin walled
    Priority priority = std::nullopt;   ///< likewise; specular_ior is then over vacuum
};

/// The interior of OpenPBR 1.1, of which `color` (at least 1e-30) of the light passes `depth` metres (> 0) unscattered.
/// `scatter` / depth is the coefficient of scattering; where that is more than is missing, absorption is raised by as
/// much in all channels.
Medium open_pbr_interior(Rgb color, float depth, Rgb scatter = {0, 0, 0}, float anisotropy = 0);

/// Two materials on one surface: what scatters is (1 - weight) of the first and weight of the second, each with its own
/// relief. Both come before this one in Scene::materials and may be mixes: of at most kMaxMixed materials in all.
inline constexpr uint32_t kMaxMixed = 4;
struct MixMaterial {
    MaterialId first{}, second{};
    FloatInput weight{0.5f};
};

using Material = std::variant<DiffuseMaterial, RefractionMaterial, GlassMaterial, MirrorMaterial, ConductorMaterial,
                              ThinGlassMaterial, DiffuseTransmissionMaterial, OpenPbrMaterial, MixMaterial>;

// --- Relief ----------------------------------------------------------------------------------------------------

/// Heights, of which the surface gets the slopes.
struct BumpMap {
    TextureId texture{};  ///< linear; its first channel
    float scale = 0.01f;  ///< metres for 1, may be negative
};

/// What turns the shading normals of a material's surfaces; at most one for each material.
struct Relief {
    MaterialId material{};
    std::variant<NormalMap, BumpMap> map;
};

// --- Shapes ----------------------------------------------------------------------------------------------------

/// Of a vertex, as normal maps and surfaces with a grain have it: `direction` is where u grows, of any length, zero for
/// none. -v is side (normal × direction).
struct Tangent {
    Vec3 direction;
    float side = 1;  ///< 1 or -1
    bool operator==(const Tangent&) const = default;
};

/// A mesh has at most so many sets of texture coordinates.
inline constexpr uint32_t kMaxUvSets = 8;

/// Indexed triangles. Counter-clockwise seen from outside: the geometric normal is (p1 - p0) × (p2 - p0).
struct Mesh {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;           ///< empty (flat) or one per position; need not be unit length
    std::vector<Vec2> uvs;               ///< empty or one per position
    std::vector<uint32_t> indices;       ///< three per triangle, each < positions.size()
    std::vector<Rgb> colors = {};        ///< empty or one per position; see VertexColorTexture
    std::vector<float> alphas = {};      ///< likewise, in [0, 1]
    std::vector<Tangent> tangents = {};  ///< empty or one per position; without, triangles have those of their uvs
    /// Further sets of texture coordinates: number k is more_uvs[k - 1], empty or one per position.
    std::vector<std::vector<Vec2>> more_uvs = {};
};

/// Normals point outwards. u runs with the angle about +Y from +X towards -Z, v from the north pole down.
struct Sphere {
    Vec3 center;
    float radius = 1;
};

/// The parallelogram center + a * half_u + b * half_v, a and b in [-1, 1]; normal along half_u × half_v.
/// uv = ((a + 1) / 2, (1 - b) / 2).
struct Rectangle {
    Vec3 center;
    Vec3 half_u{1, 0, 0};
    Vec3 half_v{0, 1, 0};
};

struct Disk {
    Vec3 center;
    Vec3 normal{0, 0, 1};  ///< need not be unit length
    float radius = 1;
};

using Shape = std::variant<MeshId, Sphere, Rectangle, Disk>;

/// A shape placed in the world with a material. Several instances may share one shape.
struct Instance {
    ShapeId shape{};
    MaterialId material{};
    Affine world_from_object;
};

// --- Lights ----------------------------------------------------------------------------------------------------

struct PointLight {
    Vec3 position;
    Rgb intensity{1, 1, 1};  ///< W/sr; a flux Φ is Φ / 4π
};

/// Between the two cone angles of a spot, with x in the cosine of the angle, from 0 at the outer to 1 at the inner one:
/// smoothstep, x² (3 - 2x), or as glTF has it (KHR_lights_punctual), x².
enum class SpotFalloff : uint8_t { smoothstep, squared };

/// Zero outside the outer cone.
struct SpotLight {
    Vec3 position;
    Vec3 direction{0, -1, 0};  ///< where it points
    Rgb intensity{1, 1, 1};    ///< W/sr inside the inner cone
    float inner_angle = 30;    ///< half angle, degrees, [0, outer_angle]
    float outer_angle = 45;    ///< half angle, degrees, (0, 180]
    SpotFalloff falloff = SpotFalloff::smoothstep;
};

/// Intensities of a luminaire by direction, bilinear in the two angles (degrees): `vertical` from where the light
/// points, `horizontal` about that. Above the last vertical angle and below the first there is nothing.
struct IntensityProfile {
    std::vector<float> vertical;    ///< at least two, ascending, within [0, 180]
    std::vector<float> horizontal;  ///< one where all planes are alike; else ascending from 0 to 360, both included
    std::vector<float> candela;     ///< plane by plane: vertical.size() for each horizontal angle; >= 0
};

/// A point with the intensities of a measured luminaire (an IES file), candela taken as W/sr.
struct GoniometricLight {
    Vec3 position;
    Vec3 direction{0, -1, 0};  ///< where vertical angle 0 points
    /// Degrees that the planes are turned about `direction`, counter-clockwise seen along it, from where plane 0 is:
    /// at +X for a light that points down, and turned along by the shortest way for one that points elsewhere.
    float rotation = 0;
    Rgb intensity{1, 1, 1};  ///< W/sr per candela of the profile
    ProfileId profile{};
};

/// From infinitely far. With an angular diameter it is a disc of even radiance in the sky, which camera rays and
/// reflections see; the sun's is 0.53.
struct DirectionalLight {
    Vec3 direction{0, -1, 0};       ///< where the light travels to
    Rgb irradiance{1, 1, 1};        ///< W/m² on a surface that faces it
    float angular_diameter = 0;     ///< degrees, 0 or kMinAngularDiameter … kMaxAngularDiameter
    bool visible_to_camera = true;  ///< of a disc: to rays from the camera; everything else sees it anyway
};
inline constexpr double kMinAngularDiameter = 1e-3, kMaxAngularDiameter = 90;  ///< degrees

/// Shadow rays per camera sample that one light may ask for.
inline constexpr uint32_t kMaxLightSamples = 4096;

/// Every point of the instance's surface emits `radiance`, times the texture there, on the side of the geometric normal
/// unless two_sided.
struct AreaLight {
    InstanceId instance{};
    Rgb radiance{1, 1, 1};
    bool two_sided = false;
    uint32_t samples = 1;  ///< shadow rays per camera sample, 1 … kMaxLightSamples
    bool visible_to_camera =
        true;  ///< otherwise rays from the camera pass through the instance as if it were not there
    std::optional<TextureId> texture = std::nullopt;  ///< may exceed 1; negative values count as 0; never a MIP map
};

/// Radiance from infinitely far: constant, or a latitude-longitude image times `radiance`.
/// The image's top row is +Y, its centre column -Z, a quarter to the right of that +X; `rotation` turns it about +Y,
/// counter-clockwise seen from above.
struct EnvironmentLight {
    Rgb radiance{1, 1, 1};
    std::optional<ImageId> image = std::nullopt;
    ColorSpace color_space = ColorSpace::linear;
    float rotation = 0;             ///< degrees
    uint32_t samples = 1;           ///< shadow rays per camera sample, 1 … kMaxLightSamples
    bool visible_to_camera = true;  ///< otherwise it is black where a ray from the camera meets nothing else
};

/// At most one EnvironmentLight per scene.
using Light = std::variant<PointLight, SpotLight, DirectionalLight, AreaLight, EnvironmentLight, GoniometricLight>;

// --- Cameras ---------------------------------------------------------------------------------------------------

// Of all kinds: `look_at` is in the middle of the picture, and what is up there is `up` made perpendicular to the view.

inline constexpr uint32_t kMinApertureBlades = 3, kMaxApertureBlades = 64;

/// Pinhole, or with an aperture a thin lens. What lies in the plane at `focus_distance`, perpendicular to the view, is
/// sharp; a point at distance d is spread over the aperture's image, |d - f| / d times its size in that plane. A pixel
/// is the mean of the radiance over filter and aperture, so the aperture does not change the exposure.
struct PerspectiveCamera {
    Vec3 position{0, 0, 0};
    Vec3 look_at{0, 0, -1};
    Vec3 up{0, 1, 0};
    float vertical_fov = 40;                             ///< degrees, in (0, 180)
    float aperture_radius = 0;                           ///< metres, up to 1e15; 0: pinhole
    std::optional<float> focus_distance = std::nullopt;  ///< metres along the view, > 0; nothing: that of look_at
    uint32_t aperture_blades = 0;  ///< 0: round; 3 … 64: a regular polygon with corners at the radius
    float aperture_rotation = 0;   ///< degrees, counter-clockwise in the picture; at 0 a corner is to the right
};

/// Parallel rays along the view, from the plane through `position`.
struct OrthographicCamera {
    Vec3 position{0, 0, 0};
    Vec3 look_at{0, 0, -1};
    Vec3 up{0, 1, 0};
    float height = 2;  ///< metres between the picture's top and bottom, > 0
};

/// The whole sphere of directions as a latitude-longitude picture: the top row is `up`, a quarter to the right of the
/// middle is to the right.
struct PanoramaCamera {
    Vec3 position{0, 0, 0};
    Vec3 look_at{0, 0, -1};
    Vec3 up{0, 1, 0};
};

/// How far from the middle a direction appears that is an angle θ off the view: proportional to θ, or to sin(θ/2),
/// which gives all pixels the same solid angle.
enum class FisheyeProjection : uint8_t { equidistant, equisolid };

/// A round picture that touches the nearer sides of the frame; black outside.
struct FisheyeCamera {
    Vec3 position{0, 0, 0};
    Vec3 look_at{0, 0, -1};
    Vec3 up{0, 1, 0};
    float fov = 180;  ///< across the circle; degrees, in (0, 360]
    FisheyeProjection projection = FisheyeProjection::equidistant;
};

using Camera = std::variant<PerspectiveCamera, OrthographicCamera, PanoramaCamera, FisheyeCamera>;

// --- The scene -------------------------------------------------------------------------------------------------

struct Scene {
    std::vector<RawImage> images;
    std::vector<Texture> textures;
    std::vector<Material> materials;
    std::vector<Relief> reliefs;  ///< of some of the materials
    std::vector<Mesh> meshes;
    std::vector<Shape> shapes;
    std::vector<Instance> instances;
    std::vector<Light> lights;
    std::vector<Camera> cameras;
    std::vector<IntensityProfile> profiles;

    /// For messages and for choosing a camera by name; parallel to the arrays above, or empty.
    struct Names {
        std::vector<std::string> images, textures, materials, meshes, shapes, instances, lights, cameras, profiles;
    } names;
};

enum class ElementKind : uint8_t { image, texture, material, mesh, shape, instance, light, camera, profile };
inline constexpr size_t kElementKinds = 9;

/// One element of a scene: of which array, and its number there.
struct Element {
    ElementKind kind{};
    uint32_t index = 0;
    auto operator<=>(const Element&) const = default;
};

/// XXH3-128 of the scene's content as 32 hexadecimal digits. Names do not count.
std::string scene_hash(const Scene& scene);

/// Appends and returns the new element's id.
template <class Id, class T>
Id add(std::vector<T>& pool, T value) {
    pool.push_back(std::move(value));
    return Id(static_cast<uint32_t>(pool.size() - 1));
}

}  // namespace steradian
