// What an OpenPbrMaterial's layers reflect, as tables that are computed when a scene is made.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include "math/vector.h"
#include "shading/dispersion.h"
#include "shading/microfacet_energy.h"
#include "shading/thin_film.h"
#include "steradian/scene.h"

namespace steradian {

/// Fibres that stand up from a surface: the distribution of A. C. Estevez and C. Kulla, "Production Friendly Microfacet
/// Sheen BRDF", 2017, equation 2, with the masking of D. Neubelt and M. Pettineo, "Crafting a Next-Gen Material
/// Pipeline for The Order: 1886", 2013. Roughnesses are clamped to [0.07, 1].
class FuzzTable {
public:
    /// Of this roughness, or where it is a texture, of all.
    explicit FuzzTable(const FloatInput& roughness);
    /// f cos θ_i, white; both above the surface.
    Rgb eval(float roughness, Vec3d wo, Vec3d wi) const noexcept;
    /// What is reflected of the light from the cosine mu, at most 1. Between the roughnesses of the table within 1e-2.
    double albedo(float roughness, double mu) const noexcept;

private:
    struct Level {
        double scale = 1;
        std::array<double, 64> albedo{};
    };
    static Level make_level(double roughness);
    struct Position {
        size_t first;
        double fraction;
    };
    Position position(float roughness) const noexcept;
    std::vector<Level> levels_;  ///< one, or over the roughness
};

/// Of a base that is under a thin film everywhere.
struct FilmTables {
    FilmThicknesses thicknesses;
    /// Over the opaque base (below the coat) with what is lost of each channel, over glass, and over metal; null where
    /// the base has no such part.
    std::shared_ptr<const FilmOnDielectric> dielectric, glass;
    std::shared_ptr<const MicrofacetEnergy> energy;
    std::shared_ptr<const FilmOnMetal> metal;
};

struct OpenPbrTables {
    bool textured = false;                     ///< the tables of the base are over its roughness as well
    bool every_grain = false;                  ///< and over its grain
    bool coat_textured = false;                ///< likewise
    TabulatedRoughness base{Roughness{}};      ///< as far as the tables go
    float eta = 1.5f;                          ///< of the base as a body: inside over outside
    GlassIndex glass_index;                    ///< the same by the wavelength
    double eta_outside = 1.5, coat_eta = 1.6;  ///< of reflections from outside
    double coat_normal_reflectance = 0, coat_inner_reflectance = 0;
    std::shared_ptr<const MicrofacetEnergy> metal, dielectric, glass;  ///< of the base; glass: where it transmits
    std::shared_ptr<const MicrofacetEnergy> coat;                      ///< null without a coat
    std::shared_ptr<const FuzzTable> fuzz;                             ///< null without fuzz
    FilmTables film;                                                   ///< of nothing without a film
};

/// α along u and across: section "Microfacet model" of the specification.
Vec2 open_pbr_alpha(float roughness, float anisotropy, GrainShape shape = GrainShape::open_pbr) noexcept;
/// Of the base as roughened by the coat, where the two are as rough as that.
float open_pbr_roughness(const OpenPbrMaterial& m, float specular_roughness, float coat_roughness) noexcept;

/// Tables by what they are made of, so that materials which have it in common share them.
class SharedTables {
public:
    std::shared_ptr<const MicrofacetEnergy> reflecting(const TabulatedRoughness& r) {
        return energy(Kind::reflecting, r, 0);
    }
    std::shared_ptr<const MicrofacetEnergy> coating(const TabulatedRoughness& r, double eta) {
        return energy(Kind::coating, r, eta);
    }
    std::shared_ptr<const MicrofacetEnergy> transmitting(const TabulatedRoughness& r, IndexRange eta) {
        return energy(Kind::transmitting, r, eta.first, eta.last);
    }
    std::shared_ptr<const FuzzTable> fuzz(const FloatInput& roughness);

    /// What the tables of a film are made of.
    struct Film {
        double above = 1, film = 1;                         ///< indices
        double thinnest = 0, thickest = 0;                  ///< micrometres
        double below = 1, eta = 1;                          ///< the base under a coat, and without one
        bool metal = false, glass = false, opaque = false;  ///< the parts that there are
        float tint[3] = {};                                 ///< of the metal towards grazing angles
        TabulatedRoughness base{Roughness{}};
    };
    FilmTables film(const Film& of);

private:
    enum class Kind : uint8_t { reflecting, coating, transmitting };
    std::shared_ptr<const MicrofacetEnergy> energy(Kind kind, const TabulatedRoughness& r, double eta,
                                                   double last_eta = 0);

    using Key = std::tuple<Kind, float, float, bool, bool, bool, double, double>;
    std::map<Key, std::shared_ptr<const MicrofacetEnergy>> energy_;
    std::map<std::pair<float, bool>, std::shared_ptr<const FuzzTable>> fuzz_;
    using FilmKey =
        std::tuple<std::array<double, 6>, std::array<bool, 3>, std::array<float, 3>, float, float, bool, bool, bool>;
    std::map<FilmKey, FilmTables> films_;
};

OpenPbrTables make_open_pbr_tables(const OpenPbrMaterial& m, SharedTables& shared);

}  // namespace steradian
