#include "formats/gltf/animation.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "math/elementary.h"
#include "math/vector.h"

namespace steradian::gltf {
namespace {

using Quaternion = std::array<double, 4>;

enum class Path : uint8_t { translation, rotation, scale, weights };
constexpr std::array<std::string_view, 4> kPaths{"translation", "rotation", "scale", "weights"};
enum class Interpolation : uint8_t { linear, step, cubic_spline };
constexpr std::array<std::string_view, 3> kInterpolations{"LINEAR", "STEP", "CUBICSPLINE"};

/// What a sampler says: values at keyframes. A value is `width` numbers; with CUBICSPLINE each stands between the
/// tangents of the curve towards it and away from it.
struct Curve {
    Interpolation interpolation = Interpolation::linear;
    const std::vector<float>& times;  ///< at least one, never decreasing
    const Accessor& values;
    size_t width = 0;

    enum Part : uint8_t { in_tangent, value, out_tangent };
    size_t parts() const { return interpolation == Interpolation::cubic_spline ? 3 : 1; }
};

Quaternion normalized(Quaternion q) {
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(length > 0)) return {0, 0, 0, 1};
    for (double& x : q) x /= length;
    return q;
}

/// Appendix C.4 of the specification, along the shorter arc.
Quaternion slerp(const Quaternion& a, const Quaternion& b, double t) {
    constexpr double kSameDirection = 1e-6;  // radians: the arc is its chord to 13 digits
    double cosine = 0;
    for (size_t i = 0; i < 4; ++i) cosine += a[i] * b[i];
    const double sign = cosine < 0 ? -1 : 1;
    const double angle = math::acos(min_of(sign * cosine, 1.0));
    const bool near = angle < kSameDirection;
    const double wa = near ? 1 - t : math::sin(angle * (1 - t)) / math::sin(angle);
    const double wb = sign * (near ? t : math::sin(angle * t) / math::sin(angle));
    Quaternion out;
    for (size_t i = 0; i < 4; ++i) out[i] = wa * a[i] + wb * b[i];
    return normalized(out);
}

class Reader {
public:
    Reader(Context& context, Accessors& accessors, const Object& animation, double time)
        : context_(context), accessors_(accessors), animation_(animation), time_(time) {
        samplers_.elements = animation.array("samplers");
    }

    Pose read() {
        for (const Value value : animation_.array("channels"))
            read_channel(Object(context_.source, value, "a channel"));
        return std::move(pose_);
    }

private:
    void read_channel(const Object& channel) {
        const Object target(context_.source, channel.require("target"), "'target'");
        const auto node = target.reference("node", context_.tables.nodes);
        if (!node) return;  // an extension says what is meant, and those that we do not have are reported
        const std::string_view path = json::read_string(context_.source, target.require("path"), "'path'");
        const auto known = std::find(kPaths.begin(), kPaths.end(), path);
        if (known == kPaths.end()) {
            context_.not_honoured("the animation of " + quoted(path) + " has no effect", target.offset_of("path"));
            return;
        }
        if (Object(context_.source, context_.tables.nodes.elements[*node], "a node").has("matrix")) {
            context_.not_honoured("the animation of a node with a 'matrix' has no effect", channel.offset());
            return;
        }
        const Object sampler(context_.source, samplers_.elements[channel.require_reference("sampler", samplers_)],
                             "an animation sampler");
        context_.budget.take(sizeof(Pose::value_type), context_.source, channel.offset());
        if (!set(pose_[*node], static_cast<Path>(known - kPaths.begin()), sampler))
            context_.warn("two channels animate the same property of a node: the first one counts", channel.offset());
    }

    /// False where something is there already.
    bool set(NodePose& pose, Path path, const Object& sampler) {
        const auto put = [&](auto& into, auto make) {
            if (into) return false;
            into = make(value_at(curve(sampler, path), path));
            return true;
        };
        const auto vector = [](const std::vector<double>& v) { return std::array<double, 3>{v[0], v[1], v[2]}; };
        switch (path) {
            case Path::translation:
                return put(pose.translation, vector);
            case Path::scale:
                return put(pose.scale, vector);
            case Path::rotation:
                return put(pose.rotation, [](const std::vector<double>& v) {
                    return normalized({v[0], v[1], v[2], v[3]});
                });
            case Path::weights:
                return put(pose.weights, [](std::vector<double> v) { return v; });
        }
        return false;
    }

