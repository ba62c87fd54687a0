#include "rays.h"

#include <algorithm>

#include "random.h"

namespace steradian::bench {
namespace {

struct Scene {
    const Accel& accel;
    const BenchMesh& mesh;
    Vec3 center;
    float diagonal;
    View view;
    Vec3 light;
};

/// A point that rays have reached, its normal towards where they came from, moved off the surface along it.
struct Point {
    Vec3 p, n;
};

/// The camera in the middle when nearly every direction from there hits something, else in front of the mesh.
Scene set_up(const Accel& accel, const BenchMesh& mesh) {
    const Accel::Bounds bounds = accel.bounds();
    const Vec3 center = (bounds.lo + bounds.hi) * 0.5f;
    const float diagonal = distance(bounds.lo, bounds.hi);
    Random random(2);
    int met = 0;
    for (int i = 0; i < 1000; ++i) met += accel.occluded(Ray{center, 0, normalize(random.in_cube()), kInfinity});
    const bool inside = met > 900;
    const Vec3 from = center + normalize(Vec3{0.3f, 0.3f, 1}) * diagonal;
    View view = inside ? View{center, normalize(Vec3{1, 0.05f, 0.1f})} : View{from, normalize(center - from)};
    if (mesh.view) view = *mesh.view;
    const Vec3 light = inside ? center : center + normalize(Vec3{0.4f, 1, 0.5f}) * diagonal;
    return {accel, mesh, center, diagonal, view, light};
}

std::vector<Ray> camera_rays(const View& view, uint32_t size) {
    Random random(3);
    const Vec3 right = normalize(cross(view.forward, {0, 1, 0})), up = cross(right, view.forward);
    std::vector<Ray> rays;
    rays.reserve(size_t(size) * size);
    for (uint32_t y = 0; y < size; ++y)
        for (uint32_t x = 0; x < size; ++x) {
            const double sx = (x + random.unit()) / size - 0.5, sy = 0.5 - (y + random.unit()) / size;
            const Vec3 d = view.forward + right * static_cast<float>(0.9 * sx) + up * static_cast<float>(0.9 * sy);
            rays.push_back({view.from, 0, normalize(d), kInfinity});
        }
    return rays;
}

std::vector<Point> follow(const Scene& scene, const std::vector<Ray>& rays) {
    std::vector<Hit> hits(rays.size());
    scene.accel.intersect(rays, hits);
    std::vector<Point> points;
    for (size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i].found()) continue;
        const uint32_t* corner = &scene.mesh.indices[3 * size_t(hits[i].prim)];
        const Vec3 a = scene.mesh.positions[corner[0]], b = scene.mesh.positions[corner[1]],
                   c = scene.mesh.positions[corner[2]];
        Vec3 n = Vec3(normalize(cross(Vec3d(b) - Vec3d(a), Vec3d(c) - Vec3d(a))));
        if (dot(n, rays[i].d) > 0) n = -n;
        const Vec3 p = rays[i].o + rays[i].d * hits[i].t;
        points.push_back({p + n * (1e-5f * scene.diagonal), n});
    }
    return points;
}

std::vector<Ray> bounce(const std::vector<Point>& points, float tmax, uint64_t seed) {
    Random random(seed);
    std::vector<Ray> rays;
    rays.reserve(points.size());
    for (const Point& point : points) rays.push_back({point.p, 0, random.cosine_about(point.n), tmax});
    return rays;
}

std::vector<Ray> shadow_rays(const std::vector<Point>& points, Vec3 light) {
    std::vector<Ray> rays;
    for (const Point& point : points) {
        const Vec3 way = point.p - light;
        if (dot(way, point.n) < 0) rays.push_back({light, 0, normalize(way), length(way)});
    }
    return rays;
}

}  // namespace

const std::vector<std::string>& ray_set_names() {
    static const std::vector<std::string> names = {"camera", "diffuse", "diffuse-2", "occlusion", "shadow"};
    return names;
}

std::vector<RaySet> record_rays(const Accel& accel, const BenchMesh& mesh, uint32_t size,
                                const std::vector<std::string>& names) {
    const Scene scene = set_up(accel, mesh);
    const std::vector<Ray> camera = camera_rays(scene.view, size);
    const std::vector<Point> seen = follow(scene, camera);
    const std::vector<Ray> first = bounce(seen, kInfinity, 4);
    std::vector<RaySet> all;
    all.push_back({"camera", false, true, camera});
    all.push_back({"diffuse", false, false, first});
    all.push_back({"diffuse-2", false, false, bounce(follow(scene, first), kInfinity, 5)});
    all.push_back({"occlusion", true, false, bounce(seen, 0.1f * scene.diagonal, 6)});
    all.push_back({"shadow", true, true, shadow_rays(seen, scene.light)});
    std::erase_if(all, [&](const RaySet& set) {
        const bool asked = names.empty() || std::find(names.begin(), names.end(), set.name) != names.end();
        return !asked || set.rays.empty();
    });
    return all;
}

RaySet sample(const RaySet& set, size_t chunk, size_t chunks) {
    if (set.rays.size() <= chunk * chunks) return set;
    RaySet out{set.name, set.any_hit, set.coherent, {}};
    for (size_t i = 0; i < chunks; ++i) {
        const size_t begin = i * (set.rays.size() - chunk) / std::max<size_t>(1, chunks - 1);
        out.rays.insert(out.rays.end(), set.rays.begin() + ptrdiff_t(begin),
                        set.rays.begin() + ptrdiff_t(begin + chunk));
    }
    return out;
}

}  // namespace steradian::bench
