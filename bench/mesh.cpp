#include "mesh.h"

#include <charconv>
#include <filesystem>
#include <unordered_map>

#include "formats/mesh_file.h"
#include "random.h"

namespace steradian::bench {
namespace {

constexpr int kMaxSubdivisions = 6;

BenchMesh sphere() {
    const float g = 1.6180339887f;
    BenchMesh m;
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

Result<BenchMesh> load(const std::string& path) {
    Result<MeshFile> file = load_mesh_file(path);
    if (!file) return file.error();
    BenchMesh mesh;
    mesh.name = std::filesystem::path(path).stem().string();
    for (const MeshPart& part : file->parts) {
        const auto base = static_cast<uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), part.mesh.positions.begin(), part.mesh.positions.end());
        for (const uint32_t i : part.mesh.indices) mesh.indices.push_back(base + i);
    }
    if (mesh.indices.empty()) return make_error(ErrorCode::bad_input, path + ": no triangles to measure");
    return mesh;
}

Result<int> subdivisions(const std::string& argument, size_t colon) {
    int levels = 0;
    const char *begin = argument.data() + colon + 1, *end = argument.data() + argument.size();
    const auto [stop, error] = std::from_chars(begin, end, levels);
    if (error != std::errc() || stop != end || levels < 0 || levels > kMaxSubdivisions)
        return make_error(ErrorCode::usage, argument + ": after ':' a number of subdivisions from 0 to " +
                                                std::to_string(kMaxSubdivisions) + " is expected");
    return levels;
}

}  // namespace

void subdivide(BenchMesh& mesh) {
    std::unordered_map<uint64_t, uint32_t> middles;
    middles.reserve(mesh.indices.size() / 2);
    const auto middle = [&](uint32_t a, uint32_t b) {
        const uint64_t edge = uint64_t(std::min(a, b)) << 32 | std::max(a, b);
        const auto [found, added] = middles.try_emplace(edge, uint32_t(mesh.positions.size()));
        if (added) mesh.positions.push_back((mesh.positions[a] + mesh.positions[b]) * 0.5f);
        return found->second;
    };
    std::vector<uint32_t> finer;
    finer.reserve(4 * mesh.indices.size());
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        const uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
        const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        finer.insert(finer.end(), {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca});
    }
    mesh.indices = std::move(finer);
}

const std::vector<NamedMesh>& generated_meshes() {
    static const std::vector<NamedMesh> meshes = {
        {"sphere", "327,680 triangles, all alike", sphere},
        {"soup", "300,000 small triangles at random", soup},
        {"landscape-2m", "2 million triangles: ground, trees, rocks", [] { return landscape(2'000'000); }},
        {"landscape-10m", "10 million triangles of the same kind", [] { return landscape(10'000'000); }}};
    return meshes;
}

Result<BenchMesh> make_mesh(const std::string& argument) {
    const auto padded = [](BenchMesh mesh, const std::string& name) {
        if (mesh.name.empty()) mesh.name = name;
        mesh.positions.reserve(mesh.positions.size() + 2);
        return mesh;
    };
    for (const NamedMesh& named : generated_meshes())
        if (named.name == argument) return padded(named.generate(), named.name);
    const size_t colon = argument.rfind(':');
    int levels = 0;
    if (colon != std::string::npos) {
        const Result<int> given = subdivisions(argument, colon);
        if (!given) return given.error();
        levels = *given;
    }
    Result<BenchMesh> mesh = load(argument.substr(0, colon));
    if (!mesh) return mesh.error();
    for (; levels > 0; --levels) subdivide(*mesh);
    return padded(std::move(*mesh), argument);
}

}  // namespace steradian::bench
