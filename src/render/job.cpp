// The one driver: checks the settings, hands (tile × block) units to the workers block by block over the whole frame,
// and folds what they bring into the film. With a time limit or a target for the error there are many passes, each of
// some samples for all pixels.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "render/adaptive_film.h"
#include "render/cryptomatte.h"
#include "render/film.h"
#include "render/integrator.h"
#include "render/memory_estimate.h"
#include "render/metadata.h"
#include "render/passes.h"
#include "scene/validate.h"

namespace steradian {
namespace {

using Clock = std::chrono::steady_clock;

Error settings_error(std::string message) { return make_error(ErrorCode::usage, std::move(message)); }

Status check(const RenderSettings& s, const Execution& e) {
    if (auto status = validate(s); !status) return status;
    if (e.tile_size < 1 || e.tile_size > 256)
        return settings_error(fmt::format("a tile size of {}: expected 1 to 256", e.tile_size));
    if (e.threads > 1024) return settings_error(fmt::format("{} threads: expected at most 1024", e.threads));
    if (e.fireflies > kMaxFireflies)
        return settings_error(fmt::format("{} fireflies: expected at most {}", e.fireflies, kMaxFireflies));
    if (!(e.time_limit == 0 || (e.time_limit >= kMinTimeLimit && e.time_limit <= kMaxTimeLimit)))
        return settings_error(fmt::format("a time limit of {} seconds: expected {} to {}, or 0 for none", e.time_limit,
                                          kMinTimeLimit, kMaxTimeLimit));
    if (e.time_limit > 0 && s.target_error > 0)
        return settings_error(
            "a time limit and a target for the error: one of them, so that time does not decide how "
            "many samples a pixel has");
    return check_picture_memory(s, e);
}

class Job final : public RenderJob {
public:
    Job(std::shared_ptr<const RenderScene> scene, const RenderSettings& settings, const Execution& execution,
        CameraSampler camera)
        : scene_(std::move(scene)),
          settings_(settings),
          execution_(execution),
          window_(window_of(settings)),
          film_(settings.target_error > 0 ? Crop{} : window_, execution.tile_size, settings.aovs),
          context_{*scene_,
                   settings_,
                   camera,
                   FilterSampler(settings.filter),
                   sampler_of(settings),
                   cancelled_,
                   rays_,
                   nullptr,
                   MatteIds(scene_->shading.scene, settings.aovs)},
          blocks_((settings.samples_per_pixel + kBlockSamples - 1) / kBlockSamples) {
        if (settings.target_error > 0)
            adaptive_.emplace(window_, double(settings.target_error), settings.samples_per_pixel, settings.aovs);
    }

    ~Job() override {
        cancel();
        for (std::thread& worker : workers_) worker.join();
    }

    /// Own threads and not TBB's: the number of workers is then exactly what was asked for, in any host program.
    void launch() {
        const uint32_t wanted = workers_of(execution_);
        const uint64_t units = passes_.begin_first();
        const auto count = static_cast<uint32_t>(std::min<uint64_t>(wanted, std::max<uint64_t>(units, 1)));
        // Integrators take their memory here, where running out of it can still be reported by start().
        std::vector<std::unique_ptr<Integrator>> integrators;
        for (uint32_t i = 0; i < count; ++i)
            integrators.push_back(make_integrator(context_, largest_tile(settings_, execution_)));
        running_ = count;
        workers_.reserve(count);
        for (uint32_t i = 0; i < count; ++i) {
            try {
                workers_.emplace_back([this, integrator = std::move(integrators[i])] { work(*integrator); });
            } catch (const std::system_error& e) {
                fail(make_error(ErrorCode::resources, fmt::format("cannot start {} threads: {}", count, e.what())));
                retire(count - i);
                break;
            }
        }
    }

    void cancel() noexcept override { cancelled_.store(true); }

    bool finished() const noexcept override { return finished_.load(); }

    bool wait_for(double seconds) override {
        std::unique_lock lock(mutex_);
        return done_.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return running_ == 0; });
    }

    RenderProgress progress() const override {
        RenderProgress p;
        p.samples_done = samples_done_.load();
        p.samples_total = samples_expected();
        p.rays = rays_.load();
        p.seconds = finished() ? seconds_.load() : std::chrono::duration<double>(Clock::now() - begin_).count();
        return p;
    }

    Result<Image> snapshot() const override {
        const FloatMode mode;
        try {
            return picture();
        } catch (const std::bad_alloc&) {
            return make_error(ErrorCode::resources, "not enough memory for the picture");
        }
    }

