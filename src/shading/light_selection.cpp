#include "shading/light_selection.h"

#include <algorithm>

#include "math/elementary.h"
#include "scene/intensity_profile.h"
#include "shading/light/mesh_emitter.h"
#include "shading/shading_scene.h"

namespace steradian {
namespace {

double mean(Rgb c) { return (double(c.r) + c.g + c.b) / 3; }

LightBounds at_point(Vec3 p, double strength) { return {p, p, {{0, 0, 1}, std::numbers::pi, 0, false}, strength}; }

/// Of a surface as a whole, per radiance.
class EmitterBounds {
public:
    EmitterBounds(const ShadingScene& scene, double area, bool two_sided)
        : scene_(scene), area_(area), two_sided_(two_sided) {}

    LightBounds operator()(const std::monostate&) const { return {}; }
    LightBounds operator()(const MeshEmitter& e) const {
        LightBounds out;
        each_triangle_bounds(scene_, e.instance, e.mesh, two_sided_,
                             [&](const LightBounds& triangle) { out = unite(out, triangle); });
        return out;
    }
    LightBounds operator()(const SphereEmitter& e) const {
        return round(e.center, Vec3d{e.radius, e.radius, e.radius});
    }
    LightBounds operator()(const EllipsoidEmitter& e) const {
        const Affine& m = scene_.scene.instances[index(e.instance)].world_from_object;
        const auto row = [&](size_t r) { return e.radius * length(Vec3d{m.m[r][0], m.m[r][1], m.m[r][2]}); };
        return round(transform_point(m, e.center), {row(0), row(1), row(2)});
    }
    LightBounds operator()(const RectangleEmitter& e) const {
        return flat(e.center, abs(e.half_u) + abs(e.half_v), e.normal);
    }
    LightBounds operator()(const DiskEmitter& e) const {
        const Vec3d &u = e.axis_u, &v = e.axis_v;
        const Vec3d reach{std::sqrt(u.x * u.x + v.x * v.x), std::sqrt(u.y * u.y + v.y * v.y),
                          std::sqrt(u.z * u.z + v.z * v.z)};
        return flat(e.center, reach, e.normal);
    }

private:
    /// A convex body shows a quarter of its surface on average (Cauchy).
    LightBounds round(Vec3d center, Vec3d reach) const {
        return {center - reach, center + reach, {{0, 0, 1}, std::numbers::pi, 0, false}, area_ / 4};
    }
    LightBounds flat(Vec3d center, Vec3d reach, Vec3d normal) const {
        return {center - reach, center + reach, {normal, 0, std::numbers::pi / 2, two_sided_}, area_};
    }

    const ShadingScene& scene_;
    double area_;
    bool two_sided_;
};

/// What one light sends and where; a strength of 0 where there is nothing, or where it is infinitely far away.
struct Shining {
    LightBounds bounds;
    double flux = 0;  ///< W, mean of the channels
    bool distant = false;
};

class ShiningOf {
public:
    ShiningOf(const ShadingScene& scene, const ShadingScene::LightData& data) : scene_(scene), data_(data) {}

