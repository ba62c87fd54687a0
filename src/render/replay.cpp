#include "steradian/replay.h"

#include <fmt/format.h>

#include "base/parallel.h"
#include "render/integrator.h"
#include "render/memory_estimate.h"
#include "render/recorder.h"
#include "scene/validate.h"

namespace steradian {
namespace {

std::string name_at(const std::vector<std::string>& names, size_t index) {
    return index < names.size() ? names[index] : std::string();
}

void add_names(const Scene& scene, SampleTrace& trace) {
    for (TracedVertex& vertex : trace.vertices) {
        if (!vertex.escaped) vertex.object = name_at(scene.names.instances, vertex.instance);
        for (TracedLight& light : vertex.lights) light.name = name_at(scene.names.lights, light.light);
    }
}

Status check(const RenderSettings& s, uint32_t x, uint32_t y, uint64_t sample) {
    if (auto status = validate(s); !status) return status;
    const Crop window = window_of(s);
    if (x < window.x0 || x >= window.x1 || y < window.y0 || y >= window.y1)
        return make_error(ErrorCode::usage, fmt::format("there is no pixel {},{}: the picture has {},{} to {},{}", x, y,
                                                        window.x0, window.y0, window.x1 - 1, window.y1 - 1));
    if (sample >= s.samples_per_pixel)
        return make_error(ErrorCode::usage, fmt::format("there is no sample {}: a pixel has samples 0 to {}", sample,
                                                        s.samples_per_pixel - 1));
    return Ok{};
}

}  // namespace

Result<SampleTrace> replay(const std::shared_ptr<const RenderScene>& scene, const RenderSettings& settings, uint32_t x,
                           uint32_t y, uint64_t sample) {
    const FloatMode mode;
    if (auto status = check(settings, x, y, sample); !status) return std::move(status).error();
    const auto camera = camera_of(*scene, settings);
    if (!camera) return camera.error();
    try {
        const std::atomic<bool> cancelled{false};
        std::atomic<uint64_t> rays{0};
        Recorder recorder;
        RenderSettings colour_only = settings;
        colour_only.aovs = {};
        const RenderContext context{
            *scene,    colour_only, *camera,  FilterSampler(settings.filter), sampler_of(settings),
            cancelled, rays,        &recorder};
        Counters counters;
        TileSums sums(1, {});
        const auto integrator = make_integrator(context, 1);
        integrator->render({{x, y, x + 1, y + 1}, sample, 1}, sums, counters);
        if (recorder.failed()) throw std::bad_alloc();
        SampleTrace trace = std::move(recorder.trace());
        trace.x = x, trace.y = y, trace.sample = sample;
        add_names(scene->shading.scene, trace);
        return trace;
    } catch (const std::bad_alloc&) {
        return make_error(ErrorCode::resources, "not enough memory to replay a sample");
    }
}

}  // namespace steradian
