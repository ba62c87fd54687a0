// What opening instances (src/accel/open.h) does to the rays: many instances of one body, within each other or apart.
// `instance_bench [RAYS]` prints a table for docs/performance.md; RAYS of each kind (60000).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "accel/accel.h"
#include "clock.h"
#include "math/transform.h"
#include "mesh.h"
#include "random.h"

namespace steradian::bench {
namespace {

constexpr int kTriangles = 50'000, kRepetitions = 7;

/// Small triangles in a ball, as leaves in the crown of a tree: most rays go through.
BenchMesh crown() {
    BenchMesh mesh;
    Random random(5);
    for (int i = 0; i < kTriangles; ++i) {
        const Vec3 at = normalize(random.in_cube()) * static_cast<float>(std::cbrt(random.unit()));
        for (int corner = 0; corner < 3; ++corner) {
            mesh.indices.push_back(static_cast<uint32_t>(mesh.positions.size()));
            mesh.positions.push_back(at + random.in_cube() * 0.02f);
        }
    }
    return mesh;
}

/// Rotated instances of a body of diameter 2 in [-half, half]³.
std::vector<GeometryInstance> place_all(int count, bool apart, double& half) {
    std::vector<GeometryInstance> all;
    Random random(3);
    const int side = static_cast<int>(std::ceil(std::cbrt(count) - 1e-9));
    half = apart ? 1.1 * (side - 1) : 0.4 * std::cbrt(count);
    for (int i = 0; i < count; ++i) {
        Vec3 at = random.in_cube() * static_cast<float>(half);
        if (apart)
            at = (Vec3{float(i % side), float(i / side % side), float(i / side / side)} * 2.2f) -
                 Vec3{1, 1, 1} * float(half);
        const Vec3 around = random.in_cube();
        all.push_back(
            {0, translation(at.x, at.y, at.z) * rotation_degrees(360 * random.unit(), {around.x, around.y, around.z})});
    }
    return all;
}

struct Rays {
    RayKind kind;
    std::vector<Ray> rays;
};
/// A picture from outside, and rays from anywhere to anywhere.
std::vector<Rays> rays_of(float size, int count) {
    Rays camera{RayKind::coherent, {}}, incoherent{RayKind::incoherent, {}};
    const int side = static_cast<int>(std::sqrt(count));
    const Vec3 eye{0.3f * size, 0.5f * size, 2.4f * size};
    for (int i = 0; i < side * side; ++i) {
        const float x = float(i % side) + 0.5f, y = float(i / side) + 0.5f, across = 2 * size / float(side);
        camera.rays.push_back({eye, 0, Vec3{x * across - size, size - y * across, 0} - eye, kInfinity});
    }
    Random random(8);
    for (int i = 0; i < count; ++i) {
        const Vec3 from = random.in_cube() * size, to = random.in_cube() * size;
        incoherent.rays.push_back({from, 0, to - from, kInfinity});
    }
    return {camera, incoherent};
}

double seconds(const Accel& accel, const Rays& rays, std::vector<Hit>& hits) {
    const double before = thread_seconds();
    accel.intersect(rays.rays, hits, rays.kind);
    return thread_seconds() - before;
}

/// A line of the table.
int measure(const char* name, const BenchMesh& mesh, int count, bool apart, int ray_count) {
    double half = 0;
    const std::vector<GeometryInstance> instances = place_all(count, apart, half);
    const Geometry geometry = mesh.geometry();
    AccelOptions options;
    options.open = OpenInstances::never;
    const Result<Accel> whole = Accel::build({&geometry, 1}, instances, options);
    options.open = OpenInstances::automatic;
    const Result<Accel> chosen = Accel::build({&geometry, 1}, instances, options);
    if (!whole || !chosen) return 1;
    const AccelStatistics &before = whole->statistics(), &after = chosen->statistics();
    fmt::print("| {} | {} | {} | {} |", name, count, apart ? "apart" : "within each other", after.instance_parts);
    for (const Rays& rays : rays_of(static_cast<float>(half + 1), ray_count)) {
        std::vector<Hit> hits(rays.rays.size()), same(rays.rays.size());
        double best[2] = {kInfinity, kInfinity};
        for (int i = 0; i < kRepetitions; ++i) {
            best[0] = std::min(best[0], seconds(*whole, rays, hits));
            best[1] = std::min(best[1], seconds(*chosen, rays, same));
        }
        if (std::memcmp(hits.data(), same.data(), hits.size() * sizeof(Hit)) != 0) return 2;
        fmt::print(" {:.2f} | **{:.2f}** |", double(hits.size()) / best[0] * 1e-6, best[0] / best[1]);
    }
    fmt::print(" {:.1f} → {:.1f} | {:.0f} → {:.0f} |\n", double(before.bytes) * 1e-6, double(after.bytes) * 1e-6,
               before.build_seconds * 1e3, after.build_seconds * 1e3);
    std::fflush(stdout);
    return 0;
}

int run(int ray_count) {
    fmt::print(
        "| body | instances | where | parts | camera, M/s | opened ÷ | incoherent, M/s | opened ÷ | MB | build, ms "
        "|\n|---|---|---|---|---|---|---|---|---|---|\n");
    const BenchMesh solid = bumpy_sphere(kTriangles), sparse = crown();
    for (const auto& [name, mesh] : {std::pair{"solid", &solid}, {"crown", &sparse}})
        for (const bool apart : {false, true})
            for (const int count : {4, 16, 100, 1000, 10'000})
                if (const int status = measure(name, *mesh, count, apart, ray_count)) return status;
    return 0;
}

}  // namespace
}  // namespace steradian::bench

int main(int argc, char** argv) { return steradian::bench::run(std::max(argc > 1 ? std::atoi(argv[1]) : 60'000, 100)); }
