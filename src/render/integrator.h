// What the scheduler asks of an integrator: one unit of work, a tile × a block of samples.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "render/film.h"
#include "render/render_scene.h"
#include "shading/camera.h"
#include "shading/filter.h"
#include "shading/sampler.h"
#include "steradian/render.h"

namespace steradian {

struct WorkUnit {
    TileRect tile;
    uint64_t first_sample = 0;
    uint32_t samples = 0;  ///< at most kBlockSamples
};

/// What a worker counts; added up at the end.
struct Counters {
    uint64_t camera_rays = 0, specular_rays = 0, shadow_rays = 0, bad_samples = 0;
    std::optional<BadSample> first_bad_sample;  ///< the smallest (sample, y, x)

    void bad(const BadSample& sample);
    void add(const Counters& other);
};

/// Everything that is the same for all units of a job.
struct RenderContext {
    const RenderScene& scene;
    const RenderSettings& settings;
    CameraSampler camera;
    FilterSampler filter;
    Sampler sampler;
    const std::atomic<bool>& cancelled;
    std::atomic<uint64_t>& rays;  ///< traced so far by all workers, for progress
};

/// One per worker: it owns that worker's memory, reserved when it is made.
class Integrator {
public:
    virtual ~Integrator() = default;
    /// Adds the unit's samples to `sums` (one per pixel of the tile, row by row), each pixel's in ascending order.
    /// False when the job was cancelled on the way; the sums are then worthless.
    virtual bool render(const WorkUnit& unit, std::span<RgbSum> sums, Counters& counters) noexcept = 0;
};

/// What one such integrator holds.
uint64_t direct_integrator_bytes(uint32_t max_tile_pixels) noexcept;
std::unique_ptr<Integrator> make_direct_integrator(const RenderContext& context, uint32_t max_tile_pixels);

}  // namespace steradian
