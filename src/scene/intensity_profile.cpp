#include "scene/intensity_profile.h"

#include <algorithm>
#include <numbers>

#include "math/elementary.h"
#include "math/vector.h"

namespace steradian {
namespace {

struct Place {
    size_t first = 0;
    double t = 0;  ///< of the way to the next
};

/// x is within the ends of `angles`, of which there are at least two.
Place place_of(const std::vector<float>& angles, double x) {
    const auto above = std::upper_bound(angles.begin() + 1, angles.end() - 1, x);
    const auto i = static_cast<size_t>(above - angles.begin()) - 1;
    const double a = angles[i], b = angles[i + 1];
    return {i, clamp_to((x - a) / (b - a), 0.0, 1.0)};
}

/// The mean over all planes at one vertical angle.
double mean_around(const IntensityProfile& p, size_t v) {
    const size_t n = p.vertical.size();
    if (p.horizontal.size() == 1) return p.candela[v];
    double sum = 0;
    for (size_t h = 0; h + 1 < p.horizontal.size(); ++h)
        sum += (double(p.horizontal[h + 1]) - p.horizontal[h]) *
               (double(p.candela[h * n + v]) + p.candela[(h + 1) * n + v]);
    return sum / 720;
}

}  // namespace

double intensity_at(const IntensityProfile& p, double vertical, double horizontal) noexcept {
    if (!(vertical >= p.vertical.front() && vertical <= p.vertical.back())) return 0;
    const size_t n = p.vertical.size();
    const Place v = place_of(p.vertical, vertical);
    const auto along = [&](size_t plane) {
        const float* row = p.candela.data() + plane * n + v.first;
        return row[0] + (double(row[1]) - row[0]) * v.t;
    };
    if (p.horizontal.size() == 1) return along(0);
    const Place h = place_of(p.horizontal, horizontal);
    const double a = along(h.first);
    return a + (along(h.first + 1) - a) * h.t;
}

double total_flux(const IntensityProfile& p) noexcept {
    constexpr double kRadians = std::numbers::pi / 180;
    double sum = 0;
    for (size_t v = 0; v + 1 < p.vertical.size(); ++v) {
        // ∫ (a + s (θ - θ0)) sin θ dθ = [-(a + s (θ - θ0)) cos θ + s sin θ]
        const double t0 = p.vertical[v] * kRadians, t1 = p.vertical[v + 1] * kRadians;
        const double a = mean_around(p, v), b = mean_around(p, v + 1), s = (b - a) / (t1 - t0);
        sum += a * math::cos(t0) - b * math::cos(t1) + s * (math::sin(t1) - math::sin(t0));
    }
    return max_of(2 * std::numbers::pi * sum, 0.0);
}

double lit_angle(const IntensityProfile& p) noexcept {
    const size_t n = p.vertical.size();
    size_t dark_from = n;
    for (; dark_from > 0; --dark_from)
        for (size_t h = 0; h < p.horizontal.size(); ++h)
            if (p.candela[h * n + dark_from - 1] > 0) return p.vertical[std::min(dark_from, n - 1)];
    return 0;
}

float peak_intensity(const IntensityProfile& p) noexcept {
    return *std::max_element(p.candela.begin(), p.candela.end());
}

}  // namespace steradian
