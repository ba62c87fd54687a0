#include "shading/filter.h"

#include <array>
#include <cstddef>
#include <vector>

#include "math/elementary.h"

namespace steradian {
namespace {

/// Mitchell & Netravali 1988, equation 8, with B = C = 1/3 and the support stretched from [-2, 2] to [-1, 1]; factored
/// on the outer half, where it has a double root at the edge and changes sign at 8/7 of its half width.
constexpr double kMitchellRoot = 4.0 / 7;
constexpr double mitchell(double x) {
    x *= 2;
    if (x <= 1) return (7 * x - 12) * x * x / 6 + 8.0 / 9;
    return 7.0 / 18 * (2 - x) * (2 - x) * (2 * kMitchellRoot - x);
}

/// A standard deviation of a third of the radius, shifted down to be 0 at the radius.
double gaussian(double x) { return math::exp(-4.5 * x * x) - math::exp(-4.5); }

/// One axis of the filter at x >= 0 in units of the radius; 0 outside. Any scale.
double profile(FilterKind kind, double x) {
    if (!(x <= 1)) return 0;
    switch (kind) {
        case FilterKind::box:
            return 1;
        case FilterKind::tent:
            return 1 - x;
        case FilterKind::gaussian:
            return gaussian(x);
        case FilterKind::mitchell:
            return mitchell(x);
    }
    return 0;
}

/// ∫ over [a, b] by the five points of Gauss and Legendre: exact for polynomials up to degree 9.
double integrate(FilterKind kind, double a, double b) {
    const double near = std::sqrt(5 - 2 * std::sqrt(10.0 / 7)) / 3, far = std::sqrt(5 + 2 * std::sqrt(10.0 / 7)) / 3;
    const double near_weight = (322 + 13 * std::sqrt(70.0)) / 900, far_weight = (322 - 13 * std::sqrt(70.0)) / 900;
    const double middle = (a + b) / 2, half = (b - a) / 2;
    const auto f = [&](double s) { return profile(kind, middle + half * s); };
    return half * (128.0 / 225 * f(0) + near_weight * (f(-near) + f(near)) + far_weight * (f(-far) + f(far)));
}

/// ∫f over one half of the axis in units of the radius.
double half_integral(FilterKind kind) {
    switch (kind) {
        case FilterKind::box:
            return 1;
        case FilterKind::tent:
            return 0.5;
        case FilterKind::gaussian: {
            double sum = 0;
            for (int i = 0; i < 64; ++i) sum += integrate(kind, i / 64.0, (i + 1) / 64.0);
            return sum;
        }
        case FilterKind::mitchell:
            return 0.25;
    }
    return 1;
}

}  // namespace

/// The distribution of |x| under |f|, x in units of the radius. The mass of each cell is exact; within a cell the
/// density is taken as linear. So the density drawn from differs from |f| by at most (1/8 + 1/12) h² max|f''|, for the
/// interpolation and for the mass it misses; h <= 1/1024 and max|f''| <= 18 of the peak make less than 5e-6 of it.
struct FilterSampler::Table {
    static constexpr size_t kCellsPerPart = 512;
    static constexpr size_t kGuides = 1024;

    explicit Table(FilterKind kind);
    double invert(double u) const noexcept;

    std::vector<double> x, density, cdf;    ///< at the ends of the cells
    std::array<uint16_t, kGuides> guide{};  ///< the cell in which the cdf passes i / kGuides
    double absolute_over_signed = 1;        ///< ∫|f| / ∫f
};

FilterSampler::Table::Table(FilterKind kind) {
    // The parts join where the function is not smooth: the middle and the root.
    const std::array<double, 4> joints{0, 0.5, kMitchellRoot, 1};
    const size_t cells = (joints.size() - 1) * kCellsPerPart;
    x.reserve(cells + 1), density.reserve(cells + 1), cdf.reserve(cells + 1);
    for (size_t i = 0; i <= cells; ++i) {
        const size_t part = i / kCellsPerPart < joints.size() - 1 ? i / kCellsPerPart : joints.size() - 2;
        const double fraction = static_cast<double>(i - part * kCellsPerPart) / kCellsPerPart;
        x.push_back(i == cells ? 1 : joints[part] + (joints[part + 1] - joints[part]) * fraction);
        density.push_back(std::fabs(profile(kind, x[i])));
        cdf.push_back(i == 0 ? 0 : cdf[i - 1] + std::fabs(integrate(kind, x[i - 1], x[i])));
    }
    const double total = cdf.back();
    absolute_over_signed = total / half_integral(kind);
    for (double& c : cdf) c /= total;

    size_t cell = 0;
    for (size_t i = 0; i < kGuides; ++i) {
        while (cell + 1 < cells && cdf[cell + 1] <= static_cast<double>(i) / kGuides) ++cell;
        guide[i] = static_cast<uint16_t>(cell);
    }
}

double FilterSampler::Table::invert(double u) const noexcept {
    size_t cell = guide[static_cast<size_t>(u * kGuides)];
    while (cell + 2 < cdf.size() && cdf[cell + 1] <= u) ++cell;
    const double mass = cdf[cell + 1] - cdf[cell];
    const double w = (u - cdf[cell]) / mass;
    if (!(w > 0)) return x[cell];
    // ∫ of a linear density up to s is w of the whole: the root of a quadratic, in the form that does not cancel.
    const double p0 = density[cell], p1 = density[cell + 1];
    const double s = w * (p0 + p1) / (p0 + std::sqrt(p0 * p0 + w * (p1 * p1 - p0 * p0)));
    return x[cell] + (x[cell + 1] - x[cell]) * s;
}

FilterSampler::FilterSampler(const Filter& filter) : filter_(filter) {
    if (filter.kind == FilterKind::gaussian || filter.kind == FilterKind::mitchell)
        table_ = std::make_shared<const Table>(filter.kind);
    const double half_width = half_integral(filter.kind) * filter.radius;
    normalisation_ = 1 / (4 * half_width * half_width);
}

FilterSample FilterSampler::sample(Vec2 u) const noexcept {
    bool negative = false;
    const auto axis = [&](float number) {
        // The centre of the 2^-24 that the number stands for: never 0 or 1, and symmetric.
        const double v = 2 * (static_cast<double>(number) + 0x1p-25) - 1;
        const double size = std::fabs(v);
        double x = size;
        if (filter_.kind == FilterKind::tent) x = size / (1 + std::sqrt(1 - size));
        if (table_) x = table_->invert(size);
        negative ^= filter_.kind == FilterKind::mitchell && x > kMitchellRoot;
        return clamp_to(static_cast<float>(std::copysign(x, v) * filter_.radius), -filter_.radius, filter_.radius);
    };
    FilterSample out;
    out.offset.x = axis(u.x);
    out.offset.y = axis(u.y);
    const double ratio = table_ ? table_->absolute_over_signed : 1;
    out.weight = static_cast<float>(negative ? -ratio * ratio : ratio * ratio);
    return out;
}

float FilterSampler::evaluate(Vec2 offset) const noexcept {
    const double fx = profile(filter_.kind, std::fabs(static_cast<double>(offset.x)) / filter_.radius);
    const double fy = profile(filter_.kind, std::fabs(static_cast<double>(offset.y)) / filter_.radius);
    return static_cast<float>(fx * fy * normalisation_);
}

}  // namespace steradian
