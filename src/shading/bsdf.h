// How surfaces scatter. A Bsdf is a value: textures have been read; nothing refers to the scene but tables of the
// material, which live as long as the ShadingScene.
// wo and wi are unit world vectors that point away from the surface. Every pdf is per solid angle.
#pragma once

#include <array>
#include <optional>
#include <variant>

#include "math/vector.h"
#include "shading/fresnel.h"
#include "shading/microfacet_energy.h"
#include "shading/surface.h"
#include "shading/thin_film.h"
#include "steradian/scene.h"

namespace steradian {

struct OpenPbrTables;  // what its layers reflect, see open_pbr_tables.h

/// On so much of a surface as `weight` says.
struct PointFilm {
    float weight = 0;
    FilmPlace thickness{};  ///< in the tables
};

struct DiffuseBsdf {
    Rgb reflectance;
    bool two_sided = false;
    float roughness = 0;
};
struct RefractionBsdf {
    float eta = 1.5f;
};
struct GlassBsdf {
    float eta = 1.5f;
    Rgb reflectance, transmittance;
};
struct MirrorBsdf {
    Rgb reflectance;
};
struct ConductorBsdf {
    struct Schlick {
        Rgb normal, grazing;
        Rgb dip{};  ///< times μ (1 - μ)⁶: by how much it is darker, most at 82 degrees
    };
    std::variant<ComplexIndex, Schlick> fresnel;
    const FilmOnMetal* films = nullptr;  ///< of a Schlick metal; null where there is no film
    PointFilm film;
    Rgb mean_fresnel;
    Rgb tint{1, 1, 1};
    Microfacets facets;
    const MicrofacetEnergy* energy = nullptr;  ///< null: what bounces between facets is lost
};
struct RoughGlassBsdf {
    float eta = 1.5f;
    Rgb reflectance, transmittance;
    Microfacets facets{0.1f, 0.1f};            ///< not smooth
    const MicrofacetEnergy* energy = nullptr;  ///< null: what bounces between facets is lost
    float index_place = 0;                     ///< where eta lies in the range of `energy`
    const FilmOnDielectric* films = nullptr;   ///< null where there is no film
    PointFilm film{};
};
struct ThinGlassBsdf {
    float eta = 1.5f;
    Rgb transmittance;
};

struct DiffuseTransmissionBsdf {
    Rgb reflectance, transmittance;
};

struct OpenPbrBsdf {
    ConductorBsdf metal;
    RoughGlassBsdf glass;
    Rgb specular_color;
    Rgb diffuse, subsurface_color;
    Rgb coat_color, darkening{1, 1, 1};
    Rgb fuzz_color;
    float metalness = 0, transmission = 0, subsurface = 0, diffuse_roughness = 0;
    float coat_weight = 0, fuzz_weight = 0, fuzz_roughness = 0.5f;
    PointFilm film;
    float passed_share = 0;  ///< of what the subsurface of a thin wall scatters
    bool thin_walled = false;
    Microfacets coat;
    /// The coat has a frame of its own. Then the lobe itself says which of the two normals come from maps, and Bsdf or
    /// Part not.
    bool coat_apart = false;
    bool base_folded = false, coat_folded = false;
    Frame coat_frame{};
    const OpenPbrTables* tables = nullptr;
};

using PlainLobe = std::variant<DiffuseBsdf, RefractionBsdf, GlassBsdf, MirrorBsdf, ConductorBsdf, RoughGlassBsdf,
                               ThinGlassBsdf, DiffuseTransmissionBsdf, OpenPbrBsdf>;

/// Parts whose weights, all more than 0, sum to 1.
struct MixBsdf {
    struct Part {
        PlainLobe lobe;
        Frame frame;          ///< as in Bsdf
        bool folded = false;  ///< as in Bsdf
        float weight = 0;
    };
    std::array<Part, kMaxMixed> parts;
    uint32_t count = 0;
};

/// Of a medium, at a point without a surface.
struct PhaseBsdf {
    float anisotropy = 0;
};

using Lobe = std::variant<DiffuseBsdf, RefractionBsdf, GlassBsdf, MirrorBsdf, ConductorBsdf, RoughGlassBsdf,
                          ThinGlassBsdf, DiffuseTransmissionBsdf, OpenPbrBsdf, MixBsdf, PhaseBsdf>;

struct Bsdf {
    Lobe lobe;
    Vec3 ng;
    Frame frame;  ///< z is the shading normal (of a mix the mean), x the direction of u where the lobe has one
    /// The normal comes from a map: what the lobe sends through the surface by mistake is mirrored at it.
    bool folded = false;
};

struct BsdfEval {
    Rgb f_cos;      ///< f · |cos θ_i|; 0 for specular lobes
    float pdf = 0;  ///< of `sample` choosing wi
    Rgb diffuse{};  ///< what of f_cos comes from matte and fuzzy layers
};

struct BsdfSample {
    Vec3 wi;
    Rgb weight;     ///< f · |cos θ_i| / pdf
    float pdf = 0;  ///< 0 for specular lobes
    bool specular = false;
    bool transmitted = false;
    float radiance_scale = 1;  ///< the (η_i/η_t)² that is part of weight
};

/// Whether the surface lies between two directions.
inline bool on_two_sides(const Bsdf& bsdf, Vec3 a, Vec3 b) {
    const Vec3d n = bsdf.ng;
    return (dot(Vec3d(a), n) < 0) != (dot(Vec3d(b), n) < 0);
}

/// Whether the surface sends light of different wavelengths in different directions.
bool disperses(const ShadingScene& scene, const SurfacePoint& point) noexcept;
/// For light of a wavelength in micrometres, 0 where that is open: a surface that disperses then has the index of line
/// d.
Bsdf make_bsdf(const ShadingScene& scene, const SurfacePoint& point, float wavelength = 0) noexcept;
/// All lobes are perfectly specular: light sampling is of no use.
bool is_specular(const Bsdf& bsdf) noexcept;
/// Light from behind the shading normal (seen from wo) brings nothing: choosing lights need not think of it.
bool only_reflects(const Bsdf& bsdf) noexcept;
BsdfEval eval(const Bsdf& bsdf, Vec3 wo, Vec3 wi) noexcept;
/// Nothing when no light can leave towards wo (the back of a one-sided surface, say).
std::optional<BsdfSample> sample(const Bsdf& bsdf, Vec3 wo, float uc, Vec2 u) noexcept;

}  // namespace steradian
