#include "accel/build_fast.h"

#include <algorithm>
#include <bit>
#include <vector>

#include "accel/morton.h"
#include "base/parallel.h"

namespace steradian {
namespace {

/// Of 8, 16, 32 and 64, measured: the larger, the nearer to the heuristic alone, in time and in the rays' speed.
constexpr size_t kTreelet = 64;
/// Levels that a leaf of the tree over treelets may need below itself: it holds at most eight of them.
constexpr uint32_t kLevelsBelow = static_cast<uint32_t>(std::bit_width(8 * kTreelet / kBlock));
constexpr uint64_t kSortWork = 2;  ///< of kDivideWork
/// Keys are cut, and treelets divided, in chunks of this size, whatever the number of workers.
constexpr size_t kKeyChunk = 16384, kTreeletChunk = 64;

/// Appends where the treelets of the keys [begin, end) begin: the largest subtrees that fit.
void cut(std::span<const MortonKey> keys, size_t begin, size_t end, std::vector<uint32_t>& firsts) {
    if (end - begin <= kTreelet) {
        firsts.push_back(static_cast<uint32_t>(begin));
        return;
    }
    // The two ends of the range differ in the bit that divides it; the keys where it is set follow those where it is
    // not.
    const uint64_t differs = keys[begin].code ^ keys[end - 1].code;
    const auto bit = [&](size_t i) {
        return differs ? keys[i].code & std::bit_floor(differs) : i & std::bit_floor(begin ^ (end - 1));
    };
    size_t low = begin, high = end - 1;  // not set at low, set at high
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        (bit(middle) ? high : low) = middle;
    }
    cut(keys, begin, high, firsts), cut(keys, high, end, firsts);
}

class FastBuilder {
public:
    FastBuilder(std::span<BuildPrimitive> primitives, const BvhOptions& options, BinaryPool& pool,
                BuildMonitor& monitor)
        : primitives_(primitives), options_(options), pool_(pool), monitor_(monitor) {}

    BinaryNode* run() {
        const uint32_t needed = static_cast<uint32_t>(std::bit_width(primitives_.size())) + kLevelsBelow;
        if (needed > options_.max_depth) return nullptr;
        sort();
        monitor_.advance(primitives_.size() * kSortWork);
        if (monitor_.poll()) return nullptr;
        find_treelets();
        BvhOptions options = options_;
        options.builder = BvhBuilder::sah, options.mostly = ItemKind::instance;
        options.max_depth -= kLevelsBelow;
        options.work = 0;
        BinaryPool::Source source(pool_);
        BinaryNode& root = *source.next();
        divide(treelets_, {0, treelets_.size(), 0}, options, monitor_, pool_, source, root);
        if (monitor_.poll()) return nullptr;
        put_in_order();
        collect_leaves(root);
        divide_treelets();
        return &root;
    }

private:
    void sort() {
        const LargeArray<MortonKey> keys = morton_order(primitives_, range_bounds(primitives_));
        sorted_.resize(primitives_.size());
        std::vector<std::vector<uint32_t>> parts((keys.size() + kKeyChunk - 1) / kKeyChunk);
        parallel_for(keys.size(), kKeyChunk, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) sorted_[i] = primitives_[keys[i].index];
            cut(keys, begin, end, parts[begin / kKeyChunk]);
        });
        size_t count = 1;
        for (const auto& part : parts) count += part.size();
        firsts_.reserve(count);
        for (const auto& part : parts) firsts_.insert(firsts_.end(), part.begin(), part.end());
        firsts_.push_back(static_cast<uint32_t>(keys.size()));
    }

    uint32_t size_of(uint32_t treelet) const { return firsts_[treelet + 1] - firsts_[treelet]; }

    void find_treelets() {
        treelets_.resize(firsts_.size() - 1);
        parallel_for(treelets_.size(), kTreeletChunk, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) {
                const Box box =
                    range_bounds(std::span(sorted_).subspan(firsts_[i], firsts_[i + 1] - firsts_[i])).box.box();
                treelets_[i] = {box, static_cast<uint32_t>(i), ItemKind::instance};
            }
        });
    }

    /// Puts the primitives in the order in which the treelets are now.
    void put_in_order() {
        places_.resize(treelets_.size() + 1);
        for (size_t i = 0; i < treelets_.size(); ++i) places_[i + 1] = places_[i] + size_of(treelets_[i].id);
        parallel_for(treelets_.size(), kTreeletChunk, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) {
                const auto from = sorted_.begin() + firsts_[treelets_[i].id];
                std::copy(from, from + size_of(treelets_[i].id), primitives_.begin() + places_[i]);
            }
        });
        sorted_ = {};
    }

    /// From ranges of treelets to ranges of primitives.
    void collect_leaves(BinaryNode& node) {
        node.begin = places_[node.begin], node.end = places_[node.end];
        if (node.is_leaf()) return leaves_.push_back(&node);
        for (BinaryNode* child : node.child) collect_leaves(*child);
    }

    void divide_treelets() {
        BvhOptions options = options_;
        options.builder = BvhBuilder::sah;
        options.work -= kSortWork;
        parallel_for(leaves_.size(), kTreeletChunk, [&](size_t begin, size_t end) {
            if (monitor_.poll()) return;
            BinaryPool::Source source(pool_);
            for (size_t i = begin; i < end; ++i) {
                BinaryNode& leaf = *leaves_[i];
                divide(primitives_, {leaf.begin, leaf.end, leaf.depth}, options, monitor_, pool_, source, leaf);
            }
        });
    }

    std::span<BuildPrimitive> primitives_;
    const BvhOptions& options_;
    BinaryPool& pool_;
    BuildMonitor& monitor_;
    LargeArray<BuildPrimitive> sorted_;     ///< along the curve
    std::vector<uint32_t> firsts_;          ///< where treelets begin along the curve, and where the last one ends
    std::vector<BuildPrimitive> treelets_;  ///< ids along the curve
    std::vector<uint32_t> places_;          ///< the same in their final order
    std::vector<BinaryNode*> leaves_;       ///< of the tree over treelets
};

}  // namespace

BinaryNode* build_fast(std::span<BuildPrimitive> primitives, const BvhOptions& options, BinaryPool& pool,
                       BuildMonitor& monitor) {
    return FastBuilder(primitives, options, pool, monitor).run();
}

}  // namespace steradian
