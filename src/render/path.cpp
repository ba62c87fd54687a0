// Unidirectional path tracing with next-event estimation: every rough vertex asks lights for directions and the BSDF
// for one, and multiple importance sampling puts the two together (Veach 1997, chapter 9). The BSDF's direction carries
// the path on; Russian roulette ends it.
#include "render/wavefront.h"

namespace steradian {
namespace {

/// With at most so many lights the first rough vertex of a path samples all of them, as `direct` does. Otherwise, and
/// at every later vertex, one light is chosen.
constexpr uint32_t kFewLights = 16;

/// a² / (a² + b²) (Veach 1997, section 9.2.4) for the strategy with a, against another one with b: densities times
/// numbers of samples, not both 0.
float power_heuristic(double a, double b) {
    const double ratio = b / a;
    return static_cast<float>(1 / (1 + ratio * ratio));
}

class PathIntegrator final : public WavefrontIntegrator {
public:
    PathIntegrator(const RenderContext& context, uint32_t max_tile_pixels)
        : WavefrontIntegrator(context, max_tile_pixels),
          lights_(shading_.light_selection),
          choice_(c_.settings.light_choice),
          limit_(c_.settings.clamp > 0 ? c_.settings.clamp : kInfinity) {
        states_.resize(capacity(max_tile_pixels));
        scatters_ = true;
        arrivals_.resize(kTogether);
        // What light samples leave out then, the BSDF's find.
        if (c_.settings.light_sampling == LightSampling::mis) density_ = EnvironmentDensity::compensated;
    }

    static uint64_t bytes(uint32_t max_tile_pixels) noexcept {
        return WavefrontIntegrator::bytes(max_tile_pixels) + capacity(max_tile_pixels) * sizeof(State) +
               kTogether * sizeof(Arrival);
    }

private:
    /// What a path's next vertex has to know of the ones before.
    struct State {
        SurfacePoint from;        ///< the last vertex, as lights were sampled from it
        float bsdf_pdf = 0;       ///< of the ray under way; 0 where no light sample could have found its direction
        bool all_lights = false;  ///< at the last vertex, rather than one
        uint32_t direct_bounces = ~0u;  ///< what has more bounces than this is not direct light
        float radiance_scale = 1;       ///< what refraction has left in the throughput
    };

    /// So many paths choose their lights together: as many as there are before memory is what they wait for, and few
    /// enough that what waits stays in the first cache.
    static constexpr uint32_t kTogether = 16;
    /// A path at a surface, or at a point in a medium, before it chooses lights and a direction.
    struct Arrival {
        uint32_t id;
        SurfacePoint point;
        Vertex vertex;
    };
    static_assert(std::is_trivially_destructible_v<Arrival>);

    void bounce(uint32_t depth) noexcept override {
        each_hit([&](uint32_t id, const Ray& ray, const Hit& hit) { see(id, ray, hit, depth); });
        leave(depth);
    }

    /// What the path's ray has found: its emission at once; a vertex waits for others to come.
    void see(uint32_t id, const Ray& ray, const Hit& hit, uint32_t depth) noexcept {
        if (depth == 0) states_[id] = {};
        if (!hit.found() && ends_in_medium(ray)) {
            if (depth >= c_.settings.max_depth) return;
            Arrival& a = arrivals_[waiting_];
            a.id = id;
            ::new (static_cast<void*>(&a.vertex)) Vertex(vertex_in_medium(id, ray));
            ::new (static_cast<void*>(&a.point)) SurfacePoint(a.vertex.from);
            if (++waiting_ == kTogether) leave(depth);
            return;
        }
        if (!hit.found()) {
            const SurfacePoint* from = states_[id].bsdf_pdf > 0 ? &states_[id].from : nullptr;
            for (uint32_t i = 0; i < distant_sources(shading_); ++i) {
                const DistantRadiance sky = distant_radiance(shading_, i, ray.d, depth == 0, from, density_);
                add_emission(id, sky.radiance, sky.light, depth, true, [&] { return sky.pdf; });
            }
            return;
        }
        // In place: a BSDF takes kilobytes, of which most kinds use a few bytes.
        Arrival& a = arrivals_[waiting_];
        a.id = id;
        const SurfacePoint& point = *::new (static_cast<void*>(&a.point)) SurfacePoint(arrive(id, ray, hit));
        const Vec3 wo = -ray.d;
        const uint32_t light = shading_.instances[point.instance].area_light;
        add_emission(id, emitted_radiance(shading_, point, wo), light, depth, false,
                     [&] { return pdf_light(shading_, light, states_[id].from, ray.d, &point); });
        if (depth >= c_.settings.max_depth) return;
        disperse(id, point);
        ::new (static_cast<void*>(&a.vertex)) Vertex(vertex_at(point, wo, path(id).wavelength));
        if (++waiting_ == kTogether) leave(depth);
    }

