// KHR_materials_pbrSpecularGlossiness: surfaces by what they scatter, what they reflect at normal incidence, and gloss.
#pragma once

#include "formats/gltf/images.h"

namespace steradian::gltf {

/// A coloured reflectance at normal incidence as a metal on a part of the surface and a dielectric of index 1.5 on the
/// rest. By Schlick's approximation, in which reflectances at normal incidence mix linearly and all become 1 at grazing
/// angles, the two together reflect `specular` at every angle. The part is the smallest for which the metal reflects no
/// more than 1: then what the dielectric leaves for the matte base below it is 1 - max(specular), as the extension
/// says.
struct SplitReflectance {
    float metalness = 0;
    Rgb metal{1, 1, 1};    ///< of the metal; a channel that would have to be below 0 is 0
    float dielectric = 1;  ///< by how much the dielectric reflects less, where all channels are darker than it
};
inline constexpr float kDielectricReflectance = 0.04f;  ///< of an index of 1.5
SplitReflectance split_reflectance(Rgb specular) noexcept;

/// What a map with the specular colour (sRGB) and the glossiness in its alpha becomes, in 8 bits: numbers, or for a
/// metal colours in sRGB.
RawImage convert_specular_glossiness(const RawImage& map, const SpecularGlossinessPlane& plane);

}  // namespace steradian::gltf