    Shining operator()(const PointLight& light) const {
        const double intensity = mean(light.intensity);
        return {at_point(light.position, intensity), 4 * std::numbers::pi * intensity};
    }
    Shining operator()(const SpotLight& light) const {
        Shining out{at_point(light.position, mean(light.intensity))};
        const double outer = light.outer_angle * (std::numbers::pi / 180);
        out.bounds.cone = {data_.direction, outer, 0, false};
        out.flux = 2 * std::numbers::pi * mean(light.intensity) * (1 - (data_.cos_inner + data_.cos_outer) / 2);
        return out;
    }
    Shining operator()(const GoniometricLight& light) const {
        const IntensityProfile& profile = scene_.scene.profiles[index(light.profile)];
        Shining out{at_point(light.position, mean(light.intensity) * peak_intensity(profile))};
        const double widest = lit_angle(profile) * (std::numbers::pi / 180);
        if (widest < std::numbers::pi) out.bounds.cone = {data_.axes.down, widest, 0, false};
        out.flux = mean(light.intensity) * total_flux(profile);
        return out;
    }
    Shining operator()(const AreaLight& light) const {
        Shining out{std::visit(EmitterBounds(scene_, data_.area, light.two_sided), data_.emitter)};
        const double radiance = mean(light.radiance) * data_.mean_texture;
        out.bounds.strength *= radiance;
        out.flux = std::numbers::pi * data_.area * radiance * (light.two_sided ? 2 : 1);
        return out;
    }
    Shining operator()(const DirectionalLight& light) const { return {{}, 0, !is_black(light.irradiance)}; }
    Shining operator()(const EnvironmentLight&) const { return {{}, 0, true}; }

private:
    const ShadingScene& scene_;
    const ShadingScene::LightData& data_;
};

/// Run `i` of `n` equal ones: values [first_of(i), first_of(i + 1)).
uint64_t first_of(uint64_t i, uint64_t n, uint64_t values) { return (i * values + n - 1) / n; }
uint32_t run_of(uint64_t x, uint64_t n, uint64_t values) { return static_cast<uint32_t>(x * n / values); }

/// A run for each by the cumulative powers; at least one value for whatever has power is not promised by rounding, so
/// that every light gets one first.
uint64_t first_by(const std::vector<double>& cumulative, uint64_t i, uint64_t values) {
    const double share = i > 0 ? cumulative[i - 1] / cumulative.back() : 0;
    return i + static_cast<uint64_t>(share * static_cast<double>(values - cumulative.size()));
}

}  // namespace

LightSelection::LightSelection(const ShadingScene& scene) : lights_(static_cast<uint32_t>(scene.lights.size())) {
    std::vector<LightBounds> bounds;
    bounds.reserve(lights_);
    cumulative_.reserve(lights_);
    double total = 0;
    for (uint32_t i = 0; i < lights_; ++i) {
        const Shining light = std::visit(ShiningOf(scene, scene.lights[i]), scene.scene.lights[i]);
        if (light.distant) distant_.push_back(i);
        bounds.push_back(light.bounds);
        if (std::isfinite(light.flux)) total += light.flux;
        cumulative_.push_back(total);
    }
    if (total == 0) cumulative_.clear();
    tree_ = LightTree(bounds);
}

uint64_t LightSelection::bytes() const noexcept {
    return tree_.bytes() + distant_.size() * sizeof(uint32_t) + cumulative_.size() * sizeof(double);
}

uint64_t LightSelection::distant_values(LightChoice by, const LightReceiver& at) const noexcept {
    if (distant_.empty()) return 0;
    const bool others = by == LightChoice::bvh ? tree_.reaches(at) : !cumulative_.empty();
    return others ? kLightValues / 2 : kLightValues;
}

std::optional<ChosenLight> LightSelection::choose(LightChoice by, const LightReceiver& at,
                                                  uint32_t choice) const noexcept {
    const LightQuery query = this->query(by, at, choice);
    return query.tree ? query.tree->choose(query.at, query.choice, query.values) : query.chosen;
}

LightQuery LightSelection::query(LightChoice by, const LightReceiver& at, uint32_t choice) const noexcept {
    LightQuery out;
    const auto answer = [&](uint32_t light) { out.chosen = ChosenLight{light, probability(by, at, light)}; };
    if (lights_ == 0) return out;
    if (by == LightChoice::uniform) {
        answer(run_of(choice, lights_, kLightValues));
        return out;
    }
    const uint64_t distant = distant_values(by, at), others = kLightValues - distant;
    if (choice < distant) {
        answer(distant_[run_of(choice, distant_.size(), distant)]);
        return out;
    }
    const auto x = static_cast<uint32_t>(choice - distant);
    if (by == LightChoice::bvh) return {&tree_, at, x, others, {}};
    if (cumulative_.empty()) return out;
    // The last light whose run begins at or before x.
    uint32_t lo = 0, hi = static_cast<uint32_t>(cumulative_.size());
    while (hi - lo > 1) {
        const uint32_t middle = lo + (hi - lo) / 2;
        (first_by(cumulative_, middle, others) <= x ? lo : hi) = middle;
    }
    answer(lo);
    return out;
}

double LightSelection::probability(LightChoice by, const LightReceiver& at, uint32_t light) const noexcept {
    if (light >= lights_) return 0;
    const auto of_equals = [&](uint64_t i, uint64_t n, uint64_t values) {
        return static_cast<double>(first_of(i + 1, n, values) - first_of(i, n, values)) * 0x1p-32;
    };
    if (by == LightChoice::uniform) return of_equals(light, lights_, kLightValues);
    const uint64_t distant = distant_values(by, at), others = kLightValues - distant;
    double out = 0;
    if (const auto found = std::lower_bound(distant_.begin(), distant_.end(), light);
        found != distant_.end() && *found == light)
        out = of_equals(static_cast<uint64_t>(found - distant_.begin()), distant_.size(), distant);
    if (by == LightChoice::bvh) return out > 0 ? out : tree_.probability(at, light, others);
    if (cumulative_.empty() || others == 0) return out;
    const uint64_t first = first_by(cumulative_, light, others),
                   end = light + 1 < cumulative_.size() ? first_by(cumulative_, light + 1, others) : others;
    return out + static_cast<double>(end - first) * 0x1p-32;
}

}  // namespace steradian
