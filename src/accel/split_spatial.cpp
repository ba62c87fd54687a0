#include "accel/split_spatial.h"

#include <algorithm>
#include <vector>

#include "base/parallel.h"

namespace steradian {
namespace {

constexpr uint32_t kBins = 16;
/// Ranges are binned in chunks of this size, whatever the number of workers.
constexpr size_t kChunk = 32768;

/// Slices of the range's box along one axis; bin i lies between planes i and i + 1.
class Slices {
public:
    Slices(const RangeBounds& bounds, int axis) : axis_(axis) {
        const Box box = bounds.box.box();
        const float lo = box.lo[axis], extent = box.hi[axis] - lo;
        for (uint32_t i = 0; i < kBins; ++i) plane_[i] = lo + extent * (float(i) / kBins);
        plane_[kBins] = box.hi[axis];
        scale_ = kBins / extent;
        usable_ = is_finite(scale_) && scale_ > 0;
        for (uint32_t i = 0; i < kBins; ++i) usable_ = usable_ && plane_[i] < plane_[i + 1];
    }
    int axis() const { return axis_; }
    bool usable() const { return usable_; }
    float plane(uint32_t i) const { return plane_[i]; }
    /// The last plane that is not above `x`.
    uint32_t at(float x) const {
        const float place = (x - plane_[0]) * scale_;
        uint32_t i = place > 0 ? std::min(static_cast<uint32_t>(place), kBins - 1) : 0;
        while (i > 0 && x < plane_[i]) --i;
        while (i + 1 < kBins && x >= plane_[i + 1]) ++i;
        return i;
    }

private:
    int axis_;
    bool usable_;
    float scale_, plane_[kBins + 1];
};

Box4 box_of(const BuildPrimitive& p) { return {Float4::load(p.lo).first_three(), Float4::load(p.hi).first_three()}; }

/// Where a primitive is cut, as SpatialSplit says.
struct Sides {
    bool left, right;
};
Sides sides_of(const BuildPrimitive& p, const SpatialSplit& split) {
    if (p.kind != ItemKind::block) {
        const bool left = 0.5f * p.centroid(split.axis) < split.plane;
        return {left, !left};
    }
    const float lo = p.lo[split.axis], hi = p.hi[split.axis];
    return {lo<split.plane, hi> split.plane || lo >= split.plane};
}

struct Bins {
    Box4 box[kBins];
    uint32_t first[kBins] = {}, last[kBins] = {};  ///< how many begin and end there

    void add(const BuildPrimitive& p, const Slices& slices) {
        const int axis = slices.axis();
        if (p.kind != ItemKind::block) {
            const uint32_t i = slices.at(0.5f * p.centroid(axis));
            ++first[i], ++last[i];
            return box[i].extend(box_of(p));
        }
        const uint32_t begin = slices.at(p.lo[axis]);
        uint32_t end = slices.at(p.hi[axis]);
        if (end > begin && p.hi[axis] == slices.plane(end)) --end;
        ++first[begin], ++last[end];
        if (begin == end) return box[begin].extend(box_of(p));
        BuildPrimitive part = p;
        for (uint32_t i = begin; i <= end; ++i) {
            part.lo[axis] = i == begin ? p.lo[axis] : slices.plane(i);
            part.hi[axis] = i == end ? p.hi[axis] : slices.plane(i + 1);
            box[i].extend(box_of(part));
        }
    }
    void extend(const Bins& other) {
        for (uint32_t i = 0; i < kBins; ++i) {
            box[i].extend(other.box[i]);
            first[i] += other.first[i], last[i] += other.last[i];
        }
    }
};

void count_all(std::span<const BuildPrimitive> primitives, const Slices& slices, Bins& bins) {
    if (primitives.size() <= kChunk) {
        for (const BuildPrimitive& p : primitives) bins.add(p, slices);
        return;
    }
    std::vector<Bins> parts((primitives.size() + kChunk - 1) / kChunk);
    parallel_for(primitives.size(), kChunk, [&](size_t begin, size_t end) {
        for (const BuildPrimitive& p : primitives.subspan(begin, end - begin)) parts[begin / kChunk].add(p, slices);
    });
    for (const Bins& part : parts) bins.extend(part);
}

}  // namespace

std::optional<SpatialSplit> find_spatial_split(const Range& range, const RangeBounds& bounds, ItemKind kind,
                                               size_t room) {
    const Area half_area_of(bounds);
    std::optional<SpatialSplit> best;
    for (int axis = 0; axis < 3; ++axis) {
        const Slices slices(bounds, axis);
        if (!slices.usable()) continue;
        Bins bins;
        count_all(range.own, slices, bins);
        count_all(range.added, slices, bins);
        float right_cost[kBins];
        uint32_t on_right[kBins], on_left = 0;
        Box4 side;
        for (uint32_t i = kBins - 1; i > 0; --i) {
            side.extend(bins.box[i]);
            on_right[i] = bins.last[i] + (i + 1 < kBins ? on_right[i + 1] : 0);
            right_cost[i] = on_right[i] ? half_area_of(side) * leaf_cost(kind, on_right[i]) : 0.0f;
        }
        side = Box4{};
        for (uint32_t i = 1; i < kBins; ++i) {
            side.extend(bins.box[i - 1]);
            on_left += bins.first[i - 1];
            if (on_left == 0 || on_right[i] == 0 || on_left + on_right[i] - range.size() > room) continue;
            const float cost = half_area_of(side) * leaf_cost(kind, on_left) + right_cost[i];
            if (!best || cost < best->cost) best = SpatialSplit{cost, axis, slices.plane(i), on_left, on_right[i]};
        }
    }
    if (best) {
        const float area = half_area_of(bounds.box);
        best->cost = area > 0 ? best->cost / area : 0;
    }
    return best;
}

Halves apply_spatial_split(const Range& range, const SpatialSplit& split, std::vector<BuildPrimitive>& cut) {
    Halves halves;
    const int axis = split.axis;
    const auto divide = [&](std::span<BuildPrimitive> primitives) {
        size_t left = 0, right = primitives.size();
        while (left < right) {
            BuildPrimitive& p = primitives[left];
            const Sides sides = sides_of(p, split);
            if (!sides.left) {
                halves.bounds[1].extend(p);
                std::swap(p, primitives[--right]);
                continue;
            }
            if (sides.right) {
                BuildPrimitive& part = cut.emplace_back(p);
                part.lo[axis] = p.hi[axis] = split.plane;
                halves.bounds[1].extend(part);
            }
            halves.bounds[0].extend(p);
            ++left;
        }
        return left;
    };
    halves.own = divide(range.own), halves.added = divide(range.added);
    return halves;
}

float overlap(const Halves& halves, const RangeBounds& all) {
    const Box4 &a = halves.bounds[0].box, &b = halves.bounds[1].box;
    const Box4 shared{larger(a.lo, b.lo), smaller(a.hi, b.hi)};
    if (shared.box().empty()) return 0;
    const Area half_area_of(all);
    const float area = half_area_of(all.box);
    return area > 0 ? half_area_of(shared) / area : 0;
}

}  // namespace steradian
