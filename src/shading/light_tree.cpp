#include "shading/light_tree.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "math/elementary.h"

namespace steradian {
namespace {

constexpr double kPiD = std::numbers::pi;
constexpr int kBins = 12;
/// After so many divisions lights are halved by count, so that no way down is longer than kDeepest + 31 steps.
constexpr uint32_t kDeepest = 32;
constexpr size_t kLongestWay = kDeepest + 31;

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

void FourLights::set(int lane, const LightBounds& b, double total_strength) {
    constexpr double kLeastAngle = 0.01;  // much more than kCosineSlack leaves open
    const Vec3 c = static_cast<Vec3>(b.lo * 0.5 + b.hi * 0.5), direction = static_cast<Vec3>(b.cone.axis);
    center[0][lane] = c.x, center[1][lane] = c.y, center[2][lane] = c.z;
    const Vec3d reach{max_of(b.hi.x - c.x, c.x - b.lo.x), max_of(b.hi.y - c.y, c.y - b.lo.y),
                      max_of(b.hi.z - c.z, c.z - b.lo.z)};
    radius2[lane] = static_cast<float>(clamp_to(dot(reach, reach) * (1 + 1e-5), 1e-30, 1e37));
    axis[0][lane] = direction.x, axis[1][lane] = direction.y, axis[2][lane] = direction.z;
    const double theta_e = max_of(b.cone.theta_e, kLeastAngle);
    const double theta_o = b.cone.theta_o + theta_e > kPiD - kLeastAngle ? kPiD : b.cone.theta_o;
    cos_o[lane] = static_cast<float>(math::cos(theta_o));
    sin_o[lane] = static_cast<float>(math::sin(theta_o));
    cos_e[lane] = static_cast<float>(math::cos(theta_e));
    strength[lane] = static_cast<float>(clamp_to(b.strength / total_strength, 1e-30, 1.0));
    two_sided[lane] = b.cone.two_sided ? 1 : 0;
}

class LightTreeBuilder {
public:
    LightTreeBuilder(std::span<const LightBounds> lights, LightTree& out) : lights_(lights), out_(out) {}

