// What goniometric lights send into which direction.
#pragma once

#include "steradian/scene.h"

namespace steradian {

/// Candela at angles in degrees, bilinear between those of the table: `vertical` from 0 (the light's direction) to 180,
/// `horizontal` in [0, 360]. 0 above the last vertical angle and below the first.
double intensity_at(const IntensityProfile& profile, double vertical, double horizontal) noexcept;

/// ∫ of intensity_at over all directions, in closed form.
double total_flux(const IntensityProfile& profile) noexcept;

/// No direction with a larger vertical angle (degrees) has any intensity.
double lit_angle(const IntensityProfile& profile) noexcept;

/// The largest candela value.
float peak_intensity(const IntensityProfile& profile) noexcept;

}  // namespace steradian
