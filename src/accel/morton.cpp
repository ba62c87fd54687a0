#include "accel/morton.h"

#include <array>
#include <bit>
#include <vector>

#include "base/large_array.h"
#include "base/parallel.h"

namespace steradian {
namespace {

/// Ranges at least this large are looked at in chunks by all workers, and their parts sorted by all of them.
constexpr size_t kChunk = 16384;
/// Codes of a range of no more than this are computed once. For so many there is room on the stack.
constexpr size_t kSmall = 2048;
constexpr uint32_t kDigitBits = 8, kSmallDigitBits = 5;

using Firsts = std::vector<uint32_t>;

/// How many primitives have each digit, and in which bits of the code they differ.
template <uint32_t kBits>
struct Counts {
    static constexpr uint32_t kDigits = 1u << kBits;
    std::array<uint32_t, kDigits> of{};
    uint64_t differ = 0;

    void add(const Counts& other) {
        for (uint32_t d = 0; d < kDigits; ++d) of[d] += other.of[d];
        differ |= other.differ;
    }
};

/// Where each digit ends in a range that is in their order.
template <uint32_t kBits>
struct Digits {
    static constexpr uint32_t kDigits = 1u << kBits;
    uint32_t first;
    std::array<uint32_t, kDigits> end;

    Digits(const Counts<kBits>& counts, size_t begin) : first(static_cast<uint32_t>(begin)) {
        uint32_t place = first;
        for (uint32_t d = 0; d < kDigits; ++d) end[d] = place += counts.of[d];
    }
    uint32_t begin(uint32_t digit) const { return digit == 0 ? first : end[digit - 1]; }
    /// Brings everything to where its digit is, by exchanges: digit_of(i), exchange(i, j).
    template <class DigitOf, class Exchange>
    void sort(const DigitOf& digit_of, const Exchange& exchange) const {
        std::array<uint32_t, kDigits> next;
        for (uint32_t d = 0; d < kDigits; ++d) next[d] = begin(d);
        for (uint32_t d = 0; d < kDigits; ++d)
            while (next[d] < end[d]) {
                const uint32_t i = next[d], digit = digit_of(i), to = next[digit]++;
                if (digit != d) exchange(i, to);
            }
    }
    /// body(begin, end) for the largest subtrees over [from, to) of up to `most`, and for single
    /// digits.
    template <class Body>
    void cut(uint32_t from, uint32_t to, uint32_t most, const Body& body) const {
        const uint32_t b = begin(from), e = end[to - 1];
        if (b == e) return;
        if (e - b <= most || to - from == 1) return body(b, e);
        const uint32_t middle = (from + to) / 2;
        cut(from, middle, most, body), cut(middle, to, most, body);
    }
};

uint32_t low_bit(uint32_t high, uint32_t bits) { return high > bits ? high - bits : 0; }

/// A radix sort from the highest digit down, each digit in place (McIlroy, Bostic & McIlroy 1993, "Engineering Radix
/// Sort").
class CurveSorter {
public:
    CurveSorter(LargeArray<BuildPrimitive>& primitives, const MortonGrid& grid, uint32_t most, bool may_copy)
        : all_(primitives),
          primitives_(primitives),
          digit_(primitives.size() > kSmall ? primitives.size() : 0),
          grid_(grid),
          most_(most),
          may_copy_(may_copy) {}

    /// A range whose codes are the same from bit `high` on.
    void sort(uint32_t begin, uint32_t end, uint32_t high, Firsts& firsts) {
        if (end - begin <= kSmall) return sort_small(begin, end, firsts);
        if (high == 0) return cut_by_place(begin, end, firsts);
        std::vector<Large> of_chunks;
        Large counts = count(begin, end, low_bit(high, kDigitBits), of_chunks);
        // Where the digit says nothing, from the first bit that does.
        if (counts.of[digit_[begin]] == end - begin) {
            high = static_cast<uint32_t>(std::bit_width(counts.differ));
            if (high == 0) return cut_by_place(begin, end, firsts);
            counts = count(begin, end, low_bit(high, kDigitBits), of_chunks);
        }
        const Digits<kDigitBits> digits(counts, begin);
        if (may_copy_ && end - begin == all_.size() && !of_chunks.empty()) {
            copy_in_order(digits, of_chunks);
        } else {
            digits.sort([&](uint32_t i) { return digit_[i]; },
                        [&](uint32_t i, uint32_t j) {
                            std::swap(primitives_[i], primitives_[j]);
                            std::swap(digit_[i], digit_[j]);
                        });
        }
        std::vector<std::pair<uint32_t, uint32_t>> parts;
        digits.cut(0, Large::kDigits, most_, [&](uint32_t b, uint32_t e) { parts.emplace_back(b, e); });
        std::vector<Firsts> of_parts(parts.size());
        const auto part = [&](size_t i, size_t) {
            sort(parts[i].first, parts[i].second, low_bit(high, kDigitBits), of_parts[i]);
        };
        if (end - begin >= kChunk)
            parallel_for(parts.size(), 1, part);
        else
            for (size_t i = 0; i < parts.size(); ++i) part(i, i + 1);
        for (const Firsts& f : of_parts) firsts.insert(firsts.end(), f.begin(), f.end());
    }

private:
    using Large = Counts<kDigitBits>;
    using Small = Counts<kSmallDigitBits>;

