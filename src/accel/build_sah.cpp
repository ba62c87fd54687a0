#include <algorithm>
#include <array>
#include <vector>

#include "accel/split.h"
#include "base/parallel.h"

namespace steradian {
namespace {

constexpr uint32_t kBins = 32;
/// Small ranges get fewer: most ranges are small, and there the bins themselves would be most of the work.
uint32_t bins_for(size_t count) { return static_cast<uint32_t>(count < 8 * (kBins - 8) ? 8 + count / 8 : kBins); }
/// Ranges are binned in chunks of this size, whatever the number of workers.
constexpr size_t kChunk = 32768;

struct Bin {
    Box box;
    uint32_t count = 0;

    void extend(const Bin& other) {
        box.extend(other.box);
        count += other.count;
    }
};
using Bins = std::array<std::array<Bin, kBins>, 3>;

/// From a centroid to its bin, the same for counting and for dividing.
class Binning {
public:
    Binning(const Box& centroids, size_t primitives) : count_(bins_for(primitives)) {
        for (int axis = 0; axis < 3; ++axis) {
            origin_[axis] = centroids.lo[axis];
            const float scale = float(count_) / (centroids.hi[axis] - centroids.lo[axis]);
            // 0 where the centroids coincide, or nearly so that the scale is infinite.
            scale_[axis] = is_finite(scale) ? scale : 0.0f;
        }
    }
    uint32_t count() const { return count_; }
    bool usable(int axis) const { return scale_[axis] > 0; }
    uint32_t bin(const BuildPrimitive& p, int axis) const {
        const float x = (p.centroid(axis) - origin_[axis]) * scale_[axis];
        return static_cast<uint32_t>(clamp_to(x, 0.0f, float(count_ - 1)));
    }

private:
    uint32_t count_;
    float origin_[3], scale_[3];
};

void count(std::span<const BuildPrimitive> primitives, const Binning& binning, Bins& bins) {
    for (const BuildPrimitive& p : primitives)
        for (int axis = 0; axis < 3; ++axis) {
            Bin& bin = bins[static_cast<size_t>(axis)][binning.bin(p, axis)];
            bin.box.extend(p.box);
            ++bin.count;
        }
}

void count_all(std::span<const BuildPrimitive> primitives, const Binning& binning, Bins& bins) {
    if (primitives.size() <= kChunk) return count(primitives, binning, bins);
    std::vector<Bins> parts((primitives.size() + kChunk - 1) / kChunk);
    parallel_for(primitives.size(), kChunk, [&](size_t begin, size_t end) {
        count(primitives.subspan(begin, end - begin), binning, parts[begin / kChunk]);
    });
    for (const Bins& part : parts)
        for (size_t axis = 0; axis < 3; ++axis)
            for (size_t bin = 0; bin < kBins; ++bin) bins[axis][bin].extend(part[axis][bin]);
}

}  // namespace

RangeBounds range_bounds(std::span<const BuildPrimitive> primitives) {
    RangeBounds all;
    if (primitives.size() <= kChunk) {
        for (const BuildPrimitive& p : primitives) all.extend(p);
        return all;
    }
    std::vector<RangeBounds> parts((primitives.size() + kChunk - 1) / kChunk);
    parallel_for(primitives.size(), kChunk, [&](size_t begin, size_t end) {
        RangeBounds part;
        for (const BuildPrimitive& p : primitives.subspan(begin, end - begin)) part.extend(p);
        parts[begin / kChunk] = part;
    });
    for (const RangeBounds& part : parts) all.extend(part);
    return all;
}

std::optional<SahSplit> find_sah_split(std::span<const BuildPrimitive> primitives, const RangeBounds& bounds,
                                       const LeafCost& leaf_cost) {
    const Binning binning(bounds.centroids, primitives.size());
    Bins bins;
    count_all(primitives, binning, bins);
    std::optional<SahSplit> best;
    for (int axis = 0; axis < 3; ++axis) {
        if (!binning.usable(axis)) continue;
        const auto& row = bins[static_cast<size_t>(axis)];
        std::array<double, kBins> right_cost{};
        Bin side;
        for (uint32_t i = binning.count() - 1; i > 0; --i) {
            side.extend(row[i]);
            right_cost[i] = side.box.half_area() * leaf_cost(side.count);
        }
        side = Bin{};
        for (uint32_t i = 1; i < binning.count(); ++i) {
            side.extend(row[i - 1]);
            if (side.count == 0 || side.count == primitives.size()) continue;
            const double cost = side.box.half_area() * leaf_cost(side.count) + right_cost[i];
            if (!best || cost < best->cost) best = SahSplit{cost, axis, i};
        }
    }
    if (best) {
        const double area = bounds.box.half_area();
        best->cost = area > 0 ? best->cost / area : 0;
    }
    return best;
}

size_t apply_sah_split(std::span<BuildPrimitive> primitives, const RangeBounds& bounds, const SahSplit& split) {
    const Binning binning(bounds.centroids, primitives.size());
    const auto middle = std::partition(primitives.begin(), primitives.end(),
                                       [&](const BuildPrimitive& p) { return binning.bin(p, split.axis) < split.bin; });
    return static_cast<size_t>(middle - primitives.begin());
}

}  // namespace steradian
