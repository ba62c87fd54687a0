#include "formats/mesh/polygon.h"

#include <cmath>

namespace steradian {

Vec3d newell_vector(std::span<const Vec3> corners) {
    Vec3d sum;
    if (corners.size() < 3) return sum;
    // Relative to the first corner, so that a small polygon far from the origin keeps its digits.
    const Vec3d origin = corners[0];
    Vec3d a = Vec3d(corners[1]) - origin;
    for (size_t i = 2; i < corners.size(); ++i) {
        const Vec3d b = Vec3d(corners[i]) - origin;
        sum = sum + cross(a, b);
        a = b;
    }
    return sum;
}

/// Drops the axis along which the polygon is thinnest and makes the outline counter-clockwise. False when it has no
/// area.
bool PolygonTriangulator::project(std::span<const Vec3> corners) {
    const Vec3d normal = newell_vector(corners);
    const double x = std::fabs(normal.x), y = std::fabs(normal.y), z = std::fabs(normal.z);
    const int axis = x > y && x > z ? 0 : y > z ? 1 : 2;
    const double along = normal[axis];
    if (!(std::fabs(along) > 0)) return false;
    const int u = along > 0 ? (axis + 1) % 3 : (axis + 2) % 3;
    const int v = along > 0 ? (axis + 2) % 3 : (axis + 1) % 3;
    points_.resize(corners.size());
    for (size_t i = 0; i < corners.size(); ++i) points_[i] = {double(corners[i][u]), double(corners[i][v])};
    return true;
}

void PolygonTriangulator::fan(uint32_t first, size_t count, std::vector<uint32_t>& out) const {
    uint32_t b = next_[first];
    for (size_t i = 2; i < count; ++i) {
        const uint32_t c = next_[b];
        out.insert(out.end(), {first, b, c});
        b = c;
    }
}

bool PolygonTriangulator::triangulate(std::span<const Vec3> corners, std::vector<uint32_t>& out) {
    const auto n = static_cast<uint32_t>(corners.size());
    if (n == 3) {
        out.insert(out.end(), {0, 1, 2});
        return true;
    }
    next_.resize(n);
    previous_.resize(n);
    for (uint32_t i = 0; i < n; ++i) {
        next_[i] = i + 1 < n ? i + 1 : 0;
        previous_[i] = i > 0 ? i - 1 : n - 1;
    }
    if (!project(corners)) {
        fan(0, n, out);
        return true;  // no area: any triangles will do
    }
    reflex_.resize(n);
    bool convex = true;
    for (uint32_t i = 0; i < n; ++i) {
        reflex_[i] = !(corner_area(i) > 0);
        convex &= !reflex_[i];
    }
    if (convex) {
        fan(0, n, out);
        return true;
    }
    build_grid();
    return clip_ears(out);
}

uint32_t PolygonTriangulator::column(double x) const {
    return static_cast<uint32_t>(clamp_to((x - grid_origin_.x) * grid_scale_.x, 0.0, double(grid_ - 1)));
}
uint32_t PolygonTriangulator::row(double y) const {
    return static_cast<uint32_t>(clamp_to((y - grid_origin_.y) * grid_scale_.y, 0.0, double(grid_ - 1)));
}

/// Reflex corners sorted by cell (counting sort); about one corner per cell.
void PolygonTriangulator::build_grid() {
    Point low = points_[0], high = points_[0];
    size_t count = 0;
    for (size_t i = 0; i < points_.size(); ++i) {
        const Point p = points_[i];
        low = {min_of(low.x, p.x), min_of(low.y, p.y)};
        high = {max_of(high.x, p.x), max_of(high.y, p.y)};
        count += reflex_[i];
    }
    grid_ = static_cast<uint32_t>(std::sqrt(static_cast<double>(count))) + 1;
    grid_origin_ = low;
    grid_scale_ = {high.x > low.x ? grid_ / (high.x - low.x) : 0, high.y > low.y ? grid_ / (high.y - low.y) : 0};

    const auto cell_of = [&](Point p) { return size_t(row(p.y)) * grid_ + column(p.x); };
    cell_begin_.assign(size_t(grid_) * grid_ + 1, 0);
    for (size_t i = 0; i < points_.size(); ++i)
        if (reflex_[i]) ++cell_begin_[cell_of(points_[i])];
    uint32_t sum = 0;
    for (uint32_t& entry : cell_begin_) {
        sum += entry;
        entry = sum;
    }
    cells_.resize(count);
    for (size_t i = points_.size(); i-- > 0;)
        if (reflex_[i]) cells_[--cell_begin_[cell_of(points_[i])]] = static_cast<uint32_t>(i);
}

/// Whether the candidate lies in the closed triangle of the ear. Corners at the ear's own corners do not count:
/// outlines with holes pass twice through the ends of the cut that joins hole and border.
bool PolygonTriangulator::blocks(uint32_t candidate, uint32_t ear) const {
    const uint32_t i = previous_[ear], k = next_[ear];
    if (!reflex_[candidate] || candidate == i || candidate == ear || candidate == k) return false;
    const Point a = points_[i], b = points_[ear], c = points_[k], p = points_[candidate];
    const auto same = [&](Point q) { return p.x == q.x && p.y == q.y; };
    if (same(a) || same(b) || same(c)) return false;
    return area(a, b, p) >= 0 && area(b, c, p) >= 0 && area(c, a, p) >= 0;
}

bool PolygonTriangulator::is_ear(uint32_t i, uint64_t& tests) const {
    ++tests;
    if (!(corner_area(i) > 0)) return false;
    const Point a = points_[previous_[i]], b = points_[i], c = points_[next_[i]];
    const uint32_t column_end = column(max_of(a.x, max_of(b.x, c.x)));
    const uint32_t row_end = row(max_of(a.y, max_of(b.y, c.y)));
    for (uint32_t y = row(min_of(a.y, min_of(b.y, c.y))); y <= row_end; ++y) {
        for (uint32_t x = column(min_of(a.x, min_of(b.x, c.x))); x <= column_end; ++x) {
            const size_t cell = size_t(y) * grid_ + x;
            tests += 1 + cell_begin_[cell + 1] - cell_begin_[cell];
            for (uint32_t j = cell_begin_[cell]; j < cell_begin_[cell + 1]; ++j)
                if (blocks(cells_[j], i)) return false;
        }
    }
    return true;
}

bool PolygonTriangulator::clip_ears(std::vector<uint32_t>& out) {
    size_t left = points_.size();
    const uint64_t limit = kTestsPerCorner * left;
    uint64_t tests = 0;
    uint32_t i = 0;
    for (size_t misses = 0; left > 3;) {
        if (tests > limit) break;
        if (!is_ear(i, tests)) {
            if (++misses > left) break;
            i = next_[i];
            continue;
        }
        const uint32_t before = previous_[i], after = next_[i];
        out.insert(out.end(), {before, i, after});
        next_[before] = after;
        previous_[after] = before;
        reflex_[i] = 0;
        // Clipping only closes angles: a reflex corner may become convex, never the other way round.
        if (reflex_[before]) reflex_[before] = !(corner_area(before) > 0);
        if (reflex_[after]) reflex_[after] = !(corner_area(after) > 0);
        --left;
        misses = 0;
        i = next_[after];  // not `after` itself: that would make a fan of slivers
    }
    fan(i, left, out);
    return left == 3;
}

}  // namespace steradian
