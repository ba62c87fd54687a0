// A film whose thickness is of the order of a wavelength, on a dielectric or a metal: what it reflects, as colours.
// Light that bounces within the film interferes (Airy's sum, over both polarisations, with complex indices: Born &
// Wolf, "Principles of Optics", sections 1.6.4 and 14.4), which is integrated over the spectrum when a scene is made:
// the tables take the place of the fits of L. Belcour and P. Barla, "A Practical Extension to Microfacet Theory for the
// Modeling of Varying Iridescence", 2017.
//
// Colours are those of white things in white light: what reflects all wavelengths alike is grey. Channels beyond what
// can be reflected are clamped.
#pragma once

#include <cstddef>
#include <cstdint>
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

/// A place among thicknesses of a FilmThicknesses: (1 - f) of number `first` and f of the next one.
struct FilmPlace {
    uint32_t first = 0;
    float f = 0;
};

/// The thicknesses that tables are made for; between them they are linear. By the path that the film adds at normal
/// incidence, 2 n d: kFilmsPerFringe to a path of 0.45 µm, the length of a fringe of blue light; beyond 3 µm, where
/// fringes of colours fade, apart like the square of the path. So there are at most 321, and what is between them is
/// within 1.5 % of the difference between bright and dark fringes, and within 5 % where a channel is clamped.
class FilmThicknesses {
public:
    static constexpr double kFilmsPerFringe = 24;
    FilmThicknesses() = default;
    /// From one to the other (micrometres, either may be the larger), for films of that index; one where they are the
    /// same.
    FilmThicknesses(double film_index, double a, double b);
    size_t count() const noexcept { return count_; }
    double operator[](size_t i) const noexcept;
    /// Beyond the ends the nearer one.
    FilmPlace place(double thickness) const noexcept;

private:
    double path_ = 2;  ///< over the thickness
    double thinnest_ = 0, thickest_ = 0;
    double first_ = 0, step_ = 0;  ///< evenly spaced, as they are
    size_t count_ = 1;
};

/// Over the thickness and the cosine outside.
class FilmOnDielectric {
public:
    /// With `refracts` cosines are those before the light enters the medium outside, from vacuum.
    FilmOnDielectric(const FilmIndices& n, const FilmThicknesses& thicknesses, bool refracts);
    Rgb reflectance(double mu, FilmPlace place = {}) const noexcept;

    static constexpr size_t kCosines = 384;
    /// For each thickness at the cosines (i / (kCosines - 1))²; linear in their roots between them.
    const std::vector<Rgb>& table() const { return table_; }

private:
    std::vector<Rgb> table_;  ///< [thickness][cosine]
};

/// Over the thickness, the cosine outside and the reflectance at normal incidence without the film, for each channel.
class FilmOnMetal {
public:
    /// `tint_82`: what the metal reflects at 82 degrees, over what Schlick's approximation says.
    FilmOnMetal(double outside, double film, const FilmThicknesses& thicknesses, Rgb tint_82);
    Rgb reflectance(double mu, Rgb normal, FilmPlace place = {}) const noexcept;
    /// 2 ∫ R(μ) μ dμ
    Rgb mean(Rgb normal, FilmPlace place = {}) const noexcept;

private:
    Rgb mean_of(size_t row) const;

    static constexpr size_t kCosines = 96, kNormals = 33;
    std::vector<Rgb> table_;  ///< [thickness][normal][cosine]
    std::vector<Rgb> mean_;   ///< [thickness][normal]
};

}  // namespace steradian
