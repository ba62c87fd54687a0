// What the scheduler asks of an integrator: one unit of work, a tile × a block of samples.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "render/cryptomatte.h"
#include "render/film.h"
#include "render/render_scene.h"
#include "shading/camera.h"
#include "shading/filter.h"
#include "shading/sampler.h"
#include "steradian/render.h"

namespace steradian {

class Recorder;

struct WorkUnit {
    TileRect tile;
    uint64_t first_sample = 0;
    uint32_t samples = 0;
    /// Sample i of a pixel belongs to its replicate i mod all_replicates. The samples of this unit are of `replicates`
    /// of them, from first_replicate on, and first_sample counts those only. Each replicate has a sum of its own.
    uint32_t replicates = 1, first_replicate = 0, all_replicates = 1;
    /// The index in its pixel of what is sample n by that count.
    uint64_t index(uint64_t n) const noexcept {
        return n / replicates * all_replicates + first_replicate + n % replicates;
    }
};

/// What a worker counts; added up at the end.
struct Counters {
    uint64_t camera_rays = 0, bounce_rays = 0, shadow_rays = 0, bad_samples = 0;
    std::optional<PixelSample> first_bad_sample;  ///< the smallest (sample, y, x)
    uint32_t fireflies_wanted = 0;
    std::vector<PixelSample> fireflies;  ///< the brightest, in order; has room for one more than are wanted

    Counters() = default;
    explicit Counters(uint32_t wanted) : fireflies_wanted(wanted) { fireflies.reserve(size_t(wanted) + 1); }
    void bad(const PixelSample& sample);
    void good(const PixelSample& sample);
    void add(const Counters& other);
    void add_rays(const Counters& other);
};

/// Everything that is the same for all units of a job.
struct RenderContext {
    const RenderScene& scene;
    const RenderSettings& settings;
    CameraSampler camera;
    FilterSampler filter;
    Sampler sampler;
    const std::atomic<bool>& cancelled;
    std::atomic<uint64_t>& rays;   ///< traced so far by all workers, for progress
    Recorder* recorder = nullptr;  ///< of the one sample that is replayed
    MatteIds mattes{};             ///< of the things in the scene, where they are asked for
};

/// One per worker: it owns that worker's memory, reserved when it is made.
class Integrator {
public:
    virtual ~Integrator() = default;
    /// Adds the unit's samples to the sums of its tile, in ascending order to each sum. `color` has one for each pixel
    /// and replicate, row by row.
    /// False when the job was cancelled on the way; the sums are then worthless. May throw std::bad_alloc, as sums of
    /// mattes have no bound.
    virtual bool render(const WorkUnit& unit, TileSums& sums, Counters& counters) = 0;
};

/// The sampler that the settings name.
Sampler sampler_of(const RenderSettings& settings);
/// The camera that the settings name; `usage` when the scene has no such camera, bad_input for a degenerate one.
Result<CameraSampler> camera_of(const RenderScene& scene, const RenderSettings& settings);

/// What settings.integrator of the context names; integrator_bytes is what one holds.
std::unique_ptr<Integrator> make_integrator(const RenderContext& context, uint32_t max_tile_pixels);
uint64_t integrator_bytes(const RenderSettings& settings, uint32_t max_tile_pixels) noexcept;

// One file each; integrator.cpp has the table.
std::unique_ptr<Integrator> make_direct(const RenderContext& context, uint32_t max_tile_pixels);
std::unique_ptr<Integrator> make_path(const RenderContext& context, uint32_t max_tile_pixels);
std::unique_ptr<Integrator> make_ao(const RenderContext& context, uint32_t max_tile_pixels);
std::unique_ptr<Integrator> make_inspector(const RenderContext& context, uint32_t max_tile_pixels);
uint64_t path_bytes(uint32_t max_tile_pixels) noexcept;

}  // namespace steradian
