#include "hostile.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "accel/geometry.h"

namespace steradian::test {
namespace {

constexpr size_t kMaxPrimitives = 96;  ///< of all geometries together

/// Zeros follow the last byte.
class Bytes {
public:
    explicit Bytes(std::span<const uint8_t> bytes) : bytes_(bytes) {}
    uint8_t next() {
        if (place_ == bytes_.size()) return 0;
        return bytes_[place_++];
    }
    uint32_t below(size_t n) { return next() % static_cast<uint32_t>(n); }
    float raw() {
        uint32_t bits = 0;
        for (int i = 0; i < 4; ++i) bits = bits << 8 | next();
        return std::bit_cast<float>(bits);
    }
    bool empty() const { return place_ == bytes_.size(); }

private:
    std::span<const uint8_t> bytes_;
    size_t place_ = 0;
};

float decade(int exponent) { return static_cast<float>(std::pow(10.0, exponent)); }

class Decoder {
public:
    explicit Decoder(std::span<const uint8_t> bytes) : in_(bytes) {}

    HostileCase run() {
        HostileCase out;
        const uint8_t flags = in_.next();
        // Mostly geometry that is accepted: what is refused ends a case early.
        wild_ = flags % 16 == 15;
        constexpr uint32_t kDepths[] = {64, 64, 5, 1};
        out.max_depth = kDepths[flags >> 4 & 3];
        for (uint32_t i = 0, n = 1 + in_.below(4); i < n; ++i) geometry(out.scene, i);
        instances(out.scene);
        out.scene.finish(in_.next());
        rays(out);
        cut_outs(out.scene);
        return out;
    }

private:
    float accepted(float x) const { return wild_ || std::fabs(x) <= kMaxCoordinate ? x : 1; }

    /// A coordinate in units of the scale that holds for now, or one with a history.
    float coordinate() {
        const uint8_t what = in_.next();
        const int top = what >> 3;  // 0 … 31
        float x = 0;
        switch (what & 7) {
            case 0:
            case 1:
            case 2:
            case 3:
                x = static_cast<float>(top - 16) * 0.125f * scale_;
                break;
            case 4:
                x = earlier();
                break;
            case 5:
                x = std::nextafter(earlier(), top & 1 ? kInfinity : -kInfinity);
                break;
            case 6: {
                const float size = decade(static_cast<int>(in_.below(46)) - 30);
                x = top & 1 ? -size : size;
                break;
            }
            default:
                x = top & 3 ? std::bit_cast<float>(uint32_t(in_.next()) << (top % 16) | uint32_t(top & 1) << 31)
                            : in_.raw();
                break;
        }
        x = accepted(x);
        seen_[place_++ % std::size(seen_)] = x;
        return x;
    }
    float earlier() { return seen_[in_.below(std::size(seen_))]; }
    Vec3 vertex() {
        const float x = coordinate(), y = coordinate(), z = coordinate();
        return {x, y, z};
    }
    float size() { return std::fabs(coordinate()); }

    void geometry(TestScene& scene, uint32_t index) {
        constexpr float kScales[] = {1,      1,      1,      1,    1e-3f, 1e-12f, 1e-20f,
                                     1e-30f, 1e-38f, 1e-41f, 1e5f, 3e7f,  1e14f,  4e14f};
        const uint8_t what = in_.next();
        scale_ = kScales[(what >> 3) % std::size(kScales)];
        const uint32_t count = 1 + in_.below(24);
        // Geometries come in the order of their kinds, see TestScene::geometries().
        switch (index == 0 ? 0 : what & 7) {
            case 0:
            case 1:
            case 2:
            case 3:
                scene.meshes.push_back(mesh(count));
                break;
            case 4:
                return spheres(scene, count);
            case 5:
                return rectangles(scene, count);
            case 6:
                return disks(scene, count);
            default:  // an empty one, and the first mesh once more
                if (in_.next() & 1) return scene.meshes.emplace_back(), void();
                scene.meshes.push_back(scene.meshes.front());
                break;
        }
    }
    bool full() { return ++primitives_ > kMaxPrimitives; }

