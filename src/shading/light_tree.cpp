#include "shading/light_tree.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "math/elementary.h"

namespace steradian {
namespace {

constexpr double kPiD = std::numbers::pi;
constexpr uint64_t kNoTrail = ~uint64_t{0};  ///< of lights that are not in the tree
constexpr int kBins = 12;
/// From here on nodes are halved by count, so that no trail is longer than 32 + 31 steps.
constexpr uint32_t kDeepest = 32;

double clamped_acos(double x) { return math::acos(clamp_to(x, -1.0, 1.0)); }

/// The smallest cone around two (algorithm 1 of the paper). The axes' weights on the great circle between them follow
/// from the sines of the angles.
DirectionCone unite(const DirectionCone& p, const DirectionCone& q) {
    const bool p_is_wider = p.theta_o > q.theta_o;
    const DirectionCone &a = p_is_wider ? p : q, &b = p_is_wider ? q : p;
    DirectionCone out = a;
    out.theta_e = max_of(a.theta_e, b.theta_e);
    out.two_sided = a.two_sided || b.two_sided;
    if (a.theta_o >= kPiD) return out;
    const double between = clamped_acos(dot(a.axis, b.axis));
    if (min_of(between + b.theta_o, kPiD) <= a.theta_o) return out;
    out.theta_o = (a.theta_o + between + b.theta_o) / 2;
    const double turn = out.theta_o - a.theta_o;
    const Vec3d aside = b.axis - a.axis * dot(a.axis, b.axis);
    if (out.theta_o >= kPiD || !(length(aside) > 1e-9)) {
        out.theta_o = kPiD;
        return out;
    }
    out.axis = normalize(a.axis * math::cos(turn) + normalize(aside) * math::sin(turn));
    return out;
}

/// M_Ω of the paper (equation 1): the directions into which a cone shines, weighed by the cosine beyond θ_o.
double orientation_measure(const DirectionCone& cone) {
    const double o = cone.theta_o, w = min_of(o + cone.theta_e, kPiD);
    const double sin_o = math::sin(o), cos_o = math::cos(o);
    return 2 * kPiD * (1 - cos_o) + kPiD / 2 * (2 * w * sin_o - math::cos(o - 2 * w) - 2 * o * sin_o + cos_o);
}

double surface(const LightBounds& b) {
    const Vec3d d = b.hi - b.lo;
    return 2 * (d.x * d.y + d.y * d.z + d.z * d.x);
}

double cost(const LightBounds& b) { return b.strength * orientation_measure(b.cone) * surface(b); }

double centre(const LightBounds& b, int axis) { return b.lo[axis] / 2 + b.hi[axis] / 2; }

}  // namespace

LightBounds unite(const LightBounds& a, const LightBounds& b) {
    if (!(a.strength > 0)) return b;
    if (!(b.strength > 0)) return a;
    return {{min_of(a.lo.x, b.lo.x), min_of(a.lo.y, b.lo.y), min_of(a.lo.z, b.lo.z)},
            {max_of(a.hi.x, b.hi.x), max_of(a.hi.y, b.hi.y), max_of(a.hi.z, b.hi.z)},
            unite(a.cone, b.cone),
            a.strength + b.strength};
}

LightNode LightNode::from(const LightBounds& b, double total_strength) {
    constexpr double kLeastAngle = 0.01;  // much more than kCosineSlack leaves open
    LightNode out;
    out.center = static_cast<Vec3>(b.lo * 0.5 + b.hi * 0.5);
    const Vec3d c = out.center;
    const Vec3d reach{max_of(b.hi.x - c.x, c.x - b.lo.x), max_of(b.hi.y - c.y, c.y - b.lo.y),
                      max_of(b.hi.z - c.z, c.z - b.lo.z)};
    out.radius2 = static_cast<float>(dot(reach, reach) * (1 + 1e-5));
    out.axis = static_cast<Vec3>(b.cone.axis);
    const double theta_e = max_of(b.cone.theta_e, kLeastAngle);
    const double theta_o = b.cone.theta_o + theta_e > kPiD - kLeastAngle ? kPiD : b.cone.theta_o;
    out.cos_o = static_cast<float>(math::cos(theta_o));
    out.sin_o = static_cast<float>(math::sin(theta_o));
    out.cos_e = static_cast<float>(math::cos(theta_e));
    out.strength = static_cast<float>(clamp_to(b.strength / total_strength, 1e-30, 1.0));
    out.two_sided = b.cone.two_sided;
    return out;
}

class LightTreeBuilder {
public:
    LightTreeBuilder(std::span<const LightBounds> lights, LightTree& out) : lights_(lights), out_(out) {}

