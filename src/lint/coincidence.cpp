// Triangles of different objects that have the same vertices: which one is seen, and how often it counts, is an
// accident.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

#include "lint/check.h"
#include "lint/place_hash.h"
#include "math/ray.h"
#include "math/transform.h"

namespace steradian::lint_detail {
namespace {

/// So many placed triangles are compared, at 16 bytes each; larger scenes are left alone.
constexpr uint64_t kMostTriangles = uint64_t(1) << 23;

struct Placed {
    uint64_t hash;
    uint32_t instance, triangle;
};

using Corners = std::array<Vec3, 3>;

bool less(Vec3 a, Vec3 b) { return std::tuple(a.x, a.y, a.z) < std::tuple(b.x, b.y, b.z); }

class Coincidence {
public:
    explicit Coincidence(Check& check) : check_(check), scene_(check.scene) {}

    void run() {
        if (!collect()) return;
        std::sort(all_.begin(), all_.end(), [](const Placed& a, const Placed& b) {
            return std::tuple(a.hash, a.instance, a.triangle) < std::tuple(b.hash, b.instance, b.triangle);
        });
        for (size_t i = 1; i < all_.size(); ++i)
            if (all_[i].hash == all_[i - 1].hash && all_[i].instance != all_[i - 1].instance)
                compare(all_[i - 1], all_[i]);
        for (const auto& [pair, found] : pairs_) report(pair.first, pair.second, found);
    }

private:
    struct Found {
        uint64_t count = 0;
        uint32_t triangle = 0;  ///< the first one, of the first object
    };

    /// As they are placed, rounded once. False where there is too much.
    bool collect() {
        uint64_t total = 0;
        for (uint32_t i = 0; i < scene_.instances.size(); ++i)
            if (const Mesh* mesh = check_.world.mesh_of(i)) total += mesh->indices.size() / 3;
        if (total > kMostTriangles) return false;
        for (uint32_t i = 0; i < scene_.instances.size(); ++i) {
            const Mesh* mesh = touches_another(i) ? check_.world.mesh_of(i) : nullptr;
            for (uint32_t t = 0; mesh && 3 * size_t(t) + 2 < mesh->indices.size(); ++t)
                if (Corners c = corners(i, t); c[0] != c[1] && c[1] != c[2] && c[2] != c[0]) {
                    std::sort(c.begin(), c.end(), less);
                    all_.push_back({place_hash(c), i, t});
                }
        }
        return true;
    }
    /// By a quick look: few scenes have so many objects that all pairs take long.
    bool touches_another(uint32_t i) const {
        constexpr size_t kMostPairs = 2000;
        const size_t count = scene_.instances.size();
        if (count > kMostPairs) return true;
        for (uint32_t k = 0; k < count; ++k)
            if (k != i && check_.world.mesh_of(k) && check_.world.box(k).touches(check_.world.box(i))) return true;
        return false;
    }

    Corners corners(uint32_t instance, uint32_t triangle) const {
        const Mesh& mesh = *check_.world.mesh_of(instance);
        const Affine& place = scene_.instances[instance].world_from_object;
        Corners out;
        for (size_t k = 0; k < 3; ++k) {
            const Vec3 p = mesh.positions[mesh.indices[3 * size_t(triangle) + k]];
            if (!usable_position(p)) return {};
            out[k] = Vec3(transform_point(place, p));
        }
        return out;
    }

    static bool same_places(Corners a, Corners b) {
        std::sort(a.begin(), a.end(), less), std::sort(b.begin(), b.end(), less);
        return a == b;
    }
    static bool face_alike(const Corners& a, const Corners& b) {
        const auto normal = [](const Corners& c) {
            return cross(Vec3d(c[1]) - Vec3d(c[0]), Vec3d(c[2]) - Vec3d(c[0]));
        };
        return dot(normal(a), normal(b)) > 0;
    }

    /// Whether the picture shows it: two equal opaque surfaces look like one, and so do the two sides of a card.
    void compare(const Placed& a, const Placed& b) {
        const MaterialId first = scene_.instances[a.instance].material, second = scene_.instances[b.instance].material;
        const Corners ca = corners(a.instance, a.triangle), cb = corners(b.instance, b.triangle);
        if (ordered(scene_, first, second) || !same_places(ca, cb)) return;
        const bool shines = check_.world.emits(a.instance) || check_.world.emits(b.instance);
        const bool matters = first != second || shines || (!optics_of(scene_, first).opaque && face_alike(ca, cb));
        if (!matters) return;
        Found& found = pairs_[{a.instance, b.instance}];
        if (found.count++ == 0 || a.triangle < found.triangle) found.triangle = a.triangle;
    }

    void report(uint32_t a, uint32_t b, const Found& found) {
        const bool same = scene_.instances[a].material == scene_.instances[b].material;
        check_.out.add(Rule::coincident_surfaces, Element{ElementKind::instance, b},
                       fmt::format("{} and {} have {} in the same place: {}", check_.object(a), check_.object(b),
                                   found.count == 1 ? fmt::format("triangle {}", found.triangle)
                                                    : fmt::format("{} triangles", found.count),
                                   same ? "light passes or is sent twice" : "which of them is seen is an accident"),
                       "leave one of them out, or move it");
    }

    Check& check_;
    const Scene& scene_;
    std::vector<Placed> all_;
    std::map<std::pair<uint32_t, uint32_t>, Found> pairs_;
};

}  // namespace

void check_coincidence(Check& check) {
    if (check.out.wants(Rule::coincident_surfaces)) Coincidence(check).run();
}

}  // namespace steradian::lint_detail
