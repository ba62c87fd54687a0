// What integrators share: the camera samples of a tile as arrays of path states that advance together, one bounce at a
// time, so that the acceleration structure gets spans of rays; and a queue of shadow rays.
#pragma once

#include <algorithm>
#include <vector>

#include "render/first_hit.h"
#include "render/integrator.h"
#include "render/interiors.h"
#include "render/light_parts.h"
#include "render/recorder.h"
#include "shading/bsdf.h"
#include "shading/light.h"
#include "shading/opacity.h"
#include "shading/ray_cone.h"

namespace steradian {

/// Which numbers of a sample are used for what. Groups of four belong together (sampler.h).
enum Dimension : uint32_t {
    kFilterDimension = 0,               // and 1
    kLensDimension = 2,                 // and 3
    kBounceDimension = 4,               // four per bounce: choice of lobe, Russian roulette, direction
    kWavelengthDimension = 0x3ffffffc,  // where a scene disperses light
    kLightDimension = 0x40000000,       // four per light, where all are sampled: position, choice of part, unused
    kOneLightDimension = 0x80000000,  // four per bounce, where one light is sampled: position, choice of part, of light
    kMediumDimension = 0xe0000000,   // four per bounce, how far the way to it is in a medium: channel, distance, unused
    kOpacityDimension = 0xc0000000,  // 4096 per bounce: whether the surfaces on the way to the next vertex are there
};

/// Scaled down where its largest channel is above `limit`. What is not finite stays so, and is counted.
inline Rgb clamped(Rgb contribution, float limit) {
    const float most = max_component(contribution);
    return most > limit && is_finite(contribution) ? contribution * (limit / most) : contribution;
}

class WavefrontIntegrator : public Integrator {
public:
    WavefrontIntegrator(const RenderContext& context, uint32_t max_tile_pixels);
    bool render(const WorkUnit& unit, TileSums& sums, Counters& counters) final;

    /// Paths under way at a time, and what they take.
    static uint32_t capacity(uint32_t max_tile_pixels) noexcept;
    static uint64_t bytes(uint32_t max_tile_pixels) noexcept;
    /// What AOVs take on top.
    static uint64_t aov_bytes(AovSet aovs, uint32_t max_tile_pixels) noexcept;

protected:
    struct Path {
        SampleKey key;
        uint32_t x, y, pixel;
        float weight;      ///< the filter's
        float wavelength;  ///< micrometres; 0: all, as long as nothing has dispersed the path's light
        Rgb throughput, radiance;
        RayCone cone;  ///< of the ray under way; kept only where the scene uses footprints
        Rgb passed;    ///< what the medium has left on its way; where there are interiors only
    };

    /// Shades the hits of all paths that are still on their way: calls each_hit. `depth` bounces lie behind them.
    virtual void bounce(uint32_t depth) noexcept = 0;
    /// Of the shadow rays from vertices with `depth` bounces behind them. Those of what the camera sees start side by
    /// side and end at the same light.
    virtual RayKind shadow_ray_kind(uint32_t depth) const noexcept {
        return depth == 0 ? RayKind::coherent : RayKind::incoherent;
    }

    /// Calls shade(id of the path, ray, hit) for each, in order.
    template <class Shade>
    void each_hit(Shade shade) noexcept {
        for (size_t i = 0; i < rays_.size() && !stopped(); ++i) {
            if (c_.recorder) record_vertex(active_[i], rays_[i], hits_[i]);
            shade(active_[i], rays_[i], hits_[i]);
        }
    }
    /// The path goes on along `ray`.
    void continue_along(uint32_t id, const Ray& ray) noexcept;
    /// The path's radiance grows by `contribution` when nothing is in the way of `shadow_ray`. Rays of one `group`,
    /// such as those towards one light, are traced together.
    void connect(uint32_t id, uint32_t group, const Ray& shadow_ray, Rgb contribution, bool beyond) noexcept;
    /// The path's radiance grows by emission that its ray has found, of a surface or of the background.
    void gain(uint32_t id, Rgb contribution, bool background) noexcept {
        Path& path = paths_[id];
        path.radiance = path.radiance + contribution;
        if (parts_.wanted()) parts_.found(id, contribution, background);
    }