    /// The keyframes of a sampler's input, checked once however many samplers share them.
    const std::vector<float>& times(const Object& sampler) {
        const uint32_t number = sampler.require_reference("input", context_.tables.accessors);
        if (const auto known = times_.find(number); known != times_.end()) return known->second;
        const Accessor& accessor = accessors_.open(number);
        if (accessor.components != 1 || accessor.component != ComponentType::f32)
            context_.source.fail(sampler.offset_of("input"), "the times of keyframes must be scalars of FLOAT");
        std::vector<float> times = accessors_.read_component(accessor, 0);
        bool twice = false;
        for (size_t i = 0; i < times.size(); ++i) {
            if (!std::isfinite(times[i]) || (i > 0 && times[i] < times[i - 1]))
                context_.source.fail(
                    accessor.offset,
                    "the times of keyframes must increase, but that of number " + std::to_string(i) +
                        (std::isfinite(times[i]) ? " is before the one of number " + std::to_string(i - 1)
                                                 : " is not finite"));
            twice = twice || (i > 0 && times[i] == times[i - 1]);
        }
        if (twice) context_.warn("two keyframes are at the same time: the animation jumps", accessor.offset);
        return times_.emplace(number, std::move(times)).first->second;
    }

    Curve curve(const Object& sampler, Path path) {
        Interpolation interpolation = Interpolation::linear;
        if (const auto named = sampler.find("interpolation"))
            interpolation = static_cast<Interpolation>(
                json::read_choice(context_.source, *named, "'interpolation'", kInterpolations));
        Curve out{interpolation, times(sampler),
                  accessors_.open(sampler.require_reference("output", context_.tables.accessors))};
        const Accessor& values = out.values;
        const bool real = values.component == ComponentType::f32;
        const bool whole = values.normalized && values.component != ComponentType::u32;
        const uint32_t components = path == Path::weights ? 1 : path == Path::rotation ? 4 : 3;
        const bool may_be_whole = path == Path::weights || path == Path::rotation;
        if (!values.has_vectors_of(components) || !(real || (may_be_whole && whole)))
            context_.source.fail(sampler.offset_of("output"),
                                 "the values of " + quoted(kPaths[static_cast<size_t>(path)]) + " must be " +
                                     (components == 1 ? "scalars" : "vectors of " + std::to_string(components)) +
                                     " of FLOAT" +
                                     (may_be_whole ? ", or of normalised integers with at most 16 bits" : ""));
        const uint64_t keys = uint64_t(out.times.size()) * out.parts();
        out.width = components == 1 ? values.count / keys : components;
        if (out.width == 0 || values.count * components != keys * out.width)
            context_.source.fail(sampler.offset_of("output"), std::to_string(values.count) + " values do not fit " +
                                                                  std::to_string(out.times.size()) + " keyframes" +
                                                                  (out.parts() == 3 ? " with tangents" : ""));
        context_.budget.take(out.width * sizeof(double), context_.source, sampler.offset());
        return out;
    }

    double number(const Curve& curve, size_t key, Curve::Part part, size_t i) {
        const uint64_t at = (key * curve.parts() + (curve.parts() == 3 ? size_t(part) : 0)) * curve.width + i;
        const uint32_t components = curve.values.components;
        const double x = curve.values.element(at / components, static_cast<uint32_t>(at % components));
        if (!std::isfinite(x))
            context_.source.fail(curve.values.offset,
                                 "keyframe " + std::to_string(key) + " of an animation is not finite");
        return x;
    }

    std::vector<double> value(const Curve& curve, size_t key) {
        std::vector<double> out(curve.width);
        for (size_t i = 0; i < out.size(); ++i) out[i] = number(curve, key, Curve::value, i);
        return out;
    }

