// Direct lighting: the path that follows perfect reflection and refraction to its first other surface, and there
// connects to every light.
#include "render/wavefront.h"

namespace steradian {
namespace {

class DirectIntegrator final : public WavefrontIntegrator {
public:
    using WavefrontIntegrator::WavefrontIntegrator;

private:
    void bounce(uint32_t depth) noexcept override {
        each_hit([&](uint32_t id, const Ray& ray, const Hit& hit) { shade(id, ray, hit, depth); });
    }

    void shade(uint32_t id, const Ray& ray, const Hit& hit, uint32_t depth) noexcept {
        if (!hit.found()) {
            add_emission(id, sky_radiance(shading_, ray.d, depth == 0), true);
            return;
        }
        const SurfacePoint point = arrive(id, ray, hit);
        const Vec3 wo = -ray.d;
        add_emission(id, emitted_radiance(shading_, point, wo), false);
        if (depth >= c_.settings.max_depth) return;
        disperse(id, point);
        const Vertex vertex = vertex_at(point, wo, path(id).wavelength);
        if (is_specular(vertex.bsdf))
            follow(id, point, vertex.bsdf, wo, depth);
        else
            sample_all_lights(id, vertex, kInfinity, [](uint32_t, float, float) { return 1.0f; });
    }

    void add_emission(uint32_t id, Rgb radiance, bool background) noexcept {
        const Rgb contribution = path(id).throughput * radiance;
        gain(id, contribution, background);
        if (c_.recorder) c_.recorder->emission(radiance, 0, 0, 1, contribution);
    }

    void follow(uint32_t id, const SurfacePoint& point, const Bsdf& bsdf, Vec3 wo, uint32_t depth) noexcept {
        Path& path = this->path(id);
        const uint32_t dimension = kBounceDimension + 4 * depth;
        const float choice = c_.sampler.get_1d(path.key, dimension);
        const Vec2 u = c_.sampler.get_2d(path.key, dimension + 2);
        const std::optional<BsdfSample> next = sample(bsdf, wo, choice, u);
        if (!next || is_black(next->weight)) return;
        if (c_.recorder)
            c_.recorder->bounce({next->wi, next->weight, next->pdf, next->specular, next->transmitted, 1, true});
        path.throughput = path.throughput * next->weight;
        turn(id, point, bsdf, wo, *next);
        continue_along(id, spawn_ray(point, next->wi));
    }
};

}  // namespace

std::unique_ptr<Integrator> make_direct(const RenderContext& context, uint32_t max_tile_pixels) {
    return std::make_unique<DirectIntegrator>(context, max_tile_pixels);
}

}  // namespace steradian
