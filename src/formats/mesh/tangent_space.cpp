#include "formats/mesh/tangent_space.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <tuple>

#include "math/elementary.h"
#include "math/vector.h"

namespace steradian {
namespace {

constexpr uint32_t kNone = 0xffffffffu;

/// Bits that compare as the numbers do for equality: of the two zeros one.
uint32_t equality_bits(float x) { return std::bit_cast<uint32_t>(x == 0 ? 0.0f : x); }

using VertexKey = std::array<uint32_t, 8>;
VertexKey key_of(const Mesh& mesh, const std::vector<Vec2>& uvs, uint32_t v) {
    const Vec3 p = mesh.positions[v], n = mesh.normals[v];
    const Vec2 t = uvs[v];
    return {equality_bits(p.x), equality_bits(p.y), equality_bits(p.z), equality_bits(n.x),
            equality_bits(n.y), equality_bits(n.z), equality_bits(t.x), equality_bits(t.y)};
}

/// For each vertex the first one with the same position, normal and texture coordinates.
std::vector<uint32_t> weld(const Mesh& mesh, const std::vector<Vec2>& uvs) {
    std::vector<std::pair<VertexKey, uint32_t>> sorted(mesh.positions.size());
    for (uint32_t v = 0; v < sorted.size(); ++v) sorted[v] = {key_of(mesh, uvs, v), v};
    std::sort(sorted.begin(), sorted.end());
    std::vector<uint32_t> first(sorted.size());
    for (size_t i = 0; i < sorted.size(); ++i) {
        const bool same = i > 0 && sorted[i].first == sorted[i - 1].first;
        first[sorted[i].second] = same ? first[sorted[i - 1].second] : sorted[i].second;
    }
    return first;
}

class TangentSpace {
public:
    TangentSpace(const Mesh& mesh, const std::vector<Vec2>& uvs)
        : mesh_(mesh), uvs_(uvs), welded_(weld(mesh, uvs)), triangles_(mesh.indices.size() / 3) {
        for (uint32_t t = 0; t < triangles_.size(); ++t) triangles_[t] = measure(t);
        connect();
    }

    /// One for each corner.
    std::vector<Tangent> corners() {
        std::vector<Tangent> out(3 * triangles_.size(), Tangent{{0, 0, 0}, 1});
        std::vector<uint32_t> members;
        for (uint32_t t = 0; t < triangles_.size(); ++t)
            for (uint32_t k = 0; k < 3; ++k) {
                if (!triangles_[t].has_area || triangles_[t].any || triangles_[t].grouped[k]) continue;
                const bool preserves = triangles_[t].preserves;
                gather(3 * t + k, preserves, members);
                const Tangent tangent{mean_tangent(members), preserves ? 1.0f : -1.0f};
                for (const uint32_t corner : members) out[corner] = tangent;
            }
        borrow(out);
        return out;
    }

private:
    struct Triangle {
        Vec3d along;             ///< of unit length: where u grows
        bool has_area = false;   ///< no two corners are at one place
        bool any = true;         ///< its texture coordinates say nothing: it joins whichever group comes first
        bool preserves = false;  ///< it is not mirrored in the texture, seen with v upwards
        std::array<bool, 3> grouped{};
        std::array<uint32_t, 3> across{kNone, kNone, kNone};  ///< the corner where the neighbour's edge begins
    };

    uint32_t vertex(uint32_t corner) const { return welded_[mesh_.indices[corner]]; }
    Vec3d position(uint32_t corner) const { return mesh_.positions[vertex(corner)]; }
    static uint32_t next(uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
    static uint32_t previous(uint32_t corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }

    Triangle measure(uint32_t t) const {
        const Vec3d p0 = position(3 * t), e1 = position(3 * t + 1) - p0, e2 = position(3 * t + 2) - p0;
        Triangle out;
        out.has_area = length(e1) > 0 && length(e2) > 0 && length(e1 - e2) > 0;
        const Vec2 a = uvs_[vertex(3 * t)], b = uvs_[vertex(3 * t + 1)], c = uvs_[vertex(3 * t + 2)];
        // v upwards.
        const double u1 = double(b.x) - a.x, v1 = double(a.y) - b.y, u2 = double(c.x) - a.x, v2 = double(a.y) - c.y;
        const double area = u1 * v2 - v1 * u2;
        const Vec3d along = e1 * v2 - e2 * v1, up = e2 * u1 - e1 * u2;
        out.preserves = area > 0;
        out.any = !(std::fabs(area) > 0 && length(along) > 0 && length(up) > 0);
        out.along = normalize(along) * (out.preserves ? 1.0 : -1.0);
        return out;
    }

    /// Edges that two triangles run through in opposite directions; of more than two, the first of each.
    void connect() {
        struct Edge {
            uint32_t low, high, corner;
        };
        std::vector<Edge> edges;
        for (uint32_t corner = 0; corner < 3 * triangles_.size(); ++corner) {
            if (!triangles_[corner / 3].has_area) continue;
            const uint32_t a = vertex(corner), b = vertex(next(corner));
            edges.push_back({min_of(a, b), max_of(a, b), corner});
        }
        std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
            return std::tie(a.low, a.high, a.corner) < std::tie(b.low, b.high, b.corner);
        });
        const auto across = [&](uint32_t corner) -> uint32_t& { return triangles_[corner / 3].across[corner % 3]; };
        std::vector<uint32_t> up, down;
        for (size_t i = 0; i < edges.size();) {
            const Edge& edge = edges[i];
            up.clear(), down.clear();
            for (; i < edges.size() && edges[i].low == edge.low && edges[i].high == edge.high; ++i)
                (vertex(edges[i].corner) == edge.low ? up : down).push_back(edges[i].corner);
            for (size_t k = 0; k < min_of(up.size(), down.size()); ++k)
                across(up[k]) = down[k], across(down[k]) = up[k];
        }
    }

