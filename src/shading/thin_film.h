// A film whose thickness is of the order of a wavelength, on a dielectric or a metal: what it reflects, as colours.
// Light that bounces within the film interferes (Airy's sum, over both polarisations, with complex indices: Born &
// Wolf, "Principles of Optics", sections 1.6.4 and 14.4), which is integrated over the spectrum when a scene is made:
// the tables take the place of the fits of L. Belcour and P. Barla, "A Practical Extension to Microfacet Theory for the
// Modeling of Varying Iridescence", 2017.
//
// Colours are those of white things in white light: what reflects all wavelengths alike is grey. Channels beyond what
// can be reflected are clamped.
#pragma once

#include <array>
#include <vector>

#include "math/vector.h"

namespace steradian {

inline constexpr double kThickestFilm = 10;  ///< micrometres

struct FilmIndices {
    double outside = 1, film = 1.4, base = 1.5, base_k = 0;  ///< base + i base_k
};

/// Of one wavelength, unpolarised; cos_i outside. Thickness and wavelength in the same unit.
double film_reflectance(double cos_i, const FilmIndices& n, double thickness, double wavelength) noexcept;

/// The index n + ik, next to vacuum, of a metal by its reflectances at normal incidence, below 1, and at 82 degrees:
/// those of O. Gulbrandsen, "Artist Friendly Metallic Fresnel", 2014, equations 1 to 6, with the parameter that comes
/// nearest to the second.
struct MetalIndex {
    double n = 1, k = 0;
};
MetalIndex metal_index_of(double normal, double at_82) noexcept;

/// Over the cosine outside.
class FilmOnDielectric {
public:
    /// `weight` of the surface has the film; elsewhere its reflectance is `bare`, of a boundary with that index.
    /// With `refracts` cosines are those before the light enters the medium outside, from vacuum.
    FilmOnDielectric(const FilmIndices& n, double thickness, double weight, double bare, bool refracts);
    Rgb reflectance(double mu) const noexcept;

private:
    std::array<Rgb, 384> table_;
};

/// Over the cosine outside and the reflectance at normal incidence without the film, for each channel.
class FilmOnMetal {
public:
    /// `tint_82`: what the metal reflects at 82 degrees, over what Schlick's approximation says.
    FilmOnMetal(double outside, double film, double thickness, Rgb tint_82);
    Rgb reflectance(double mu, Rgb normal) const noexcept;
    /// 2 ∫ R(μ) μ dμ
    Rgb mean(Rgb normal) const noexcept;

private:
    static constexpr size_t kCosines = 96, kNormals = 33;
    std::vector<Rgb> table_;  ///< [normal][cosine]
    std::array<Rgb, kNormals> mean_;
};

}  // namespace steradian
