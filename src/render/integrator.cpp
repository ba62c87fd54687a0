#include "render/integrator.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <tuple>

#include "base/names.h"
#include "render/wavefront.h"

namespace steradian {
namespace {

struct Row {
    IntegratorKind kind;
    std::unique_ptr<Integrator> (*make)(const RenderContext&, uint32_t max_tile_pixels);
    uint64_t (*bytes)(uint32_t max_tile_pixels) noexcept = WavefrontIntegrator::bytes;
};

constexpr Row kIntegrators[] = {
    {IntegratorKind::path, make_path, path_bytes},
    {IntegratorKind::direct, make_direct},
    {IntegratorKind::ao, make_ao},
    {IntegratorKind::normals, make_inspector},
    {IntegratorKind::albedo, make_inspector},
    {IntegratorKind::uv, make_inspector},
    {IntegratorKind::depth, make_inspector},
    {IntegratorKind::primitive, make_inspector},
    {IntegratorKind::cost, make_inspector},
};

constexpr bool in_order() {
    for (size_t i = 0; i < std::size(kIntegrators); ++i)
        if (static_cast<size_t>(kIntegrators[i].kind) != i) return false;
    return std::size(kIntegrators) == names_of<IntegratorKind>().size();
}
static_assert(in_order());

const Row& row(IntegratorKind kind) { return kIntegrators[static_cast<size_t>(kind)]; }

}  // namespace

Sampler sampler_of(const RenderSettings& settings) {
    return Sampler(settings.sampler, settings.seed, settings.target_error > 0 ? kReplicates : 1);
}

Result<CameraSampler> camera_of(const RenderScene& scene, const RenderSettings& settings) {
    const auto& cameras = scene.shading.scene.cameras;
    if (settings.camera < cameras.size())
        return CameraSampler::make(cameras[settings.camera], settings.width, settings.height);
    return make_error(ErrorCode::usage, cameras.empty() ? "the scene has no camera"
                                                        : fmt::format("there is no camera {}: the scene has {}",
                                                                      settings.camera, cameras.size()));
}

uint64_t integrator_bytes(const RenderSettings& settings, uint32_t max_tile_pixels) noexcept {
    return row(settings.integrator).bytes(max_tile_pixels) +
           WavefrontIntegrator::aov_bytes(settings.aovs, max_tile_pixels);
}

std::unique_ptr<Integrator> make_integrator(const RenderContext& context, uint32_t max_tile_pixels) {
    return row(context.settings.integrator).make(context, max_tile_pixels);
}

void Counters::bad(const PixelSample& sample) {
    ++bad_samples;
    const auto order = [](const PixelSample& s) { return std::tuple(s.sample, s.y, s.x); };
    if (!first_bad_sample || order(sample) < order(*first_bad_sample)) first_bad_sample = sample;
}

void Counters::good(const PixelSample& sample) {
    if (fireflies_wanted == 0) return;
    const auto order = [](const PixelSample& s) { return std::tuple(-luminance(s.value), s.sample, s.y, s.x); };
    const auto before = [&](const PixelSample& a, const PixelSample& b) { return order(a) < order(b); };
    if (fireflies.size() == fireflies_wanted && !before(sample, fireflies.back())) return;
    fireflies.insert(std::upper_bound(fireflies.begin(), fireflies.end(), sample, before), sample);
    if (fireflies.size() > fireflies_wanted) fireflies.pop_back();
}

void Counters::add_rays(const Counters& other) {
    camera_rays += other.camera_rays;
    bounce_rays += other.bounce_rays;
    shadow_rays += other.shadow_rays;
}

void Counters::add(const Counters& other) {
    add_rays(other);
    const uint64_t bad_total = bad_samples + other.bad_samples;
    if (other.first_bad_sample) bad(*other.first_bad_sample);
    bad_samples = bad_total;
    for (const PixelSample& sample : other.fireflies) good(sample);
}

}  // namespace steradian
