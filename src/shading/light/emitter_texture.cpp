#include "shading/light/emitter_texture.h"

#include <numbers>

#include "base/parallel.h"
#include "math/elementary.h"
#include "scene/emission.h"
#include "shading/emission.h"
#include "shading/light/mesh_emitter.h"

namespace steradian {
namespace {

/// Values for all triangles of a mesh together, about; each has from kLeastRows² to kMostRows² of them.
constexpr uint64_t kValues = 1'000'000;
constexpr uint32_t kLeastRows = 4, kMostRows = 32;
/// Values along each axis of other shapes.
constexpr int kSide = 128;
constexpr double kLeastShare = 0.05, kLeastWhole = 1e-3;

double mean(Rgb c) { return (double(c.r) + c.g + c.b) / 3; }

class Means {
public:
    /// `of_material`: the light is what the surface's material emits.
    Means(const ShadingScene& scene, const AreaLight& light, bool of_material)
        : scene_(scene), light_(light), of_material_(of_material), per_radiance_(1 / mean(light.radiance)) {}

    TextureMeans operator()(MeshId id) const {
        const size_t n = scene_.scene.meshes[index(id)].indices.size() / 3;
        uint32_t rows = kLeastRows;
        while (rows < kMostRows && uint64_t(rows + 1) * (rows + 1) * n <= kValues) ++rows;
        TextureMeans out;
        out.triangles.resize(n);
        parallel_for(n, 256, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i)
                out.triangles[i] = static_cast<float>(of_triangle(static_cast<uint32_t>(i), rows));
        });
        double sum = 0, area = 0;
        uint32_t i = 0;
        each_triangle_bounds(scene_, light_.instance, id, light_.two_sided, [&](const LightBounds& triangle) {
            sum += triangle.strength * out.triangles[i++];
            area += triangle.strength;
        });
        out.whole = area > 0 ? max_of(sum / area, kLeastWhole) : 1;
        for (float& m : out.triangles) m = static_cast<float>((1 - kLeastShare) * m + kLeastShare * out.whole);
        return out;
    }
    TextureMeans operator()(const Rectangle&) const {
        return over_square([&](double a, double b) { return Value{at_hit(2 * a - 1, 2 * b - 1, 0), 1}; });
    }
    TextureMeans operator()(const Disk&) const {
        return over_square([&](double a, double b) {
            const double x = 2 * a - 1, y = 2 * b - 1;
            return x * x + y * y <= 1 ? Value{at_hit(x, y, 0), 1} : Value{};
        });
    }
    TextureMeans operator()(const Sphere&) const {
        return over_square([&](double a, double b) {
            SurfacePoint point;
            point.instance = index(light_.instance);
            point.uv = {static_cast<float>(a), static_cast<float>(b)};
            point.ng = point.ns = {0, 1, 0};
            return Value{at(point), math::sin(std::numbers::pi * b)};
        });
    }

private:
    struct Value {
        double value = 0, weight = 0;
    };

    double at(const SurfacePoint& point) const {
        const Rgb radiance =
            of_material_ ? material_emission(scene_, point, point.ng) : area_radiance(scene_, light_, point);
        return clamp_to(mean(radiance) * per_radiance_, 0.0, 1e30);
    }
    double at_hit(double u, double v, uint32_t prim) const {
        const Hit hit{1, static_cast<float>(u), static_cast<float>(v), prim, index(light_.instance)};
        return at(surface_at(scene_, Ray{}, hit));
    }

    /// The middles of the rows² equal triangles that it can be divided into.
    double of_triangle(uint32_t prim, uint32_t rows) const {
        double sum = 0;
        for (uint32_t i = 0; i < rows; ++i)
            for (uint32_t j = 0; j < rows - i; ++j) {
                sum += at_hit((i + 1.0 / 3) / rows, (j + 1.0 / 3) / rows, prim);
                if (j + 1 < rows - i) sum += at_hit((i + 2.0 / 3) / rows, (j + 2.0 / 3) / rows, prim);
            }
        return sum / (double(rows) * rows);
    }

    template <class ValueAt>
    TextureMeans over_square(ValueAt value_at) const {
        double sum = 0, total = 0;
        for (int j = 0; j < kSide; ++j)
            for (int i = 0; i < kSide; ++i) {
                const Value v = value_at((i + 0.5) / kSide, (j + 0.5) / kSide);
                sum += v.value * v.weight;
                total += v.weight;
            }
        return {max_of(sum / total, kLeastWhole), {}};
    }

    const ShadingScene& scene_;
    const AreaLight& light_;
    bool of_material_;
    double per_radiance_;
};

}  // namespace

TextureMeans texture_means(const ShadingScene& scene, const AreaLight& light) {
    const Instance& instance = scene.scene.instances[index(light.instance)];
    const Emission emission = emission_of(scene.scene, instance.material);
    const bool of_material = !is_black(emission.radiance);
    if (is_black(light.radiance) || !(of_material ? emission.textured : light.texture.has_value())) return {};
    return std::visit(Means(scene, light, of_material), scene.scene.shapes[index(instance.shape)]);
}

}  // namespace steradian
