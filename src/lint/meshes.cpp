// Numbers of meshes that make no sense by themselves.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>
#include <vector>

#include "lint/check.h"
#include "lint/place_hash.h"
#include "math/ray.h"

namespace steradian::lint_detail {
namespace {

std::string count_of(uint64_t n, const char* one, const char* many) {
    return n == 1 ? fmt::format("1 {}", one) : fmt::format("{} {}", n, many);
}

struct MeshFaults {
    uint64_t triangles = 0;  ///< that can be rendered
    uint64_t unusable = 0, flat = 0, turned = 0;
    uint32_t first_unusable = 0, first_flat = 0;  ///< triangle
    uint32_t unusable_vertex = 0;
};

/// Cannot be seen at any size: less than a rounding of its vertices would make.
bool has_no_area(Vec3d a, Vec3d b, Vec3d c) {
    const Vec3d n = cross(b - a, c - a);
    return !(length(n) > 0);
}

/// All three normals are on the other side than the triangle's own.
bool is_turned(const Mesh& mesh, const uint32_t* corners, Vec3d n) {
    for (int k = 0; k < 3; ++k)
        if (!(dot(Vec3d(mesh.normals[corners[k]]), n) < 0)) return false;
    return true;
}

MeshFaults faults_of(const Mesh& mesh) {
    MeshFaults out;
    for (uint32_t t = 0; 3 * size_t(t) + 2 < mesh.indices.size(); ++t) {
        const uint32_t* corners = &mesh.indices[3 * size_t(t)];
        Vec3d p[3];
        bool usable = true;
        for (int k = 0; k < 3; ++k) {
            const Vec3 position = mesh.positions[corners[k]];
            p[k] = position;
            if (!usable_position(position) && usable) {
                if (out.unusable == 0) out.first_unusable = t, out.unusable_vertex = corners[k];
                usable = false;
                ++out.unusable;
            }
        }
        if (!usable) continue;
        ++out.triangles;
        if (has_no_area(p[0], p[1], p[2])) {
            if (out.flat++ == 0) out.first_flat = t;
        } else if (!mesh.normals.empty()) {
            out.turned += is_turned(mesh, corners, cross(p[1] - p[0], p[2] - p[0])) ? 1 : 0;
        }
    }
    return out;
}

template <class T, class Good>
uint64_t count_bad(const std::vector<T>& values, Good good) {
    uint64_t bad = 0;
    for (const T& v : values) bad += good(v) ? 0 : 1;
    return bad;
}

void numbers(Check& check, Element element, const Mesh& mesh, const MeshFaults& faults) {
    const auto add = [&](uint64_t bad, const std::string& message) {
        if (bad > 0) check.out.add(Rule::nan_vertices, element, check.name(element) + ": " + message);
    };
    add(faults.unusable,
        fmt::format(
            "{} left out because a vertex is not finite or beyond 1e15, the first is triangle {} with vertex {}",
            count_of(faults.unusable, "triangle is", "triangles are"), faults.first_unusable, faults.unusable_vertex));
    const uint64_t normals = count_bad(mesh.normals, [](Vec3 n) { return is_finite(n); });
    add(normals, count_of(normals, "normal is", "normals are") + " not finite: the flat ones are used");
    const auto finite = [](Vec2 uv) { return is_finite(uv.x) && is_finite(uv.y); };
    uint64_t uvs = count_bad(mesh.uvs, finite);
    for (const std::vector<Vec2>& set : mesh.more_uvs) uvs += count_bad(set, finite);
    add(uvs, count_of(uvs, "texture coordinate is", "texture coordinates are") + " not finite: 0 is used");
    const uint64_t tangents =
        count_bad(mesh.tangents, [](const Tangent& t) { return is_finite(t.direction) && is_finite(t.side); });
    add(tangents, count_of(tangents, "tangent is", "tangents are") + " not finite and left out");
}

// --- The same triangle twice ---------------------------------------------------------------------------------------

struct Turned {
    uint64_t hash;
    uint32_t triangle;
};
using Places = std::array<Vec3, 3>;

/// The three corners from the least on, in their order: that of the same triangle with the same side outside.
Places places_of(const Mesh& mesh, uint32_t triangle) {
    Places p;
    for (size_t k = 0; k < 3; ++k) p[k] = mesh.positions[mesh.indices[3 * size_t(triangle) + k]];
    const auto less = [](Vec3 a, Vec3 b) { return std::tuple(a.x, a.y, a.z) < std::tuple(b.x, b.y, b.z); };
    std::rotate(p.begin(), std::min_element(p.begin(), p.end(), less), p.end());
    return p;
}

struct Duplicates {
    uint64_t count = 0;
    uint32_t first = 0;  ///< the first triangle that repeats another one
};

/// At 16 bytes a triangle. Both sides of a card, wound against each other, are no duplicates.
Duplicates duplicates_of(const Mesh& mesh) {
    std::vector<Turned> all;
    all.reserve(mesh.indices.size() / 3);
    for (uint32_t t = 0; 3 * size_t(t) + 2 < mesh.indices.size(); ++t) {
        const Places p = places_of(mesh, t);
        const bool usable = usable_position(p[0]) && usable_position(p[1]) && usable_position(p[2]);
        if (usable && !has_no_area(p[0], p[1], p[2])) all.push_back({place_hash(p), t});
    }
    std::sort(all.begin(), all.end(), [](const Turned& a, const Turned& b) {
        return std::tuple(a.hash, a.triangle) < std::tuple(b.hash, b.triangle);
    });
    Duplicates out;
    for (size_t i = 1; i < all.size(); ++i) {
        if (all[i].hash != all[i - 1].hash || places_of(mesh, all[i].triangle) != places_of(mesh, all[i - 1].triangle))
            continue;
        if (out.count++ == 0 || all[i].triangle < out.first) out.first = all[i].triangle;
    }
    return out;
}

void duplicates(Check& check, Element element, const Mesh& mesh) {
    if (!check.out.wants(Rule::duplicate_triangles)) return;
    const Duplicates found = duplicates_of(mesh);
    if (found.count > 0)
        check.out.add(Rule::duplicate_triangles, element,
                      fmt::format("{}: {} again where another one is, the first is triangle {}", check.name(element),
                                  count_of(found.count, "triangle is there", "triangles are there"), found.first),
                      "light passes glass twice there, and lights shine twice");
}

}  // namespace

void check_meshes(Check& check) {
    for (uint32_t i = 0; i < check.scene.meshes.size(); ++i) {
        const Mesh& mesh = check.scene.meshes[i];
        const Element element{ElementKind::mesh, i};
        const MeshFaults faults = faults_of(mesh);
        numbers(check, element, mesh, faults);
        if (faults.flat > 0)
            check.out.add(Rule::degenerate_triangles, element,
                          fmt::format("{}: {} without area, the first is triangle {}", check.name(element),
                                      count_of(faults.flat, "triangle", "triangles"), faults.first_flat));
        duplicates(check, element, mesh);
        if (2 * faults.turned > faults.triangles)
            check.out.add(Rule::inverted_normals, element,
                          fmt::format("{}: the normals of {} of {} triangles point to the side that they are "
                                      "clockwise on",
                                      check.name(element), faults.turned, faults.triangles),
                          "turn either the normals or the order of the vertices around");
    }
}

}  // namespace steradian::lint_detail
