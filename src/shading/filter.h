// Filter importance sampling (Ernst, Stamminger & Greiner 2006): a sample belongs to one pixel and its position within
// the pixel's filter support is drawn with density |f| / ∫|f|; what is left of the filter is a sign and a constant.
#pragma once

#include <memory>

#include "math/vector.h"
#include "steradian/settings.h"

namespace steradian {

struct FilterSample {
    Vec2 offset;   ///< from the pixel's centre, pixels, each in [-radius, radius]
    float weight;  ///< sign(f) · ∫|f| / ∫f
};

/// Separable. Monotone in each coordinate of u, so that well spread numbers give well spread offsets. Box and tent are
/// inverted in closed form; the others by a table, built in the constructor from src/math functions only, whose density
/// is within 5e-6 of the peak of |f|.
class FilterSampler {
public:
    /// The radius must be positive and finite.
    explicit FilterSampler(const Filter& filter);
    FilterSample sample(Vec2 u) const noexcept;
    /// f(x, y) normalised to ∫f = 1; for tests and documentation.
    float evaluate(Vec2 offset) const noexcept;

private:
    struct Table;
    Filter filter_;
    double normalisation_;                ///< 1 / ∫f
    std::shared_ptr<const Table> table_;  ///< null for the filters with a closed inverse
};

}  // namespace steradian
