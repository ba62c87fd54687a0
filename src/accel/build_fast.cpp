#include "accel/build_fast.h"

#include <bit>
#include <vector>

#include "accel/morton.h"
#include "base/parallel.h"

namespace steradian {
namespace {

/// Of 8, 16, 32 and 64, measured: the larger, the nearer to the heuristic alone, in time and in the rays' speed.
constexpr uint32_t kTreelet = 64;
/// Levels that a treelet may need below itself.
constexpr uint32_t kLevelsBelow = static_cast<uint32_t>(std::bit_width(kTreelet));
constexpr uint64_t kSortWork = 2;  ///< of kDivideWork
/// Treelets are divided in chunks of this size, whatever the number of workers.
constexpr size_t kTreeletChunk = 64;

class FastBuilder {
public:
    FastBuilder(LargeArray<BuildPrimitive>& primitives, const BvhOptions& options, BinaryPool& pool,
                BuildMonitor& monitor)
        : primitives_(primitives), options_(options), pool_(pool), monitor_(monitor) {}

    std::optional<uint32_t> run() {
        const uint32_t needed = static_cast<uint32_t>(std::bit_width(primitives_.size())) + kLevelsBelow;
        if (needed > options_.max_depth) return std::nullopt;
        if (!find_treelets()) return std::nullopt;
        monitor_.advance(primitives_.size() * kSortWork);
        if (monitor_.poll()) return std::nullopt;
        BvhOptions options = options_;
        options.builder = BvhBuilder::sah, options.mostly = ItemKind::instance;
        options.max_depth -= kLevelsBelow;
        options.max_leaf = 1;
        options.work = 0;
        BinaryPool::Source source(pool_);
        const uint32_t root = source.next_two();
        divide(treelets_, {0, treelets_.size(), 0}, options, monitor_, pool_, source, root);
        if (monitor_.poll()) return std::nullopt;
        collect_leaves(root, 0);
        divide_treelets();
        return root;
    }

private:
    /// A leaf of the tree over treelets.
    struct Leaf {
        uint32_t node, depth;
    };

    /// False when most are so small that it would take too much memory for nothing.
    bool find_treelets() {
        const MortonGrid grid(range_bounds(primitives_));
        // A compact hierarchy may take less than two thirds of what primitives take twice.
        firsts_ = sort_along_curve(primitives_, grid, kTreelet, options_.layout == BvhLayout::full);
        if (firsts_.size() - 1 > most_treelets(primitives_.size())) return false;
        treelets_.resize(firsts_.size() - 1);
        parallel_for(treelets_.size(), kTreeletChunk, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) {
                const Box box =
                    range_bounds(std::span(primitives_).subspan(firsts_[i], firsts_[i + 1] - firsts_[i])).box.box();
                treelets_[i] = {box, static_cast<uint32_t>(i), ItemKind::instance};
            }
        });
        return true;
    }

    void collect_leaves(uint32_t node, uint32_t depth) {
        const BinaryNode& n = pool_[node];
        if (n.is_leaf()) return leaves_.push_back({node, depth});
        for (const int which : {0, 1}) collect_leaves(n.child(which), depth + 1);
    }

    void divide_treelets() {
        BvhOptions options = options_;
        options.builder = BvhBuilder::sah;
        options.work -= kSortWork;
        parallel_for(leaves_.size(), kTreeletChunk, [&](size_t begin, size_t end) {
            if (monitor_.poll()) return;
            BinaryPool::Source source(pool_);
            for (size_t i = begin; i < end; ++i) {
                const uint32_t treelet = treelets_[pool_[leaves_[i].node].begin()].id;
                divide(primitives_, {firsts_[treelet], firsts_[treelet + 1], leaves_[i].depth}, options, monitor_,
                       pool_, source, leaves_[i].node);
            }
        });
    }

    LargeArray<BuildPrimitive>& primitives_;
    const BvhOptions& options_;
    BinaryPool& pool_;
    BuildMonitor& monitor_;
    std::vector<uint32_t> firsts_;          ///< where treelets begin along the curve, and where the last one ends
    std::vector<BuildPrimitive> treelets_;  ///< ids along the curve
    std::vector<Leaf> leaves_;
};

}  // namespace

std::optional<uint32_t> build_fast(LargeArray<BuildPrimitive>& primitives, const BvhOptions& options, BinaryPool& pool,
                                   BuildMonitor& monitor) {
    return FastBuilder(primitives, options, pool, monitor).run();
}

}  // namespace steradian