    /// The paths that wait go on.
    void leave(uint32_t depth) noexcept {
        choose_lights(depth);
        for (uint32_t i = 0; i < waiting_; ++i) {
            const Arrival& a = arrivals_[i];
            if (!is_specular(a.vertex.bsdf)) sample_lights(a.id, a.vertex, i, depth);
            scatter(a.id, a.point, a.vertex, depth);
        }
        waiting_ = 0;
    }

    /// Emission that the ray from the last vertex has found, weighted against the light samples taken there, which find
    /// its direction with density pdf().
    template <class Pdf>
    void add_emission(uint32_t id, Rgb radiance, uint32_t light, uint32_t depth, bool background, Pdf pdf) noexcept {
        if (is_black(radiance)) return;
        const State& state = states_[id];
        float weight = 1;
        double density = 0;
        if (state.bsdf_pdf > 0) {
            density = expected_samples(state, light) * pdf();
            weight = emission_weight(state.bsdf_pdf, density);
        }
        const Rgb contribution = clamped(path(id).throughput * radiance * weight, limit_of(state, depth));
        gain(id, contribution, background);
        if (c_.recorder)
            c_.recorder->emission(radiance, state.bsdf_pdf, static_cast<float>(density), weight, contribution);
    }

    /// For all that wait, each step for all of them before the next, so that their waits for memory overlap.
    void choose_lights(uint32_t depth) noexcept {
        const uint32_t dimension = kOneLightDimension + 4 * depth;
        bool any = false;
        for (uint32_t i = 0; i < waiting_; ++i) {
            const Arrival& a = arrivals_[i];
            State& state = states_[a.id];
            light_of_[i].tree = nullptr, light_of_[i].chosen.reset();
            if (lights_.lights() == 0 || is_specular(a.vertex.bsdf)) continue;
            state.all_lights = state.direct_bounces == ~0u && lights_.lights() <= kFewLights;
            if (state.direct_bounces == ~0u) state.direct_bounces = depth + 1;
            if (state.all_lights) continue;
            const uint32_t bits = c_.sampler.bits(path(a.id).key, dimension + 3);
            light_of_[i] = lights_.query(choice_, receiver_at(a.vertex.from), bits);
            any = true;
        }
        if (!any) return;
        LightTree::answer({light_of_.data(), waiting_});
        for (uint32_t i = 0; i < waiting_; ++i) {
            const Arrival& a = arrivals_[i];
            part_of_[i].tree = nullptr, part_of_[i].chosen.reset();
            if (!light_of_[i].chosen) continue;
            const uint32_t bits = c_.sampler.bits(path(a.id).key, dimension + 2);
            part_of_[i] = part_query(shading_, light_of_[i].chosen->light, a.vertex.from, bits);
        }
        LightTree::answer({part_of_.data(), waiting_});
        for (const PartMemory what : {PartMemory::indices, PartMemory::corners})
            for (uint32_t i = 0; i < waiting_; ++i)
                if (part_of_[i].chosen) prefetch_part(shading_, light_of_[i].chosen->light, part_of_[i], what);
    }

