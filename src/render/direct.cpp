// Direct lighting: the path that follows perfect reflection and refraction to its first other surface, and there
// connects to every light. Many paths advance together, one bounce at a time, over arrays of path states, so that the
// acceleration structure gets spans of rays.
#include <algorithm>
#include <tuple>
#include <vector>

#include "render/integrator.h"
#include "shading/bsdf.h"
#include "shading/light.h"

namespace steradian {
namespace {

/// Which numbers of a sample are used for what. Groups of four belong together (sampler.h).
enum Dimension : uint32_t {
    kFilterDimension = 0,          // and 1; 2 and 3 are for a lens
    kBounceDimension = 4,          // four per bounce: choice of lobe, unused, direction
    kLightDimension = 0x40000000,  // four per light: position, choice of part, unused
};

constexpr uint32_t kBatchPaths = 4096;
constexpr uint32_t kBatchShadowRays = 16384;

class DirectIntegrator final : public Integrator {
public:
    DirectIntegrator(const RenderContext& context, uint32_t max_tile_pixels)
        : c_(context), shading_(context.scene.shading), capacity_(std::max(max_tile_pixels, kBatchPaths)) {
        paths_.resize(capacity_);
        active_.reserve(capacity_);
        rays_.reserve(capacity_);
        next_active_.reserve(capacity_);
        next_rays_.reserve(capacity_);
        hits_.resize(capacity_);
        shadow_rays_.reserve(kBatchShadowRays);
        connections_.reserve(kBatchShadowRays);
        occluded_.resize(kBatchShadowRays);
    }

    bool render(const WorkUnit& unit, std::span<RgbSum> sums, Counters& counters) noexcept override {
        const uint32_t pixels = unit.tile.pixels();
        const uint32_t step = std::max(1u, capacity_ / pixels);
        for (uint32_t done = 0; done < unit.samples; done += step) {
            const uint32_t samples = std::min(step, unit.samples - done);
            generate(unit, unit.first_sample + done, samples, counters);
            for (uint32_t depth = 0; !active_.empty(); ++depth) {
                advance(depth, counters);
                if (stopped()) return false;
            }
            accumulate(pixels * samples, sums, counters);
        }
        return true;
    }

    static uint64_t bytes(uint32_t max_tile_pixels) noexcept {
        constexpr uint64_t path = sizeof(Path) + 2 * (sizeof(uint32_t) + sizeof(Ray)) + sizeof(Hit);
        return std::max(max_tile_pixels, kBatchPaths) * path +
               kBatchShadowRays * (sizeof(Ray) + sizeof(Connection) + sizeof(uint8_t));
    }

private:
    struct Path {
        SampleKey key;
        uint32_t x, y, pixel;
        float weight;
        Rgb throughput, radiance;
    };
    /// A shadow ray's owner and what it brings when nothing is in the way.
    struct Connection {
        uint32_t path;
        Rgb contribution;
    };

    /// Camera rays, sample by sample and within a sample pixel by pixel.
    void generate(const WorkUnit& unit, uint64_t first_sample, uint32_t samples, Counters& counters) noexcept {
        active_.clear();
        rays_.clear();
        const uint32_t pixels = unit.tile.pixels();
        for (uint32_t i = 0; i < pixels * samples; ++i) {
            Path& path = paths_[i];
            path.pixel = i % pixels;
            path.x = unit.tile.x0 + path.pixel % unit.tile.width();
            path.y = unit.tile.y0 + path.pixel / unit.tile.width();
            path.key = c_.sampler.key(path.x, path.y, first_sample + i / pixels);
            const FilterSample position = c_.filter.sample(c_.sampler.get_2d(path.key, kFilterDimension));
            path.weight = position.weight;
            path.throughput = {1, 1, 1};
            path.radiance = {};
            const Vec2 film{static_cast<float>(path.x) + 0.5f + position.offset.x,
                            static_cast<float>(path.y) + 0.5f + position.offset.y};
            rays_.push_back(c_.camera.generate(film));
            active_.push_back(i);
        }
        counters.camera_rays += pixels * samples;
    }

    /// One bounce of all paths that are still on their way.
    void advance(uint32_t depth, Counters& counters) noexcept {
        const std::span<Hit> hits(hits_.data(), rays_.size());
        in_slices(rays_, [&](std::span<const Ray> rays, size_t first) {
            const RayKind kind = depth == 0 ? RayKind::coherent : RayKind::incoherent;
            c_.scene.accel.intersect(rays, hits.subspan(first, rays.size()), kind);
        });
        next_active_.clear();
        next_rays_.clear();
        for (size_t i = 0; i < hits.size() && !stopped(); ++i) shade(active_[i], rays_[i], hits[i], depth, counters);
        trace_shadow_rays(counters);
        counters.specular_rays += next_rays_.size();
        active_.swap(next_active_);
        rays_.swap(next_rays_);
    }

    void shade(uint32_t id, const Ray& ray, const Hit& hit, uint32_t depth, Counters& counters) noexcept {
        Path& path = paths_[id];
        if (!hit.found()) {
            path.radiance = path.radiance + path.throughput * environment_radiance(shading_, ray.d);
            return;
        }
        const SurfacePoint point = surface_at(shading_, ray, hit);
        const Vec3 wo = -ray.d;
        path.radiance = path.radiance + path.throughput * emitted_radiance(shading_, point, wo);
        if (depth >= c_.settings.max_depth) return;
        const Bsdf bsdf = make_bsdf(shading_, point);
        if (is_specular(bsdf))
            follow(id, point, bsdf, wo, depth);
        else
            connect(id, point, bsdf, wo, counters);
    }

