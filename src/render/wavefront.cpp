#include "render/wavefront.h"

namespace steradian {
namespace {

constexpr uint32_t kBatchPaths = 4096;
constexpr uint32_t kBatchShadowRays = 16384;
/// Traced at a time: a cancelled job must not wait for thousands of rays, which in a hostile scene take milliseconds
/// each.
constexpr size_t kSlice = 512;

}  // namespace

uint32_t WavefrontIntegrator::capacity(uint32_t max_tile_pixels) noexcept {
    return std::max(max_tile_pixels, kBatchPaths);
}

uint64_t WavefrontIntegrator::bytes(uint32_t max_tile_pixels) noexcept {
    constexpr uint64_t path =
        sizeof(Path) + Interiors::bytes_per_path() + 2 * (sizeof(uint32_t) + sizeof(Ray)) + sizeof(Hit);
    constexpr uint64_t shadow_ray = sizeof(Ray) + sizeof(Connection) + sizeof(uint32_t) + sizeof(uint8_t);
    return max_tile_pixels * sizeof(uint32_t) + capacity(max_tile_pixels) * path + kBatchShadowRays * shadow_ray;
}

uint64_t WavefrontIntegrator::aov_bytes(AovSet aovs, uint32_t max_tile_pixels) noexcept {
    const uint64_t splits = SumKinds(aovs).light ? kBatchShadowRays * sizeof(LightSplit) : 0;
    return capacity(max_tile_pixels) * (FirstHits::bytes_per_path(aovs) + LightParts::bytes_per_path(aovs)) + splits;
}

WavefrontIntegrator::WavefrontIntegrator(const RenderContext& context, uint32_t max_tile_pixels)
    : c_(context),
      shading_(context.scene.shading),
      capacity_(capacity(max_tile_pixels)),
      first_hits_(context, capacity(max_tile_pixels)),
      parts_(context, capacity(max_tile_pixels)),
      interiors_(context, capacity(max_tile_pixels)) {
    if (parts_.wanted()) splits_.reserve(kBatchShadowRays);
    pixels_.reserve(max_tile_pixels);
    paths_.resize(capacity_);
    active_.reserve(capacity_);
    rays_.reserve(capacity_);
    next_active_.reserve(capacity_);
    next_rays_.reserve(capacity_);
    hits_.resize(capacity_);
    shadow_rays_.reserve(kBatchShadowRays);
    connections_.reserve(kBatchShadowRays);
    shadow_order_.resize(kBatchShadowRays);
    occluded_.resize(kBatchShadowRays);
}

bool WavefrontIntegrator::render(const WorkUnit& unit, TileSums& sums, Counters& counters) {
    counters_ = &counters;
    const uint32_t pixels = unit.tile.pixels();
    const uint32_t step = std::max(1u, capacity_ / pixels);
    order_pixels(unit.tile);
    for (uint32_t done = 0; done < unit.samples; done += step) {
        const uint32_t samples = std::min(step, unit.samples - done);
        generate(unit, unit.first_sample + done, samples);
        for (uint32_t depth = 0; !active_.empty(); ++depth) {
            advance(depth);
            if (stopped()) return false;
        }
        accumulate(unit, pixels * samples, sums);
    }
    return true;
}

/// In squares of four by four, made of four of two by two each: pixels that follow each other are close, so that their
/// rays go much the same way.
void WavefrontIntegrator::order_pixels(const TileRect& tile) noexcept {
    pixels_.clear();
    const uint32_t width = tile.width(), height = tile.pixels() / width;
    for (uint32_t y0 = 0; y0 < height; y0 += 4)
        for (uint32_t x0 = 0; x0 < width; x0 += 4)
            for (uint32_t i = 0; i < 16; ++i) {
                const uint32_t x = x0 + (i & 1) + (i >> 1 & 2), y = y0 + (i >> 1 & 1) + (i >> 2 & 2);
                if (x < width && y < height) pixels_.push_back(y * width + x);
            }
}

/// Camera rays, pixel by pixel and all samples of a pixel together.
void WavefrontIntegrator::generate(const WorkUnit& unit, uint64_t first_sample, uint32_t samples) noexcept {
    active_.clear();
    rays_.clear();
    const uint32_t pixels = unit.tile.pixels();
    for (uint32_t i = 0; i < pixels * samples; ++i) {
        Path& path = paths_[i];
        path.pixel = pixels_[i / samples];
        path.x = unit.tile.x0 + path.pixel % unit.tile.width();
        path.y = unit.tile.y0 + path.pixel / unit.tile.width();
        path.key = c_.sampler.key(path.x, path.y, unit.index(first_sample + i % samples));
        const FilterSample position = c_.filter.sample(c_.sampler.get_2d(path.key, kFilterDimension));
        path.weight = position.weight;
        path.wavelength = 0;
        path.throughput = {1, 1, 1};
        path.radiance = {};
        const Vec2 film{static_cast<float>(path.x) + 0.5f + position.offset.x,
                        static_cast<float>(path.y) + 0.5f + position.offset.y};
        if (c_.recorder) c_.recorder->camera(film, path.weight);
        if (first_hits_.wanted()) first_hits_.begin(i, position.offset);
        if (parts_.wanted()) parts_.begin(i);
        if (!c_.camera.sees(film)) continue;
        const Vec2 lens = c_.camera.has_lens() ? c_.sampler.get_2d(path.key, kLensDimension) : Vec2{};
        rays_.push_back(c_.camera.generate(film, lens));
        if (shading_.uses_footprints()) path.cone = c_.camera.cone(film);
        if (interiors_.wanted()) {
            interiors_.begin(i, rays_.back());
            end_in_medium(i, rays_.back(), 0);
        }
        active_.push_back(i);
    }
    counters_->camera_rays += active_.size();
}

/// One bounce of all paths that are still on their way.
void WavefrontIntegrator::advance(uint32_t depth) noexcept {
    const std::span<Hit> hits(hits_.data(), rays_.size());
    const RayKind kind = depth == 0 ? RayKind::coherent : RayKind::incoherent;
    in_slices(rays_.size(), [&](size_t first, size_t count) {
        c_.scene.accel.intersect(std::span(rays_).subspan(first, count), hits.subspan(first, count), kind);
    });
    depth_ = depth;
    if ((depth == 0 && shading_.hides_instances) || shading_.has_cut_outs || interiors_.wanted()) look_through(hits);
    if (interiors_.wanted()) absorb();
    next_active_.clear();
    next_rays_.clear();
    bounce(depth);
    trace_shadow_rays();
    counters_->bounce_rays += next_rays_.size();
    active_.swap(next_active_);
    rays_.swap(next_rays_);
}

/// Camera rays go on to what is behind a light that they do not see, all rays to what is behind a surface that happens
/// not to be there.
void WavefrontIntegrator::look_through(std::span<Hit> hits) noexcept {
    for (size_t i = 0; i < hits.size() && !stopped(); ++i) {
        const uint32_t id = active_[i];
        if (interiors_.wanted()) interiors_.start(id);
        const auto goes_on = [&](uint32_t crossing) {
            if (!hits[i].found()) return false;
            return passes(paths_[id], rays_[i], hits[i], crossing) ||
                   (interiors_.wanted() && interiors_.passes(id, rays_[i], hits[i]));
        };
        for (uint32_t crossing = 0; goes_on(crossing); ++crossing) {
            const Hit after = hits[i];
            c_.scene.accel.next_hit({&rays_[i], 1}, {&after, 1}, {&hits[i], 1});
        }
    }
}

/// Whatever a path brings from its next vertex has passed what lies before it.
void WavefrontIntegrator::absorb() noexcept {
    for (size_t i = 0; i < rays_.size() && !stopped(); ++i) {
        const uint32_t id = active_[i];
        Path& path = paths_[id];
        path.passed = scatters_ ? interiors_.weight(id, path.throughput, rays_[i], hits_[i])
                                : interiors_.transmittance(id, false, hits_[i].t);
        path.throughput = path.throughput * path.passed;
    }
}

/// `depth` bounces lie behind the ray.
void WavefrontIntegrator::end_in_medium(uint32_t id, Ray& ray, uint32_t depth) const noexcept {
    if (!scatters_) return;
    const Vec2 u = c_.sampler.get_2d(paths_[id].key, kMediumDimension + 4 * depth);
    interiors_.end_in_medium(id, paths_[id].throughput, u, ray);
}

WavefrontIntegrator::Vertex WavefrontIntegrator::vertex_in_medium(uint32_t id, const Ray& ray) const noexcept {
    Vertex out;
    out.from.p = static_cast<Vec3>(Vec3d(ray.o) + Vec3d(ray.d) * double{ray.tmax});
    out.from.both_sides = true;
    out.bsdf.lobe = PhaseBsdf{interiors_.medium(id)->anisotropy};
    out.wo = -ray.d;
    return out;
}

/// `crossing` surfaces lie behind the ray already.
bool WavefrontIntegrator::passes(const Path& path, const Ray& ray, const Hit& hit, uint32_t crossing) const noexcept {
    const uint32_t light = shading_.instances[hit.instance].area_light;
    if (depth_ == 0 && light != kNoLight && !std::get<AreaLight>(shading_.scene.lights[light]).visible_to_camera)
        return true;
    if (!shading_.is_cut_out(hit.instance)) return false;
    const float opacity = opacity_at(shading_, surface_at(shading_, ray, hit));
    if (opacity >= 1) return false;
    const uint32_t dimension = kOpacityDimension + 4096 * depth_ + 4 * (crossing % 1024);
    return opacity <= 0 || c_.sampler.get_1d(path.key, dimension) >= opacity;
}

/// What cut-outs, with nothing else in the way but boundaries that are not there, let pass.
float WavefrontIntegrator::transmittance(const Connection& connection, const Ray& shadow_ray) const noexcept {
    float passes = 1;
    Interiors::Walk walk;
    if (interiors_.wanted()) walk = interiors_.walk(connection.path, connection.beyond);
    for (Hit hit = c_.scene.accel.intersect(shadow_ray); hit.found() && passes > 0 && !stopped();) {
        if (!shading_.has_priority(hit.instance) || !interiors_.passes(walk, shadow_ray, hit))
            passes *= 1 - opacity_at(shading_, surface_at(shading_, shadow_ray, hit));
        const Hit after = hit;
        c_.scene.accel.next_hit({&shadow_ray, 1}, {&after, 1}, {&hit, 1});
    }
    return passes;
}

void WavefrontIntegrator::record_vertex(uint32_t id, const Ray& ray, const Hit& hit) noexcept {
    TracedVertex vertex;
    vertex.origin = ray.o;
    vertex.direction = ray.d;
    vertex.throughput = paths_[id].throughput;
    vertex.in_medium = !hit.found() && ends_in_medium(ray);
    vertex.escaped = !hit.found() && !vertex.in_medium;
    if (interiors_.wanted()) vertex.transmittance = paths_[id].passed;
    if (vertex.in_medium) vertex.position = vertex_in_medium(id, ray).from.p;
    if (hit.found()) {
        SurfacePoint point = surface_at(shading_, ray, hit);
        if (interiors_.wanted()) interiors_.describe(id, ray, hit, point);
        vertex.position = point.p;
        vertex.normal = make_bsdf(shading_, point).frame.z;
        vertex.instance = hit.instance;
        vertex.primitive = hit.prim;
    }
    c_.recorder->vertex(std::move(vertex));
}

void WavefrontIntegrator::choose_wavelength(uint32_t id) noexcept {
    Path& path = paths_[id];
    const WavelengthSample chosen = shading_.wavelengths->sample(c_.sampler.bits(path.key, kWavelengthDimension));
    path.wavelength = chosen.wavelength;
    path.throughput = path.throughput * chosen.weight;
    if (c_.recorder) c_.recorder->wavelength(chosen.wavelength * 1000, chosen.weight);
}

void WavefrontIntegrator::continue_along(uint32_t id, const Ray& ray) noexcept {
    next_rays_.push_back(ray);
    if (interiors_.wanted()) end_in_medium(id, next_rays_.back(), depth_ + 1);
    next_active_.push_back(id);
}

void WavefrontIntegrator::connect(uint32_t id, uint32_t group, const Ray& shadow_ray, Rgb contribution,
                                  bool beyond) noexcept {
    if (shadow_rays_.size() == kBatchShadowRays) trace_shadow_rays();
    shadow_rays_.push_back(shadow_ray);
    connections_.push_back({id, group, contribution, beyond});
}

/// Those of one group after each other, each in the order in which they were given. Of many groups some share a place.
void WavefrontIntegrator::order_shadow_rays() noexcept {
    constexpr uint32_t kGroups = 64;
    uint32_t place[kGroups + 1] = {};
    for (const Connection& c : connections_) ++place[c.group % kGroups + 1];
    for (uint32_t i = 1; i < kGroups; ++i) place[i] += place[i - 1];
    for (uint32_t i = 0; i < connections_.size(); ++i) shadow_order_[place[connections_[i].group % kGroups]++] = i;
}

void WavefrontIntegrator::trace_shadow_rays() noexcept {
    const std::span<uint8_t> occluded(occluded_.data(), shadow_rays_.size());
    order_shadow_rays();
    in_slices(shadow_rays_.size(), [&](size_t first, size_t count) {
        const uint32_t* order = shadow_order_.data() + first;
        Ray rays[kSlice];
        uint8_t result[kSlice];
        for (size_t i = 0; i < count; ++i) rays[i] = shadow_rays_[order[i]];
        c_.scene.accel.occluded({rays, count}, {result, count}, shadow_ray_kind(depth_));
        for (size_t i = 0; i < count; ++i) occluded[order[i]] = result[i];
    });
    for (size_t i = 0; i < occluded.size(); ++i) {
        float passes = 1;
        if (occluded[i] == Accel::cut_out) passes = transmittance(connections_[i], shadow_rays_[i]);
        const bool blocked = occluded[i] == Accel::blocked || !(passes > 0);
        if (c_.recorder) c_.recorder->shadow(blocked ? 0 : passes);
        if (blocked) continue;
        const uint32_t id = connections_[i].path;
        Rgb contribution = connections_[i].contribution;
        if (passes < 1) contribution = contribution * passes;
        paths_[id].radiance = paths_[id].radiance + contribution;
        if (parts_.wanted()) parts_.add(id, splits_[i], contribution);
    }
    counters_->shadow_rays += shadow_rays_.size();
    shadow_rays_.clear();
    connections_.clear();
    splits_.clear();
}

/// Calls trace(index of the first, number) for one slice of so many rays after the other, until all are done or the job
/// is cancelled.
template <class Trace>
void WavefrontIntegrator::in_slices(size_t rays, Trace trace) const noexcept {
    for (size_t first = 0; first < rays && !stopped(); first += kSlice) {
        const size_t count = std::min(kSlice, rays - first);
        trace(first, count);
        c_.rays.fetch_add(count, std::memory_order_relaxed);
    }
}

void WavefrontIntegrator::accumulate(const WorkUnit& unit, uint32_t count, TileSums& sums) {
    for (uint32_t i = 0; i < count; ++i) {
        const Path& path = paths_[i];
        const Rgb l = path.radiance;
        const PixelSample sample{path.x, path.y, path.key.index, l};
        const bool good = is_finite(l) && l.r >= 0 && l.g >= 0 && l.b >= 0;
        if (good) {
            const uint64_t replicate = path.key.index % unit.all_replicates - unit.first_replicate;
            sums.color[path.pixel * unit.replicates + replicate].add(l, path.weight);
            if (!sums.squares.empty()) sums.squares[path.pixel].add(l, path.weight);
            if (!sums.light.empty()) parts_.add_to(sums.light[path.pixel], i, path.weight);
            counters_->good(sample);
        } else {
            counters_->bad(sample);
        }
        if (first_hits_.wanted()) first_hits_.add_to(sums, path.pixel, i, path.weight);
        if (c_.recorder) c_.recorder->finish(l, !good);
    }
}

}  // namespace steradian