    void sample_lights(uint32_t id, const Vertex& at, uint32_t place, uint32_t depth) noexcept {
        if (lights_.lights() == 0) return;
        const State& state = states_[id];
        const float limit = limit_of(state, depth + 1);
        if (state.all_lights) {
            sample_all_lights(id, at, limit, [&](uint32_t n, float light_pdf, float bsdf_pdf) {
                return light_weight(double(light_pdf) * n, bsdf_pdf);
            });
            return;
        }
        const Path& path = this->path(id);
        const uint32_t dimension = kOneLightDimension + 4 * depth;
        const Vec2 u = c_.sampler.get_2d(path.key, dimension);
        const uint32_t part = c_.sampler.bits(path.key, dimension + 2);
        const std::optional<ChosenLight>& chosen = light_of_[place].chosen;
        if (!chosen) return;
        const double probability = chosen->probability;
        sample_towards(
            id, at, chosen->light, part, u, path.throughput / static_cast<float>(probability), limit,
            [&](float light_pdf, float bsdf_pdf) { return light_weight(light_pdf * probability, bsdf_pdf); },
            &part_of_[place]);
    }

    void scatter(uint32_t id, const SurfacePoint& point, const Vertex& at, uint32_t depth) noexcept {
        Path& path = this->path(id);
        State& state = states_[id];
        const uint32_t dimension = kBounceDimension + 4 * depth;
        const float choice = c_.sampler.get_1d(path.key, dimension);
        const Vec2 u = c_.sampler.get_2d(path.key, dimension + 2);
        const std::optional<BsdfSample> next = sample(at.bsdf, at.wo, choice, u);
        if (!next || is_black(next->weight)) return;
        path.throughput = path.throughput * next->weight;
        state.radiance_scale *= next->radiance_scale;
        state.bsdf_pdf = next->specular ? 0 : next->pdf;
        state.from = at.from;
        float survival = 1;
        if (depth + 1 > c_.settings.roulette_depth)
            survival = min_of(max_component(path.throughput) / state.radiance_scale, 1.0f);
        const bool survives = survival == 1 || c_.sampler.get_1d(path.key, dimension + 1) < survival;
        if (c_.recorder)
            c_.recorder->bounce(
                {next->wi, next->weight, next->pdf, next->specular, next->transmitted, survival, survives});
        if (!survives) return;
        turn(id, point, at.bsdf, at.wo, *next);
        path.throughput = path.throughput / survival;
        continue_along(id, spawn_ray(point, next->wi));
    }

    /// How many samples a vertex takes of `light` on average.
    double expected_samples(const State& state, uint32_t light) const noexcept {
        return state.all_lights ? light_sample_count(shading_, light)
                                : lights_.probability(choice_, receiver_at(state.from), light);
    }

    /// The weight of a light sample. A light without a density cannot be found by the BSDF.
    float light_weight(double density, float bsdf_pdf) const noexcept {
        if (density == 0) return 1;
        switch (c_.settings.light_sampling) {
            case LightSampling::mis:
                return power_heuristic(density, bsdf_pdf);
            case LightSampling::light:
                return 1;
            case LightSampling::bsdf:
                return 0;
        }
        return 1;
    }

    /// The weight of emission that the BSDF has found, which no light sample could have where their density is 0.
    float emission_weight(float bsdf_pdf, double density) const noexcept {
        if (density == 0) return 1;
        switch (c_.settings.light_sampling) {
            case LightSampling::mis:
                return power_heuristic(bsdf_pdf, density);
            case LightSampling::light:
                return 0;
            case LightSampling::bsdf:
                return 1;
        }
        return 1;
    }

    float limit_of(const State& state, uint32_t bounces) const noexcept {
        return bounces > state.direct_bounces ? limit_ : kInfinity;
    }

    const LightSelection& lights_;
    const LightChoice choice_;
    const float limit_;  ///< for contributions that are not direct light
    std::vector<State> states_;
    std::vector<Arrival> arrivals_;  ///< of them the first waiting_
    uint32_t waiting_ = 0;
    std::array<LightQuery, kTogether> light_of_, part_of_;  ///< the light that each of them chooses, and its triangle
};

}  // namespace

std::unique_ptr<Integrator> make_path(const RenderContext& context, uint32_t max_tile_pixels) {
    return std::make_unique<PathIntegrator>(context, max_tile_pixels);
}

uint64_t path_bytes(uint32_t max_tile_pixels) noexcept { return PathIntegrator::bytes(max_tile_pixels); }

}  // namespace steradian
