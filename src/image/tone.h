// From scene-linear light to 8-bit sRGB.
#pragma once

#include <span>
#include <string_view>

#include "math/vector.h"
#include "steradian/image.h"
#include "steradian/result.h"

namespace steradian {

/// srgb (clipped), agx, aces, neutral, reinhard. Each is named after its published definition.
std::span<const std::string_view> view_names() noexcept;

/// IEC 61966-2-1, by our own pow; encode clips to [0, 1].
float srgb_encode(float linear) noexcept;
float srgb_decode(float encoded) noexcept;

/// Display-linear Rec. 709 in [0, 1] from scene-linear, after `exposure` stops. `view` must be one of view_names().
Rgb apply_view(std::string_view view, Rgb scene_linear, float exposure) noexcept;

}  // namespace steradian