    /// Where a ray of a path has arrived.
    SurfacePoint arrive(uint32_t id, const Ray& ray, const Hit& hit) noexcept {
        SurfacePoint out = surface_at(shading_, ray, hit);
        if (shading_.uses_footprints()) {
            RayCone& cone = paths_[id].cone;
            cone = cone.after(hit.t);
            out.footprint = footprint_of(cone, out);
        }
        if (interiors_.wanted()) interiors_.describe(id, ray, hit, out);
        if (depth_ == 0 && first_hits_.wanted()) first_hits_.see(id, paths_[id].key, out, -ray.d);
        return out;
    }
    /// Where the surface disperses light, the path gets a wavelength for the rest of its way, unless it has one.
    void disperse(uint32_t id, const SurfacePoint& point) noexcept {
        if (shading_.wavelengths && paths_[id].wavelength == 0 && disperses(shading_, point)) choose_wavelength(id);
    }
    /// The path turns at `point`.
    void turn(uint32_t id, const SurfacePoint& point, const Bsdf& bsdf, Vec3 wo, const BsdfSample& next) noexcept {
        if (parts_.wanted()) parts_.turn(id, bsdf, wo, next);
        if (interiors_.wanted()) interiors_.turn(id, on_two_sides(bsdf, wo, next.wi));
        if (shading_.uses_footprints() && point.instance != kNoHit)
            paths_[id].cone = bounced(paths_[id].cone, shading_, point, next);
    }

    /// A point where light is gathered.
    struct Vertex {
        SurfacePoint from;  ///< facing wo: the side that receives
        Bsdf bsdf;
        Vec3 wo;
    };
    Vertex vertex_at(const SurfacePoint& point, Vec3 wo, float wavelength = 0) const noexcept {
        Vertex out{point, make_bsdf(shading_, point, wavelength), wo};
        out.from.ns = out.bsdf.frame.z;
        out.from = facing(out.from, wo);
        // What is seen from behind its shading normal scatters about the geometric one, if at all.
        if (!(dot(out.from.ns, wo) > 0)) out.from.ns = out.from.ng;
        out.from.both_sides = !only_reflects(out.bsdf);
        return out;
    }
    /// A point in a medium, where a ray has ended.
    Vertex vertex_in_medium(uint32_t id, const Ray& ray) const noexcept;
    /// One direction towards one light. `scale` stands for the path's throughput over the expected number of samples,
    /// `limit` is for what comes of it (see clamped()), and weight(light's density, BSDF's) gives the sample's weight.
    /// `part`: see sample_light().
    template <class Weight>
    void sample_towards(uint32_t id, const Vertex& at, uint32_t light, uint32_t choice, Vec2 u, Rgb scale, float limit,
                        Weight weight, const LightQuery* part = nullptr) noexcept;
    /// Every light, as often as it wants; `weight` is also told how often that is: weight(n, light's density, BSDF's).
    /// Samples of one light continue one low-discrepancy sequence: sample i of n within camera sample s is its point
    /// s n + i.
    template <class Weight>
    void sample_all_lights(uint32_t id, const Vertex& at, float limit, Weight weight) noexcept;

    Path& path(uint32_t id) noexcept { return paths_[id]; }
    bool stopped() const noexcept { return c_.cancelled.load(std::memory_order_relaxed); }

    const RenderContext& c_;
    const ShadingScene& shading_;
    /// Which the environment is sampled with.
    EnvironmentDensity density_ = EnvironmentDensity::complete;
    /// Media scatter: rays end in them. Otherwise what they scatter is lost.
    bool scatters_ = false;
    /// Whether a ray that has hit nothing has ended in a medium.
    static bool ends_in_medium(const Ray& ray) noexcept { return ray.tmax < kInfinity; }

private:
    /// A shadow ray's owner and what it brings when nothing is in the way.
    struct Connection {
        uint32_t path, group;
        Rgb contribution;
        bool beyond = false;  ///< it leaves to the other side of the surface
    };