    Result<RenderResult> take() override {
        {
            std::unique_lock lock(mutex_);
            done_.wait(lock, [&] { return running_ == 0; });
            if (error_) return *error_;
        }
        auto image = snapshot();
        if (!image) return std::move(image).error();
        const AdaptiveFilm::Samples samples = samples_per_pixel();
        RenderResult result;
        result.image = std::move(*image);
        result.min_samples = samples.min;
        result.max_samples = samples.max;
        result.mean_samples = double(samples.total) / double(pixels());
        result.complete = passes_.ended() || (!adaptive_ && samples.min == settings_.samples_per_pixel);
        result.out_of_time = out_of_time_;
        result.error = report();
        result.statistics = statistics();
        return result;
    }

private:
    uint64_t pixels() const { return uint64_t(window_.x1 - window_.x0) * (window_.y1 - window_.y0); }

    AdaptiveFilm::Samples samples_per_pixel() const {
        if (adaptive_) return adaptive_->samples();
        const Film::Range range = film_.samples_per_pixel();
        return {range.min, range.max, samples_done_.load()};
    }
    std::optional<ErrorReport> report() const {
        if (!adaptive_ || !passes_.ended()) return std::nullopt;
        return adaptive_->report();
    }

    Image picture() const {
        // What ran out of time is the whole picture of so many samples.
        const bool whole = passes_.ended() && out_of_time_;
        const std::optional<ErrorReport> error = report();
        Image image = adaptive_ ? adaptive_->develop() : film_.develop();
        const AdaptiveFilm::Samples samples = samples_per_pixel();
        RenderSettings made_of = settings_;
        if (whole) made_of.samples_per_pixel = samples.min;
        image.metadata = picture_metadata(made_of, scene_->hash, samples.min, samples.max);
        image.metadata.merge(matte_metadata(scene_->shading.scene, settings_.aovs));
        if (adaptive_)
            image.metadata.merge(
                target_metadata(settings_, samples.max, double(samples.total) / double(pixels()), error));
        return image;
    }

    RenderStatistics statistics() const {
        RenderStatistics s;
        s.samples = samples_done_.load();
        s.camera_rays = counters_.camera_rays;
        s.bounce_rays = counters_.bounce_rays;
        s.shadow_rays = counters_.shadow_rays;
        s.bad_samples = counters_.bad_samples;
        s.first_bad_sample = counters_.first_bad_sample;
        s.fireflies = counters_.fireflies;
        s.threads = took_part_;
        s.seconds = seconds_.load();
        return s;
    }

    void work(Integrator& integrator) noexcept {
        const FloatMode mode;
        Counters counters;
        bool took_part = false;
        try {
            counters = Counters(execution_.fireflies);
            passes_.run([&](uint64_t unit) {
                const bool done = adaptive_ ? render_adaptive(integrator, unit, counters)
                                  : timed() ? render_part(integrator, unit, counters)
                                            : render_unit(integrator, unit, counters);
                took_part |= done;
                return done;
            });
        } catch (const std::bad_alloc&) {
            fail(make_error(ErrorCode::resources, "not enough memory to render"));
        } catch (const std::exception& e) {
            fail(make_error(ErrorCode::render_failed, fmt::format("the render failed: {}", e.what())));
        }
        {
            const std::lock_guard lock(mutex_);
            counters_.add(counters);
            took_part_ += took_part;
        }
        retire(1);
    }

    bool timed() const { return execution_.time_limit > 0; }

    /// How many units the next pass has.
    uint64_t begin_pass() {
        if (adaptive_) return begin_adaptive_pass();
        if (timed()) return begin_timed_pass();
        return std::exchange(first_sample_, settings_.samples_per_pixel) == 0 ? blocks_ * film_.tiles() : 0;
    }

    /// More samples for all pixels, in the same block of the film: at most as many as there are, for the speed is not
    /// known well in the beginning, and no more than there is time for. The first is made in any case.
    uint64_t begin_timed_pass() {
        first_sample_ += samples_;
        const uint64_t left = settings_.samples_per_pixel - first_sample_;
        if (left == 0) return 0;
        const double possible = first_sample_ == 0 ? 1 : samples_in_time() / double(pixels());
        if (!(possible >= 1)) {
            out_of_time_ = true;
            return 0;
        }
        const uint64_t most =
            std::min({left, std::max<uint64_t>(first_sample_, 1), kBlockSamples - first_sample_ % kBlockSamples});
        samples_ = static_cast<uint32_t>(min_of(possible, double(most)));
        return film_.tiles();
    }

    uint64_t begin_adaptive_pass() {
        if (!adaptive_->begin_pass()) return 0;
        samples_planned_ = samples_done_.load() + adaptive_->samples_to_come();
        return adaptive_->units();
    }

    double elapsed() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

    /// How many more camera samples there is time for, at the speed so far.
    double samples_in_time() const {
        return double(samples_done_.load()) / max_of(elapsed(), 1e-9) * (execution_.time_limit - elapsed());
    }

    /// By the end, as far as can be told.
    uint64_t samples_expected() const {
        const uint64_t done = samples_done_.load(), most = pixels() * settings_.samples_per_pixel;
        if (passes_.ended()) return done;
        if (adaptive_) return samples_planned_.load();
        if (!timed() || done == 0) return most;
        return done + static_cast<uint64_t>(min_of(max_of(samples_in_time(), 0.0), double(most - done)));
    }

