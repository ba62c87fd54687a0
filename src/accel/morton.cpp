#include "accel/morton.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "base/parallel.h"

namespace steradian {
namespace {

constexpr uint32_t kAxisBits = 21, kDigitBits = 8, kDigits = 1u << kDigitBits;
/// Keys are counted and moved in chunks: of at least this many keys, and at most kMaxChunks of them, whatever the
/// number of workers.
constexpr size_t kMinChunk = 16384, kMaxChunks = 128;

/// Two zeros before every bit of a number of 21 bits.
uint64_t spread(uint32_t x) {
    uint64_t v = x;
    v = (v | v << 32) & 0x1f00000000ffff;
    v = (v | v << 16) & 0x1f0000ff0000ff;
    v = (v | v << 8) & 0x100f00f00f00f00f;
    v = (v | v << 4) & 0x10c30c30c30c30c3;
    v = (v | v << 2) & 0x1249249249249249;
    return v;
}

/// Cells of the same size along all axes: a flat scene is cut along its length first. In double, where neither the
/// smallest extent nor the largest leaves the range.
class Grid {
public:
    explicit Grid(const Box& centroids) : lo_(centroids.lo) {
        const Vec3d size = Vec3d(centroids.hi) - lo_;
        const double extent = std::max({size.x, size.y, size.z});
        scale_ = extent > 0 ? double(1u << kAxisBits) / extent : 0;
    }
    uint64_t code(const BuildPrimitive& p) const {
        uint64_t code = 0;
        for (int axis = 0; axis < 3; ++axis) code = code << 1 | spread(cell(p.centroid(axis) - lo_[axis]));
        return code;
    }

private:
    uint32_t cell(double from_lo) const {
        return std::min(static_cast<uint32_t>(from_lo * scale_), (1u << kAxisBits) - 1);
    }
    Vec3d lo_;
    double scale_;
};

using Histogram = std::array<uint32_t, kDigits>;

/// One pass of a least-significant-digit radix sort, stable. False, and nothing moved, when all keys have the same
/// digit.
bool sort_by_digit(const LargeArray<MortonKey>& from, uint32_t shift, size_t chunk, std::vector<Histogram>& places,
                   LargeArray<MortonKey>& to) {
    const auto digit = [shift](const MortonKey& key) { return key.code >> shift & (kDigits - 1); };
    parallel_for(from.size(), chunk, [&](size_t begin, size_t end) {
        Histogram own{};
        for (size_t i = begin; i < end; ++i) ++own[digit(from[i])];
        places[begin / chunk] = own;
    });
    uint32_t place = 0;
    for (uint32_t d = 0; d < kDigits; ++d) {
        const uint32_t first = place;
        for (Histogram& h : places) place += std::exchange(h[d], place);
        if (place - first == from.size()) return false;
    }
    parallel_for(from.size(), chunk, [&](size_t begin, size_t end) {
        Histogram& own = places[begin / chunk];
        for (size_t i = begin; i < end; ++i) to[own[digit(from[i])]++] = from[i];
    });
    return true;
}

}  // namespace

LargeArray<MortonKey> morton_order(std::span<const BuildPrimitive> primitives, const RangeBounds& bounds) {
    const size_t count = primitives.size();
    const size_t chunk = std::max(kMinChunk, (count + kMaxChunks - 1) / kMaxChunks);
    const Grid grid(bounds.centroids.box());
    LargeArray<MortonKey> keys(count), other(count);
    parallel_for(count, chunk, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) keys[i] = {grid.code(primitives[i]), static_cast<uint32_t>(i)};
    });
    std::vector<Histogram> places((count + chunk - 1) / chunk);
    for (uint32_t shift = 0; shift < 3 * kAxisBits; shift += kDigitBits)
        if (sort_by_digit(keys, shift, chunk, places, other)) std::swap(keys, other);
    return keys;
}

}  // namespace steradian