    void follow(uint32_t id, const SurfacePoint& point, const Bsdf& bsdf, Vec3 wo, uint32_t depth) noexcept {
        Path& path = paths_[id];
        const uint32_t dimension = kBounceDimension + 4 * depth;
        const float choice = c_.sampler.get_1d(path.key, dimension);
        const Vec2 u = c_.sampler.get_2d(path.key, dimension + 2);
        const std::optional<BsdfSample> next = sample(bsdf, wo, choice, u);
        if (!next || is_black(next->weight)) return;
        path.throughput = path.throughput * next->weight;
        next_rays_.push_back(spawn_ray(point, next->wi));
        next_active_.push_back(id);
    }

    /// Light samples of one light continue one low-discrepancy sequence: sample i of n within camera sample s is its
    /// point s n + i.
    void connect(uint32_t id, const SurfacePoint& point, const Bsdf& bsdf, Vec3 wo, Counters& counters) noexcept {
        Path& path = paths_[id];
        const SurfacePoint from = facing(point, wo);  // the side that receives
        const auto lights = static_cast<uint32_t>(shading_.scene.lights.size());
        for (uint32_t light = 0; light < lights && !stopped(); ++light) {
            const uint32_t n = light_sample_count(shading_, light);
            const Rgb scale = path.throughput / static_cast<float>(n);
            const uint32_t dimension = kLightDimension + 4 * light;
            for (uint32_t i = 0; i < n; ++i) {
                const SampleKey key{path.key.pixel, path.key.sample * n + i};
                const Vec2 u = c_.sampler.get_2d(key, dimension);
                const uint32_t choice = c_.sampler.bits(key, dimension + 2);
                const std::optional<LightSample> towards = sample_light(shading_, light, from, choice, u);
                if (!towards) continue;
                const float density = towards->pdf > 0 ? towards->pdf : 1.0f;
                const Rgb contribution = scale * eval(bsdf, wo, towards->wi).f_cos * (towards->radiance / density);
                if (is_black(contribution)) continue;
                if (shadow_rays_.size() == kBatchShadowRays) trace_shadow_rays(counters);
                shadow_rays_.push_back(towards->shadow_ray);
                connections_.push_back({id, contribution});
            }
        }
    }

    void trace_shadow_rays(Counters& counters) noexcept {
        const std::span<uint8_t> occluded(occluded_.data(), shadow_rays_.size());
        in_slices(shadow_rays_, [&](std::span<const Ray> rays, size_t first) {
            c_.scene.accel.occluded(rays, occluded.subspan(first, rays.size()), RayKind::coherent);
        });
        for (size_t i = 0; i < occluded.size(); ++i) {
            if (occluded[i]) continue;
            Rgb& radiance = paths_[connections_[i].path].radiance;
            radiance = radiance + connections_[i].contribution;
        }
        counters.shadow_rays += shadow_rays_.size();
        shadow_rays_.clear();
        connections_.clear();
    }

    bool stopped() const noexcept { return c_.cancelled.load(std::memory_order_relaxed); }

    /// Calls trace(some rays, index of the first) until all are done or the job is cancelled: a cancelled job must not
    /// wait for thousands of rays, which in a hostile scene take milliseconds each.
    template <class Trace>
    void in_slices(std::span<const Ray> rays, Trace trace) const noexcept {
        constexpr size_t kSlice = 512;
        for (size_t first = 0; first < rays.size() && !stopped(); first += kSlice) {
            const std::span<const Ray> slice = rays.subspan(first, std::min(kSlice, rays.size() - first));
            trace(slice, first);
            c_.rays.fetch_add(slice.size(), std::memory_order_relaxed);
        }
    }

    void accumulate(uint32_t count, std::span<RgbSum> sums, Counters& counters) noexcept {
        for (uint32_t i = 0; i < count; ++i) {
            const Path& path = paths_[i];
            const Rgb l = path.radiance;
            if (is_finite(l) && l.r >= 0 && l.g >= 0 && l.b >= 0)
                sums[path.pixel].add(l, path.weight);
            else
                counters.bad({path.x, path.y, path.key.sample, l});
        }
    }

    const RenderContext& c_;
    const ShadingScene& shading_;
    const uint32_t capacity_;
    std::vector<Path> paths_;
    std::vector<uint32_t> active_, next_active_;
    std::vector<Ray> rays_, next_rays_;  ///< of the active paths, in the same order
    std::vector<Hit> hits_;
    std::vector<Ray> shadow_rays_;
    std::vector<Connection> connections_;
    std::vector<uint8_t> occluded_;
};

}  // namespace

uint64_t direct_integrator_bytes(uint32_t max_tile_pixels) noexcept { return DirectIntegrator::bytes(max_tile_pixels); }

void Counters::bad(const BadSample& sample) {
    ++bad_samples;
    const auto order = [](const BadSample& s) { return std::tuple(s.sample, s.y, s.x); };
    if (!first_bad_sample || order(sample) < order(*first_bad_sample)) first_bad_sample = sample;
}

void Counters::add(const Counters& other) {
    camera_rays += other.camera_rays;
    specular_rays += other.specular_rays;
    shadow_rays += other.shadow_rays;
    const uint64_t bad_total = bad_samples + other.bad_samples;
    if (other.first_bad_sample) bad(*other.first_bad_sample);
    bad_samples = bad_total;
}

std::unique_ptr<Integrator> make_direct_integrator(const RenderContext& context, uint32_t max_tile_pixels) {
    return std::make_unique<DirectIntegrator>(context, max_tile_pixels);
}

}  // namespace steradian
