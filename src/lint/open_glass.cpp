// Solid transparent bodies whose surface does not enclose them: what goes in never comes out as it should.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "lint/check.h"
#include "lint/pieces.h"
#include "lint/seams.h"
#include "lint/union_find.h"
#include "math/transform.h"

namespace steradian::lint_detail {
namespace {

/// Perfect refraction is made for single sheets (docs/conventions.md).
bool needs_a_body(const Scene& scene, MaterialId id) {
    const Material& material = scene.materials[index(id)];
    if (std::holds_alternative<RefractionMaterial>(material)) return false;
    if (const auto* mix = std::get_if<MixMaterial>(&material))
        return needs_a_body(scene, mix->first) || needs_a_body(scene, mix->second);
    return optics_of(scene, id).solid;
}

/// Seen from above, water fills what is below: its surface needs no bottom. By the share of its area that faces up.
constexpr double kLevel = 0.8;

/// The area of a surface as a vector, and its size.
struct Facing {
    Vec3d sum;
    double total = 0;

    void add(Vec3d n) {
        if (!std::isfinite(length(n))) return;
        sum = sum + n;
        total += length(n);
    }
    void add(const Facing& o) { sum = sum + o.sum, total += o.total; }
    bool is_level() const { return std::fabs(sum.y) > kLevel * total; }
};

class OpenGlass {
public:
    explicit OpenGlass(Check& check)
        : check_(check),
          scene_(check.scene),
          rounding_(rounding(check)),
          places_(rounding_),
          body_of_(scene_.instances.size()) {}

    void run() {
        for (uint32_t i = 0; i < scene_.instances.size(); ++i) {
            if (!needs_a_body(scene_, scene_.instances[i].material)) continue;
            if (std::holds_alternative<Disk>(shape(i)) && !facing(i).is_level()) sheet(i, "a disk");
            if (add_rims(i)) glass_.push_back(i);
        }
        if (glass_.empty() || !add_others()) return;
        const std::vector<Rim> open = open_rims(rims_);
        std::vector<Rim> of_glass;
        for (const Rim& rim : open)
            if (std::binary_search(glass_.begin(), glass_.end(), rim.object)) of_glass.push_back(rim);
        if (of_glass.empty()) return;
        join();
        for (const auto& [body, found] : holes_of(places_, of_glass, body_of_)) report(body, found);
    }

private:
    const Shape& shape(uint32_t i) const { return scene_.shapes[index(scene_.instances[i].shape)]; }

    /// What coordinates of the glass are rounded by, on their way into the world.
    static double rounding(const Check& check) {
        double most = 0;
        for (uint32_t i = 0; i < check.scene.instances.size(); ++i) {
            const Box& box = check.world.box(i);
            if (needs_a_body(check.scene, check.scene.instances[i].material) && !box.empty())
                most = max_of(most, max_of(lint_detail::reach(box.lo), lint_detail::reach(box.hi)));
        }
        return max_of(most * 0x1p-20, 1e-30);
    }

    Box grown(Box box) const {
        const Vec3d by{rounding_, rounding_, rounding_};
        return {box.lo - by, box.hi + by};
    }

    Facing facing(uint32_t i) const {
        Facing out;
        const uint64_t count = count_pieces(scene_, i);
        for (uint32_t k = 0; k < count; ++k)
            if (const auto p = piece(scene_, i, k)) out.add(cross((*p)[1] - (*p)[0], (*p)[2] - (*p)[0]));
        return out;
    }

    /// The loose edges of an object. False where it has none, or is a copy in the same place: they close nothing.
    bool add_rims(uint32_t i) {
        const size_t before = rims_.size();
        const Affine& place = scene_.instances[i].world_from_object;
        const auto add = [&](Vec3d a, Vec3d b) {
            rims_.push_back(
                {places_.number_of(transform_point(place, a)), places_.number_of(transform_point(place, b)), i});
        };
        if (const auto* r = std::get_if<Rectangle>(&shape(i))) {
            const Vec3d c = r->center, u = r->half_u, v = r->half_v;
            if (!rectangles_.insert(places_.number_of(transform_point(place, c))).second) return false;
            add(c - u - v, c + u - v), add(c + u - v, c + u + v), add(c + u + v, c - u + v), add(c - u + v, c - u - v);
        } else if (const auto* id = std::get_if<MeshId>(&shape(i))) {
            const Mesh& mesh = scene_.meshes[index(*id)];
            if (!meshes_.emplace(*id, place.m).second) return false;
            const std::vector<LooseEdge>& loose = loose_edges(*id);
            if (rims_.size() + loose.size() > kMostRims) return too_many_ = true, false;
            for (const LooseEdge& edge : loose) add(Vec3d(mesh.positions[edge.a]), Vec3d(mesh.positions[edge.b]));
        }
        return rims_.size() > before;
    }
    const std::vector<LooseEdge>& loose_edges(MeshId id) {
        const auto [known, added] = loose_.try_emplace(id);
        if (added) known->second = check_.bodies.topology(id)->loose;
        return known->second;
    }