    /// The corners around the same vertex that are reached from one over edges, of triangles with its orientation.
    void gather(uint32_t start, bool preserves, std::vector<uint32_t>& members) {
        members.clear();
        open_.assign(1, start);
        while (!open_.empty()) {
            const uint32_t corner = open_.back();
            open_.pop_back();
            Triangle& triangle = triangles_[corner / 3];
            bool& grouped = triangle.grouped[corner % 3];
            if (grouped) continue;
            // One that does not care takes the orientation of the first group that it joins.
            const auto& g = triangle.grouped;
            if (triangle.any && !g[0] && !g[1] && !g[2]) triangle.preserves = preserves;
            if (triangle.preserves != preserves) continue;
            grouped = true;
            members.push_back(corner);
            // Over the edge before this corner the neighbour's edge begins at the same vertex, over the one behind it
            // ends there.
            const uint32_t before = triangle.across[previous(corner) % 3], behind = triangle.across[corner % 3];
            if (before != kNone) open_.push_back(before);
            if (behind != kNone) open_.push_back(next(behind));
        }
    }

    /// Of the triangles' tangents, in the plane of the vertex normal, by the angles of the corners there.
    Vec3 mean_tangent(const std::vector<uint32_t>& members) const {
        const Vec3d n = normalize(Vec3d(mesh_.normals[vertex(members[0])]));
        const auto in_plane = [&](Vec3d v) { return normalize(v - n * dot(v, n)); };
        Vec3d sum;
        for (const uint32_t corner : members) {
            const Triangle& triangle = triangles_[corner / 3];
            if (triangle.any) continue;
            const Vec3d p = position(corner);
            const Vec3d a = in_plane(position(next(corner)) - p), b = in_plane(position(previous(corner)) - p);
            sum = sum + in_plane(triangle.along) * math::acos(clamp_to(dot(a, b), -1.0, 1.0));
        }
        return static_cast<Vec3>(normalize(sum));
    }

    /// What has no tangent, as corners of triangles without area, takes that of a corner at the same vertex.
    void borrow(std::vector<Tangent>& out) const {
        const auto has_one = [&](uint32_t corner) { return out[corner].direction != Vec3{}; };
        std::vector<uint32_t> lender(mesh_.positions.size(), kNone);
        for (uint32_t corner = 0; corner < out.size(); ++corner)
            if (has_one(corner) && lender[vertex(corner)] == kNone) lender[vertex(corner)] = corner;
        for (uint32_t corner = 0; corner < out.size(); ++corner)
            if (!has_one(corner) && !triangles_[corner / 3].has_area && lender[vertex(corner)] != kNone)
                out[corner] = out[lender[vertex(corner)]];
    }

    const Mesh& mesh_;
    const std::vector<Vec2>& uvs_;
    std::vector<uint32_t> welded_;
    std::vector<Triangle> triangles_;
    std::vector<uint32_t> open_;
};

/// A vertex with everything that it has but its tangent, once more.
uint32_t copy_vertex(Mesh& mesh, uint32_t v) {
    const auto copy = [&](auto& values) {
        if (!values.empty()) values.push_back(values[v]);
    };
    copy(mesh.positions), copy(mesh.normals), copy(mesh.uvs), copy(mesh.colors), copy(mesh.alphas);
    for (std::vector<Vec2>& uvs : mesh.more_uvs) copy(uvs);
    mesh.tangents.push_back({});
    return static_cast<uint32_t>(mesh.positions.size() - 1);
}

/// Gives corners their tangents; a vertex that needs a second one is copied.
void assign(Mesh& mesh, const std::vector<Tangent>& corners) {
    const auto key = [&](uint32_t corner) {
        const Tangent& t = corners[corner];
        const auto bits = [](float x) { return std::bit_cast<uint32_t>(x); };
        return std::tuple(mesh.indices[corner], t.side, bits(t.direction.x), bits(t.direction.y), bits(t.direction.z));
    };
    std::vector<uint32_t> sorted(corners.size());
    std::iota(sorted.begin(), sorted.end(), 0u);
    std::sort(sorted.begin(), sorted.end(),
              [&](uint32_t a, uint32_t b) { return std::pair(key(a), a) < std::pair(key(b), b); });
    mesh.tangents.assign(mesh.positions.size(), Tangent{{0, 0, 0}, 1});
    std::vector<uint32_t> indices(corners.size());
    uint32_t vertex = kNone;
    for (size_t i = 0; i < sorted.size(); ++i) {
        const uint32_t corner = sorted[i];
        const bool first = i == 0 || mesh.indices[corner] != mesh.indices[sorted[i - 1]];
        if (first)
            vertex = mesh.indices[corner];
        else if (key(corner) != key(sorted[i - 1]))
            vertex = copy_vertex(mesh, mesh.indices[corner]);
        mesh.tangents[vertex] = corners[corner];
        indices[corner] = vertex;
    }
    mesh.indices = std::move(indices);
}

}  // namespace

void add_tangents(Mesh& mesh, uint32_t uv_set) {
    static const std::vector<Vec2> kNothing;
    const std::vector<Vec2>& uvs = uv_set == 0                      ? mesh.uvs
                                   : uv_set <= mesh.more_uvs.size() ? mesh.more_uvs[uv_set - 1]
                                                                    : kNothing;
    if (mesh.normals.empty() || uvs.empty()) return;
    assign(mesh, TangentSpace(mesh, uvs).corners());
}

}  // namespace steradian
