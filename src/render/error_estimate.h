// What the replicates of pixels tell about the error √mean(Var / (I + 0.01)²) of a picture, and how sure that is.
#pragma once

#include <array>
#include <span>

#include "render/sums.h"
#include "steradian/render.h"

namespace steradian {

/// A pixel's replicates are in two groups.
inline constexpr uint32_t kGroupReplicates = kReplicates / 2;

/// R, G, B.
using Channels = std::array<double, 3>;

/// The sums of one pixel in one group, and how many samples each is of.
struct GroupSums {
    std::span<const RgbSum> replicates;
    double samples_each = 1;
};

/// Of the group's mean, as its replicates tell it.
Channels group_variance(const GroupSums& group) noexcept;

/// Sums over pixels. v is Var / (I + 0.01)² of a pixel, mean of the channels, as its replicates tell it.
struct ErrorSums {
    double pixels = 0;
    double v = 0;
    double squares = 0;   ///< Σ v²
    double products = 0;  ///< Σ of what one half of the replicates tells of v times what the other half tells
    ErrorSums& operator+=(const ErrorSums& other) noexcept {
        pixels += other.pixels, v += other.v, squares += other.squares, products += other.products;
        return *this;
    }
    /// As if each pixel's v were `factor` times as large.
    ErrorSums scaled(double factor) const noexcept {
        return {pixels, v * factor, squares * factor * factor, products * factor * factor};
    }
};

/// Of one pixel, which is the mean of both groups; `around`: the mean of the pixels around it.
ErrorSums pixel_error(const GroupSums& a, const GroupSums& b, const Channels& around) noexcept;
/// The same as one group alone tells it, of a pixel of which the other one has as many samples.
ErrorSums group_error(const GroupSums& group, const Channels& around) noexcept;

/// Whose sums they are; for what the two functions above return.
enum class Teller { both_groups, one_group };

/// How many independent normal deviates would tell the error as well as these pixels do; infinite without noise.
double error_freedom(const ErrorSums& sums, Teller teller = Teller::both_groups) noexcept;
/// By what factor the mean of the true squared errors may be larger than v / pixels, but for one case in 1 / doubt.
double error_margin(const ErrorSums& sums, double doubt, Teller teller = Teller::both_groups) noexcept;
/// By what factor another estimate of the same error, which is as good, may be larger than this one, but for one case
/// in 1 / doubt.
double repetition_margin(const ErrorSums& sums, double doubt, Teller teller) noexcept;
/// What the squared errors of pixels that met nothing of what they could see may add up to, but for one case in
/// 1 / doubt: -ln doubt, the limit for the mean of a Poisson distribution of which nothing was seen, in units of
/// pixels.
double unseen_error(double doubt) noexcept;
/// An estimate that rests on less than so many independent deviates is not trusted: its standard error is above 35 %.
inline constexpr double kLeastFreedom = 16;
/// In how many cases the error may be beyond the bound.
inline constexpr double kDoubt = 1 - ErrorReport::confidence;
/// Whether there are so many pixels that a few unseen ones are within the target.
bool enough_pixels(double pixels, double target) noexcept;
/// `limited`: there were to be more samples than were allowed.
ErrorReport judge(const ErrorSums& sums, double target, bool limited = false);

}  // namespace steradian
