// Pearson's chi-square test, for everything that draws samples from a density that it also states.
//
// The level: with T tests in a run, each at level α, a correct program fails with a probability of at most T α
// (Bonferroni, whatever the dependence between the tests). kSignificance = 1e-6 keeps a run of up to a thousand tests
// below 0.1 %; seeds are fixed, so a test that passes once passes always. A fault is found all the same: relative
// errors ε of the densities of k bins raise the statistic of n samples by n ε², and its standard deviation is √(2k), so
// that ε above about √(7 √k / n) is refused.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <ostream>
#include <span>

#include "steradian/vec.h"

namespace steradian::test {

inline constexpr double kSignificance = 1e-6;

struct ChiSquare {
    double statistic = 0;
    int dof = 0;
    double p_value = 1;  ///< the probability of a statistic at least as large when the density is right

    /// For EXPECT_TRUE(result.passes()) << result.
    bool passes(double significance = kSignificance) const { return p_value >= significance; }
};
std::ostream& operator<<(std::ostream& out, const ChiSquare& result);

/// Pools the bins with the smallest expectations until every one expects at least 5 (Cochran's rule). The totals must
/// agree; when they do not (more than rounding, 1e-6), p is 0. Samples in bins that expect nothing at all make p 0 too.
ChiSquare chi_square(std::span<const double> observed, std::span<const double> expected);

/// P(X > statistic) for the chi-square distribution.
double chi_square_upper_tail(double statistic, double dof);

/// Directions over the sphere in theta_bins × phi_bins cells of equal solid angle about +z; θ from +z. `sample(i)` for
/// i in [0, n) is a unit direction or nothing; `density` is per solid angle and may integrate to less than 1: the rest
/// is what `sample` must return nothing for, as one more bin. The density is integrated over each cell by the composite
/// midpoint rule with 16 × 16 points, refined to at most 512 × 512 until a step changes the cell's expectation by less
/// than 1e-2 of its standard deviation. So a peak must not be narrower than about a sixteenth of a cell; p is 0 when
/// the integral is not known to 1 % or is above 1, and when a sample is not finite.
ChiSquare chi_square_directions(const std::function<std::optional<Vec3>(uint64_t)>& sample,
                                const std::function<double(Vec3)>& density, uint64_t n, int theta_bins, int phi_bins);

}  // namespace steradian::test