    void cut_by_place(uint32_t begin, uint32_t end, Firsts& firsts) const {
        for (uint32_t i = begin; i < end; i += most_) firsts.push_back(i);
    }

    /// All primitives to where their digits are, by all workers.
    void copy_in_order(const Digits<kDigitBits>& digits, const std::vector<Large>& of_chunks) {
        std::vector<std::array<uint32_t, Large::kDigits>> first(of_chunks.size());
        for (uint32_t d = 0; d < Large::kDigits; ++d) {
            uint32_t place = digits.begin(d);
            for (size_t chunk = 0; chunk < of_chunks.size(); ++chunk)
                first[chunk][d] = place, place += of_chunks[chunk].of[d];
        }
        LargeArray<BuildPrimitive> sorted(all_.size());
        parallel_for(all_.size(), kChunk, [&](size_t begin, size_t end) {
            std::array<uint32_t, Large::kDigits>& next = first[begin / kChunk];
            for (size_t i = begin; i < end; ++i) sorted[next[digit_[i]]++] = all_[i];
        });
        all_.swap(sorted);
        primitives_ = all_;
    }

    /// Notes the digits from bit `low` on. `of_chunks` are the counts of the chunks, if there are any.
    Large count(uint32_t begin, uint32_t end, uint32_t low, std::vector<Large>& of_chunks) {
        const uint64_t first = grid_.code(primitives_[begin]);
        const auto count_some = [&](size_t from, size_t to, Large& counts) {
            for (size_t i = from; i < to; ++i) {
                const uint64_t code = grid_.code(primitives_[i]);
                digit_[i] = static_cast<uint8_t>(code >> low);
                ++counts.of[digit_[i]];
                counts.differ |= code ^ first;
            }
        };
        Large all;
        if (end - begin < kChunk) {
            count_some(begin, end, all);
            return all;
        }
        of_chunks.assign((end - begin + kChunk - 1) / kChunk, Large());
        parallel_for(end - begin, kChunk,
                     [&](size_t b, size_t e) { count_some(begin + b, begin + e, of_chunks[b / kChunk]); });
        for (const Large& part : of_chunks) all.add(part);
        return all;
    }

    void sort_small(uint32_t begin, uint32_t end, Firsts& firsts) const {
        uint64_t codes[kSmall];
        for (uint32_t i = begin; i < end; ++i) codes[i - begin] = grid_.code(primitives_[i]);
        sort_small(begin, end, codes, firsts);
    }
    void sort_small(uint32_t begin, uint32_t end, uint64_t* codes, Firsts& firsts) const {
        const uint32_t size = end - begin;
        if (size <= most_) return firsts.push_back(begin);
        uint64_t differ = 0;
        for (uint32_t i = 1; i < size; ++i) differ |= codes[i] ^ codes[0];
        if (differ == 0) return cut_by_place(begin, end, firsts);
        const uint32_t low = low_bit(static_cast<uint32_t>(std::bit_width(differ)), kSmallDigitBits);
        const auto digit_of = [&](uint32_t i) {
            return static_cast<uint32_t>(codes[i - begin] >> low) & (Small::kDigits - 1);
        };
        Small counts;
        for (uint32_t i = begin; i < end; ++i) ++counts.of[digit_of(i)];
        const Digits<kSmallDigitBits> digits(counts, begin);
        digits.sort(digit_of, [&](uint32_t i, uint32_t j) {
            std::swap(primitives_[i], primitives_[j]);
            std::swap(codes[i - begin], codes[j - begin]);
        });
        digits.cut(0, Small::kDigits, most_,
                   [&](uint32_t b, uint32_t e) { sort_small(b, e, codes + (b - begin), firsts); });
    }

    LargeArray<BuildPrimitive>& all_;
    std::span<BuildPrimitive> primitives_;
    LargeArray<uint8_t> digit_;
    const MortonGrid& grid_;
    const uint32_t most_;
    const bool may_copy_;
};

}  // namespace

MortonGrid::MortonGrid(const RangeBounds& bounds) {
    const Box centroids = bounds.centroids.box();
    lo_ = Vec3d(centroids.lo);
    const Vec3d size = Vec3d(centroids.hi) - lo_;
    const double extent = std::max({size.x, size.y, size.z});
    scale_ = extent > 0 ? double(1u << kAxisBits) / extent : 0;
}

std::vector<uint32_t> sort_along_curve(LargeArray<BuildPrimitive>& primitives, const MortonGrid& grid, uint32_t most,
                                       bool may_copy) {
    Firsts firsts;
    const auto count = static_cast<uint32_t>(primitives.size());
    if (count > 0) CurveSorter(primitives, grid, most, may_copy).sort(0, count, 3 * MortonGrid::kAxisBits, firsts);
    firsts.push_back(count);
    return firsts;
}

}  // namespace steradian
