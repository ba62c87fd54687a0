// Rendering in one call, for the tests of what comes out.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "steradian/render.h"

namespace steradian::test {

inline std::shared_ptr<const RenderScene> prepared(Scene scene, const Execution& execution = {}) {
    Diagnostics diagnostics;
    auto result = prepare(std::move(scene), execution, diagnostics);
    EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().str());
    return result.ok() ? *result : nullptr;
}

inline RenderResult run(const std::shared_ptr<const RenderScene>& scene, const RenderSettings& settings,
                        const Execution& execution = {}) {
    auto job = RenderJob::start(scene, settings, execution);
    EXPECT_TRUE(job.ok()) << (job.ok() ? "" : job.error().str());
    auto result = (*job)->take();
    EXPECT_TRUE(result.ok());
    return std::move(*result);
}

/// One channel, pixel by pixel; empty when there is none of that name.
inline std::vector<float> channel(const Image& image, const std::string& name) {
    const auto at = std::find(image.channels.begin(), image.channels.end(), name);
    std::vector<float> out;
    if (at == image.channels.end()) return out;
    for (size_t i = static_cast<size_t>(at - image.channels.begin()); i < image.pixels.size();
         i += image.channels.size())
        out.push_back(image.pixels[i]);
    return out;
}

}  // namespace steradian::test
