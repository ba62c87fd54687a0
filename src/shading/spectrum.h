// Wavelengths and colours, for what depends on the wavelength itself: thin films.
#pragma once

#include "math/elementary.h"
#include "math/vector.h"

namespace steradian {

/// Micrometres: what lies beyond is hardly seen.
inline constexpr double kShortestWavelength = 0.38, kLongestWavelength = 0.73;

/// What light of one wavelength (in micrometres) adds to linear red, green and blue of Rec. 709, up to one factor for
/// each: by the fits to the CIE 1931 colour matching functions of C. Wyman, P.-P. Sloan and P. Shirley, "Simple
/// Analytic Approximations to the CIE XYZ Color Matching Functions", 2013, section 2.2. Channels may be negative.
inline Vec3d rgb_response(double wavelength) {
    const double nm = wavelength * 1000;
    const auto lobe = [&](double height, double middle, double below, double above) {
        const double t = (nm - middle) / (nm < middle ? below : above);
        return height * math::exp(-t * t / 2);
    };
    const double x = lobe(1.056, 599.8, 37.9, 31.0) + lobe(0.362, 442.0, 16.0, 26.7) - lobe(0.065, 501.1, 20.4, 26.2);
    const double y = lobe(0.821, 568.8, 46.9, 40.5) + lobe(0.286, 530.9, 16.3, 31.1);
    const double z = lobe(1.217, 437.0, 11.8, 36.0) + lobe(0.681, 459.0, 26.0, 13.8);
    return {3.2406 * x - 1.5372 * y - 0.4986 * z, -0.9689 * x + 1.8758 * y + 0.0415 * z,
            0.0557 * x - 0.2040 * y + 1.0570 * z};
}

}  // namespace steradian
