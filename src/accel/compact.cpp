#include "accel/compact.h"

#include <algorithm>

#include "accel/children.h"
#include "base/parallel.h"

namespace steradian {
namespace {

/// Nodes whose blocks are written together, at first apart from the others.
constexpr size_t kChunk = 256;

bool holds_blocks(uint32_t ref) { return ChildRef::is_leaf(ref) && ChildRef::kind(ref) == ItemKind::block; }

}  // namespace

CompactLevel make_compact(Bvh& bvh, const std::function<PackedTriangle(uint32_t id)>& triangle, BuildMonitor& monitor,
                          uint64_t work) {
    CompactLevel out;
    out.nodes.resize(bvh.nodes.size());
    std::vector<std::vector<uint64_t>> chunks((bvh.nodes.size() + kChunk - 1) / kChunk);
    const auto add_run = [&](uint32_t ref, std::vector<uint64_t>& to) {
        PackedTriangle run[ChildRef::kMaxRun * kBlock];
        size_t count = 0;
        const size_t first = size_t(ChildRef::first(ref)) * kBlock;
        for (size_t i = first; i < first + size_t(ChildRef::count(ref)) * kBlock; ++i)
            if (bvh.blocks[i] != kNoHit) run[count++] = triangle(bvh.blocks[i]);
        const auto offset = static_cast<uint32_t>(to.size());
        append_compact_blocks({run, count}, to);
        return CompactRef::leaf(offset);
    };
    const auto done_by = [&](size_t node) { return work * node / bvh.nodes.size(); };
    parallel_for(bvh.nodes.size(), kChunk, [&](size_t begin, size_t end) {
        if (monitor.poll()) return;
        std::vector<uint64_t>& chunk = chunks[begin / kChunk];
        for (size_t i = begin; i < end; ++i) {
            const uint32_t children = child_count(bvh.nodes[i]);
            CompactNode& node = out.nodes[i] = quantise(bvh.nodes[i], children);
            for (uint32_t c = 0; c < children; ++c)
                if (holds_blocks(node.child[c])) node.child[c] = add_run(node.child[c], chunk);
        }
        chunk.shrink_to_fit();
        monitor.advance(done_by(end) - done_by(begin));
    });
    if (monitor.poll()) return {};
    decltype(bvh.nodes)().swap(bvh.nodes);
    decltype(bvh.blocks)().swap(bvh.blocks);

    std::vector<size_t> starts;
    size_t units = 0;
    for (const auto& chunk : chunks) starts.push_back(units), units += chunk.size();
    if (units == 0) return out;
    out.blocks.resize(units + kPaddingUnits);
    std::fill_n(out.blocks.end() - kPaddingUnits, kPaddingUnits, uint64_t(0));
    parallel_for(out.nodes.size(), kChunk, [&](size_t begin, size_t end) {
        std::vector<uint64_t>& chunk = chunks[begin / kChunk];
        const size_t start = starts[begin / kChunk];
        std::copy(chunk.begin(), chunk.end(), out.blocks.begin() + ptrdiff_t(start));
        std::vector<uint64_t>().swap(chunk);
        for (size_t i = begin; i < end; ++i)
            for (uint32_t& ref : out.nodes[i].child)
                if (holds_blocks(ref)) ref += static_cast<uint32_t>(start);
    });
    return out;
}

}  // namespace steradian
