#include "accel/margin.h"

#include <algorithm>
#include <cmath>

namespace steradian {
namespace {

/// Elements of transforms (but for translations) and coordinates with which nothing over- or underflows.
constexpr double kMaxElement = 0x1p20, kMaxReach = 0x1p40;
/// Margins are at most this part of the box.
constexpr float kMaxMarginShare = 0x1p-7f;
/// What is lost where numbers become denormal, mapped by A, and more.
constexpr double kLeastMargin = 0x1p-50;

double largest_element(const Affine& a) {
    double most = 0;
    for (const auto& row : a.m)
        for (int axis = 0; axis < 3; ++axis) most = max_of(most, std::fabs(row[axis]));
    return most;
}

/// |a| |b| as affine transforms: the sums of magnitudes that their product runs into.
Affine magnitudes(const Affine& a, const Affine& b) {
    Affine out;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column) {
            double sum = column == 3 ? std::fabs(a.m[row][3]) : 0;
            for (int k = 0; k < 3; ++k) sum += std::fabs(a.m[row][k]) * std::fabs(b.m[k][column]);
            out.m[row][column] = sum;
        }
    return out;
}

/// What a b is off from the identity by, at most, element by element.
Affine residual(const Affine& a, const Affine& b) {
    Affine out = magnitudes(a, b);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column) {
            double sum = column == 3 ? a.m[row][3] : 0;
            for (int k = 0; k < 3; ++k) sum += a.m[row][k] * b.m[k][column];
            out.m[row][column] = std::fabs(sum - (row == column ? 1 : 0)) + 0x1p-48 * (out.m[row][column] + 1);
        }
    return out;
}

Box grown(const Box& box, Vec3 by) {
    Box out;
    for (int axis = 0; axis < 3; ++axis) {
        out.lo[axis] = below(double(box.lo[axis]) - by[axis]);
        out.hi[axis] = above(double(box.hi[axis]) + by[axis]);
    }
    return out;
}

}  // namespace

Box near_box(const Box& scene) {
    if (scene.empty()) return scene;
    const float reach = kNearReach * max_component(scene.hi - scene.lo);
    return grown(scene, {reach, reach, reach});
}

std::optional<Vec3> rounding_margin(const PlacedGeometry& placed, const Affine& world_from_object, const Box& near) {
    const Affine &a = world_from_object, &b = placed.object_from_world;
    const Box inner = transformed_bounds(b, near);
    double far_out = 0, width[3], magnitude[3];
    for (int axis = 0; axis < 3; ++axis) {
        width[axis] = double(inner.hi[axis]) - inner.lo[axis];
        magnitude[axis] = max_of(std::fabs(inner.lo[axis]), std::fabs(inner.hi[axis]));
        far_out = max_of(far_out, double(max_of(std::fabs(near.lo[axis]), std::fabs(near.hi[axis]))));
    }
    if (!(max_of(largest_element(a), largest_element(b)) <= kMaxElement && far_out <= kMaxReach)) return std::nullopt;
    double reach = 0;  // |t d|, at most
    for (const auto& row : a.m) {
        double sum = 0;
        for (int k = 0; k < 3; ++k) sum += std::fabs(row[k]) * width[k];
        reach = max_of(reach, 2 * sum);
    }
    const double most = far_out + reach;  // |o + t d|, and |o| + |t d|
    double inside[3];
    for (int axis = 0; axis < 3; ++axis) {
        double sum = std::fabs(b.m[axis][3]);
        for (int k = 0; k < 3; ++k) sum += std::fabs(b.m[axis][k]) * most;
        inside[axis] = 0x1.6p-20 * width[axis] + 0x1p-23 * magnitude[axis] + 0x1p-48 * sum;
    }
    const Affine off = residual(a, b);
    Vec3 margin;
    for (int axis = 0; axis < 3; ++axis) {
        double of_product = 0, sum = 0;
        for (int k = 0; k < 3; ++k) sum += std::fabs(a.m[axis][k]) * inside[k], of_product += off.m[axis][k];
        if (!(of_product <= 0x1p-10)) return std::nullopt;
        sum += of_product * most + off.m[axis][3] + 0x1p-70 * reach + kLeastMargin;
        margin[axis] = above(sum + 0x1p-22 * (double(near.hi[axis]) - near.lo[axis]));
    }
    const float limit = kMaxMarginShare * max_component(placed.world.hi - placed.world.lo);
    if (!(max_component(margin) <= limit)) return std::nullopt;
    return margin;
}

void Placement::add_margins() {
    near = near_box(scene);
    margins.clear();
    margins.reserve(placed.size());
    for (size_t i = 0; i < placed.size(); ++i) {
        PlacedGeometry& p = placed[i];
        margins.push_back(Vec3{});
        if (p.identity || p.world.empty()) continue;
        margins[i] = rounding_margin(p, instances[i].world_from_object, near);
        if (margins[i]) p.world = grown(p.world, *margins[i]);
    }
}

Box Placement::world_box(uint32_t instance, const Box& part) const {
    const PlacedGeometry& p = placed[instance];
    if (p.identity) return part;
    if (!margins[instance]) return p.world;
    Box box = grown(transformed_bounds(instances[instance].world_from_object, part), *margins[instance]);
    // A part's box may be a little larger than the part (compact nodes), but no hit is outside of the instance's.
    for (int axis = 0; axis < 3; ++axis) {
        box.lo[axis] = max_of(box.lo[axis], p.world.lo[axis]);
        box.hi[axis] = min_of(box.hi[axis], p.world.hi[axis]);
    }
    return box;
}

}  // namespace steradian
