#include "render/allocation.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace steradian {
namespace {

/// A cell that seems to have no noise is sampled as if it had this share of the mean.
constexpr double kNoiseFloor = 0.1;
/// Where little is known, the margin is not a guide to how many samples there should be.
constexpr double kMostMargin = 4;
/// Of one group's estimate, so that the picture's own will be trusted: it needs kLeastFreedom with twice the samples.
constexpr double kFreedomWanted = 1.5 * kLeastFreedom;
/// In how many cases the picture's own estimate may be larger than planned, so that it is not certified.
constexpr double kDoubtOfPlan = 0.02;

/// The squared relative deviation of one sample, as it counts in the picture, of each cell.
struct Need {
    double pixels, deviation;
};

/// Of one sample.
double variance_of(const CellError& cell) { return cell.error.v * double(cell.samples) / cell.error.pixels; }

/// What is rare may have been met in the cells around and not in this one: their mean is the least that it has.
double variance_around(std::span<const CellError> cells, size_t columns, size_t cell) {
    const size_t x = cell % columns, y = cell / columns, rows = cells.size() / columns;
    double sum = 0;
    int count = 0;
    for (size_t j = y > 0 ? y - 1 : 0; j <= std::min(y + 1, rows - 1); ++j)
        for (size_t i = x > 0 ? x - 1 : 0; i <= std::min(x + 1, columns - 1); ++i)
            sum += variance_of(cells[j * columns + i]), ++count;
    return sum / count;
}

std::vector<Need> needs_of(std::span<const CellError> cells, size_t columns) {
    std::vector<Need> needs;
    double total = 0, pixels = 0;
    for (size_t i = 0; i < cells.size(); ++i) {
        const double deviation = std::sqrt(max_of(variance_of(cells[i]), variance_around(cells, columns, i)));
        needs.push_back({cells[i].error.pixels, deviation});
        total += deviation * cells[i].error.pixels, pixels += cells[i].error.pixels;
    }
    for (Need& need : needs) need.deviation = max_of(need.deviation, kNoiseFloor * total / pixels);
    return needs;
}

/// The number of samples that is nearest to `wanted`, as a ratio.
uint64_t nearest(double wanted, SampleLimits limits) {
    const double ratio = wanted * 1.4142135623730951 / double(limits.least);
    if (!(ratio >= 2)) return limits.least;
    if (!(wanted < double(limits.most))) return limits.most;
    // The exponent of a number that is at least 2 and finite.
    const auto power = (std::bit_cast<uint64_t>(ratio) >> 52) - 1023;
    return std::min(limits.least << power, limits.most);
}

/// What the squared errors add up to when each cell has `scale` times its deviation as its number of samples: for the
/// least samples in all they are proportional.
double noise_of(std::span<const Need> needs, double scale, SampleLimits limits) {
    double noise = 0;
    for (const Need& need : needs)
        noise += need.deviation * need.deviation * need.pixels / double(nearest(scale * need.deviation, limits));
    return noise;
}

/// The smallest scale that brings the noise to the goal, within a factor of 1.0001 or so.
double scale_for(std::span<const Need> needs, double goal, SampleLimits limits) {
    double smallest = std::numeric_limits<double>::infinity(), largest = 0;
    for (const Need& need : needs)
        smallest = min_of(smallest, need.deviation), largest = max_of(largest, need.deviation);
    if (largest == 0) return 0;
    // Between nobody having more than the least, and everybody the most.
    double low = double(limits.least) / largest, high = double(limits.most) / smallest;
    if (noise_of(needs, low, limits) <= goal) return low;
    while (high > 1.0001 * low) {
        const double middle = std::sqrt(low * high);
        (noise_of(needs, middle, limits) <= goal ? high : low) = middle;
    }
    return high;
}

}  // namespace

std::vector<uint64_t> allocate(std::span<const CellError> cells, size_t columns, double target, SampleLimits limits) {
    const std::vector<Need> needs = needs_of(cells, columns);
    double pixels = 0;
    for (const Need& need : needs) pixels += need.pixels;
    // Pictures that cannot be certified anyway are sampled until their noise is within the target.
    const double all = target * target * pixels;
    const double allowed = enough_pixels(pixels, target) ? all - unseen_error(kDoubt) : all;

    // Where a few samples make most of the noise, their number, and so the freedom, grows like that of all samples.
    ErrorSums now;
    for (const CellError& cell : cells) now += cell.error;
    const double trusted = now.v * error_freedom(now, Teller::one_group) / kFreedomWanted;

    std::vector<uint64_t> wanted(cells.size());
    double margin = 1;
    // The margin follows from where the noise will be, and that from the margin; it changes little after that.
    for (int round = 0; round < 3; ++round) {
        const double scale = scale_for(needs, now.v > 0 ? min_of(allowed / margin, trusted) : allowed / margin, limits);
        ErrorSums planned;
        for (size_t i = 0; i < cells.size(); ++i) {
            wanted[i] = nearest(scale * needs[i].deviation, limits);
            planned += cells[i].error.scaled(double(cells[i].samples) / double(wanted[i]));
        }
        margin = min_of(error_margin(planned, kDoubt, Teller::one_group) *
                            repetition_margin(planned, kDoubtOfPlan, Teller::one_group),
                        kMostMargin);
    }
    return wanted;
}

}  // namespace steradian