    /// What else may have something on the edges: a lid of another material. False where it would take too long.
    bool add_others() {
        for (uint32_t k = 0; k < scene_.instances.size() && !too_many_; ++k) {
            if (std::binary_search(glass_.begin(), glass_.end(), k)) continue;
            const bool touches = std::any_of(glass_.begin(), glass_.end(), [&](uint32_t i) {
                ++spent_;
                return check_.world.box(k).touches(grown(check_.world.box(i)));
            });
            if (touches) spent_ += count_pieces(scene_, k);
            if (spent_ > kBudget) return false;
            if (touches) add_rims(k);
        }
        return !too_many_;
    }

    /// Pieces of glass that share an edge are one body: it has the number of its first piece.
    void join() {
        std::map<std::pair<uint32_t, uint32_t>, uint32_t> on_edge;
        UnionFind bodies(scene_.instances.size());
        for (const Rim& rim : rims_) {
            if (!std::binary_search(glass_.begin(), glass_.end(), rim.object)) continue;
            const auto edge = std::minmax(rim.from, rim.to);
            bodies.join(on_edge.try_emplace(edge, rim.object).first->second, rim.object);
        }
        for (const uint32_t i : glass_) body_of_[i] = bodies.find(i), pieces_[body_of_[i]].push_back(i);
    }

    void report(uint32_t body, const OpenBody& found) {
        Facing all;
        for (const uint32_t i : pieces_[body]) all.add(facing(i));
        if (all.is_level()) return;
        const size_t others = pieces_[body].size() - 1;
        const uint32_t i = found.first;
        if (others == 0 && std::holds_alternative<Rectangle>(shape(i))) return sheet(i, "a rectangle");
        // The first instance stands for all of a mesh.
        if (const auto* id = std::get_if<MeshId>(&shape(i)); id && !reported_.insert(*id).second) return;
        uint64_t edges = 0;
        for (const Hole& hole : found.holes) edges += hole.edges;
        const Vec3d a = found.holes[0].from, b = found.holes[0].to;
        const std::string more = others == 0   ? ""
                                 : others == 1 ? " and another piece"
                                               : fmt::format(" and {} other pieces", others);
        add(i, fmt::format(
                   "{}{} of solid glass ({}) {} open: {} with {} edges, the first from ({:.5g}, {:.5g}, {:.5g}) "
                   "to ({:.5g}, {:.5g}, {:.5g})",
                   check_.object(i), more, check_.material(scene_.instances[i].material), others == 0 ? "is" : "are",
                   found.holes.size() == 1 ? "1 hole" : fmt::format("{} holes", found.holes.size()), edges, a.x, a.y,
                   a.z, b.x, b.y, b.z));
    }
    void sheet(uint32_t i, const char* kind) {
        add(i, fmt::format("{} is {} of solid glass ({}): what passes stays inside for ever", check_.object(i), kind,
                           check_.material(scene_.instances[i].material)));
    }
    void add(uint32_t i, std::string message) {
        check_.out.add(Rule::open_glass, Element{ElementKind::instance, i}, std::move(message),
                       "close it, or make the sheet 'thin_glass' (open_pbr: geometry_thin_walled)");
    }

    /// Triangles of neighbours and pairs of boxes in all, and loose edges: about a second.
    static constexpr uint64_t kBudget = uint64_t(1) << 24;
    static constexpr size_t kMostRims = size_t(1) << 17;

    Check& check_;
    const Scene& scene_;
    double rounding_;
    Places places_;
    std::vector<Rim> rims_;
    std::vector<uint32_t> glass_;                       ///< instances with loose edges, ascending
    std::vector<uint32_t> body_of_;                     ///< of each instance in glass_
    std::map<uint32_t, std::vector<uint32_t>> pieces_;  ///< of each body
    std::map<MeshId, std::vector<LooseEdge>> loose_;
    std::set<uint32_t> rectangles_;  ///< places of their middles
    std::set<std::pair<MeshId, decltype(Affine::m)>> meshes_;
    std::set<MeshId> reported_;
    uint64_t spent_ = 0;
    bool too_many_ = false;
};

}  // namespace

void check_open_glass(Check& check) {
    if (check.out.wants(Rule::open_glass)) OpenGlass(check).run();
}

}  // namespace steradian::lint_detail
