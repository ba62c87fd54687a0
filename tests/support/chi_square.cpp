#include "support/chi_square.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

namespace steradian::test {
namespace {

constexpr double kSmallestExpectation = 5;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// The regularised upper incomplete gamma function Q(a, x): by the series of P for small x and by Lentz's continued
/// fraction of Q for large x (Abramowitz & Stegun 6.5.29 and 6.5.31).
double gamma_q(double a, double x) {
    if (!(x > 0)) return 1;
    const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (int n = 1; n < 100000 && term > sum * 1e-17; ++n) sum += term *= x / (a + n);
        return std::max(0.0, 1 - front * sum);
    }
    double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
    for (int n = 1; n < 100000; ++n) {
        const double an = -n * (n - a);
        b += 2;
        d = 1 / (an * d + b);
        c = b + an / c;
        h *= d * c;
        if (std::fabs(d * c - 1) < 1e-15) break;
    }
    return front * h;
}

/// ∫ density over one cell with side × side points.
double midpoint(const std::function<double(Vec3)>& density, double z0, double z1, double phi0, double phi1, int side) {
    double sum = 0;
    for (int i = 0; i < side; ++i) {
        const double z = z0 + (z1 - z0) * (i + 0.5) / side;
        const double r = std::sqrt(std::max(0.0, 1 - z * z));
        for (int j = 0; j < side; ++j) {
            const double phi = phi0 + (phi1 - phi0) * (j + 0.5) / side;
            sum += density(
                {static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)), static_cast<float>(z)});
        }
    }
    return sum * (z1 - z0) * (phi1 - phi0) / (static_cast<double>(side) * side);
}

struct Integral {
    double value, error;
};

Integral integrate_cell(const std::function<double(Vec3)>& density, double z0, double z1, double phi0, double phi1,
                        double n) {
    Integral result{midpoint(density, z0, z1, phi0, phi1, 16), 0};
    for (int side = 32; side <= 512; side *= 2) {
        const double finer = midpoint(density, z0, z1, phi0, phi1, side);
        result = {finer, std::fabs(finer - result.value)};
        if (result.error < 1e-2 * std::sqrt(std::max(finer * n, kSmallestExpectation)) / n) break;
    }
    return result;
}

}  // namespace

double chi_square_upper_tail(double statistic, double dof) { return gamma_q(dof / 2, statistic / 2); }

std::ostream& operator<<(std::ostream& out, const ChiSquare& result) {
    return out << "chi-square " << result.statistic << " with " << result.dof
               << " degrees of freedom, p = " << result.p_value;
}

ChiSquare chi_square(std::span<const double> observed, std::span<const double> expected) {
    const ChiSquare impossible{kInfinite, 0, 0};
    if (observed.size() != expected.size()) return impossible;
    const double total_observed = std::accumulate(observed.begin(), observed.end(), 0.0);
    const double total_expected = std::accumulate(expected.begin(), expected.end(), 0.0);
    if (!(std::fabs(total_observed - total_expected) <= 1e-6 * std::max(1.0, total_observed))) return impossible;

    std::vector<size_t> order(observed.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return expected[a] < expected[b]; });

    ChiSquare result;
    double pooled_observed = 0, pooled_expected = 0;
    int bins = 0;
    const auto close_bin = [&](double o, double e) {
        result.statistic += (o - e) * (o - e) / e;
        ++bins;
    };
    for (const size_t i : order) {
        if (!(expected[i] >= 0)) return impossible;
        if (expected[i] == 0 && observed[i] > 0) return impossible;
        pooled_observed += observed[i], pooled_expected += expected[i];
        if (pooled_expected < kSmallestExpectation) continue;
        close_bin(pooled_observed, pooled_expected);
        pooled_observed = pooled_expected = 0;
    }
    // Sorted upwards, so something is left over only when everything together expects less than one bin should.
    if (pooled_expected > 0) close_bin(pooled_observed, pooled_expected);
    result.dof = bins - 1;
    result.p_value = result.dof > 0 ? chi_square_upper_tail(result.statistic, result.dof) : 1;
    return result;
}

ChiSquare chi_square_directions(const std::function<std::optional<Vec3>(uint64_t)>& sample,
                                const std::function<double(Vec3)>& density, uint64_t n, int theta_bins, int phi_bins) {
    const size_t cells = static_cast<size_t>(theta_bins) * static_cast<size_t>(phi_bins);
    std::vector<double> observed(cells + 1), expected(cells + 1);
    const double two_pi = 2 * std::numbers::pi, count = static_cast<double>(n);
    for (uint64_t i = 0; i < n; ++i) {
        const std::optional<Vec3> d = sample(i);
        if (!d) {
            ++observed[cells];
            continue;
        }
        if (!(std::fabs(d->x) + std::fabs(d->y) + std::fabs(d->z) < 2)) return {kInfinite, 0, 0};
        double phi = std::atan2(static_cast<double>(d->y), static_cast<double>(d->x));
        if (phi < 0) phi += two_pi;
        const int row = std::clamp(static_cast<int>((1 - d->z) / 2 * theta_bins), 0, theta_bins - 1);
        const int column = std::clamp(static_cast<int>(phi / two_pi * phi_bins), 0, phi_bins - 1);
        ++observed[static_cast<size_t>(row * phi_bins + column)];
    }
    double total = 0, error = 0;
    for (int row = 0; row < theta_bins; ++row)
        for (int column = 0; column < phi_bins; ++column) {
            const double z1 = 1 - 2.0 * row / theta_bins, z0 = 1 - 2.0 * (row + 1) / theta_bins;
            const double phi0 = two_pi * column / phi_bins, phi1 = two_pi * (column + 1) / phi_bins;
            const auto cell = static_cast<size_t>(row * phi_bins + column);
            Integral mass = integrate_cell(density, z0, z1, phi0, phi1, count);
            // A cell that the support of the density only touches may be missed by a few points.
            for (int side = 512; mass.value == 0 && observed[cell] > 0 && side <= 4096; side *= 8)
                mass.value = midpoint(density, z0, z1, phi0, phi1, side);
            expected[cell] = mass.value * count;
            total += mass.value, error += mass.error;
        }
    if (!(error < 1e-2 && total <= 1 + error + 1e-6)) return {kInfinite, 0, 0};
    // What should be missing is known within the error of the integration: the value nearest to what was observed.
    const double slack = (error + 1e-6) * count, missing = (1 - total) * count;
    expected[cells] = std::max(0.0, std::clamp(observed[cells], missing - slack, missing + slack));
    const double sum = std::accumulate(expected.begin(), expected.end(), 0.0);
    for (double& e : expected) e *= count / sum;
    return chi_square(observed, expected);
}

}  // namespace steradian::test
