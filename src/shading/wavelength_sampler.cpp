#include "shading/wavelength_sampler.h"

#include <algorithm>
#include <cmath>

#include "shading/spectrum.h"

namespace steradian {
namespace {

constexpr double kSpectrum = kLongestSample - kShortestSample;

double mean(Vec3d v) { return (v.x + v.y + v.z) / 3; }

}  // namespace

WavelengthSampler::WavelengthSampler() {
    constexpr double kStep = kSpectrum / kCells;
    Vec3d sum;
    for (size_t i = 0; i <= kCells; ++i) {
        const Vec3d r = rgb_response(kShortestSample + kStep * double(i));
        response_[i] = {max_of(r.x, 0.0), max_of(r.y, 0.0), max_of(r.z, 0.0)};
        sum = sum + response_[i] * (i == 0 || i == kCells ? 0.5 : 1.0);
    }
    for (Vec3d& w : response_) w = {w.x / (sum.x * kStep), w.y / (sum.y * kStep), w.z / (sum.z * kStep)};
    double below = 0;
    for (size_t i = 0; i <= kCells; ++i) {
        pdf_[i] = mean(response_[i]);
        if (i > 0) below += (pdf_[i - 1] + pdf_[i]) / 2 * kStep;
        below_[i] = below;
    }
}

WavelengthSample WavelengthSampler::sample(uint32_t bits) const noexcept {
    const double u = (static_cast<double>(bits) + 0.5) * 0x1p-32 * below_[kCells];
    const auto above = std::upper_bound(below_.begin() + 1, below_.end() - 1, u);
    const auto cell = static_cast<size_t>(above - below_.begin()) - 1;
    // With p linear over the cell, p0 t + (p1 - p0) t² / 2 is the share of its integral up to t.
    const double p0 = pdf_[cell], p1 = pdf_[cell + 1], left = (u - below_[cell]) * (kCells / kSpectrum);
    const double root = std::sqrt(max_of(p0 * p0 + 2 * (p1 - p0) * left, 0.0));
    const double t = min_of(2 * left / (p0 + root), 1.0);
    const Vec3d w = response_[cell] * (1 - t) + response_[cell + 1] * t, weight = w * (1 / mean(w));
    return {static_cast<float>(kShortestSample + (double(cell) + t) * (kSpectrum / kCells)),
            {static_cast<float>(weight.x), static_cast<float>(weight.y), static_cast<float>(weight.z)}};
}

Vec3d WavelengthSampler::response(double wavelength) const noexcept {
    const double at = (wavelength - kShortestSample) * (kCells / kSpectrum);
    if (!(at >= 0 && at <= double(kCells))) return {};
    const size_t cell = min_of(static_cast<size_t>(at), kCells - 1);
    const double t = at - double(cell);
    return response_[cell] * (1 - t) + response_[cell + 1] * t;
}

double WavelengthSampler::pdf(double wavelength) const noexcept { return mean(response(wavelength)); }

}  // namespace steradian