    void choose_wavelength(uint32_t id) noexcept;
    void generate(const WorkUnit& unit, uint64_t first_sample, uint32_t samples) noexcept;
    void advance(uint32_t depth) noexcept;
    void look_through(std::span<Hit> hits) noexcept;
    bool passes(const Path& path, const Ray& ray, const Hit& hit, uint32_t crossing) const noexcept;
    void absorb() noexcept;
    void end_in_medium(uint32_t id, Ray& ray, uint32_t depth) const noexcept;
    float transmittance(const Connection& connection, const Ray& shadow_ray) const noexcept;
    void trace_shadow_rays() noexcept;
    void order_pixels(const TileRect& tile) noexcept;
    void order_shadow_rays() noexcept;
    void record_vertex(uint32_t id, const Ray& ray, const Hit& hit) noexcept;
    void accumulate(const WorkUnit& unit, uint32_t count, TileSums& sums);
    template <class Trace>
    void in_slices(size_t rays, Trace trace) const noexcept;

    const uint32_t capacity_;
    Counters* counters_ = nullptr;  ///< of the unit under way
    uint32_t depth_ = 0;            ///< bounces behind the paths under way
    std::vector<uint32_t> pixels_;  ///< of the tile, in the order of their paths
    std::vector<Path> paths_;
    std::vector<uint32_t> active_, next_active_;
    std::vector<Ray> rays_, next_rays_;  ///< of the active paths, in the same order
    std::vector<Hit> hits_;
    std::vector<Ray> shadow_rays_;
    std::vector<Connection> connections_;
    std::vector<uint32_t> shadow_order_;  ///< in which they are traced
    std::vector<uint8_t> occluded_;       ///< an Accel::Occlusion each
    FirstHits first_hits_;
    LightParts parts_;
    Interiors interiors_;
    std::vector<LightSplit> splits_;  ///< of the shadow rays, where parts are wanted
};

template <class Weight>
void WavefrontIntegrator::sample_towards(uint32_t id, const Vertex& at, uint32_t light, uint32_t choice, Vec2 u,
                                         Rgb scale, float limit, Weight weight, const LightQuery* part) noexcept {
    const std::optional<LightSample> towards = sample_light(shading_, light, at.from, choice, u, density_, part);
    if (!towards) return;
    const float density = towards->pdf > 0 ? towards->pdf : 1.0f;
    const BsdfEval scattered = eval(at.bsdf, at.wo, towards->wi);
    const float mis_weight = weight(towards->pdf, scattered.pdf);
    Rgb arriving = towards->radiance / density;
    bool beyond = false;
    if (interiors_.wanted()) {
        beyond = on_two_sides(at.bsdf, at.wo, towards->wi);
        arriving = arriving * interiors_.transmittance(id, beyond, towards->distance());
    }
    const Rgb contribution = clamped(scale * scattered.f_cos * arriving * mis_weight, limit);
    const bool brings = !is_black(contribution);
    if (c_.recorder)
        c_.recorder->light(
            {light, {}, towards->wi, towards->pdf, scattered.pdf, mis_weight, contribution, brings, false});
    if (!brings) return;
    connect(id, light, towards->shadow_ray, contribution, beyond);
    if (parts_.wanted()) splits_.push_back(parts_.split(id, at.bsdf, at.wo, towards->wi, scattered));
}

template <class Weight>
void WavefrontIntegrator::sample_all_lights(uint32_t id, const Vertex& at, float limit, Weight weight) noexcept {
    const SampleKey own = path(id).key;
    const auto lights = static_cast<uint32_t>(shading_.scene.lights.size());
    for (uint32_t light = 0; light < lights && !stopped(); ++light) {
        const uint32_t n = light_sample_count(shading_, light);
        const Rgb scale = path(id).throughput / static_cast<float>(n);
        const uint32_t dimension = kLightDimension + 4 * light;
        for (uint32_t i = 0; i < n; ++i) {
            const SampleKey key{own.pixel, own.sample * n + i};
            const Vec2 u = c_.sampler.get_2d(key, dimension);
            const uint32_t choice = c_.sampler.bits(key, dimension + 2);
            sample_towards(id, at, light, choice, u, scale, limit,
                           [&](float light_pdf, float bsdf_pdf) { return weight(n, light_pdf, bsdf_pdf); });
        }
    }
}

}  // namespace steradian
