// How surfaces scatter. A Bsdf is a value: textures have been read, nothing refers to the scene.
// wo and wi are unit world vectors that point away from the surface. Every pdf is per solid angle.
#pragma once

#include <optional>
#include <variant>

#include "math/vector.h"
#include "shading/surface.h"
#include "steradian/scene.h"

namespace steradian {

struct DiffuseBsdf {
    Rgb reflectance;
    bool two_sided = false;
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

struct Bsdf {
    std::variant<DiffuseBsdf, RefractionBsdf, GlassBsdf, MirrorBsdf> lobe;
    Vec3 ng;
    Frame frame;  ///< z is the shading normal
};

struct BsdfEval {
    Rgb f_cos;      ///< f · |cos θ_i|; 0 for specular lobes
    float pdf = 0;  ///< of `sample` choosing wi
};

struct BsdfSample {
    Vec3 wi;
    Rgb weight;     ///< f · |cos θ_i| / pdf
    float pdf = 0;  ///< 0 for specular lobes
    bool specular = false;
    bool transmitted = false;
};

Bsdf make_bsdf(const ShadingScene& scene, const SurfacePoint& point) noexcept;
/// All lobes are perfectly specular: light sampling is of no use.
bool is_specular(const Bsdf& bsdf) noexcept;
BsdfEval eval(const Bsdf& bsdf, Vec3 wo, Vec3 wi) noexcept;
/// Nothing when no light can leave towards wo (the back of a one-sided surface, say).
std::optional<BsdfSample> sample(const Bsdf& bsdf, Vec3 wo, float uc, Vec2 u) noexcept;

/// Unpolarised reflectance of a smooth dielectric; cos_i on the incident side in [0, 1], eta = transmitted over
/// incident index. 1 for total internal reflection.
float fresnel_dielectric(float cos_i, float eta) noexcept;

}  // namespace steradian
