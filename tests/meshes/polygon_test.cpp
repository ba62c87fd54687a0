#include "formats/mesh/polygon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "formats/mesh/corner_table.h"
#include "math/elementary.h"

namespace steradian {
namespace {

struct Cut {
    std::vector<uint32_t> triangles;
    bool clean = false;
};
Cut cut(const std::vector<Vec3>& polygon) {
    Cut out;
    PolygonTriangulator triangulator;
    out.clean = triangulator.triangulate(polygon, out.triangles);
    return out;
}

/// For polygons with whole coordinates in the plane z = 0, where all of this is exact: the triangles are oriented like
/// the polygon, none is turned over, and their areas sum to the polygon's. Together that means they cover it once.
void expect_exact_cover(const std::vector<Vec3>& polygon) {
    const Cut result = cut(polygon);
    EXPECT_TRUE(result.clean);
    ASSERT_EQ(result.triangles.size(), 3 * (polygon.size() - 2));
    const double whole = newell_vector(polygon).z;
    double sum = 0;
    for (size_t i = 0; i < result.triangles.size(); i += 3) {
        const std::vector<Vec3> triangle{polygon[result.triangles[i]], polygon[result.triangles[i + 1]],
                                         polygon[result.triangles[i + 2]]};
        const double area = newell_vector(triangle).z;
        EXPECT_GE(area * whole, 0);
        sum += area;
    }
    EXPECT_EQ(sum, whole);
}

std::vector<Vec3> mirrored(std::vector<Vec3> polygon) {
    std::reverse(polygon.begin(), polygon.end());
    return polygon;
}

TEST(Polygon, NewellVectorIsTwiceTheArea) {
    const std::vector<Vec3> square{{1, 1, 5}, {3, 1, 5}, {3, 3, 5}, {1, 3, 5}};
    const Vec3d n = newell_vector(square);
    EXPECT_EQ(n.x, 0);
    EXPECT_EQ(n.y, 0);
    EXPECT_EQ(n.z, 8);
    EXPECT_EQ(newell_vector(mirrored(square)).z, -8);
}

TEST(Polygon, ConvexIsAFanAboutTheFirstCorner) {
    EXPECT_EQ(cut({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}).triangles, (std::vector<uint32_t>{0, 1, 2, 0, 2, 3}));
}

TEST(Polygon, ConcaveQuadIsCutAtItsReflexCorner) {
    // An arrow head: the diagonal 1-3 would lie outside.
    const std::vector<Vec3> arrow{{0, 0, 0}, {4, 4, 0}, {0, 2, 0}, {-4, 4, 0}};
    expect_exact_cover(arrow);
    std::set<uint32_t> in_all{0, 2};
    const Cut result = cut(arrow);
    for (size_t i = 0; i < 6; i += 3) {
        const std::set<uint32_t> triangle(result.triangles.begin() + long(i), result.triangles.begin() + long(i) + 3);
        EXPECT_TRUE(std::includes(triangle.begin(), triangle.end(), in_all.begin(), in_all.end()));
    }
    expect_exact_cover(mirrored(arrow));
}

TEST(Polygon, CornersOnStraightEdgesAreKept) {
    const std::vector<Vec3> square{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0},
                                   {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}};
    expect_exact_cover(square);
    const Cut result = cut(square);
    for (size_t i = 0; i < result.triangles.size(); i += 3) {
        const std::vector<Vec3> t{square[result.triangles[i]], square[result.triangles[i + 1]],
                                  square[result.triangles[i + 2]]};
        EXPECT_GT(newell_vector(t).z, 0) << "a triangle without area, though it can be avoided";
    }
}

TEST(Polygon, HoleJoinedByACut) {
    expect_exact_cover(
        {{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0}, {0, 0, 0}, {3, 3, 0}, {3, 6, 0}, {6, 6, 0}, {6, 3, 0}, {3, 3, 0}});
}

TEST(Polygon, CombAndSpiral) {
    std::vector<Vec3> comb;
    for (int i = 0; i < 200; ++i) {
        comb.push_back({float(4 * i), 0, 0});
        comb.push_back({float(4 * i + 1), 100, 0});
        comb.push_back({float(4 * i + 2), 100, 0});
        comb.push_back({float(4 * i + 3), 0, 0});
    }
    comb.push_back({800, -1, 0});
    comb.push_back({-1, -1, 0});
    expect_exact_cover(comb);
    expect_exact_cover(mirrored(comb));

    std::vector<Vec3> spiral, back;
    int x = 0, y = 0;
    for (int i = 0; i < 100; ++i) {
        const int d = i % 4, length = 4 * (i + 2);
        // The inner wall runs one unit inside of the outer one.
        spiral.push_back({float(x), float(y), 0});
        x += d == 0 ? length : d == 2 ? -length : 0;
        y += d == 1 ? length : d == 3 ? -length : 0;
    }
    for (const Vec3 p : spiral) back.push_back(p);
    std::vector<Vec3> outline = spiral;
    const auto side = [](size_t i) { return i % 4; };
    for (size_t i = back.size(); i-- > 0;) {
        const float dx = side(i) == 0 || side(i) == 3 ? 1.0f : -1.0f, dy = side(i) == 0 || side(i) == 1 ? 1.0f : -1.0f;
        outline.push_back({back[i].x + dx, back[i].y + dy, 0});
    }
    expect_exact_cover(outline);
}

TEST(Polygon, StarsOfAHundredThousandCornersTakeLinearTime) {
    // Radii alternate, so that every second corner is reflex; without the grid this is 10^10 tests.
    std::vector<Vec3> star;
    const int n = 100000;
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * 3.14159265358979 * i / n, r = i % 2 ? 1000000.0 : 900000.0;
        star.push_back({float(int(r * math::cos(angle))), float(int(r * math::sin(angle))), 0});
    }
    expect_exact_cover(star);
}

TEST(Polygon, DegenerateOnesBecomeSomething) {
    for (const std::vector<Vec3>& polygon :
         {std::vector<Vec3>(5, Vec3{1, 2, 3}), std::vector<Vec3>{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}},
          std::vector<Vec3>{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}}) {
        const Cut result = cut(polygon);
        ASSERT_EQ(result.triangles.size(), 3 * (polygon.size() - 2));
        for (const uint32_t i : result.triangles) EXPECT_LT(i, polygon.size());
    }
}

TEST(Polygon, TheWorkIsBounded) {
    // Crossing scribbles of many corners: no outline that can be cut, but an end.
    std::vector<Vec3> scribble;
    uint64_t state = 1;
    for (int i = 0; i < 30000; ++i) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        scribble.push_back({float(state >> 48), float((state >> 32) & 0xffff), 0});
    }
    const Cut result = cut(scribble);
    EXPECT_FALSE(result.clean);
    EXPECT_EQ(result.triangles.size(), 3 * (scribble.size() - 2));
}

TEST(CornerTable, NumbersInOrderOfFirstUse) {
    CornerTable table;
    std::vector<CornerTable::Key> keys;
    for (uint32_t i = 0; i < 5000; ++i) keys.push_back({i % 71, i % 13, i * 2654435761u});
    for (uint32_t i = 0; i < keys.size(); ++i) EXPECT_EQ(table.number_of(keys[i]), std::pair(i, true));
    for (uint32_t i = 0; i < keys.size(); ++i) {
        EXPECT_EQ(table.number_of(keys[i]), std::pair(i, false));
        EXPECT_EQ(table.find(keys[i]), i);
    }
    EXPECT_EQ(table.find({1, 2, 3}), CornerTable::kMissing);
}

}  // namespace
}  // namespace steradian
