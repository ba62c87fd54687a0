#include "render/first_hit.h"

#include "render/wavefront.h"

namespace steradian {

FirstHits::FirstHits(const RenderContext& context, uint32_t paths)
    : c_(context), bsdfs_(context.settings.aovs.has_any({Aov::albedo, Aov::normal})) {
    if (SumKinds(context.settings.aovs).first_hits()) states_.resize(paths);
}

uint64_t FirstHits::bytes_per_path(AovSet aovs) noexcept { return SumKinds(aovs).first_hits() ? sizeof(State) : 0; }

void FirstHits::begin(uint32_t path, Vec2 offset) noexcept {
    states_[path] = {};
    states_[path].sample.distance2 = offset.x * offset.x + offset.y * offset.y;
}

/// The albedo is that of one sample of the BSDF, by the same numbers as the path's own: without noise where it is
/// diffuse. The scaling of radiance by refraction is taken out.
void FirstHits::see_bsdf(State& state, const SampleKey& key, const SurfacePoint& point, Vec3 wo) const noexcept {
    const Bsdf bsdf = make_bsdf(c_.scene.shading, point);
    const float choice = c_.sampler.get_1d(key, kBounceDimension);
    const Vec2 u = c_.sampler.get_2d(key, kBounceDimension + 2);
    const std::optional<BsdfSample> next = sample(bsdf, wo, choice, u);
    if (next) state.albedo = next->weight / next->radiance_scale;
    const Vec3 n = bsdf.frame.z;
    state.normal = dot(n, wo) < 0 ? -n : n;
}

void FirstHits::see(uint32_t path, const SampleKey& key, const SurfacePoint& point, Vec3 wo) noexcept {
    State& state = states_[path];
    state.found = true;
    if (bsdfs_) see_bsdf(state, key, point, wo);
    state.sample.position = point.p;
    state.sample.depth = static_cast<float>(max_of(c_.camera.depth_of(point.p), 0.0));
    state.sample.uv = point.uv;
    state.sample.object = point.instance + 1;
    state.sample.material = static_cast<uint32_t>(index(c_.scene.shading.scene.instances[point.instance].material)) + 1;
    state.sample.primitive = point.prim + 1;
}

void FirstHits::add_to(TileSums& sums, uint32_t pixel, uint32_t path, float filter_weight) const {
    const State& state = states_[path];
    if (!sums.features.empty()) {
        FeatureSum& sum = sums.features[pixel];
        sum.weight += double(filter_weight);
        if (state.found) {
            sum.alpha += double(filter_weight);
            sum.albedo.add(state.albedo, filter_weight);
            sum.normal.add({state.normal.x, state.normal.y, state.normal.z}, filter_weight);
        }
    }
    if (!sums.centres.empty()) sums.centres[pixel] += state.sample;
    const int32_t sign = filter_weight < 0 ? -1 : 1;
    const auto id = [](const std::vector<uint32_t>& ids, uint32_t number) { return number > 0 ? ids[number - 1] : 0; };
    if (!sums.objects.empty()) sums.objects[pixel].add(id(c_.mattes.objects, state.sample.object), sign);
    if (!sums.materials.empty()) sums.materials[pixel].add(id(c_.mattes.materials, state.sample.material), sign);
}

}  // namespace steradian
