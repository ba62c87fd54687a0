// How one sample of one pixel came to its value: its path, vertex by vertex.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "steradian/render.h"

namespace steradian {

/// A direction that a light was asked for. Densities are per solid angle.
struct TracedLight {
    uint32_t light = 0;  ///< index into Scene::lights
    std::string name;    ///< of the light, where it has one
    Vec3 direction;      ///< unit, towards the light
    float light_pdf = 0, bsdf_pdf = 0;
    float mis_weight = 1;
    Rgb contribution;         ///< to the radiance of the sample, unless it is occluded; after what cut-outs let pass
    bool shadow_ray = false;  ///< one was traced; otherwise there was nothing to bring
    bool occluded = false;
};

/// How the path went on from a vertex.
struct TracedBounce {
    Vec3 direction;
    Rgb weight;     ///< f cos / pdf
    float pdf = 0;  ///< 0 where the scattering is specular
    bool specular = false, transmitted = false;
    float survival = 1;    ///< probability with which Russian roulette let the path go on
    bool survived = true;  ///< it did
};

struct TracedVertex {
    Vec3 origin, direction;      ///< the ray that led here
    Rgb throughput;              ///< of the path up to here, with what the medium on the way has left
    Rgb transmittance{1, 1, 1};  ///< what that is; where a medium scatters, over the probability of coming so far
    bool escaped = false;        ///< the ray hit nothing; then there is no surface
    bool in_medium = false;      ///< the ray was scattered before it hit anything: no surface either
    Vec3 position, normal;       ///< world space; the shading normal
    uint32_t instance = 0, primitive = 0;
    std::string object;  ///< name of the instance, where it has one
    Rgb emission;        ///< radiance from here towards the ray's origin
    /// Of the ray: with which the last vertex's BSDF and its light samples (times their expected number) chose it.
    float bsdf_pdf = 0, light_pdf = 0;
    float mis_weight = 1;
    Rgb contribution;  ///< of the emission to the radiance of the sample
    /// Chosen here, in nanometres, for the rest of the path; 0 where none was.
    float wavelength = 0;
    Rgb wavelength_weight;  ///< what the throughput was multiplied by
    std::vector<TracedLight> lights;
    std::optional<TracedBounce> bounce;
};

struct SampleTrace {
    uint32_t x = 0, y = 0;
    uint64_t sample = 0;
    Vec2 film;                ///< where the camera ray goes through, pixels from the top left corner
    float filter_weight = 1;  ///< what the radiance counts in the pixel's mean
    Rgb radiance;             ///< as a render adds it, to the bit
    bool bad = false;         ///< not finite or negative: a render drops it
    std::vector<TracedVertex> vertices;
};

/// Computes sample `sample` of pixel (x, y) with the code that renders pictures, and writes down what happens.
/// `usage` for settings that make no sense, for a pixel outside the picture (or its crop) and for a sample beyond
/// samples_per_pixel. Of integrators other than `path` and `direct` there is not more than the first surface to tell.
Result<SampleTrace> replay(const std::shared_ptr<const RenderScene>& scene, const RenderSettings& settings, uint32_t x,
                           uint32_t y, uint64_t sample);

}  // namespace steradian
