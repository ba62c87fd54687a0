// Surfaces of different objects that lie in one plane and overlap there without being the same: which of them is seen
// is decided by rounding. Where one object stands on another nobody sees it, so only what a camera sees is a finding.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <vector>

#include "lint/check.h"
#include "lint/pieces.h"

namespace steradian::lint_detail {
namespace {

/// So many pieces are compared, at 16 bytes each; larger scenes are left alone.
constexpr uint64_t kMostPieces = uint64_t(1) << 23;
/// Pairs in one plane that are compared in all.
constexpr uint64_t kMostPairs = uint64_t(1) << 23;
/// More pieces in one plane are a terrain, or a grid, and left alone as well.
constexpr size_t kMostInPlane = size_t(1) << 18;
/// Of two objects so many overlaps are looked for from the cameras.
constexpr uint32_t kMostLooks = 8;
/// An overlap of less than this part of the smaller piece is rounding.
constexpr double kLeastOverlap = 1e-3;

struct Placed {
    uint64_t plane;
    uint32_t instance, number;
};

struct Point2 {
    double x = 0, y = 0;
};
double cross2(Point2 a, Point2 b, Point2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

/// A triangle clipped by others has at most six corners.
struct Polygon {
    std::array<Point2, 8> p;
    size_t n = 0;
    void add(Point2 q) { p[n++] = q; }
    double area() const {
        double sum = 0;
        for (size_t i = 2; i < n; ++i) sum += cross2(p[0], p[i - 1], p[i]);
        return sum / 2;
    }
    Point2 middle() const {
        Point2 out;
        for (size_t i = 0; i < n; ++i) out.x += p[i].x / double(n), out.y += p[i].y / double(n);
        return out;
    }
};

/// What of the polygon is to the left of the line from a to b (Sutherland and Hodgman 1974).
Polygon clipped(const Polygon& polygon, Point2 a, Point2 b) {
    Polygon out;
    for (size_t i = 0; i < polygon.n; ++i) {
        const Point2 from = polygon.p[i], to = polygon.p[(i + 1) % polygon.n];
        const double f = cross2(a, b, from), t = cross2(a, b, to);
        if (f >= 0) out.add(from);
        if ((f > 0 && t < 0) || (f < 0 && t > 0)) {
            const double s = f / (f - t);
            out.add({from.x + (to.x - from.x) * s, from.y + (to.y - from.y) * s});
        }
    }
    return out;
}

/// A piece seen along an axis that its plane is far from.
struct Flat {
    Placed placed;
    std::array<Point2, 3> p;     ///< counter-clockwise
    double least = 0, most = 0;  ///< x
    double least_y = 0, most_y = 0;

    Polygon polygon() const {
        Polygon out;
        for (const Point2 q : p) out.add(q);
        return out;
    }
};

/// The normal's longest component, for which the plane is a graph over the other two.
int steepest_axis(Vec3d n) {
    const double x = std::fabs(n.x), y = std::fabs(n.y), z = std::fabs(n.z);
    return x >= y && x >= z ? 0 : y >= z ? 1 : 2;
}
Point2 seen_along(int axis, Vec3d p) { return {p[(axis + 1) % 3], p[(axis + 2) % 3]}; }

Vec3d normal_of(const Corners& c) { return normalize(cross(c[1] - c[0], c[2] - c[0])); }

class Overlap {
public:
    explicit Overlap(Check& check) : check_(check), scene_(check.scene), rays_(check.scene, check.world) {}

    void run() {
        if (scene_.cameras.empty() || !collect()) return;
        std::sort(all_.begin(), all_.end(), [](const Placed& a, const Placed& b) {
            return std::tuple(a.plane, a.instance, a.number) < std::tuple(b.plane, b.instance, b.number);
        });
        for (size_t begin = 0, end = 0; begin < all_.size(); begin = end) {
            while (end < all_.size() && all_[end].plane == all_[begin].plane) ++end;
            if (all_[begin].instance != all_[end - 1].instance && end - begin <= kMostInPlane) compare(begin, end);
        }
        for (const auto& [pair, found] : pairs_)
            if (found.seen) report(pair.first, pair.second, found.where);
    }

private:
    struct Found {
        uint32_t looks = 0;
        bool seen = false;
        Vec3d where;
    };

    /// Lights have a rule of their own.
    bool takes_part(uint32_t instance) const {
        return check_.world.visible_to_camera(instance) && !check_.world.emits(instance);
    }

    bool collect() {
        uint64_t total = 0;
        for (uint32_t i = 0; i < scene_.instances.size(); ++i) total += count_pieces(scene_, i);
        if (total > kMostPieces) return false;
        middle_ = check_.world.all().center();
        cell_ = check_.world.all().size() / 65536;
        if (!(cell_ > 0) || !std::isfinite(cell_)) return false;
        for (uint32_t i = 0; i < scene_.instances.size(); ++i) {
            if (!takes_part(i)) continue;
            const uint64_t count = count_pieces(scene_, i);
            for (uint32_t k = 0; k < count; ++k)
                if (const auto corners = piece(scene_, i, k))
                    if (const auto plane = plane_of(*corners)) all_.push_back({*plane, i, k});
        }
        return true;
    }

    /// Planes that are equal but for rounding mostly have one number; some do not, and are not compared.
    std::optional<uint64_t> plane_of(const Corners& c) const {
        Vec3d n = normal_of(c);
        if (!(length(n) > 0)) return std::nullopt;
        if (n[steepest_axis(n)] < 0) n = -n;
        const auto whole = [](double x) { return static_cast<uint64_t>(static_cast<int64_t>(std::floor(x + 0.5))); };
        uint64_t out = whole(dot(n, c[0] - middle_) / cell_) & 0x3fffff;
        for (int axis = 0; axis < 3; ++axis) out = out << 14 | (whole(n[axis] * 4096) & 0x3fff);
        return out;
    }

    void compare(size_t begin, size_t end) {
        std::vector<Flat> flats;
        const int axis = steepest_axis(normal_of(*piece(scene_, all_[begin].instance, all_[begin].number)));
        for (size_t i = begin; i < end; ++i) flats.push_back(flat(all_[i], axis));
        std::sort(flats.begin(), flats.end(), [](const Flat& a, const Flat& b) {
            return std::tuple(a.least, a.placed.instance, a.placed.number) <
                   std::tuple(b.least, b.placed.instance, b.placed.number);
        });
        for (size_t i = 0; i < flats.size(); ++i)
            for (size_t k = i + 1; k < flats.size() && flats[k].least < flats[i].most; ++k) {
                if (++compared_ > kMostPairs) return;
                if (differ(flats[i].placed.instance, flats[k].placed.instance) && flats[i].least_y < flats[k].most_y &&
                    flats[k].least_y < flats[i].most_y)
                    look(flats[i], flats[k], axis);
            }
    }
    Flat flat(const Placed& placed, int axis) const {
        const Corners c = *piece(scene_, placed.instance, placed.number);
        Flat out{placed, {seen_along(axis, c[0]), seen_along(axis, c[1]), seen_along(axis, c[2])}};
        if (cross2(out.p[0], out.p[1], out.p[2]) < 0) std::swap(out.p[1], out.p[2]);
        out.least = min_of(min_of(out.p[0].x, out.p[1].x), out.p[2].x);
        out.most = max_of(max_of(out.p[0].x, out.p[1].x), out.p[2].x);
        out.least_y = min_of(min_of(out.p[0].y, out.p[1].y), out.p[2].y);
        out.most_y = max_of(max_of(out.p[0].y, out.p[1].y), out.p[2].y);
        return out;
    }
    /// Two equal surfaces look like one, and so do pieces of the same object.
    bool differ(uint32_t a, uint32_t b) const {
        const MaterialId first = scene_.instances[a].material, second = scene_.instances[b].material;
        return first != second && !ordered(scene_, first, second);
    }

    void look(const Flat& a, const Flat& b, int axis) {
        const auto pair = std::minmax(a.placed.instance, b.placed.instance);
        Found& found = pairs_[{pair.first, pair.second}];
        if (found.seen || found.looks >= kMostLooks) return;
        Polygon both = a.polygon();
        for (size_t k = 0; k < 3 && both.n > 0; ++k) both = clipped(both, b.p[k], b.p[(k + 1) % 3]);
        if (!(both.n > 2 && both.area() > kLeastOverlap * min_of(a.polygon().area(), b.polygon().area()))) return;
        const Corners ca = *piece(scene_, a.placed.instance, a.placed.number),
                      cb = *piece(scene_, b.placed.instance, b.placed.number);
        if (same_places(ca, cb)) return;  // those are coincident-surfaces
        const Vec3d p = on_plane(ca, both.middle(), axis), q = on_plane(cb, both.middle(), axis);
        constexpr double kRounding = 0x1p-22;
        if (!(length(p - q) <= kRounding * (reach(p) + reach(p - middle_)))) return;
        ++found.looks;
        found.seen = seen(p);
        if (found.seen) found.where = p;
    }
    static bool same_places(Corners a, Corners b) {
        const auto less = [](Vec3d u, Vec3d v) { return std::tuple(u.x, u.y, u.z) < std::tuple(v.x, v.y, v.z); };
        std::sort(a.begin(), a.end(), less), std::sort(b.begin(), b.end(), less);
        return std::equal(a.begin(), a.end(), b.begin(), [&](Vec3d u, Vec3d v) { return !less(u, v) && !less(v, u); });
    }
    static Vec3d on_plane(const Corners& c, Point2 at, int axis) {
        const Vec3d n = normal_of(c);
        const Vec3d base = axis == 0 ? Vec3d{0, at.x, at.y} : axis == 1 ? Vec3d{at.y, 0, at.x} : Vec3d{at.x, at.y, 0};
        const Vec3d up{axis == 0 ? 1.0 : 0, axis == 1 ? 1.0 : 0, axis == 2 ? 1.0 : 0};
        return base + up * (dot(n, c[0] - base) / n[axis]);
    }

    /// From the place of a camera, whatever it looks at.
    bool seen(Vec3d p) {
        for (const Camera& camera : scene_.cameras) {
            Vec3d way = std::visit([](const auto& c) { return Vec3d(c.position); }, camera) - p;
            if (const auto* parallel = std::get_if<OrthographicCamera>(&camera)) {
                const Vec3d back = normalize(Vec3d(parallel->position) - Vec3d(parallel->look_at));
                way = back * dot(way, back);
            }
            const double far = length(way), near = 1e-5 * check_.world.all().size();
            if (far > near && !rays_.blocked(p, way * (1 / far), near, far).value_or(true)) return true;
        }
        return false;
    }

    void report(uint32_t a, uint32_t b, Vec3d p) {
        check_.out.add(Rule::overlapping_surfaces, Element{ElementKind::instance, b},
                       fmt::format("{} and {} lie in one plane and overlap, at ({:.4g}, {:.4g}, {:.4g}): which of them "
                                   "is seen there is an accident",
                                   check_.object(a), check_.object(b), p.x, p.y, p.z),
                       "move one of them a little out of the plane");
    }

    Check& check_;
    const Scene& scene_;
    Rays rays_;
    std::vector<Placed> all_;
    std::map<std::pair<uint32_t, uint32_t>, Found> pairs_;
    Vec3d middle_;
    double cell_ = 0;
    uint64_t compared_ = 0;
};

}  // namespace

void check_overlap(Check& check) {
    if (check.out.wants(Rule::overlapping_surfaces)) Overlap(check).run();
}

}  // namespace steradian::lint_detail