    void run() {
        for (uint32_t i = 0; i < lights_.size(); ++i)
            if (lights_[i].strength > 0) order_.push_back(i);
        if (order_.empty()) return;
        out_.places_.assign(lights_.size(), {});
        scratch_.resize(order_.size());
        const Range all{0, static_cast<uint32_t>(order_.size()), 0};
        const LightBounds whole = bounds(all);
        total_ = whole.strength;
        out_.whole_.set(0, whole, total_);
        build(all, {});
        out_.nodes_.shrink_to_fit();
        out_.parents_.shrink_to_fit();
    }

private:
    struct Range {
        uint32_t begin, end;
        uint32_t depth;  ///< divisions above it
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
    uint32_t divide(Range r) {
        if (r.depth < kDeepest && r.size() > 2) {
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

    /// The range as the children of one node: the largest is divided again as long as there is room.
    std::vector<Range> children(Range r) {
        std::vector<Range> out{r};
        while (out.size() < LightNode::kWidth) {
            const auto largest =
                std::max_element(out.begin(), out.end(), [](Range a, Range b) { return a.size() < b.size(); });
            if (largest->size() == 1) break;
            const Range whole = *largest;
            const uint32_t middle = divide(whole);
            *largest = {whole.begin, middle, whole.depth + 1};
            out.insert(largest + 1, {middle, whole.end, whole.depth + 1});
        }
        return out;
    }

    uint32_t build(Range r, LightTree::Place parent) {
        const auto node = static_cast<uint32_t>(out_.nodes_.size());
        out_.nodes_.emplace_back();
        out_.parents_.push_back(parent);
        const std::vector<Range> ranges = children(r);
        for (uint32_t k = 0; k < ranges.size(); ++k) {
            const uint32_t count = ranges[k].size(), light = order_[ranges[k].begin];
            out_.nodes_[node].children[k / 4].set(static_cast<int>(k % 4), bounds(ranges[k]), total_);
            out_.nodes_[node].lights[k] = count;
            const uint32_t child = count == 1 ? light : build(ranges[k], {node, k});
            out_.nodes_[node].child[k] = child;
            if (count == 1) out_.places_[light] = {node, k};
        }
        return node;
    }

    std::span<const LightBounds> lights_;
    LightTree& out_;
    std::vector<uint32_t> order_, scratch_;
    double total_ = 0;
};

LightTree::LightTree(std::span<const LightBounds> lights) { LightTreeBuilder(lights, *this).run(); }

namespace {

void prefetch(const LightNode& node) {
    const auto* at = reinterpret_cast<const char*>(&node);
    for (size_t i = 0; i < sizeof node; i += 64) __builtin_prefetch(at + i);
}

/// How a node's children divide its values: child k has those from end[k - 1] (0 for the first) to end[k].
struct Runs {
    uint64_t end[LightNode::kWidth];
    uint64_t begin(uint32_t k) const { return k > 0 ? end[k - 1] : 0; }
    uint64_t values(uint32_t k) const { return end[k] - begin(k); }
};

/// False where no child counts. Without branches: none of them could be predicted.
bool divide(const LightNode& node, const LightReceiver& at, uint64_t values, Runs& out) {
    double importance[LightNode::kWidth];
    for (int k = 0; k < LightNode::kWidth; k += 4) light_importance(node.children[k / 4], at, importance + k);
    // Up to each child, itself included; of either half by itself first, so that fewer sums wait for each other.
    double sum[LightNode::kWidth];
    constexpr int kHalf = LightNode::kWidth / 2;
    for (int k = 0; k < kHalf; ++k) {
        sum[k] = importance[k] + (k > 0 ? sum[k - 1] : 0);
        sum[kHalf + k] = importance[kHalf + k] + (k > 0 ? sum[kHalf + k - 1] : 0);
    }
    for (int k = kHalf; k < LightNode::kWidth; ++k) sum[k] += sum[kHalf - 1];
    const double total = sum[LightNode::kWidth - 1];
    uint64_t lights = 0;
    for (int k = 0; k < LightNode::kWidth; ++k) out.end[k] = lights += node.lights[k] * uint64_t(importance[k] > 0);
    if (!(total > 0)) return false;
    const auto rest = static_cast<double>(values - lights);
    // A little more than its share, so that the last one that counts has all of the rest in spite of rounding.
    const double per_importance = rest / total * (1 + 0x1p-50);
    for (int k = 0; k < LightNode::kWidth; ++k)
        out.end[k] += static_cast<uint64_t>(static_cast<int64_t>(min_of(sum[k] * per_importance, rest)));
    return true;
}

/// The way of one choice down its tree.
class Descent {
public:
    Descent() = default;  // of no meaning, and for nothing
    explicit Descent(const LightQuery& query)
        : nodes_(query.tree->nodes().data()), node_(nodes_), x_(query.choice), values_(query.values) {
        prefetch(*node_);
    }

    /// One node further. False at the end, where the query is answered if it found a light.
    bool step(LightQuery& query) {
        Runs runs;
        if (!divide(*node_, query.at, values_, runs)) return false;
        uint32_t k = 0;
        for (int i = 0; i + 1 < LightNode::kWidth; ++i) k += x_ >= runs.end[i];
        x_ -= runs.begin(k);
        values_ = runs.values(k);
        const uint32_t child = node_->child[k];
        if (node_->lights[k] == 1) {
            query.chosen = ChosenLight{child, static_cast<double>(values_) * 0x1p-32};
            return false;
        }
        node_ = nodes_ + child;
        prefetch(*node_);
        return true;
    }

private:
    const LightNode *nodes_, *node_;
    uint64_t x_, values_;
};

}  // namespace

bool LightTree::reaches(const LightReceiver& at) const noexcept {
    double importance[4];
    light_importance(whole_, at, importance);
    return importance[0] > 0;
}

std::optional<ChosenLight> LightTree::choose(const LightReceiver& at, uint32_t choice, uint64_t values) const noexcept {
    if (empty()) return std::nullopt;
    LightQuery query{this, at, choice, values, {}};
    Descent way(query);
    while (way.step(query)) {
    }
    return query.chosen;
}

void LightTree::answer(std::span<LightQuery> queries) noexcept {
    constexpr size_t kTogether = 16;
    Descent ways[kTogether];
    uint32_t of[kTogether];
    for (; !queries.empty(); queries = queries.subspan(std::min(kTogether, queries.size()))) {
        size_t under_way = 0;
        for (size_t i = 0; i < std::min(kTogether, queries.size()); ++i) {
            if (!queries[i].tree || queries[i].tree->empty()) continue;
            of[under_way] = static_cast<uint32_t>(i);
            ways[under_way++] = Descent(queries[i]);
        }
        while (under_way > 0) {
            size_t left = 0;
            for (size_t i = 0; i < under_way; ++i) {
                if (!ways[i].step(queries[of[i]])) continue;
                of[left] = of[i];
                ways[left++] = ways[i];
            }
            under_way = left;
        }
    }
}

double LightTree::probability(const LightReceiver& at, uint32_t light, uint64_t values) const noexcept {
    if (light >= places_.size() || places_[light].node == kNowhere) return 0;
    std::array<Place, kLongestWay> way;
    size_t steps = 0;
    for (Place place = places_[light]; place.node != kNowhere; place = parents_[place.node]) {
        prefetch(nodes_[place.node]);
        way[steps++] = place;
    }
    while (steps-- > 0 && values > 0) {
        const Place place = way[steps];
        Runs runs;
        if (!divide(nodes_[place.node], at, values, runs)) return 0;
        values = runs.values(place.child);
    }
    return static_cast<double>(values) * 0x1p-32;
}

}  // namespace steradian