    void run() {
        for (uint32_t i = 0; i < lights_.size(); ++i)
            if (lights_[i].strength > 0) order_.push_back(i);
        if (order_.empty()) return;
        out_.trails_.assign(lights_.size(), kNoTrail);
        out_.nodes_.reserve(2 * order_.size() - 1);
        scratch_.resize(order_.size());
        const Range all{0, static_cast<uint32_t>(order_.size())};
        const LightBounds whole = bounds(all);
        total_ = whole.strength;
        out_.nodes_.push_back(LightNode::from(whole, total_));
        build(0, all, 0, 0);
    }

private:
    struct Range {
        uint32_t begin, end;
        uint32_t size() const { return end - begin; }
    };
    struct Split {
        double cost = 1e300;
        int axis = -1, bin = 0;
    };
    struct Centres {
        double lo[3], hi[3];
        int bin(const LightBounds& b, int axis) const {
            const double x = (centre(b, axis) - lo[axis]) / (hi[axis] - lo[axis]);
            return static_cast<int>(clamp_to(x * kBins, 0.0, kBins - 1.0));
        }
    };

    LightBounds bounds(Range r) const {
        LightBounds out;
        for (uint32_t i = r.begin; i < r.end; ++i) out = unite(out, lights_[order_[i]]);
        return out;
    }