    TriangleMesh mesh(uint32_t count) {
        TriangleMesh m;
        Vec3 a{0, 0, 0}, b{scale_, 0, 0}, c{0, scale_, 0};
        for (uint32_t i = 0; i < count && !full(); ++i) {
            const uint8_t what = in_.next();
            switch (what & 7) {
                case 0:  // the same again, from another vertex or the other way round
                    std::swap(a, what & 8 ? b : a), std::swap(b, what & 16 ? c : b);
                    break;
                case 1:  // no area
                    m.add(a, b, what & 8 ? a : what & 16 ? b : a + (b - a) * 0.5f);
                    break;
                case 2:  // beyond an edge
                    a = b, b = c, c = vertex();
                    break;
                case 3: {  // smaller and smaller ones around a vertex
                    const float factor = decade(-static_cast<int>(what >> 5) - 1);
                    for (uint32_t n = what >> 3 & 3; n && !full(); --n) {
                        m.add(a, b, c);
                        b = a + (b - a) * factor, c = a + (c - a) * factor;
                    }
                    break;
                }
                case 4: {  // a step aside
                    const Vec3 step{what & 8 ? scale_ : 0, what & 16 ? scale_ : 0, what & 32 ? scale_ : 0};
                    a = a + step, b = b + step, c = c + step;
                    break;
                }
                default:
                    a = vertex(), b = vertex(), c = vertex();
                    break;
            }
            for (const Vec3* p : {&a, &b, &c})
                if (!wild_ && !usable_position(*p)) a = {0, 0, 0}, b = {scale_, 0, 0}, c = {0, scale_, 0};
            m.add(a, b, c);
        }
        if (!wild_ && scale_ <= 1 && in_.next() % 4 == 0) m.move(1, {3e5f, -2e5f, 1e5f});
        return m;
    }
    void spheres(TestScene& scene, uint32_t count) {
        std::vector<SphereGeometry> all;
        for (uint32_t i = 0; i < count && !full(); ++i) {
            const uint8_t what = in_.next();
            SphereGeometry s{vertex(), size() * 0.5f};
            if (what % 4 == 0 && !all.empty()) s = all.back();
            all.push_back(s);
            // A long row: more leaves than a ray takes from its packet at once.
            for (uint32_t n = what == 255 ? 80 : 0; n && !full(); --n) {
                s.center.z -= 2 * scale_;
                all.push_back(s);
            }
        }
        scene.spheres.push_back(std::move(all));
    }
    template <class Shape>
    std::vector<Shape> planar(uint32_t count) {
        std::vector<Shape> all;
        for (uint32_t i = 0; i < count && !full(); ++i) {
            Shape shape;
            auto& [center, u, v] = shape;
            const uint8_t what = in_.next();
            center = vertex();
            u = what & 1 ? Vec3{scale_, 0, 0} : vertex() * 0.25f;
            v = what & 2 ? Vec3{0, scale_, 0} : vertex() * 0.25f;
            all.push_back(what % 4 == 3 && !all.empty() ? all.back() : shape);
        }
        return all;
    }
    void rectangles(TestScene& scene, uint32_t count) { scene.rectangles.push_back(planar<RectangleGeometry>(count)); }
    void disks(TestScene& scene, uint32_t count) { scene.disks.push_back(planar<DiskGeometry>(count)); }

    Affine transform() {
        const uint8_t what = in_.next();
        switch (what & 7) {
            case 0:
            case 1:
            case 2:
                return {};
            case 3: {
                scale_ = 1;
                const Vec3 by = vertex();
                return translation(by.x, by.y, by.z);
            }
            case 4: {  // mirrored, stretched, both over many orders of magnitude
                double s[3];
                for (double& x : s) {
                    const uint8_t b = in_.next();
                    x = (b & 1 ? -1 : 1) * (b & 2 ? 1 : std::pow(10.0, (b >> 2) - (b < 128 ? 8 : 48)));
                }
                return scaling(s[0], s[1], s[2]);
            }
            case 5:
                return rotation_degrees(what & 8 ? 90.0 * (what >> 4) : 1.4 * in_.next(),
                                        {float(what >> 4 & 1), float(what >> 5 & 1), 1});
            case 6: {
                const double size = std::pow(10.0, int(in_.below(25)) - 12);
                const Affine turned = rotation_degrees(1.4 * in_.next(), {1, 1, 1});
                return scaling(size, what & 8 ? -size : size, size) * turned;
            }
            default: {  // sheared, and back from far away
                Affine sheared;
                sheared.m[0][1] = (int(in_.next()) - 128) / 64.0;
                sheared.m[2][0] = (int(in_.next()) - 128) / 64.0;
                const Affine back = translation(-3e5, 2e5, -1e5);
                return what & 8 ? rotation_degrees(17.0 * (what >> 4), {0, 1, 0}) * back : sheared * back;
            }
        }
    }
    void instances(TestScene& scene) {
        const auto geometries = static_cast<uint32_t>(scene.geometries().size());
        const uint8_t how = in_.next();
        // Each in place once, which finish() does.
        if (how % 4 == 0) return;
        for (uint32_t i = 0, n = 1 + how % 7; i < n; ++i) {
            GeometryInstance instance{in_.below(geometries), transform()};
            if (!wild_ && !Accel::build(scene.geometries(), {&instance, 1})) instance.world_from_object = {};
            scene.instances.push_back(instance);
        }
    }

