#include "accel/compact_block.h"

#include <algorithm>
#include <bit>

namespace steradian {
namespace {

bool same_bits(Vec3 a, Vec3 b) {
    return std::bit_cast<uint32_t>(a.x) == std::bit_cast<uint32_t>(b.x) &&
           std::bit_cast<uint32_t>(a.y) == std::bit_cast<uint32_t>(b.y) &&
           std::bit_cast<uint32_t>(a.z) == std::bit_cast<uint32_t>(b.z);
}

/// The different vertices of up to kBlock triangles, in the order in which they came.
struct Vertices {
    Vec3 p[3 * kBlock];
    uint32_t count = 0;

    uint32_t find(Vec3 q) const {
        uint32_t i = 0;
        while (i < count && !same_bits(p[i], q)) ++i;
        return i;
    }
    uint32_t add(Vec3 q) {
        const uint32_t i = find(q);
        if (i == count) p[count++] = q;
        return i;
    }
    uint32_t new_in(const PackedTriangle& t) const {
        uint32_t n = 0;
        for (const Vec3& q : t.corner) n += find(q) == count;
        return n;
    }
};

/// Brings up to kBlock triangles to the front: the first, and each time what then adds the fewest vertices.
uint32_t group(std::span<PackedTriangle> triangles) {
    Vertices vertices;
    uint32_t size = 0;
    for (; size < kBlock && size < triangles.size(); ++size) {
        size_t best = size;
        uint32_t fewest = 4;
        for (size_t i = size; i < triangles.size(); ++i)
            if (const uint32_t n = vertices.new_in(triangles[i]); n < fewest) fewest = n, best = i;
        // The others keep their order.
        std::rotate(triangles.begin() + size, triangles.begin() + ptrdiff_t(best),
                    triangles.begin() + ptrdiff_t(best) + 1);
        for (const Vec3& q : triangles[size].corner) vertices.add(q);
    }
    return size;
}

/// Where corner c of triangle k goes when there are twelve vertices: kWhere[c][k], in the whole array.
constexpr uint32_t kWhere[3][kBlock] = {{0, 2, 3, 4}, {1, 5, 6, 7}, {10, 8, 9, 11}};

/// The vertices of a block, with the indices to them as in the header.
struct Indexed {
    Vertices vertices;
    uint32_t indices = 0, code = 0;
};

Indexed index_vertices(std::span<const PackedTriangle> block) {
    Indexed out;
    Vertices& v = out.vertices;
    const auto set = [&](uint32_t corner, uint32_t lane, uint32_t index) {
        if (lane > 0) out.indices |= index << (3 * (3 * corner + lane - 1));
    };
    // Even where the first triangle has a vertex twice.
    for (const Vec3& q : block[0].corner) v.p[v.count++] = q;
    for (uint32_t lane = 0; lane < kBlock; ++lane)
        for (uint32_t corner = 0; corner < 3; ++corner)
            set(corner, lane, lane < block.size() ? v.add(block[lane].corner[corner]) & 7 : corner);
    if (v.count <= 8) {
        out.code = v.count - CompactBlock::kMinVertices;
        return out;
    }
    out.indices = 0, out.code = CompactBlock::kCodeOfMany;
    v.count = CompactBlock::kManyVertices;
    for (uint32_t lane = 0; lane < kBlock; ++lane)
        for (uint32_t corner = 0; corner < 3; ++corner) {
            const uint32_t where = kWhere[corner][lane];
            v.p[where] = block[lane < block.size() ? lane : 0].corner[corner];
            set(corner, lane, corner == 2 ? where - CompactBlock::kSecondVector : where);
        }
    return out;
}

class Bytes {
public:
    explicit Bytes(uint64_t* unit) : to_(reinterpret_cast<char*>(unit)) {}
    template <class T>
    void put(T x) {
        std::memcpy(to_, &x, sizeof(x));
        to_ += sizeof(x);
    }

private:
    char* to_;
};

void append_block(std::span<PackedTriangle> block, bool last, std::vector<uint64_t>& out) {
    std::sort(block.begin(), block.end(), [](const PackedTriangle& a, const PackedTriangle& b) { return a.id < b.id; });
    const Indexed indexed = index_vertices(block);
    const Vertices& v = indexed.vertices;
    const bool long_ids = block.back().id - block[0].id > 0xffff;
    const size_t start = out.size();
    out.resize(start + CompactBlock::units_for(v.count, long_ids));
    Bytes to(&out[start]);
    to.put(indexed.indices | indexed.code << CompactBlock::kIndexBits | (long_ids ? CompactBlock::kLongIds : 0) |
           (last ? CompactBlock::kLast : 0));
    for (int axis = 0; axis < 3; ++axis)
        for (uint32_t i = 0; i < v.count; ++i) to.put(v.p[i][axis]);
    to.put(block[0].id);
    for (uint32_t lane = 1; lane < kBlock; ++lane) {
        const bool present = lane < block.size();
        if (long_ids) {
            to.put(present ? block[lane].id : kNoHit);
        } else {
            to.put(static_cast<uint16_t>(present ? block[lane].id - block[0].id : 0));
        }
    }
}

}  // namespace

void append_compact_blocks(std::span<PackedTriangle> triangles, std::vector<uint64_t>& out) {
    while (!triangles.empty()) {
        const uint32_t size = group(triangles);
        append_block(triangles.first(size), size == triangles.size(), out);
        triangles = triangles.subspan(size);
    }
}

}  // namespace steradian