    Centres centres(Range r) const {
        Centres out{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
        for (uint32_t i = r.begin; i < r.end; ++i)
            for (int axis = 0; axis < 3; ++axis) {
                const double c = centre(lights_[order_[i]], axis);
                out.lo[axis] = min_of(out.lo[axis], c);
                out.hi[axis] = max_of(out.hi[axis], c);
            }
        return out;
    }

    /// The cheapest division of the bins of one axis (equation 2 of the paper; long boxes are cut across by k_r).
    void try_axis(Range r, const Centres& c, int axis, double longest, Split& best) const {
        const double extent = c.hi[axis] - c.lo[axis];
        if (!(extent > 0)) return;
        std::array<LightBounds, kBins> bins{};
        for (uint32_t i = r.begin; i < r.end; ++i) {
            const LightBounds& light = lights_[order_[i]];
            LightBounds& bin = bins[static_cast<size_t>(c.bin(light, axis))];
            bin = unite(bin, light);
        }
        std::array<double, kBins> above{};
        LightBounds sum;
        for (size_t b = kBins - 1; b > 0; --b) {
            sum = unite(sum, bins[b]);
            above[b - 1] = sum.strength > 0 ? cost(sum) : -1;
        }
        sum = {};
        for (size_t b = 0; b + 1 < kBins; ++b) {
            sum = unite(sum, bins[b]);
            if (!(sum.strength > 0) || above[b] < 0) continue;
            const double total = (cost(sum) + above[b]) * (longest / extent);
            if (total < best.cost) best = {total, axis, static_cast<int>(b)};
        }
    }

    /// Where the second half of the range begins, which is put in order.
    uint32_t divide(Range r, uint32_t depth) {
        if (depth < kDeepest && r.size() > 2) {
            const Centres c = centres(r);
            double longest = 0;
            for (int axis = 0; axis < 3; ++axis) longest = max_of(longest, c.hi[axis] - c.lo[axis]);
            Split best;
            for (int axis = 0; axis < 3; ++axis) try_axis(r, c, axis, longest, best);
            if (best.axis >= 0) return partition(r, c, best);
        }
        return r.begin + r.size() / 2;
    }

    /// Stable, so that lights stay in the order of their indices.
    uint32_t partition(Range r, const Centres& c, const Split& split) {
        uint32_t below = r.begin, above = 0;
        for (uint32_t i = r.begin; i < r.end; ++i) {
            const uint32_t light = order_[i];
            if (c.bin(lights_[light], split.axis) <= split.bin)
                order_[below++] = light;
            else
                scratch_[above++] = light;
        }
        std::copy_n(scratch_.begin(), above, order_.begin() + below);
        return below;
    }

    void build(uint32_t node, Range r, uint32_t depth, uint64_t trail) {
        out_.nodes_[node].lights = r.size();
        if (r.size() == 1) {
            out_.nodes_[node].child = order_[r.begin];
            out_.trails_[order_[r.begin]] = trail;
            return;
        }
        const uint32_t middle = divide(r, depth);
        const Range halves[2] = {{r.begin, middle}, {middle, r.end}};
        const auto child = static_cast<uint32_t>(out_.nodes_.size());
        out_.nodes_[node].child = child;
        for (const Range& half : halves) out_.nodes_.push_back(LightNode::from(bounds(half), total_));
        for (uint32_t k = 0; k < 2; ++k) build(child + k, halves[k], depth + 1, trail | uint64_t{k} << depth);
    }

    std::span<const LightBounds> lights_;
    LightTree& out_;
    std::vector<uint32_t> order_, scratch_;
    double total_ = 0;
};

LightTree::LightTree(std::span<const LightBounds> lights) { LightTreeBuilder(lights, *this).run(); }

namespace {

/// Of both, since the next one is known only after much arithmetic, and lies far away in a large tree.
inline void prefetch_children(const LightNode* nodes, const LightNode* children) {
    for (int k = 0; k < 2; ++k) {
        if (children[k].lights == 1) continue;
        const auto* next = reinterpret_cast<const char*>(nodes + children[k].child);
        __builtin_prefetch(next);
        __builtin_prefetch(next + 64);
    }
}

/// How many of a node's `values` its first child has; nothing where neither counts.
std::optional<uint64_t> share_of_first(const LightNode* children, const LightReceiver& at, uint64_t values) {
    const LightImportance a = light_importance(children[0], at), b = light_importance(children[1], at);
    if (a.numerator == 0 && b.numerator == 0) return std::nullopt;
    if (b.numerator == 0) return values;
    if (a.numerator == 0) return 0;
    const double to_a = a.numerator * b.distance2, to_b = b.numerator * a.distance2;
    const auto share = static_cast<uint64_t>(static_cast<double>(values) * (to_a / (to_a + to_b)));
    return clamp_to<uint64_t>(share, children[0].lights, values - children[1].lights);
}

}  // namespace

std::optional<ChosenLight> LightTree::choose(const LightReceiver& at, uint32_t choice, uint64_t values) const noexcept {
    if (!reaches(at)) return std::nullopt;
    const LightNode* node = nodes_.data();
    uint64_t x = choice;
    while (node->lights > 1) {
        const LightNode* children = nodes_.data() + node->child;
        prefetch_children(nodes_.data(), children);
        const std::optional<uint64_t> first = share_of_first(children, at, values);
        if (!first) return std::nullopt;
        const bool second = x >= *first;
        x -= second ? *first : 0;
        values = second ? values - *first : *first;
        node = children + second;
    }
    return ChosenLight{node->child, static_cast<double>(values) * 0x1p-32};
}

double LightTree::probability(const LightReceiver& at, uint32_t light, uint64_t values) const noexcept {
    if (light >= trails_.size() || trails_[light] == kNoTrail || !reaches(at)) return 0;
    const LightNode* node = nodes_.data();
    for (uint64_t trail = trails_[light]; node->lights > 1 && values > 0; trail >>= 1) {
        const LightNode* children = nodes_.data() + node->child;
        prefetch_children(nodes_.data(), children);
        const std::optional<uint64_t> first = share_of_first(children, at, values);
        if (!first) return 0;
        const uint64_t second = trail & 1;
        values = second ? values - *first : *first;
        node = children + second;
    }
    return static_cast<double>(values) * 0x1p-32;
}

}  // namespace steradian
