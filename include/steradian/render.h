// From a Scene to a picture.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "steradian/image.h"
#include "steradian/result.h"
#include "steradian/scene.h"
#include "steradian/settings.h"

namespace steradian {

/// A scene made ready to render: checked, its light tables and bounding volume hierarchies built. Immutable, so many
/// jobs may use it at once.
class RenderScene;

/// What prepare asks and tells its caller on the way; either may be missing. Called by one thread at a time, which need
/// not be the caller's.
struct PrepareHooks {
    std::function<bool()> cancelled;  ///< asked now and then whether to stop
    /// Told how much of the hierarchies is built: 0 when that begins, then more each time, and 1 when it is done.
    std::function<void(double fraction)> progress;
};

/// Takes the scene over (its arrays are moved, not copied). Fails with bad_input when an id refers to nothing or a
/// value makes no sense, with resources when there is not enough memory, with render_failed when cancelled. Geometry
/// that cannot be rendered (vertices that are not finite or beyond 1e15) is dropped with one counted warning in
/// `diagnostics`.
Result<std::shared_ptr<const RenderScene>> prepare(Scene scene, const Execution& execution, Diagnostics& diagnostics,
                                                   const PrepareHooks& hooks = {});

/// What rendering a scene takes, in bytes and within about a fifth, before any of it is taken.
struct MemoryEstimate {
    uint64_t scene = 0;      ///< what the Scene holds: geometry, texels, objects
    uint64_t hierarchy = 0;  ///< the hierarchy and the tables of lights and objects, as long as the scene is rendered
    uint64_t build = 0;      ///< on top of that while they are built
    uint64_t picture = 0;    ///< while a picture is rendered
    uint64_t peak() const noexcept { return scene + hierarchy + (build > picture ? build : picture); }
};
/// Of a scene that need not have been checked, and of settings and an execution in their documented ranges. prepare and
/// RenderJob::start refuse what does not fit into memory by these numbers.
MemoryEstimate estimate_memory(const Scene& scene, const RenderSettings& settings, const Execution& execution = {});

struct RenderProgress {
    uint64_t samples_done = 0;   ///< camera samples finished, over all pixels
    uint64_t samples_total = 0;  ///< by the end; with a time limit or a target an estimate
    uint64_t rays = 0;           ///< traced so far, shadow rays included
    double seconds = 0;          ///< since the job started
};

/// A camera sample and its radiance, before the filter's weight.
struct PixelSample {
    uint32_t x = 0, y = 0;
    uint64_t sample = 0;
    Rgb value;
};

struct RenderStatistics {
    uint64_t samples = 0;
    uint64_t camera_rays = 0;
    uint64_t bounce_rays = 0;  ///< those that carry a path on
    uint64_t shadow_rays = 0;
    uint64_t bad_samples = 0;
    /// Of those that were not finite, non-negative radiances and counted as 0, the one with the smallest (sample, y,
    /// x).
    std::optional<PixelSample> first_bad_sample;
    /// As many as Execution::fireflies asks for: those of the largest luminance, and among equals of the smallest
    /// (sample, y, x). replay() (replay.h) shows where they come from.
    std::vector<PixelSample> fireflies;
    uint32_t threads = 0;  ///< how many really took part
    double seconds = 0;
};

/// What is known of the error √mean(Var / (I + 0.01)²) of a picture that was rendered up to a target, over pixels and
/// channels (docs/decisions/0016).
struct ErrorReport {
    double estimate = 0;
    double bound = 0;        ///< no claim unless `certified`; may be infinite
    bool certified = false;  ///< in `confidence` of all cases this picture's error is at most `bound`, which is at most
                             ///< the target; but for light that is in many pixels and that no sample met
    std::string reason;      ///< why not: a sentence's part, in English
    static constexpr double confidence = 0.95;
};

struct RenderResult {
    /// R, G, B of the crop window (or the whole picture) and the AOVs that were asked for, with metadata.
    Image image;
    bool complete = true;  ///< false after a cancel: `image` holds what was done, each pixel over its own sample count
    uint64_t min_samples = 0, max_samples = 0;  ///< per pixel
    double mean_samples = 0;                    ///< of all pixels; there may have been more that do not count
    bool out_of_time = false;  ///< Execution::time_limit ended it; it is complete, with fewer samples than were allowed
    std::optional<ErrorReport> error;  ///< where RenderSettings::target_error asked for one, once it is complete
    RenderStatistics statistics;
};

/// A render in progress on its own threads. Destroying it cancels and waits.
class RenderJob {
public:
    static Result<std::unique_ptr<RenderJob>> start(std::shared_ptr<const RenderScene> scene,
                                                    const RenderSettings& settings, const Execution& execution);
    virtual ~RenderJob() = default;

    /// Asks the job to stop soon. Safe from any thread, and from a signal handler.
    virtual void cancel() noexcept = 0;
    virtual bool finished() const noexcept = 0;
    /// Blocks until the job ends, at most `seconds`; true when it has ended.
    virtual bool wait_for(double seconds) = 0;
    virtual RenderProgress progress() const = 0;
    /// The picture as it is now, from whole sample blocks of each tile; pixels without samples are 0.
    virtual Result<Image> snapshot() const = 0;
    /// Blocks until the end and hands the result over, once.
    virtual Result<RenderResult> take() = 0;
};

/// prepare, start, wait.
Result<RenderResult> render(Scene scene, const RenderSettings& settings, const Execution& execution = {});

}  // namespace steradian
