#include "render/metadata.h"

#include <fmt/format.h>

#include "base/names.h"
#include "steradian/version.h"

namespace steradian {

std::string partial_samples(const RenderSettings& s, uint64_t min_samples, uint64_t max_samples) {
    std::string out = fmt::format("{} to {}", min_samples, max_samples);
    // The largest number stands for "as many as there is time for".
    if (s.samples_per_pixel < kMaxSamplesPerPixel) out += fmt::format(" of {}", s.samples_per_pixel);
    return out + " samples";
}

std::map<std::string, std::string> picture_metadata(const RenderSettings& s, const std::string& scene_hash,
                                                    uint64_t min_samples, uint64_t max_samples) {
    std::map<std::string, std::string> m;
    m["software"] = "Steradian " STERADIAN_VERSION;
    m["steradian:scene"] = scene_hash;
    m["steradian:size"] = fmt::format("{}x{}", s.width, s.height);
    if (s.crop) m["steradian:crop"] = fmt::format("{},{},{},{}", s.crop->x0, s.crop->y0, s.crop->x1, s.crop->y1);
    m["steradian:camera"] = fmt::format("{}", s.camera);
    m["steradian:integrator"] = name_of(s.integrator);
    m["steradian:max_depth"] = fmt::format("{}", s.max_depth);
    if (s.integrator == IntegratorKind::path) {
        m["steradian:light_sampling"] = name_of(s.light_sampling);
        m["steradian:light_choice"] = name_of(s.light_choice);
        m["steradian:roulette_depth"] = fmt::format("{}", s.roulette_depth);
        if (s.clamp > 0) m["steradian:clamp"] = fmt::format("{} (biased: indirect light was limited)", s.clamp);
    }
    if (s.integrator == IntegratorKind::ao && s.ao_distance > 0)
        m["steradian:ao_distance"] = fmt::format("{}", s.ao_distance);
    if (!s.aovs.empty()) m["steradian:aovs"] = names_in(s.aovs);
    m["steradian:sampler"] = name_of(s.sampler);
    m["steradian:seed"] = fmt::format("{}", s.seed);
    m["steradian:filter"] = fmt::format("{} {}", name_of(s.filter.kind), s.filter.radius);
    m["steradian:samples"] = fmt::format("{}", min_samples);
    if (s.target_error == 0 && min_samples != s.samples_per_pixel)
        m["steradian:partial"] = partial_samples(s, min_samples, max_samples);
    return m;
}

std::map<std::string, std::string> target_metadata(const RenderSettings& s, uint64_t max_samples, double mean_samples,
                                                   const std::optional<ErrorReport>& report) {
    std::map<std::string, std::string> m;
    m["steradian:target_error"] = fmt::format("{}", s.target_error);
    m["steradian:mean_samples"] = fmt::format("{:.1f}", mean_samples);
    m["steradian:max_samples"] = fmt::format("{}", max_samples);
    if (!report) {
        m["steradian:partial"] = "stopped before the target";
        return m;
    }
    m["steradian:error_estimate"] = fmt::format("{:.4g}", report->estimate);
    m["steradian:certified"] = report->certified ? fmt::format("yes: error at most {:.4g} with {:.0f} % confidence",
                                                               report->bound, 100 * ErrorReport::confidence)
                                                 : "no: " + report->reason;
    return m;
}

}  // namespace steradian