    Vec3 point(const TestScene& scene) {
        if (scene.points.empty()) return vertex();
        const uint32_t low = in_.next();
        return scene.points[(low | uint32_t(in_.next()) << 8) % scene.points.size()];
    }
    Ray ray(const TestScene& scene, uint8_t what) {
        const float away = static_cast<float>(scene.size) * (what & 8 ? 1 : 0.25f);
        Ray r;
        switch (what & 7) {
            case 0:
            case 1: {  // from one point to another
                r.o = point(scene);
                r.d = Vec3(Vec3d(point(scene)) - Vec3d(r.o));
                if (what & 16) r.o = Vec3(Vec3d(r.o) - Vec3d(r.d) * 2);
                // Where everything is tiny, a direction of that size counts as none.
                if (max_component(abs(r.d)) < 1e-30f) r.d = r.d * 0x1p100f;
                break;
            }
            case 2: {  // along an axis, with zeros of either sign
                r.o = point(scene);
                const int axis = (what >> 3) % 3;
                r.d = {what & 32 ? 0.0f : -0.0f, what & 64 ? 0.0f : -0.0f, what & 128 ? 0.0f : -0.0f};
                r.d[axis] = what & 32 ? 1.0f : -1.0f;
                r.o[axis] -= r.d[axis] * away;
                break;
            }
            case 3:
            case 4: {  // towards a point, along few directions
                const uint8_t b = in_.next();
                r.d = {float(b & 7) - 3.5f, float(b >> 3 & 7) - 3.5f, float(b >> 6) - 1.5f};
                r.o = Vec3(Vec3d(point(scene)) - Vec3d(r.d) * double(away));
                break;
            }
            case 5:
                r.o = vertex(), r.d = vertex();
                break;
            case 6:
                r.o = {in_.raw(), in_.raw(), in_.raw()};
                r.d = {in_.raw(), in_.raw(), in_.raw()};
                break;
            default:
                return hard_rays(scene, 1, in_.next())[0];
        }
        return r;
    }
    void range(Ray& r) {
        constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
        constexpr float kEnds[] = {0,         -0.0f,      -1,  1, 1e-45f, 1e-38f, std::numeric_limits<float>::max(),
                                   kInfinity, -kInfinity, kNan};
        const uint8_t what = in_.next();
        if (what & 3) return;
        if (what & 4) r.tmin = what & 8 ? kEnds[in_.below(std::size(kEnds))] : size();
        if (what & 16) r.tmax = what & 8 ? kEnds[in_.below(std::size(kEnds))] : size();
    }
    /// Rays that go much the same way as `middle`.
    void bundle(HostileCase& out, const Ray& middle, size_t count) {
        const uint8_t what = in_.next();
        const double spread = std::pow(10.0, -1 - int(what & 7)), length_d = length(Vec3d(middle.d)),
                     apart = what & 8 ? 0 : out.scene.size * std::pow(10.0, -1 - int(what >> 4 & 7));
        Random random(in_.next());
        while (count--) {
            Ray r = middle;
            r.d = Vec3(Vec3d(middle.d) + Vec3d(random.in_cube(spread)) * length_d);
            r.o = Vec3(Vec3d(middle.o) + Vec3d(random.in_cube(1)) * apart);
            // Some stay exactly as they are in an axis, or get a zero there.
            for (int axis = 0; axis < 3; ++axis) {
                if (random.below(4) == 0) r.d[axis] = middle.d[axis];
                if (random.below(16) == 0) r.d[axis] = std::copysign(0.0f, middle.d[axis]);
            }
            if (what & 128 && random.below(8) == 0) range(r);
            out.rays.push_back(r);
        }
    }
    void rays(HostileCase& out) {
        const size_t count = 1 + in_.below(100);
        while (out.rays.size() < count) {
            const uint8_t what = in_.next();
            Ray r = ray(out.scene, what);
            range(r);
            out.rays.push_back(r);
            const size_t room = count - out.rays.size();
            if (what >= 64 && (what & 7) != 5 && (what & 7) != 6) bundle(out, r, std::min<size_t>(room, what % 40));
            if (in_.empty()) bundle(out, r, count - out.rays.size());
        }
        for (uint32_t i = 0, n = 1 + in_.below(4); i < n; ++i)
            out.batches.push_back(static_cast<uint8_t>(1 + in_.below(100)));
        const auto ids = static_cast<uint32_t>(out.scene.instances.size());
        for (const Ray& r : out.rays) {
            const uint8_t what = in_.next();
            Hit after{what & 1 ? r.tmin : size(), 0, 0, uint32_t(what >> 1 & 3), (what >> 3) % (ids + 1)};
            if (what >= 224) after.t = in_.raw();
            out.after.push_back(after);
        }
    }

    /// Last, so that cases without any come from bytes that end before this.
    void cut_outs(TestScene& scene) {
        const std::vector<Geometry> geometries = scene.geometries();
        for (size_t i = 0; i < scene.instances.size(); ++i) {
            const size_t size = (primitive_count(geometries[scene.instances[i].geometry]) + 7) / 8;
            const uint8_t what = in_.next();
            if ((what & 1) == 0) continue;
            std::vector<uint8_t> bits(size, 255);
            if (what & 2)
                for (uint8_t& byte : bits) byte = in_.next();
            scene.set_cut_outs(i, std::move(bits));
        }
    }

    Bytes in_;
    bool wild_ = false;
    float scale_ = 1;
    float seen_[16] = {0, 1, -1, 0.5f};
    size_t place_ = 4;
    size_t primitives_ = 0;
};

}  // namespace

HostileCase hostile_case(std::span<const uint8_t> bytes) { return Decoder(bytes).run(); }

}  // namespace steradian::test
