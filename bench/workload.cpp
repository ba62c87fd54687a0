#include "workload.h"

#include <cmath>
#include <filesystem>
#include <map>

#include "formats/mesh_file.h"
#include "math/vector.h"

namespace steradian::bench {
namespace {

/// SplitMix64.
class Random {
public:
    explicit Random(uint64_t seed) : state_(seed) {}
    double unit() {
        uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return double((z ^ (z >> 31)) >> 11) * 0x1p-53;
    }
    Vec3 in_cube() {
        const double x = unit(), y = unit(), z = unit();
        return Vec3(Vec3d{2 * x - 1, 2 * y - 1, 2 * z - 1});
    }
    Vec3 cosine_about(Vec3 n) {
        const double u = unit(), angle = 2 * std::numbers::pi * unit(), r = std::sqrt(u);
        const Vec3d local{r * std::cos(angle), r * std::sin(angle), std::sqrt(1 - u)};
        return normalize(Frame::from_z(n).to_world(Vec3(local)));
    }

private:
    uint64_t state_;
};

void subdivide(BenchMesh& mesh) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
        const auto [found, added] =
            middles.try_emplace({std::min(a, b), std::max(a, b)}, uint32_t(mesh.positions.size()));
        if (added) mesh.positions.push_back((mesh.positions[a] + mesh.positions[b]) * 0.5f);
        return found->second;
    };
    std::vector<uint32_t> finer;
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        const uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
        const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        finer.insert(finer.end(), {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca});
    }
    mesh.indices = std::move(finer);
}

BenchMesh sphere() {
    const float g = 1.6180339887f;
    BenchMesh m;
    m.name = "generated sphere";
    m.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    m.indices = {0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4,  11, 10, 2,  10, 7, 6, 7, 1, 8,
                 3, 9,  4, 3, 4, 2, 3, 2, 6, 3, 6, 8,  3, 8,  9,  4, 9, 5, 2, 4,  11, 6,  2,  10, 8,  6, 7, 9, 8, 1};
    for (int level = 0; level < 7; ++level) {
        subdivide(m);
        for (Vec3& p : m.positions) p = normalize(p);
    }
    return m;
}

BenchMesh soup() {
    BenchMesh m;
    m.name = "generated soup";
    Random random(1);
    for (uint32_t i = 0; i < 300'000; ++i) {
        const Vec3 c = random.in_cube();
        for (uint32_t k = 0; k < 3; ++k) {
            m.indices.push_back(3 * i + k);
            m.positions.push_back(c + random.in_cube() * 0.01f);
        }
    }
    return m;
}

struct Camera {
    Vec3 from, forward;
};

/// In the middle when nearly every direction from there hits something, else in front of the mesh.
Camera place_camera(const Accel& accel, Vec3 center, float diagonal) {
    Random random(2);
    int met = 0;
    for (int i = 0; i < 1000; ++i) met += accel.occluded({center, 0, normalize(random.in_cube()), kInfinity});
    if (met > 900) return {center, normalize(Vec3{1, 0.05f, 0.1f})};
    const Vec3 from = center + normalize(Vec3{0.3f, 0.3f, 1}) * diagonal;
    return {from, normalize(center - from)};
}

std::vector<Ray> camera_rays(const Camera& camera, uint32_t size, Random& random) {
    const Vec3 right = normalize(cross(camera.forward, {0, 1, 0})), up = cross(right, camera.forward);
    std::vector<Ray> rays;
    rays.reserve(size_t(size) * size);
    for (uint32_t y = 0; y < size; ++y)
        for (uint32_t x = 0; x < size; ++x) {
            const double sx = (x + random.unit()) / size - 0.5, sy = 0.5 - (y + random.unit()) / size;
            const Vec3 d = camera.forward + right * static_cast<float>(0.9 * sx) + up * static_cast<float>(0.9 * sy);
            rays.push_back({camera.from, 0, normalize(d), kInfinity});
        }
    return rays;
}

std::vector<Ray> bounce(const BenchMesh& mesh, const std::vector<Ray>& rays, const std::vector<Hit>& hits,
                        float diagonal, float tmax, Random& random) {
    std::vector<Ray> out;
    for (size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i].found()) continue;
        const uint32_t* corner = &mesh.indices[3 * size_t(hits[i].prim)];
        const Vec3 a = mesh.positions[corner[0]];
        Vec3 n = Vec3(normalize(cross(Vec3d(mesh.positions[corner[1]] - a), Vec3d(mesh.positions[corner[2]] - a))));
        if (dot(n, rays[i].d) > 0) n = -n;
        const Vec3 p = rays[i].o + rays[i].d * hits[i].t;
        out.push_back({p + n * (1e-5f * diagonal), 0, random.cosine_about(n), tmax});
    }
    return out;
}

}  // namespace

std::vector<BenchMesh> generated_meshes() {
    std::vector<BenchMesh> meshes;
    meshes.push_back(sphere());
    meshes.push_back(soup());
    return meshes;
}

Result<BenchMesh> load_mesh(const std::string& argument) {
    const size_t colon = argument.rfind(':');
    const std::string path = argument.substr(0, colon);
    Result<MeshFile> file = load_mesh_file(path);
    if (!file) return file.error();
    BenchMesh mesh;
    mesh.name = std::filesystem::path(path).stem().string();
    for (const MeshPart& part : file->parts) {
        const auto base = static_cast<uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), part.mesh.positions.begin(), part.mesh.positions.end());
        for (const uint32_t i : part.mesh.indices) mesh.indices.push_back(base + i);
    }
    if (colon != std::string::npos)
        for (int level = std::atoi(argument.c_str() + colon + 1); level > 0; --level) subdivide(mesh);
    return mesh;
}

std::vector<RaySet> record_rays(const Accel& accel, const BenchMesh& mesh, uint32_t size) {
    const Accel::Bounds bounds = accel.bounds();
    const float diagonal = distance(bounds.lo, bounds.hi);
    Random random(3);
    RaySet camera{"camera", false, {}}, diffuse{"diffuse", false, {}}, occlusion{"occlusion", true, {}};
    camera.rays = camera_rays(place_camera(accel, (bounds.lo + bounds.hi) * 0.5f, diagonal), size, random);
    std::vector<Hit> hits(camera.rays.size());
    accel.intersect(camera.rays, hits);
    diffuse.rays = bounce(mesh, camera.rays, hits, diagonal, kInfinity, random);
    occlusion.rays = bounce(mesh, camera.rays, hits, diagonal, 0.1f * diagonal, random);
    return {std::move(camera), std::move(diffuse), std::move(occlusion)};
}

}  // namespace steradian::bench
