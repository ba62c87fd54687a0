#include "lint/seams.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "lint/union_find.h"

namespace steradian::lint_detail {

uint32_t Places::number_of(Vec3d p) {
    // Cells are larger than the distance, so that most points have to be looked for in one of them alone.
    const double size = 8 * distance_;
    // What is far larger than the glass may be more cells away than integers count.
    const auto cell = [&](double x) { return static_cast<int64_t>(clamp_to(std::floor(x / size), -0x1p60, 0x1p60)); };
    const Vec3d lo = p - Vec3d{distance_, distance_, distance_}, hi = p + Vec3d{distance_, distance_, distance_};
    for (int64_t x = cell(lo.x); x <= cell(hi.x); ++x)
        for (int64_t y = cell(lo.y); y <= cell(hi.y); ++y)
            for (int64_t z = cell(lo.z); z <= cell(hi.z); ++z)
                if (const auto found = in_cell_.find({x, y, z}); found != in_cell_.end())
                    for (const uint32_t number : found->second)
                        if (length(places_[number] - p) <= distance_) return number;
    const auto number = static_cast<uint32_t>(places_.size());
    places_.push_back(p);
    in_cell_[{cell(p.x), cell(p.y), cell(p.z)}].push_back(number);
    return number;
}

std::vector<Rim> open_rims(const std::vector<Rim>& rims) {
    struct Edge {
        uint32_t low, high, object;
        bool operator<(const Edge& o) const {
            return std::tuple(low, high, object) < std::tuple(o.low, o.high, o.object);
        }
    };
    const auto edge_of = [](const Rim& r) { return Edge{min_of(r.from, r.to), max_of(r.from, r.to), r.object}; };
    std::vector<Edge> edges;
    for (const Rim& rim : rims) edges.push_back(edge_of(rim));
    std::sort(edges.begin(), edges.end());
    std::vector<Rim> out;
    for (const Rim& rim : rims) {
        const Edge edge = edge_of(rim);
        const auto first = std::lower_bound(edges.begin(), edges.end(), Edge{edge.low, edge.high, 0});
        const auto end = std::upper_bound(first, edges.end(), Edge{edge.low, edge.high, 0xffffffffu});
        if (edge.low != edge.high && first->object == std::prev(end)->object) out.push_back(rim);
    }
    return out;
}

namespace {

// Rounding of coordinates moves the vertices of a seam off its line, by up to some 1e-7 of its length.
constexpr double kCrack = 1e-5;

/// Edges that hang together.
struct Loop {
    std::vector<size_t> edges;
    bool simple = true;  ///< two at every place: it can be walked along, whichever way its edges run
};

/// Twice the area that it encloses, and the sum of the squares of its lengths.
struct Measure {
    double area = 0, length_squared = 0;
};

Measure measure(const Places& places, const std::vector<Rim>& open, Loop loop) {
    const Vec3d origin = places.at(open[loop.edges[0]].from);
    Vec3d area;
    Measure out;
    const auto add = [&](uint32_t from, uint32_t to) {
        const Vec3d a = places.at(from) - origin, b = places.at(to) - origin;
        area = area + cross(a, b);
        out.length_squared += dot(b - a, b - a);
    };
    if (!loop.simple) {
        for (const size_t e : loop.edges) add(open[e].from, open[e].to);
    } else {
        std::multimap<uint32_t, size_t> at;
        for (const size_t e : loop.edges) at.emplace(open[e].from, e), at.emplace(open[e].to, e);
        size_t edge = loop.edges[0];
        uint32_t place = open[edge].from;
        for (size_t n = 0; n < loop.edges.size(); ++n) {
            const uint32_t next = open[edge].from == place ? open[edge].to : open[edge].from;
            add(place, next);
            const auto [one, end] = at.equal_range(next);
            edge = one->second == edge ? std::next(one)->second : one->second;
            place = next;
        }
    }
    out.area = length(area);
    return out;
}

}  // namespace

std::map<uint32_t, OpenBody> holes_of(const Places& places, const std::vector<Rim>& open,
                                      const std::vector<uint32_t>& body_of) {
    UnionFind joined(places.count());
    std::vector<uint8_t> edges_at(places.count());
    for (const Rim& rim : open) {
        joined.join(rim.from, rim.to);
        for (const uint32_t place : {rim.from, rim.to}) edges_at[place] = min_of(edges_at[place] + 1, 3);
    }
    std::map<uint32_t, Loop> loops;  // by their lowest places
    for (size_t e = 0; e < open.size(); ++e) {
        Loop& loop = loops[joined.find(open[e].from)];
        loop.edges.push_back(e);
        loop.simple = loop.simple && edges_at[open[e].from] == 2 && edges_at[open[e].to] == 2;
    }
    std::map<uint32_t, OpenBody> out;
    for (const auto& [lowest, loop] : loops) {
        const Measure m = measure(places, open, loop);
        if (!(m.area > kCrack * m.length_squared)) continue;
        const Rim& first = open[loop.edges[0]];
        OpenBody& body = out.try_emplace(body_of[first.object], OpenBody{{}, first.object}).first->second;
        for (const size_t e : loop.edges) body.first = min_of(body.first, open[e].object);
        body.holes.push_back({loop.edges.size(), places.at(first.from), places.at(first.to)});
    }
    return out;
}

}  // namespace steradian::lint_detail
