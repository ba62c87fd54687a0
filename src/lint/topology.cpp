#include "lint/topology.h"

#include <algorithm>
#include <bit>

#include "lint/place_hash.h"
#include "lint/union_find.h"
#include "math/ray.h"

namespace steradian::lint_detail {
namespace {

/// Numbers of vertices by place: the first one there stands for all.
class Places {
public:
    explicit Places(const Mesh& mesh) : mesh_(mesh) {
        table_.assign(std::bit_ceil(2 * mesh.positions.size() + 1), kEmpty);
    }
    uint32_t first_at(uint32_t vertex) {
        const Vec3 p = mesh_.positions[vertex];
        for (size_t slot = place_hash({&p, 1}) & (table_.size() - 1);; slot = (slot + 1) & (table_.size() - 1)) {
            if (table_[slot] == kEmpty) table_[slot] = vertex;
            if (mesh_.positions[table_[slot]] == p) return table_[slot];
        }
    }

private:
    static constexpr uint32_t kEmpty = 0xffffffffu;
    const Mesh& mesh_;
    std::vector<uint32_t> table_;
};

struct Side {
    uint32_t low, high;  ///< vertices
    uint32_t triangle : 31;
    uint32_t downwards : 1;  ///< the triangle runs from high to low

    bool same_edge(const Side& o) const { return low == o.low && high == o.high; }
};
/// Triangles are below 2³¹ in any memory that there is: beyond, meshes are left alone.
constexpr size_t kMaxTriangles = size_t(1) << 31;

bool before(const Side& a, const Side& b) {
    if (a.low != b.low) return a.low < b.low;
    if (a.high != b.high) return a.high < b.high;
    return a.triangle != b.triangle ? a.triangle < b.triangle : a.downwards < b.downwards;
}

/// Of all that share an edge; what one direction has more than the other is loose.
void settle(const Side* begin, const Side* end, Topology& out) {
    int64_t sum = 0;
    for (const Side* s = begin; s != end; ++s) sum += s->downwards ? -1 : 1;
    if (sum == 0) return;
    if ((end - begin) % 2 == 0) {
        ++out.flipped;
        return;
    }
    for (const Side* s = end; s != begin && sum != 0;) {
        --s;
        if ((sum > 0) == (s->downwards != 0)) continue;
        sum += s->downwards ? 1 : -1;
        const uint32_t from = s->downwards ? s->high : s->low, to = s->downwards ? s->low : s->high;
        out.loose.push_back({from, to, s->triangle});
    }
}

}  // namespace

Topology topology_of(const Mesh& mesh) {
    const size_t triangles = mesh.indices.size() / 3;
    Topology out;
    out.place.assign(3 * triangles, Topology::kLeftOut);
    if (triangles >= kMaxTriangles) return out;
    {
        Places places(mesh);
        for (size_t t = 0; t < triangles; ++t) {
            uint32_t corner[3];
            bool usable = true;
            for (size_t k = 0; k < 3; ++k) {
                corner[k] = mesh.indices[3 * t + k];
                usable = usable && usable_position(mesh.positions[corner[k]]);
                if (usable) corner[k] = places.first_at(corner[k]);
            }
            if (!usable || corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
            std::copy_n(corner, 3, out.place.begin() + std::ptrdiff_t(3 * t));
        }
    }
    std::vector<Side> sides;
    sides.reserve(3 * triangles);
    for (size_t t = 0; t < triangles; ++t)
        for (size_t k = 0; k < 3 && !out.left_out(t); ++k) {
            const uint32_t a = out.place[3 * t + k], b = out.place[3 * t + (k + 1) % 3];
            sides.push_back({min_of(a, b), max_of(a, b), static_cast<uint32_t>(t) & 0x7fffffffu, a > b ? 1u : 0u});
        }
    std::sort(sides.begin(), sides.end(), before);
    for (size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
        while (end < sides.size() && sides[end].same_edge(sides[begin])) ++end;
        settle(sides.data() + begin, sides.data() + end, out);
    }
    return out;
}

Components components_of(const Mesh& mesh, const Topology& topology) {
    const size_t triangles = mesh.indices.size() / 3;
    UnionFind joined(mesh.positions.size());
    for (size_t t = 0; t < triangles; ++t) {
        if (topology.left_out(t)) continue;
        joined.join(topology.place[3 * t], topology.place[3 * t + 1]);
        joined.join(topology.place[3 * t], topology.place[3 * t + 2]);
    }
    std::vector<uint32_t> number(mesh.positions.size(), Topology::kLeftOut);
    std::vector<Vec3d> origin;
    Components out;
    out.of_triangle.assign(triangles, 0);
    for (size_t t = 0; t < triangles; ++t) {
        if (topology.left_out(t)) continue;
        const auto p = [&](size_t k) { return Vec3d(mesh.positions[topology.place[3 * t + k]]); };
        uint32_t& n = number[joined.find(topology.place[3 * t])];
        if (n == Topology::kLeftOut) {
            n = static_cast<uint32_t>(out.volume.size());
            out.volume.push_back(0);
            out.first.push_back(static_cast<uint32_t>(t));
            origin.push_back(p(0));
        }
        out.of_triangle[t] = n;
        const Vec3d o = origin[n];
        out.volume[n] += dot(p(0) - o, cross(p(1) - o, p(2) - o)) * (1.0 / 6);
    }
    return out;
}

}  // namespace steradian::lint_detail
