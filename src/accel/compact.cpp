#include "accel/compact.h"

#include <algorithm>

#include "accel/children.h"
#include "base/parallel.h"

namespace steradian {
namespace {

/// Nodes whose blocks are written together, at first apart from the others: few, as their array grows by doubling.
constexpr size_t kChunk = 32;
constexpr size_t kMaxTriangles = ChildRef::kMaxRun * kBlock;  ///< of a leaf

bool holds_blocks(uint32_t ref) { return ChildRef::is_leaf(ref) && ChildRef::kind(ref) == ItemKind::block; }

/// The ids of a leaf, as many as are returned.
size_t ids_of(const std::vector<uint32_t>& blocks, uint32_t leaf, uint32_t ids[kMaxTriangles]) {
    size_t count = 0;
    const size_t first = size_t(ChildRef::first(leaf)) * kBlock;
    for (size_t i = first; i < first + size_t(ChildRef::count(leaf)) * kBlock; ++i)
        if (blocks[i] != kNoHit) ids[count++] = blocks[i];
    return count;
}
size_t ids_of(const LargeArray<uint64_t>& blocks, uint32_t leaf, uint32_t ids[kMaxTriangles]) {
    size_t count = 0;
    for_each_block(&blocks[CompactRef::offset(leaf)], [&](const CompactBlock& block) {
        for (uint32_t lane = 0; lane < kBlock; ++lane)
            if (const uint32_t id = block.prim(lane); id != kNoHit) ids[count++] = id;
    });
    return count;
}

/// Writes the blocks of all leaves: those of each chunk of nodes by themselves, then all of them behind each other.
class Packer {
public:
    explicit Packer(LargeArray<CompactNode>& nodes) : nodes_(nodes), chunks_((nodes.size() + kChunk - 1) / kChunk) {}
    size_t chunks() const { return chunks_.size(); }

    /// `blocks` is what the leaves refer to now.
    template <class Blocks>
    void pack(size_t which, const Blocks& blocks, const TriangleOf& triangle) {
        std::vector<uint64_t>& chunk = chunks_[which];
        for (CompactNode& node : nodes_of(which))
            for (uint32_t c = 0; c < kWidth; ++c) {
                if (!(node.present() >> c & 1) || !holds_blocks(node.child[c])) continue;
                uint32_t ids[kMaxTriangles];
                PackedTriangle run[kMaxTriangles];
                const size_t count = ids_of(blocks, node.child[c], ids);
                for (size_t i = 0; i < count; ++i) run[i] = triangle(ids[i]);
                node.child[c] = CompactRef::leaf(static_cast<uint32_t>(chunk.size()));
                append_compact_blocks({run, count}, chunk);
            }
        chunk.shrink_to_fit();
    }
    /// Once all chunks are packed.
    LargeArray<uint64_t> join() {
        std::vector<size_t> starts;
        size_t units = 0;
        for (const auto& chunk : chunks_) starts.push_back(units), units += chunk.size();
        LargeArray<uint64_t> all;
        if (units == 0) return all;
        all.resize(units + kPaddingUnits);
        std::fill_n(all.end() - kPaddingUnits, kPaddingUnits, uint64_t(0));
        parallel_for(chunks_.size(), 1, [&](size_t which, size_t) {
            std::copy(chunks_[which].begin(), chunks_[which].end(), all.begin() + ptrdiff_t(starts[which]));
            std::vector<uint64_t>().swap(chunks_[which]);
            for (CompactNode& node : nodes_of(which))
                for (uint32_t& ref : node.child)
                    if (holds_blocks(ref)) ref += static_cast<uint32_t>(starts[which]);
        });
        return all;
    }

private:
    std::span<CompactNode> nodes_of(size_t chunk) {
        const size_t first = chunk * kChunk;
        return std::span(nodes_).subspan(first, std::min(kChunk, nodes_.size() - first));
    }

    LargeArray<CompactNode>& nodes_;
    std::vector<std::vector<uint64_t>> chunks_;
};

}  // namespace

CompactLevel make_compact(Bvh& bvh, const TriangleOf& triangle, BuildMonitor& monitor, uint64_t work) {
    CompactLevel out;
    out.nodes.resize(bvh.nodes.size());
    Packer packer(out.nodes);
    const auto done_by = [&](size_t chunk) { return work * chunk / packer.chunks(); };
    parallel_for(packer.chunks(), 1, [&](size_t chunk, size_t) {
        if (monitor.poll()) return;
        for (size_t i = chunk * kChunk; i < std::min((chunk + 1) * kChunk, out.nodes.size()); ++i)
            out.nodes[i] = quantise(bvh.nodes[i], child_count(bvh.nodes[i]));
        packer.pack(chunk, bvh.blocks, triangle);
        monitor.advance(done_by(chunk + 1) - done_by(chunk));
    });
    if (monitor.poll()) return {};
    decltype(bvh.nodes)().swap(bvh.nodes);
    decltype(bvh.blocks)().swap(bvh.blocks);
    out.blocks = packer.join();
    return out;
}

CompactLevel repack(const CompactLevel& level, const TriangleOf& triangle) {
    CompactLevel out;
    out.nodes = level.nodes;
    Packer packer(out.nodes);
    parallel_for(packer.chunks(), 1, [&](size_t chunk, size_t) { packer.pack(chunk, level.blocks, triangle); });
    out.blocks = packer.join();
    return out;
}

}  // namespace steradian
