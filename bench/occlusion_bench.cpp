// What streams (src/accel/kernels/stream.inl) do to any hits, by what there is beside triangles and where the rays
// start: spans that are too short for them against long ones. `occlusion_bench [RAYS]` prints a table for
// docs/performance.md; RAYS of each kind (65536).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "accel/accel.h"
#include "clock.h"
#include "math/transform.h"
#include "mesh.h"
#include "random.h"

namespace steradian::bench {
namespace {

constexpr size_t kShort = 95, kLong = 4096;
constexpr int kRepetitions = 9;

/// A dented sphere of radius 1, and what is around and on it.
struct World {
    std::string name;
    size_t spheres = 0, instances = 0;
    bool rectangle = false;
};

Result<Accel> build(const World& world, const BenchMesh& mesh) {
    const BenchMesh body = bumpy_sphere(20'000);
    Random random(4);
    std::vector<SphereGeometry> spheres;
    for (size_t i = 0; i < world.spheres; ++i) spheres.push_back({random.in_cube(), 0.01f});
    const RectangleGeometry light{{-1, 2, -1}, {2, 0, 0}, {0, 0, 2}};
    const std::vector<Geometry> geometries = {mesh.geometry(), body.geometry(),
                                              std::span<const SphereGeometry>(spheres),
                                              std::span<const RectangleGeometry>(&light, 1)};
    std::vector<GeometryInstance> instances = {{0, {}, {}}};
    if (world.spheres) instances.push_back({2, {}, {}});
    if (world.rectangle) instances.push_back({3, {}, {}});
    for (size_t i = 0; i < world.instances; ++i) {
        const Vec3 at = random.in_cube(), around = random.in_cube();
        instances.push_back({1,
                             translation(at.x, at.y, at.z) * scaling(0.08, 0.08, 0.08) *
                                 rotation_degrees(360 * random.unit(), {around.x, around.y, around.z}),
                             {}});
    }
    return Accel::build(geometries, instances, {});
}

/// From what is seen from outside, half of all directions: of neighbouring pixels one after the other, or from
/// anywhere on it.
std::vector<Ray> rays_from(const Accel& accel, size_t count, bool in_order, float tmax) {
    Random random(6);
    std::vector<Ray> rays;
    const auto across = static_cast<size_t>(std::sqrt(double(count)));
    for (size_t i = 0; rays.size() < count; ++i) {
        Vec3 from{0, 0, 3}, to{random.between(-0.7, 0.7), random.between(-0.7, 0.7), 0};
        if (in_order) {
            const auto pixel = [&](size_t k) {
                return float(1.4 * (double(k % across) + random.unit()) / double(across) - 0.7);
            };
            to = {pixel(i), pixel(i / across), 0};
        } else {
            from = normalize(random.in_cube()) * 3.0f, to = random.in_cube() * 0.5f;
        }
        const Hit hit = accel.intersect(Ray{from, 0, to - from, kInfinity});
        if (!hit.found()) continue;
        const Vec3 back = normalize(from - to);
        rays.push_back({from + (to - from) * hit.t + back * 1e-4f, 0, random.cosine_about(back), tmax});
    }
    return rays;
}

double seconds(const Accel& accel, const std::vector<Ray>& rays, size_t span, std::vector<uint8_t>& result) {
    const double before = thread_seconds();
    for (size_t i = 0; i < rays.size(); i += span) {
        const size_t count = std::min(span, rays.size() - i);
        accel.occluded(std::span(rays).subspan(i, count), std::span(result).subspan(i, count));
    }
    return thread_seconds() - before;
}

/// Two columns of the table: in flight, and streams ÷ in flight.
bool measure(const Accel& accel, const std::vector<Ray>& rays) {
    std::vector<uint8_t> result(rays.size()), same(rays.size());
    double best[2] = {kInfinity, kInfinity};
    for (int i = 0; i < kRepetitions; ++i) {
        best[0] = std::min(best[0], seconds(accel, rays, kShort, result));
        best[1] = std::min(best[1], seconds(accel, rays, kLong, same));
    }
    fmt::print(" {:.2f} | **{:.2f}** |", double(rays.size()) / best[0] * 1e-6, best[0] / best[1]);
    std::fflush(stdout);
    return result == same;
}

int run(size_t ray_count) {
    fmt::print(
        "| triangles | beside them | neighbours, short rays: in flight | streams ÷ | long rays: in flight | streams "
        "÷ | from anywhere: in flight | streams ÷ |\n|---|---|---|---|---|---|---|---|\n");
    for (const size_t triangles : {size_t(40'000), size_t(640'000)}) {
        const BenchMesh mesh = bumpy_sphere(triangles);
        for (const World& world : {World{"nothing"}, World{"a rectangle", 0, 0, true}, World{"1000 spheres", 1000},
                                   World{"20 instances", 0, 20}, World{"400 instances", 0, 400}}) {
            const Result<Accel> accel = build(world, mesh);
            if (!accel) return 1;
            fmt::print("| {} | {} |", mesh.indices.size() / 3, world.name);
            if (!measure(*accel, rays_from(*accel, ray_count, true, 0.3f)) ||
                !measure(*accel, rays_from(*accel, ray_count, true, kInfinity)) ||
                !measure(*accel, rays_from(*accel, ray_count, false, kInfinity)))
                return 2;
            fmt::print("\n");
        }
    }
    return 0;
}

}  // namespace
}  // namespace steradian::bench

int main(int argc, char** argv) {
    return steradian::bench::run(static_cast<size_t>(std::max(argc > 1 ? std::atoi(argv[1]) : 65'536, 100)));
}
