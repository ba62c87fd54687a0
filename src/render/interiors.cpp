#include "render/interiors.h"

#include <algorithm>

#include "shading/surface.h"
#include "shading/surface_error.h"

namespace steradian {
namespace {

/// Any direction will do that is not one in which things are built.
constexpr Vec3 kProbe{0.36423f, 0.81037f, 0.45895f};
/// Bodies that a probe may be in at a time, besides those that it has started in.
constexpr uint32_t kMostEntered = 32;

/// On the edge between two triangles both are hit.
bool same_place(const Hit& a, const Hit& b) { return a.instance == b.instance && a.t == b.t; }

/// How far along a ray other surfaces count as being in the place of `point`: twice as far as the origins of new rays
/// are moved off it (offset_origin). Obliquely that is a longer way, up to a limit.
float reach_of(const SurfacePoint& point, const Ray& ray) {
    const Vec3d n = abs(point.ng), d = ray.d;
    const double rounding = max_component(abs(point.p)) * 0x1p-23;
    const double slope = std::fabs(dot(Vec3d(point.ng), d)), steepest = 1e-3 * length(d);
    return static_cast<float>(2 * (dot(n, Vec3d(point.p_error)) + rounding) / max_of(slope, steepest));
}

}  // namespace

Interiors::Interiors(const RenderContext& context, uint32_t paths) : c_(context), shading_(context.scene.shading) {
    if (shading_.has_interiors) states_.resize(paths);
}

/// Bodies that a ray leaves more often than it enters are around its origin. Those that it leaves first are inside of
/// the others.
Interior Interiors::around(Vec3 origin) const noexcept {
    std::array<uint32_t, kMostEntered> left{}, entered{};
    uint32_t lefts = 0, entries = 0;
    const Ray probe{origin, 0, kProbe, kInfinity};
    Hit last;
    for (Hit hit = c_.scene.accel.intersect(probe); hit.found() && !c_.cancelled.load(std::memory_order_relaxed);) {
        const bool again = same_place(hit, last);
        last = hit;
        if (shading_.dielectric(hit.instance) && !again) {
            const uint32_t body = shading_.material_of(hit.instance);
            const bool enters = dot(surface_at(shading_, probe, hit).ng, kProbe) < 0;
            const auto open = std::find(entered.begin(), entered.begin() + entries, body);
            const bool is_open = open != entered.begin() + entries;
            if (enters && entries < kMostEntered) entered[entries++] = body;
            if (!enters && is_open) *open = entered[--entries];
            if (!enters && !is_open && lefts < kMostEntered) left[lefts++] = body;
        }
        c_.scene.accel.next_hit({&probe, 1}, {&last, 1}, {&hit, 1});
    }
    Interior out;
    while (lefts > 0) out.enter(shading_, left[--lefts]);
    return out;
}

void Interiors::begin(uint32_t path, const Ray& ray) noexcept {
    if (!has_last_ || ray.o != last_origin_) {
        last_origin_ = ray.o;
        last_around_ = around(ray.o);
        has_last_ = true;
    }
    State& state = states_[path];
    state = {};
    state.walk.before = state.walk.after = last_around_;
}

void Interiors::start(uint32_t path) noexcept {
    State& state = states_[path];
    state.walk = walk(path, state.beyond);
    state.beyond = false;
}

Interiors::Walk Interiors::walk(uint32_t path, bool beyond) const noexcept {
    const Walk& at = states_[path].walk;
    Walk out;
    out.now = beyond ? at.after : at.before;
    out.before = out.after = out.now;
    return out;
}

bool Interiors::passes(uint32_t path, const Ray& ray, Hit& hit) noexcept {
    return passes(states_[path].walk, ray, hit);
}

bool Interiors::passes(Walk& walk, const Ray& ray, Hit& hit) const noexcept {
    if (shading_.has_priority(hit.instance)) return passes_priority(walk, ray, hit);
    walk.before = walk.after = walk.now;
    float reach = 0;
    if (shading_.dielectric(hit.instance)) cross(walk.after, ray, hit, reach);
    return false;
}

/// What is on the other side of a body's boundary.
void Interiors::cross(Interior& inside, const Ray& ray, const Hit& hit, float& reach) const noexcept {
    const SurfacePoint point = surface_at(shading_, ray, hit);
    if (dot(Vec3d(point.ng), Vec3d(ray.d)) < 0)
        inside.enter(shading_, shading_.material_of(hit.instance));
    else
        inside.leave(shading_.material_of(hit.instance));
    reach = max_of(reach, hit.t + reach_of(point, ray));
}

bool Interiors::passes_priority(Walk& walk, const Ray& ray, Hit& hit) const noexcept {
    if (same_place(hit, walk.last)) return true;
    walk.last = hit;
    if (!(hit.t <= walk.group_end)) {
        walk.group = walk.now;
        walk.group_begin = hit.t;
        walk.group_size = 0;
    }
    ++walk.group_size;
    cross(walk.now, ray, hit, walk.group_end);
    if (walk.group.filling() == walk.now.filling()) {
        walk.before = walk.after = walk.now;
        return true;
    }
    // All that is in this place belongs to one boundary.
    std::array<Hit, Interior::kMost> found{hit};
    uint32_t count = 1;
    Hit last = hit;
    for (Hit next;; last = next) {
        c_.scene.accel.next_hit({&ray, 1}, {&last, 1}, {&next, 1});
        if (!next.found() || !(next.t <= walk.group_end) || !shading_.has_priority(next.instance)) break;
        if (!same_place(next, last)) {
            cross(walk.now, ray, next, walk.group_end);
            ++walk.group_size;
        }
        if (count < found.size()) found[count++] = next;
    }
    if (walk.group.filling() == walk.now.filling()) {
        walk.before = walk.after = walk.now;
        hit = walk.last = last;
        return true;
    }
    walk.before = walk.group;
    walk.after = walk.now;
    // It is the boundary of the body that is entered or left here; where one takes over from another, of that which
    // would be where both are.
    const uint32_t near = walk.before.filling(), far = walk.after.filling();
    const bool left = near != kVacuum && !walk.after.contains(near);
    const bool entered = far != kVacuum && !walk.before.contains(far);
    const bool of_far = entered && (!left || covers(shading_, far, near));
    for (uint32_t i = 0; i < count; ++i)
        if (shading_.material_of(found[i].instance) == (of_far ? far : near)) hit = found[i];
    walk.outer_index = (of_far ? walk.before : walk.after).index(shading_);
    // Both ends are rounded to float.
    const double rounding = last.t * 0x1p-23;
    walk.reach = walk.group_size > 1 ? max_of(hit.t - walk.group_begin, last.t - hit.t) + rounding : 0;
    return false;
}

/// New rays start beyond all boundaries of the place, since they have what is before or behind all of them.
void Interiors::describe(uint32_t path, const Ray& ray, const Hit& hit, SurfacePoint& point) const noexcept {
    if (!shading_.has_priority(hit.instance)) return;
    const Walk& walk = states_[path].walk;
    point.outer_index = walk.outer_index;
    if (!(walk.reach > 0)) return;
    const double along_normal = std::fabs(dot(Vec3d(point.ng), Vec3d(ray.d))) * walk.reach;
    for (int i = 0; i < 3; ++i)
        point.p_error[i] = round_up(point.p_error[i] + std::fabs(static_cast<double>(point.ng[i])) * along_normal);
}

void Interiors::end_in_medium(uint32_t path, Rgb throughput, Vec2 u, Ray& ray) const noexcept {
    const State& state = states_[path];
    const Medium* medium = (state.beyond ? state.walk.after : state.walk.before).medium(shading_);
    if (medium && scatters(*medium)) ray.tmax = static_cast<float>(sample_scattering(*medium, throughput, u));
}

Rgb Interiors::weight(uint32_t path, Rgb throughput, const Ray& ray, const Hit& hit) const noexcept {
    const Medium* in = medium(path);
    if (!in) return {1, 1, 1};
    if (!scatters(*in)) return steradian::transmittance(*in, hit.t);
    const bool scattered = !hit.found() && ray.tmax < kInfinity;
    return scattering_weight(*in, throughput, scattered ? ray.tmax : hit.t, scattered);
}

Rgb Interiors::transmittance(uint32_t path, bool beyond, double distance) const noexcept {
    const Walk& at = states_[path].walk;
    const Medium* medium = (beyond ? at.after : at.before).medium(shading_);
    return medium ? steradian::transmittance(*medium, distance) : Rgb{1, 1, 1};
}

}  // namespace steradian
