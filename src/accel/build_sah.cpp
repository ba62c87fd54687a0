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

/// Only as many as are used are initialised: in small ranges that would be most of the work.
struct Bins {
    Float4 lo[3][kBins], hi[3][kBins];
    uint32_t count[3][kBins];

    explicit Bins(uint32_t bins = kBins) {
        const Box4 nothing;
        for (int axis = 0; axis < 3; ++axis) {
            std::fill_n(lo[axis], bins, nothing.lo), std::fill_n(hi[axis], bins, nothing.hi);
            std::fill_n(count[axis], bins, 0u);
        }
    }
    Box4 box(int axis, uint32_t bin) const { return {lo[axis][bin], hi[axis][bin]}; }
    void extend(int axis, uint32_t bin, Float4 l, Float4 h) {
        lo[axis][bin] = smaller(l, lo[axis][bin]);
        hi[axis][bin] = larger(h, hi[axis][bin]);
    }
    void extend(const Bins& other, uint32_t bins) {
        for (int axis = 0; axis < 3; ++axis)
            for (uint32_t bin = 0; bin < bins; ++bin) {
                extend(axis, bin, other.lo[axis][bin], other.hi[axis][bin]);
                count[axis][bin] += other.count[axis][bin];
            }
    }
};

/// From a centroid to its bin, the same for counting and for dividing.
class Binning {
public:
    Binning(const RangeBounds& bounds, size_t primitives) : count_(bins_for(primitives)) {
        const Box centroids = bounds.centroids.box();
        alignas(16) float origin[4] = {}, scale[4] = {};
        for (int axis = 0; axis < 3; ++axis) {
            origin[axis] = centroids.lo[axis];
            const float s = float(count_) / (centroids.hi[axis] - centroids.lo[axis]);
            // 0 where the centroids coincide, or nearly so that the scale is infinite.
            usable_[axis] = is_finite(s) && s > 0;
            scale[axis] = usable_[axis] ? s : 0.0f;
        }
        origin_ = Float4::load(origin), scale_ = Float4::load(scale), last_ = Float4::all(float(count_ - 1));
    }
    uint32_t count() const { return count_; }
    bool usable(int axis) const { return usable_[axis]; }
    /// The bins along the three axes, of a doubled centroid that lies within the bounds.
    void bins(Float4 centroid, uint32_t out[4]) const {
        smaller((centroid - origin_) * scale_, last_).store_integers(out);
    }

private:
    uint32_t count_;
    bool usable_[3];
    Float4 origin_, scale_, last_;
};

void count(std::span<const BuildPrimitive> primitives, const Binning& binning, Bins& bins) {
    for (const BuildPrimitive& p : primitives) {
        const Float4 lo = Float4::load(p.lo).first_three(), hi = Float4::load(p.hi).first_three();
        alignas(16) uint32_t bin[4];
        binning.bins(lo + hi, bin);
        for (int axis = 0; axis < 3; ++axis) {
            bins.extend(axis, bin[axis], lo, hi);
            ++bins.count[axis][bin[axis]];
        }
    }
}

void count_all(std::span<const BuildPrimitive> primitives, const Binning& binning, Bins& bins) {
    if (primitives.size() <= kChunk) return count(primitives, binning, bins);
    std::vector<Bins> parts((primitives.size() + kChunk - 1) / kChunk);
    parallel_for(primitives.size(), kChunk, [&](size_t begin, size_t end) {
        count(primitives.subspan(begin, end - begin), binning, parts[begin / kChunk]);
    });
    for (const Bins& part : parts) bins.extend(part, kBins);
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

std::optional<SahSplit> find_sah_split(const Range& range, const RangeBounds& bounds, ItemKind kind) {
    const Binning binning(bounds, range.size());
    const Area half_area_of(bounds);
    const float area = half_area_of(bounds.box);
    if (!(area > 0)) return std::nullopt;
    Bins bins(binning.count());
    count_all(range.own, binning, bins);
    count_all(range.added, binning, bins);
    std::optional<SahSplit> best;
    const uint32_t all = static_cast<uint32_t>(range.size());
    for (int axis = 0; axis < 3; ++axis) {
        if (!binning.usable(axis)) continue;
        float right_cost[kBins];
        Box4 side;
        uint32_t in_side = 0;
        for (uint32_t i = binning.count() - 1; i > 0; --i) {
            side.extend(bins.box(axis, i));
            in_side += bins.count[axis][i];
            right_cost[i] = in_side ? half_area_of(side) * leaf_cost(kind, in_side) : 0.0f;
        }
        side = Box4{}, in_side = 0;
        for (uint32_t i = 1; i < binning.count(); ++i) {
            side.extend(bins.box(axis, i - 1));
            in_side += bins.count[axis][i - 1];
            if (in_side == 0 || in_side == all) continue;
            const float cost = half_area_of(side) * leaf_cost(kind, in_side) + right_cost[i];
            if (!best || cost < best->cost) best = SahSplit{cost, axis, i};
        }
    }
    if (best) best->cost /= area;
    return best;
}

Halves apply_sah_split(const Range& range, const RangeBounds& bounds, const SahSplit& split) {
    const Binning binning(bounds, range.size());
    const auto on_left = [&](const BuildPrimitive& p) {
        const Float4 lo = Float4::load(p.lo).first_three(), hi = Float4::load(p.hi).first_three();
        alignas(16) uint32_t bin[4];
        binning.bins(lo + hi, bin);
        return bin[split.axis] < split.bin;
    };
    RangeBounds left_bounds, right_bounds;
    const auto divide = [&](std::span<BuildPrimitive> part) {
        size_t left = 0, right = part.size();
        while (true) {
            for (; left < right && on_left(part[left]); ++left) left_bounds.extend(part[left]);
            for (; left < right && !on_left(part[right - 1]); --right) right_bounds.extend(part[right - 1]);
            if (left >= right) return left;
            std::swap(part[left], part[right - 1]);
        }
    };
    Halves halves;
    for (const int i : {0, 1}) (i ? halves.added : halves.own) = divide(i ? range.added : range.own);
    halves.bounds[0] = left_bounds, halves.bounds[1] = right_bounds;
    return halves;
}

}  // namespace steradian
