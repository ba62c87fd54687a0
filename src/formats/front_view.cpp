#include "formats/front_view.h"

#include <array>
#include <numbers>
#include <vector>

#include "formats/framing.h"
#include "math/elementary.h"
#include "math/transform.h"

namespace steradian {
namespace {

/// Of all objects, so that nothing takes longer than about a second.
constexpr uint64_t kMostTrianglesAndVertices = 1'000'000;
constexpr int kSize = 96;  // pixels of a side
/// Pixels that triangles may try, in all pictures together.
constexpr uint64_t kMostTries = 40'000'000;

struct Candidate {
    View view;
    int preference;  ///< factor of what it shows
};
constexpr int kPreferUsualHeight = 2;

/// Level views are for boxes that are open at a side: from higher up their lids would be in the way; those from above
/// are for rooms without a ceiling.
std::vector<Candidate> candidates() {
    constexpr Vec3d kLevel{0, 0, 1}, kAbove{0.5, 1.5, 1};
    std::vector<Candidate> out;
    for (const double turn : {180.0, 90.0, 270.0})
        out.push_back({{turned(kUsualView, turn), turn}, kPreferUsualHeight});
    for (const double turn : {0.0, 180.0, 90.0, 270.0}) out.push_back({{turned(kLevel, turn), turn}, 1});
    for (const double turn : {0.0, 180.0, 90.0, 270.0}) out.push_back({{turned(kAbove, turn), turn}, 1});
    return out;
}

/// How many pixels show the fronts of triangles, and how many their backs.
struct Sides {
    int front = 0, back = 0;

    int all() const { return front + back; }
    int surplus() const { return front - back; }
};

/// A square picture of a scene's meshes: of each pixel how near the nearest triangle is, and its side.
class SidesPicture {
public:
    /// Takes what it tries from `tries`; with 0 left it is not complete.
    SidesPicture(const PerspectiveCamera& camera, uint64_t& tries)
        : tries_(tries),
          eye_(camera.position),
          axes_(Vec3d(camera.position) - Vec3d(camera.look_at)),
          scale_(kSize / 2 / math::tan(static_cast<double>(camera.vertical_fov) * std::numbers::pi / 360)) {}

    void add(const Mesh& mesh, const Affine& world_from_object) {
        const bool mirrored = determinant(world_from_object) < 0;
        corners_.clear();
        for (const Vec3 p : mesh.positions)
            corners_.push_back(usable_position(p) ? project(transform_point(world_from_object, Vec3d(p))) : Vec3d{});
        for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
            const Vec3d a = corners_[mesh.indices[i]], b = corners_[mesh.indices[i + 1]],
                        c = corners_[mesh.indices[i + 2]];
            // The eye is rounded to float, so far from the origin a small model may lie about it.
            if (min_of(min_of(a.z, b.z), c.z) > 0) draw({a, b, c}, mirrored);
        }
    }
    Sides count() const {
        Sides out;
        for (const Pixel& p : pixels_)
            if (p.nearness > 0) ++(p.front ? out.front : out.back);
        return out;
    }

private:
    struct Pixel {
        double nearness = 0;  ///< 1 / depth; 0: nothing is there
        bool front = false;
    };

    /// To the right and upwards in pixels, and 1 / depth, which is linear in them; 0 for what is not in front of the
    /// eye.
    Vec3d project(Vec3d world) const {
        const Vec3d q = world - eye_;
        const double nearness = -1 / dot(q, axes_.back);
        if (!(nearness > 0 && nearness < kInfinity)) return {};
        return {kSize / 2 + scale_ * dot(q, axes_.right) * nearness, kSize / 2 + scale_ * dot(q, axes_.up) * nearness,
                nearness};
    }

    /// The pixels whose middle lies in the range.
    static std::array<int, 2> pixels_between(double lo, double hi) {
        const double first = std::ceil(lo - 0.5), last = std::floor(hi - 0.5);
        return {static_cast<int>(clamp_to(first, 0.0, double(kSize))),
                static_cast<int>(clamp_to(last, -1.0, kSize - 1.0))};
    }

    void draw(const std::array<Vec3d, 3>& v, bool mirrored) {
        const auto [x0, x1] =
            pixels_between(min_of(min_of(v[0].x, v[1].x), v[2].x), max_of(max_of(v[0].x, v[1].x), v[2].x));
        const auto [y0, y1] =
            pixels_between(min_of(min_of(v[0].y, v[1].y), v[2].y), max_of(max_of(v[0].y, v[1].y), v[2].y));
        if (x0 > x1 || y0 > y1) return;
        const auto tries = static_cast<uint64_t>((x1 - x0 + 1) * (y1 - y0 + 1));
        tries_ -= min_of(tries, tries_);
        if (tries_ == 0) return;
        const auto edge = [](Vec3d a, Vec3d b, double x, double y) {
            return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
        };
        const double area = edge(v[0], v[1], v[2].x, v[2].y);
        if (!(area != 0)) return;
        const double scale = 1 / area;
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x) {
                const double a = edge(v[1], v[2], x + 0.5, y + 0.5) * scale;
                const double b = edge(v[2], v[0], x + 0.5, y + 0.5) * scale, c = 1 - a - b;
                if (!(a >= 0 && b >= 0 && c >= 0)) continue;
                const double nearness = a * v[0].z + b * v[1].z + c * v[2].z;
                Pixel& pixel = pixels_[static_cast<size_t>(y * kSize + x)];
                if (nearness > pixel.nearness) pixel = {nearness, (area > 0) != mirrored};
            }
    }

    uint64_t& tries_;
    std::vector<Vec3d> corners_;  ///< of the mesh that is drawn
    Vec3d eye_;
    ViewAxes axes_;
    double scale_;
    std::vector<Pixel> pixels_ = std::vector<Pixel>(size_t(kSize) * kSize);
};

Sides sides_from(const Scene& scene, const Extent& extent, const View& view, uint64_t& tries) {
    SidesPicture picture(framing_camera(scene, extent, ViewAxes(view.towards_camera)), tries);
    for (const Instance& i : scene.instances)
        if (const auto* id = std::get_if<MeshId>(&scene.shapes[index(i.shape)]))
            picture.add(scene.meshes[index(*id)], i.world_from_object);
    return picture.count();
}

bool is_large(const Scene& scene) {
    uint64_t count = 0;
    for (const Instance& i : scene.instances)
        if (const auto* id = std::get_if<MeshId>(&scene.shapes[index(i.shape)])) {
            const Mesh& mesh = scene.meshes[index(*id)];
            count += mesh.positions.size() + mesh.indices.size() / 3;
        }
    return count > kMostTrianglesAndVertices;
}

}  // namespace

View front_view(const Scene& scene) {
    constexpr View kUsual{kUsualView, 0};
    if (is_large(scene)) return kUsual;
    const Extent extent = extent_of(scene);
    uint64_t tries = kMostTries;
    const Sides usual = sides_from(scene, extent, kUsual, tries);
    if (usual.back == 0 || 4 * usual.back < usual.all()) return kUsual;
    View best = kUsual;
    int most = kPreferUsualHeight * usual.surplus();
    for (const auto& [view, preference] : candidates()) {
        const Sides sides = sides_from(scene, extent, view, tries);
        const bool fewer_backs = 2 * sides.back * usual.all() < usual.back * sides.all();
        if (fewer_backs && preference * sides.surplus() > most) most = preference * sides.surplus(), best = view;
    }
    return tries > 0 ? best : kUsual;
}

}  // namespace steradian
