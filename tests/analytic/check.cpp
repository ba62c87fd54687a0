#include "analytic/check.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "steradian/image_io.h"
#include "support/support.h"

namespace steradian::analytic {
namespace {

template <class T>
T take(Result<T> result) {
    if (!result) throw std::runtime_error(result.error().str());
    return std::move(*result);
}

/// The whole picture where nothing is said.
Expected resolved(Expected region, const Image& image) {
    if (region.x1 == 0) region.x1 = image.width, region.y1 = image.height;
    return region;
}

/// What errors are relative to: the value, or the brightest of the case where it is 0 or one of several regions.
double reference(const Case& c, double value) {
    if (value != 0 && c.expected.size() == 1) return std::abs(value);
    double brightest = 0;
    for (const Expected& e : c.expected)
        for (int channel = 0; channel < 3; ++channel) brightest = std::max(brightest, std::abs(e.value[channel]));
    return brightest > 0 ? brightest : 1;
}

std::string place(const Expected& e, int channel) {
    std::string out = std::string("channel ") + "RGB"[channel];
    if (e.x1)
        out += " of pixels [" + std::to_string(e.x0) + ", " + std::to_string(e.x1) + ") x [" + std::to_string(e.y0) +
               ", " + std::to_string(e.y1) + ")";
    return out;
}

void check_pixels(const Case& c, const Expected& e, const Image& image, Judgement& out) {
    for (uint32_t y = e.y0; y < e.y1; ++y)
        for (uint32_t x = e.x0; x < e.x1; ++x)
            for (int channel = 0; channel < 3; ++channel) {
                const double got = image.pixels[(size_t(y) * image.width + x) * 3 + static_cast<size_t>(channel)],
                             want = e.value[channel];
                const double error = std::abs(got - want) / reference(c, want);
                out.worst_error = std::max(out.worst_error, error);
                if (!(error <= c.tolerance) && out.failures.size() < 10)
                    out.failures.push_back("pixel (" + std::to_string(x) + ", " + std::to_string(y) + ") channel " +
                                           "RGB"[channel] + ": " + text_of(got) + " instead of " + text_of(want));
            }
}

Judgement judge_exact(const Case& c, const PreparedCase& prepared) {
    Judgement out;
    out.samples = prepared.settings.samples_per_pixel;
    out.pictures = 1;
    const Image image = prepared.picture(prepared.settings);
    for (const Expected& given : c.expected) {
        const Expected e = resolved(given, image);
        if (e.every_pixel) check_pixels(c, e, image, out);
        for (int channel = 0; channel < 3; ++channel) {
            const double got = mean_over(image, e, channel), want = e.value[channel],
                         error = std::abs(got - want) / reference(c, want);
            out.worst_error = std::max(out.worst_error, error);
            if (!(error <= c.tolerance))
                out.failures.push_back(place(given, channel) + ": " + text_of(got) + " instead of " + text_of(want) +
                                       ", relative error " + text_of(error));
        }
    }
    return out;
}

/// [region][channel]
using Estimates = std::vector<std::vector<Estimate>>;

Estimates measure(const Case& c, const PreparedCase& prepared, uint64_t first_seed, uint32_t seeds, uint64_t samples) {
    std::vector<Image> pictures;
    for (uint32_t i = 0; i < seeds; ++i) pictures.push_back(prepared.picture(first_seed + i, samples));
    Estimates out;
    for (const Expected& given : c.expected) {
        const Expected e = resolved(given, pictures[0]);
        out.emplace_back();
        for (int channel = 0; channel < 3; ++channel) {
            std::vector<double> values;
            for (const Image& picture : pictures) values.push_back(mean_over(picture, e, channel));
            out.back().push_back(estimate(values));
        }
    }
    return out;
}

double worst_standard_error(const Case& c, const Estimates& all) {
    double worst = 0;
    for (size_t i = 0; i < all.size(); ++i)
        for (int channel = 0; channel < 3; ++channel)
            worst = std::max(worst, all[i][static_cast<size_t>(channel)].standard_error /
                                        reference(c, c.expected[i].value[channel]));
    return worst;
}

Judgement judge_statistics(const Case& c, const PreparedCase& prepared) {
    Judgement out;
    out.pictures = test::by_tier(16u, 32u);
    Estimates all;
    const double bound = test::by_tier(0.0005, 0.00025);  // of the value
    constexpr uint64_t kMostSamples = uint64_t(1) << 22;
    uint64_t seed = 1;
    for (out.samples = 64;; seed += out.pictures) {
        all = measure(c, prepared, seed, out.pictures, out.samples);
        out.worst_standard_error = worst_standard_error(c, all);
        if (out.worst_standard_error <= bound) break;
        // By the slope of independent samples; low-discrepancy ones do better, so somewhat less is asked for.
        const double ratio = out.worst_standard_error / bound;
        out.samples *= std::bit_ceil(static_cast<uint64_t>(std::clamp(std::pow(ratio, 1.8), 2.0, 64.0)));
        if (out.samples > kMostSamples) {
            out.failures.push_back("the standard error stays at " + text_of(out.worst_standard_error) +
                                   " of the value");
            return out;
        }
    }
    for (size_t i = 0; i < all.size(); ++i)
        for (int channel = 0; channel < 3; ++channel) {
            const Estimate e = all[i][static_cast<size_t>(channel)];
            const double want = c.expected[i].value[channel], base = reference(c, want),
                         error = std::abs(e.mean - want);
            const double deviation = error <= kRounding * base ? 0 : error / e.standard_error;
            out.worst_error = std::max(out.worst_error, error / base);
            out.worst_deviation = std::max(out.worst_deviation, deviation);
            if (!(deviation <= kDeviations) || !(error <= std::max(1e-3, c.tolerance) * base))
                out.failures.push_back(place(c.expected[i], channel) + ": " + text_of(e.mean) + " instead of " +
                                       text_of(want) + ", relative error " + text_of(error / base) + ", " +
                                       text_of(deviation) + " standard errors");
        }
    return out;
}

LoadedScene load_case(const std::string& scene_text, const std::vector<CaseFile>& files) {
    const test::TemporaryFolder folder;
    for (const CaseFile& file : files)
        if (file.text.empty())
            take(write_image(folder.file(file.name), file.image));
        else
            std::ofstream(folder.file(file.name), std::ios::binary) << file.text;
    return take(load_scene_json(scene_text, "scene.json", folder.path().string()));
}

}  // namespace

PreparedCase::PreparedCase(const std::string& scene_text, const std::vector<CaseFile>& files)
    : PreparedCase(load_case(scene_text, files)) {}

PreparedCase::PreparedCase(LoadedScene loaded) {
    if (!loaded.fidelity.empty()) throw std::runtime_error("not honoured: " + loaded.fidelity.warnings()[0].str());
    if (!loaded.diagnostics.empty())
        throw std::runtime_error("the scene gave a warning: " + loaded.diagnostics.warnings()[0].str());
    settings = loaded.settings;
    Diagnostics diagnostics;
    scene_ = take(prepare(std::move(loaded.scene), Execution{}, diagnostics));
    if (!diagnostics.empty())
        throw std::runtime_error("preparing the scene gave a warning: " + diagnostics.warnings()[0].str());
}

RenderResult PreparedCase::render(const RenderSettings& with) const {
    RenderResult result = take(take(RenderJob::start(scene_, with, Execution{}))->take());
    if (!result.complete) throw std::runtime_error("the picture is not complete");
    if (result.statistics.bad_samples)
        throw std::runtime_error(std::to_string(result.statistics.bad_samples) + " bad samples");
    return result;
}

Image PreparedCase::picture(uint64_t seed, uint64_t samples) const {
    RenderSettings with = settings;
    with.seed = seed;
    with.samples_per_pixel = samples;
    return picture(with);
}

Estimate estimate(const std::vector<double>& values) {
    const auto n = static_cast<double>(values.size());
    Estimate out;
    for (const double v : values) out.mean += v / n;
    double squares = 0;
    for (const double v : values) squares += (v - out.mean) * (v - out.mean);
    out.standard_error = std::sqrt(squares / (n - 1) / n);
    return out;
}

double mean_over(const Image& image, const Expected& e, int channel) {
    double sum = 0;
    for (uint32_t y = e.y0; y < e.y1; ++y)
        for (uint32_t x = e.x0; x < e.x1; ++x)
            sum += image.pixels[(size_t(y) * image.width + x) * 3 + static_cast<size_t>(channel)];
    return sum / (double(e.x1 - e.x0) * (e.y1 - e.y0));
}

Judgement judge(const Case& c) { return judge(c, PreparedCase(c.scene, c.files)); }

Judgement judge(const Case& c, const PreparedCase& prepared) {
    return c.kind == CaseClass::zero_variance ? judge_exact(c, prepared) : judge_statistics(c, prepared);
}

}  // namespace steradian::analytic
