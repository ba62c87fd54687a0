// Polygons to triangles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "math/vector.h"
#include "steradian/vec.h"

namespace steradian {

/// Twice the area vector of a polygon that need not be planar (Newell's method): its length is twice the area, its
/// direction the normal by the right-hand rule. Zero for fewer than three corners.
Vec3d newell_vector(std::span<const Vec3> corners);

/// Cuts polygons into triangles. Keeps its buffers between calls; one object per thread.
class PolygonTriangulator {
public:
    /// Appends 3 (n - 2) numbers of corners to `out`, triangles with the polygon's own orientation, for n >= 3 finite
    /// corners. Strictly convex polygons become the fan about corner 0. Others are cut by ears in the plane of the
    /// polygon (Meisters 1975), with the reflex corners in a grid, so that ordinary outlines take about linear time;
    /// the number of point-in-triangle tests is limited to kTestsPerCorner n. What is left when that limit is reached
    /// or when no ear can be found (self-intersecting outlines) becomes a fan. Returns false when it had to fall back
    /// to such a fan.
    bool triangulate(std::span<const Vec3> corners, std::vector<uint32_t>& out);

    static constexpr uint64_t kTestsPerCorner = 4096;

private:
    struct Point {
        double x, y;
    };
    static double area(Point a, Point b, Point c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

    double corner_area(uint32_t i) const { return area(points_[previous_[i]], points_[i], points_[next_[i]]); }
    bool project(std::span<const Vec3> corners);
    void fan(uint32_t first, size_t count, std::vector<uint32_t>& out) const;
    void build_grid();
    uint32_t column(double x) const;
    uint32_t row(double y) const;
    bool is_ear(uint32_t i, uint64_t& tests) const;
    bool blocks(uint32_t candidate, uint32_t ear) const;
    bool clip_ears(std::vector<uint32_t>& out);

    std::vector<Point> points_;                 ///< counter-clockwise
    std::vector<uint32_t> next_, previous_;     ///< the outline that is left
    std::vector<uint8_t> reflex_;               ///< not strictly convex, and not clipped
    std::vector<uint32_t> cell_begin_, cells_;  ///< reflex corners by cell of the grid
    uint32_t grid_ = 1;                         ///< cells per side
    Point grid_origin_{0, 0}, grid_scale_{0, 0};
};

}  // namespace steradian