    Quaternion quaternion(const Curve& curve, const std::vector<double>& v) {
        const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3]);
        if (!(std::fabs(length - 1) <= 1e-2))
            context_.warn("a rotation of an animation is not of unit length and was normalised", curve.values.offset);
        return normalized({v[0], v[1], v[2], v[3]});
    }

    /// Appendix C of the specification.
    std::vector<double> value_at(const Curve& curve, Path path) {
        const std::vector<float>& times = curve.times;
        const auto after = std::upper_bound(times.begin(), times.end(), time_,
                                            [](double t, float key) { return t < static_cast<double>(key); });
        const auto next = static_cast<size_t>(after - times.begin());
        if (next == 0) return value(curve, 0);
        const size_t key = next - 1;
        if (next == times.size() || curve.interpolation == Interpolation::step) return value(curve, key);
        const double begin = times[key], length = static_cast<double>(times[next]) - begin,
                     t = (time_ - begin) / length;
        if (curve.interpolation == Interpolation::cubic_spline) return spline(curve, key, t, length);
        std::vector<double> a = value(curve, key);
        const std::vector<double> b = value(curve, next);
        if (path == Path::rotation) {
            const Quaternion q = slerp(quaternion(curve, a), quaternion(curve, b), t);
            return {q.begin(), q.end()};
        }
        for (size_t i = 0; i < a.size(); ++i) a[i] = (1 - t) * a[i] + t * b[i];
        return a;
    }

    /// Appendix C.5: t in [0, 1] between two keyframes, which are `length` seconds apart.
    std::vector<double> spline(const Curve& curve, size_t key, double t, double length) {
        const double t2 = t * t, t3 = t2 * t;
        std::vector<double> out(curve.width);
        for (size_t i = 0; i < out.size(); ++i)
            out[i] = (2 * t3 - 3 * t2 + 1) * number(curve, key, Curve::value, i) +
                     length * (t3 - 2 * t2 + t) * number(curve, key, Curve::out_tangent, i) +
                     (3 * t2 - 2 * t3) * number(curve, key + 1, Curve::value, i) +
                     length * (t3 - t2) * number(curve, key + 1, Curve::in_tangent, i);
        return out;
    }

    Context& context_;
    Accessors& accessors_;
    Object animation_;
    double time_;
    Table samplers_{"samplers", "animation sampler"};
    std::map<uint32_t, std::vector<float>> times_;
    Pose pose_;
};

/// By name, or else by number.
uint32_t find_animation(const Context& context, const std::vector<std::string>& names) {
    const std::string& wanted = context.options.animation;
    const auto found = std::find(names.begin(), names.end(), wanted);
    if (found != names.end()) return static_cast<uint32_t>(found - names.begin());
    for (uint32_t i = 0; i < names.size(); ++i)
        if (std::to_string(i) == wanted) return i;
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + quoted(name);
    throw json::ReadFailure{Error{ErrorCode::usage,
                                  "there is no animation called " + quoted(wanted),
                                  {context.source.name(), 0, 0},
                                  {},
                                  "the file has: " + escape_for_display(list, 400)}};
}

}  // namespace

Pose read_pose(Context& context, Accessors& accessors) {
    const LoadOptions& options = context.options;
    std::vector<std::string>& names = context.loaded.animations;
    const std::vector<Value>& animations = context.tables.animations.elements;
    for (uint32_t i = 0; i < animations.size(); ++i)
        names.push_back(name_of(Object(context.source, animations[i], "an animation"), "animation", i));
    if (options.animation.empty() && !options.frame_time) return {};
    if (names.empty())
        throw json::ReadFailure{
            Error{ErrorCode::usage, "the file has no animations", {context.source.name(), 0, 0}, {}, {}}};
    const uint32_t number = options.animation.empty() ? 0 : find_animation(context, names);
    const Object animation(context.source, animations[number], "an animation");
    if (options.animation.empty() && names.size() > 1)
        context.not_honoured("the first of " + std::to_string(names.size()) + " animations is shown, " +
                                 quoted(names[0]) + "; --animation chooses another",
                             animation.offset());
    return Reader(context, accessors, animation, options.frame_time.value_or(0)).read();
}

}  // namespace steradian::gltf
