// What camera rays find, as pictures: to see whether a scene is what it is meant to be. Rays that find nothing are
// black.
#include "math/elementary.h"
#include "render/wavefront.h"

namespace steradian {
namespace {

/// What is to be shown of a point; the base class brings it.
struct Found {
    const RenderContext& context;
    const SurfacePoint& point;
    Vec3 wo;
    const SampleKey& key;
};

/// (n + 1) / 2 of the shading normal, in world space.
Rgb normal_color(const Found& f) {
    const Vec3 n = make_bsdf(f.context.scene.shading, f.point).frame.z;
    return Rgb{n.x, n.y, n.z} * 0.5f + Rgb{0.5f, 0.5f, 0.5f};
}

/// What the surface reflects and transmits of a uniform white surround, by one sample of its BSDF; that is the
/// reflectance of a diffuse surface without any noise. The scaling of radiance by refraction is taken out.
Rgb albedo_color(const Found& f) {
    const float choice = f.context.sampler.get_1d(f.key, kBounceDimension);
    const Vec2 u = f.context.sampler.get_2d(f.key, kBounceDimension + 2);
    const std::optional<BsdfSample> next = sample(make_bsdf(f.context.scene.shading, f.point), f.wo, choice, u);
    return next ? next->weight / next->radiance_scale : Rgb{};
}

/// Red is u and green v, each without its whole part.
Rgb uv_color(const Found& f) {
    const Vec2 uv = f.point.uv;
    return {uv.x - std::floor(uv.x), uv.y - std::floor(uv.y), 0};
}

/// Metres along the camera's -Z.
Rgb depth_color(const Found& f) {
    const auto depth = static_cast<float>(max_of(f.context.camera.depth_of(f.point.p), 0.0));
    return {depth, depth, depth};
}

/// A colour of its own for each primitive of each instance: bits of a hash (the finaliser of SplitMix64, Steele, Lea &
/// Flood 2014), none too dark to be seen.
Rgb primitive_color(const Found& f) {
    uint64_t x = (uint64_t(f.point.instance) << 32 | f.point.prim) + 0x9e3779b97f4a7c15;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
    x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
    x ^= x >> 31;
    const auto channel = [&](int shift) { return 0.1f + 0.9f * static_cast<float>((x >> shift) & 0xff) / 255.0f; };
    return {channel(0), channel(8), channel(16)};
}

/// Visits of nodes and tests of what leaves hold, on a scale that grows fourfold from colour to colour.
Rgb heat_of(RayVisits visits) {
    static constexpr Rgb kScale[] = {{0, 0, 0},             // 1
                                     {0.02f, 0.02f, 0.4f},  // 4
                                     {0, 0.4f, 0.3f},       // 16
                                     {0.9f, 0.6f, 0},       // 64
                                     {0.9f, 0.03f, 0},      // 256
                                     {1, 1, 1}};            // 1024 and more
    constexpr double kLast = std::size(kScale) - 1;
    const double count = double(visits.nodes) + visits.items;
    const double place = min_of(max_of(math::log2(count) / 2, 0.0), kLast);
    const auto below = static_cast<size_t>(min_of(place, kLast - 1));
    const auto part = static_cast<float>(place - static_cast<double>(below));
    return kScale[below] * (1 - part) + kScale[below + 1] * part;
}

/// What the hierarchy costs a camera ray, hit or not.
class CostInspector final : public WavefrontIntegrator {
public:
    using WavefrontIntegrator::WavefrontIntegrator;

private:
    void bounce(uint32_t) noexcept override {
        each_hit(
            [&](uint32_t id, const Ray& ray, const Hit&) { path(id).radiance = heat_of(c_.scene.accel.visits(ray)); });
    }
};

template <Rgb (*Color)(const Found&)>
class Inspector final : public WavefrontIntegrator {
public:
    using WavefrontIntegrator::WavefrontIntegrator;

private:
    void bounce(uint32_t) noexcept override {
        each_hit([&](uint32_t id, const Ray& ray, const Hit& hit) {
            if (!hit.found()) return;
            const SurfacePoint point = arrive(id, ray, hit);
            path(id).radiance = Color({c_, point, -ray.d, path(id).key});
        });
    }
};

template <Rgb (*Color)(const Found&)>
std::unique_ptr<Integrator> make(const RenderContext& context, uint32_t max_tile_pixels) {
    return std::make_unique<Inspector<Color>>(context, max_tile_pixels);
}

}  // namespace

std::unique_ptr<Integrator> make_inspector(const RenderContext& context, uint32_t max_tile_pixels) {
    switch (context.settings.integrator) {
        case IntegratorKind::normals:
            return make<normal_color>(context, max_tile_pixels);
        case IntegratorKind::albedo:
            return make<albedo_color>(context, max_tile_pixels);
        case IntegratorKind::uv:
            return make<uv_color>(context, max_tile_pixels);
        case IntegratorKind::depth:
            return make<depth_color>(context, max_tile_pixels);
        case IntegratorKind::cost:
            return std::make_unique<CostInspector>(context, max_tile_pixels);
        default:
            return make<primitive_color>(context, max_tile_pixels);
    }
}

}  // namespace steradian