    /// A tile's share of a pass with a time limit: goes on where the last one stopped.
    bool render_part(Integrator& integrator, uint64_t tile, Counters& counters) {
        const WorkUnit work{film_.rect(tile), first_sample_, samples_};
        TileSums sums = film_.open_sums(tile);
        if (!integrator.render(work, sums, counters)) return false;
        film_.extend(tile, work.samples, std::move(sums));
        samples_done_ += uint64_t(work.samples) * work.tile.pixels();
        return true;
    }

    bool render_adaptive(Integrator& integrator, uint64_t unit, Counters& counters) {
        const WorkUnit& work = adaptive_->work(unit);
        TileSums sums = adaptive_->sums(unit);
        // What is rendered a second time has had its report.
        Counters again;
        if (!integrator.render(work, sums, adaptive_->again(unit) ? again : counters)) return false;
        counters.add_rays(again);
        adaptive_->commit(unit, std::move(sums));
        samples_done_ += uint64_t(work.samples) * work.tile.pixels();
        return true;
    }

    /// Units are numbered block by block over the whole frame, so that there is a whole picture early.
    bool render_unit(Integrator& integrator, uint64_t unit, Counters& counters) {
        const size_t tile = unit % film_.tiles();
        const uint64_t block = unit / film_.tiles();
        WorkUnit work;
        work.tile = film_.rect(tile);
        work.first_sample = block * kBlockSamples;
        work.samples =
            static_cast<uint32_t>(std::min<uint64_t>(kBlockSamples, settings_.samples_per_pixel - work.first_sample));
        TileSums sums = film_.empty_sums(tile);
        if (!integrator.render(work, sums, counters)) return false;
        film_.commit(tile, block, work.samples, std::move(sums));
        samples_done_ += uint64_t(work.samples) * work.tile.pixels();
        return true;
    }

    void fail(Error error) {
        const std::lock_guard lock(mutex_);
        if (!error_) error_ = std::move(error);
        cancelled_ = true;
    }

    void retire(uint32_t workers) {
        const std::lock_guard lock(mutex_);
        running_ -= workers;
        if (running_ > 0) return;
        seconds_ = std::chrono::duration<double>(Clock::now() - begin_).count();
        finished_ = true;
        done_.notify_all();
    }

    const std::shared_ptr<const RenderScene> scene_;
    const RenderSettings settings_;
    const Execution execution_;
    const Crop window_;
    std::atomic<bool> cancelled_{false};
    std::atomic<uint64_t> rays_{0};
    Film film_;
    const RenderContext context_;
    const uint64_t blocks_;
    const Clock::time_point begin_ = Clock::now();

    std::optional<AdaptiveFilm> adaptive_;  ///< instead of film_, where there is a target
    std::atomic<uint64_t> samples_done_{0};
    std::atomic<uint64_t> samples_planned_{0};  ///< by the end, towards a target
    std::atomic<bool> out_of_time_{false};
    uint64_t first_sample_ = 0;  ///< of the pass under way
    uint32_t samples_ = 0;       ///< of each pixel in it, where there is a time limit
    Passes passes_{[this] { return begin_pass(); }, cancelled_};
    std::atomic<double> seconds_{0};
    std::atomic<bool> finished_{false};

    mutable std::mutex mutex_;  ///< guards what follows
    std::condition_variable done_;
    uint32_t running_ = 0;
    uint32_t took_part_ = 0;
    Counters counters_{execution_.fireflies};
    std::optional<Error> error_;

    std::vector<std::thread> workers_;
};

}  // namespace

Result<std::unique_ptr<RenderJob>> RenderJob::start(std::shared_ptr<const RenderScene> scene,
                                                    const RenderSettings& settings, const Execution& execution) {
    const FloatMode mode;
    if (auto status = check(settings, execution); !status) return std::move(status).error();
    auto camera = camera_of(*scene, settings);
    if (!camera) return std::move(camera).error();
    try {
        auto job = std::make_unique<Job>(std::move(scene), settings, execution, *camera);
        job->launch();
        return std::unique_ptr<RenderJob>(std::move(job));
    } catch (const std::bad_alloc&) {
        return make_error(ErrorCode::resources, fmt::format("not enough memory for a picture of {} × {} pixels",
                                                            settings.width, settings.height));
    } catch (const std::exception& e) {
        return make_error(ErrorCode::render_failed, fmt::format("cannot start the render: {}", e.what()));
    }
}

Result<RenderResult> render(Scene scene, const RenderSettings& settings, const Execution& execution) {
    Diagnostics diagnostics;
    auto prepared = prepare(std::move(scene), execution, diagnostics);
    if (!prepared) return std::move(prepared).error();
    auto job = RenderJob::start(std::move(*prepared), settings, execution);
    if (!job) return std::move(job).error();
    return (*job)->take();
}

}  // namespace steradian
