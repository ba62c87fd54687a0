// Reading textures: sRGB decoding, wrapping and filtering are ours, in fixed arithmetic, because texels reach pixels.
#pragma once

#include "math/vector.h"
#include "shading/surface.h"
#include "steradian/scene.h"

namespace steradian {

/// Texel (x, y) of an image as linear values; grey is replicated, alpha ignored. Coordinates must be inside.
/// Values of float images that are not finite read as 0 (prepare counts them).
Rgb texel(const RawImage& image, ColorSpace space, uint32_t x, uint32_t y) noexcept;

/// How many texels of a float image have a colour value that is not finite (or, if asked, negative); 0 for others.
uint64_t count_bad_texels(const RawImage& image, bool negative_too) noexcept;

/// v runs downwards from the top row.
Rgb eval_texture(const Scene& scene, TextureId id, Vec2 uv) noexcept;
/// At a point of a surface: also by its footprint, and what belongs to the surface itself.
Rgb eval_texture(const ShadingScene& scene, TextureId id, const SurfacePoint& point) noexcept;

/// The same of a colour that reflects, passes or shines: no channel is below 0, which texels of edited or filtered
/// float images are now and then.
Rgb eval_color(const ShadingScene& scene, TextureId id, const SurfacePoint& point) noexcept;

/// Which set of texture coordinates it is looked up with.
uint32_t uv_set_of(const Scene& scene, TextureId id) noexcept;

/// How the first channel changes with u and v, by differences over one texel of an image, or of
/// the level of its MIP map (over 1/256 of the unit of
/// other textures): continuous for images that are looked up bilinearly.
Vec2 texture_slope(const ShadingScene& scene, TextureId id, const SurfacePoint& point) noexcept;

}  // namespace steradian
