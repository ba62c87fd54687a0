// What a picture says about itself. Nothing in it depends on time, place or machine, so equal pictures are equal files.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "steradian/render.h"
#include "steradian/settings.h"

namespace steradian {

/// How many samples the pixels of a picture have that was stopped: "8 to 72 of 128 samples".
std::string partial_samples(const RenderSettings& settings, uint64_t min_samples, uint64_t max_samples);
std::map<std::string, std::string> picture_metadata(const RenderSettings& settings, const std::string& scene_hash,
                                                    uint64_t min_samples, uint64_t max_samples);
/// What a picture with a target for its error says of it besides; `report` once it is there.
std::map<std::string, std::string> target_metadata(const RenderSettings& settings, uint64_t max_samples,
                                                   double mean_samples, const std::optional<ErrorReport>& report);

}  // namespace steradian
