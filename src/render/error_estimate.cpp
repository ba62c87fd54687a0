#include "render/error_estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/elementary.h"

namespace steradian {
namespace {

constexpr double kLeast = 0.01;  ///< added to what the error is relative to

/// Of the variance that normal replicates tell: its own variance over its square.
constexpr double variance_of_variance(Teller teller) {
    return teller == Teller::both_groups ? 2.0 / (kReplicates - 2) : 2.0 / (kGroupReplicates - 1);
}

using Means = std::array<double, kGroupReplicates>;

double channel_of(const RgbSum& sum, int channel) { return channel == 0 ? sum.r : channel == 1 ? sum.g : sum.b; }

Means means_of(const GroupSums& group, int channel) {
    Means means;
    for (size_t r = 0; r < means.size(); ++r) means[r] = channel_of(group.replicates[r], channel) / group.samples_each;
    return means;
}

double mean_of(const Means& means) {
    double sum = 0;
    for (const double m : means) sum += m;
    return sum / double(means.size());
}

/// The variance of their mean.
double variance_of_mean(const Means& means) {
    const double mean = mean_of(means);
    double squares = 0;
    for (const double m : means) squares += (m - mean) * (m - mean);
    return squares / double(means.size() * (means.size() - 1));
}

/// I + 0.01 for one channel. I is not the mean of the pixel alone, for a bright sample would make its own error look
/// small: where half of the replicates know nothing of it, no more than the mean of the pixels around counts, and of
/// that no more than kShare, which doubles the variance there: n rare samples of equal brightness, n being distributed
/// as Poisson has it around 1, would otherwise tell half of the true relative variance.
double reference(std::span<double> means, double mean, double around) {
    constexpr double kShare = 0.7071;
    std::sort(means.begin(), means.end());
    const double median = (means[means.size() / 2 - 1] + means[means.size() / 2]) / 2;
    return max_of(max_of(median, kShare * min_of(mean, around)), 0.0) + kLeast;
}

/// The share of Σ v² that is not there by chance. The variances that two halves of the replicates tell are independent,
/// so the mean of their product is the square of the true one, whatever the distribution; that of v² is larger by
/// variance_of_variance() where replicates are normal, and by more where their tails are heavier.
double true_share(const ErrorSums& s, Teller teller) {
    const double normal = 1 / (1 + variance_of_variance(teller));
    return s.squares > 0 ? min_of(max_of(s.products / s.squares, 0.0), normal) : normal;
}

/// Σ v² / (Σ v)²: one over the number of pixels that matter.
double concentration(const ErrorSums& s) { return s.v > 0 ? s.squares / (s.v * s.v) : 0; }

/// What a normal deviate exceeds in one case of 1 / doubt, to 0.0005, for a doubt of at most 1/2 (Abramowitz and Stegun
/// 1964, "Handbook of Mathematical Functions", equation 26.2.23).
double normal_quantile(double doubt) {
    const double t = std::sqrt(-2 * math::log(doubt));
    return t - (2.515517 + t * (0.802853 + t * 0.010328)) / (1 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
}

/// The same for the F distribution, from the normal one (Paulson 1942, "An approximate normalization of the analysis of
/// variance distribution"). Infinite where m is too small for it.
double f_quantile(double n, double m, double doubt) {
    const double a = 2 / (9 * n), b = 2 / (9 * m), z = normal_quantile(doubt);
    const double denominator = (1 - b) * (1 - b) - z * z * b;
    if (!(denominator > 0)) return std::numeric_limits<double>::infinity();
    const double spread = (1 - b) * (1 - b) * a + (1 - a) * (1 - a) * b - z * z * a * b;
    const double root = ((1 - a) * (1 - b) + z * std::sqrt(max_of(spread, 0.0))) / denominator;
    return root * root * root;
}

}  // namespace

Channels group_variance(const GroupSums& group) noexcept {
    Channels out;
    for (size_t c = 0; c < out.size(); ++c) out[c] = variance_of_mean(means_of(group, int(c)));
    return out;
}

ErrorSums pixel_error(const GroupSums& a, const GroupSums& b, const Channels& around) noexcept {
    double of_a = 0, of_b = 0;
    for (int channel = 0; channel < 3; ++channel) {
        const Means in_a = means_of(a, channel), in_b = means_of(b, channel);
        std::array<double, kReplicates> all;
        std::copy(in_b.begin(), in_b.end(), std::copy(in_a.begin(), in_a.end(), all.begin()));
        const double scale = reference(all, (mean_of(in_a) + mean_of(in_b)) / 2, around[size_t(channel)]);
        // Half the variance of a group's mean is what it tells of that of the mean of both.
        const double share = 1 / (2 * 3 * scale * scale);
        of_a += share * variance_of_mean(in_a);
        of_b += share * variance_of_mean(in_b);
    }
    const double v = (of_a + of_b) / 2;
    return {1, v, v * v, of_a * of_b};
}

ErrorSums group_error(const GroupSums& group, const Channels& around) noexcept {
    static_assert(kGroupReplicates == 4, "two pairs");
    double v = 0, first = 0, second = 0;
    for (int channel = 0; channel < 3; ++channel) {
        Means means = means_of(group, channel);
        const double of_mean = variance_of_mean(means), mean = mean_of(means);
        const double off_first = means[0] - means[1], off_second = means[2] - means[3];
        const double scale = reference(means, mean, around[size_t(channel)]);
        const double share = 1 / (3 * scale * scale);
        v += share * of_mean / 2;
        // The variance of one replicate is half the mean square of the difference of two.
        first += share * off_first * off_first / (2 * kReplicates);
        second += share * off_second * off_second / (2 * kReplicates);
    }
    return {1, v, v * v, first * second};
}

double error_freedom(const ErrorSums& s, Teller teller) noexcept {
    return 2 / (concentration(s) * (1 - true_share(s, teller)));
}

/// Both the estimate and what it estimates, the sum of squared errors of this very picture, are sums over independent
/// pixels; as many chi-square deviates as fit their variances (Satterthwaite 1946) have a ratio that is distributed as
/// F. With k the excess kurtosis of a pixel's mean, v now its true variance and w variance_of_variance(), the estimate
/// of both groups varies by v² (k + w), the square of its error by v² (k + 2), and the mean of the estimate's square is
/// v² (1 + w + k): k goes out by itself. (In what one group tells k counts twice, which makes its margin larger.)
double error_margin(const ErrorSums& s, double doubt, Teller teller) noexcept {
    const double by_pixels = concentration(s);
    if (by_pixels == 0) return 1;
    const double of_error = by_pixels * (1 + true_share(s, teller) * (1 - variance_of_variance(teller)));
    return f_quantile(2 / of_error, error_freedom(s, teller), doubt);
}

double repetition_margin(const ErrorSums& s, double doubt, Teller teller) noexcept {
    if (concentration(s) == 0) return 1;
    const double freedom = error_freedom(s, teller);
    return f_quantile(freedom, freedom, doubt);
}

double unseen_error(double doubt) noexcept { return -math::log(doubt); }

/// At least half of the squared error is left for noise.
bool enough_pixels(double pixels, double target) noexcept {
    return target * target * pixels >= 2 * unseen_error(kDoubt);
}

ErrorReport judge(const ErrorSums& s, double target, bool limited) {
    ErrorReport out;
    out.estimate = std::sqrt(s.v / s.pixels);
    out.bound = std::sqrt((s.v * error_margin(s, kDoubt) + unseen_error(kDoubt)) / s.pixels);
    if (!std::isfinite(out.estimate))
        out.reason = "the estimate is not a number";
    else if (error_freedom(s) < kLeastFreedom)
        out.reason = "a few samples make most of the error (heavy tails), so its estimate cannot be trusted";
    else if (!enough_pixels(s.pixels, target))
        out.reason = fmt::format("of {} pixels, a few that met no light would exceed it, and no samples rule them out",
                                 s.pixels);
    else if (!(out.bound <= target))
        out.reason = limited ? "the samples that were allowed did not suffice"
                             : fmt::format("with more noise than was to be expected it may be {:.4g}", out.bound);
    out.certified = out.reason.empty();
    return out;
}

}  // namespace steradian
