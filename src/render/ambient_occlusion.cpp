// Ambient occlusion: the share of the hemisphere over the first surface, weighted by the cosine, in which nothing is
// nearer than a distance. One direction per camera sample.
#include "math/warp.h"
#include "render/wavefront.h"

namespace steradian {
namespace {

class AmbientOcclusion final : public WavefrontIntegrator {
public:
    using WavefrontIntegrator::WavefrontIntegrator;

private:
    /// They go in all directions.
    RayKind shadow_ray_kind(uint32_t) const noexcept override { return RayKind::incoherent; }

    void bounce(uint32_t) noexcept override {
        each_hit([&](uint32_t id, const Ray& ray, const Hit& hit) {
            if (!hit.found()) return;
            const SurfacePoint from = vertex_at(arrive(id, ray, hit), -ray.d).from;
            const Vec2 u = c_.sampler.get_2d(path(id).key, kBounceDimension + 2);
            const Vec3 local = static_cast<Vec3>(warp::cosine_hemisphere(u));
            const Vec3 wi = normalize(Frame::from_z(from.ns).to_world(local));
            // Below the triangle itself, where the shading normal leans: that direction is closed.
            if (!(dot(wi, from.ng) > 0)) return;
            Ray probe = spawn_ray(from, wi);
            if (c_.settings.ao_distance > 0) probe.tmax = c_.settings.ao_distance;
            connect(id, 0, probe, {1, 1, 1}, false);
        });
    }
};

}  // namespace

std::unique_ptr<Integrator> make_ao(const RenderContext& context, uint32_t max_tile_pixels) {
    return std::make_unique<AmbientOcclusion>(context, max_tile_pixels);
}

}  // namespace steradian
