#include "formats/obj/build.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <optional>

#include "base/parallel.h"
#include "formats/mesh/corner_table.h"
#include "formats/mesh/parse_failure.h"
#include "formats/mesh/polygon.h"
#include "math/elementary.h"
#include "math/ray.h"
#include "math/vector.h"

namespace steradian::obj {
namespace {

const Vec3& position_of(const Records& records, const Corner& corner) {
    return records.positions[static_cast<size_t>(corner.position)];
}

/// The corners' positions, for the length of one face's work.
std::span<const Vec3> gather(const Records& records, const Face& face, std::vector<Vec3>& buffer) {
    buffer.clear();
    for (const Corner& corner : face.all()) buffer.push_back(position_of(records, corner));
    return buffer;
}

/// The inner angle at corner i, in [0, 2π].
double angle_at(std::span<const Vec3> p, size_t i, Vec3d normal) {
    const Vec3d here = p[i];
    const Vec3d a = Vec3d(p[i + 1 < p.size() ? i + 1 : 0]) - here;
    const Vec3d b = Vec3d(p[i > 0 ? i - 1 : p.size() - 1]) - here;
    const Vec3d sine = cross(a, b);
    const double angle = math::atan2(length(sine), dot(a, b));
    return dot(sine, normal) < 0 ? 2 * std::numbers::pi - angle : angle;
}

/// Normals of smoothing groups, one for each (group, position) that occurs, numbered in order of first use.
class SmoothNormals {
public:
    SmoothNormals(const Records& records, std::span<const FaceList> lists) {
        std::vector<Vec3> buffer;
        for (const FaceList& list : lists)
            for (const Face& face : list.faces)
                if (face.smoothing != 0) add(records, face, buffer);
        for (Vec3d& sum : sums_) sum = normalize(sum);
    }
    /// The normal's number, kMissing where there is none because the faces cancel each other.
    uint32_t find(uint32_t group, int32_t position) const {
        const uint32_t number = table_.find({group, static_cast<uint32_t>(position), 0});
        return number != CornerTable::kMissing && length(sums_[number]) > 0 ? number : CornerTable::kMissing;
    }
    size_t size() const { return sums_.size(); }
    Vec3 operator[](size_t number) const { return static_cast<Vec3>(sums_[number]); }

private:
    void add(const Records& records, const Face& face, std::vector<Vec3>& buffer) {
        const std::span<const Vec3> points = gather(records, face, buffer);
        const Vec3d normal = normalize(newell_vector(points));
        for (size_t i = 0; i < points.size(); ++i) {
            const auto [number, added] =
                table_.number_of({face.smoothing, static_cast<uint32_t>(face.corners[i].position), 0});
            if (added) sums_.emplace_back();
            sums_[number] = sums_[number] + normal * angle_at(points, i, normal);
        }
    }

    CornerTable table_;
    std::vector<Vec3d> sums_;
};

bool needs_smooth_normals(std::span<const FaceList> lists) {
    for (const FaceList& list : lists)
        for (const Face& face : list.faces)
            if (face.smoothing != 0)
                for (const Corner& corner : face.all())
                    if (corner.normal == kNone) return true;
    return false;
}

/// Builds the mesh of one list.
class MeshBuilder {
public:
    MeshBuilder(const Records& records, const SmoothNormals& smooth, const FaceList& list)
        : records_(records), smooth_(smooth), list_(list) {
        size_t corners = 0;
        for (const Face& face : list.faces) {
            corners += face.size;
            has_normals_ |= face.smoothing != 0;
            for (const Corner& corner : face.all()) {
                has_normals_ |= corner.normal != kNone;
                has_uvs_ |= corner.uv != kNone;
            }
        }
        mesh.indices.reserve(3 * (corners - 2 * list.faces.size()));
        table_ = CornerTable(corners / 4);
    }

    void build() {
        for (size_t i = 0; i < list_.faces.size(); ++i) add(list_.faces[i], i);
    }

    Mesh mesh;
    uint64_t fans = 0;

private:
    void add(const Face& face, size_t face_number) {
        const std::span<const Vec3> points = gather(records_, face, points_);
        const Vec3 flat = has_normals_ ? static_cast<Vec3>(normalize(newell_vector(points))) : Vec3{};
        vertices_.clear();
        for (const Corner& corner : face.all()) vertices_.push_back(vertex(face, corner, face_number, flat));
        triangles_.clear();
        fans += !triangulator_.triangulate(points, triangles_);
        for (const uint32_t corner : triangles_) mesh.indices.push_back(vertices_[corner]);
    }

    /// Normals of all three origins share one numbering: the file's, then smooth ones, then those of faces.
    uint32_t vertex(const Face& face, const Corner& corner, size_t face_number, Vec3 flat) {
        size_t normal_key = 0;
        Vec3 normal = flat;
        if (has_normals_) {
            const uint32_t smooth = corner.normal == kNone && face.smoothing != 0
                                        ? smooth_.find(face.smoothing, corner.position)
                                        : CornerTable::kMissing;
            if (corner.normal != kNone) {
                normal_key = static_cast<size_t>(corner.normal);
                normal = records_.normals[normal_key];
            } else if (smooth != CornerTable::kMissing) {
                normal_key = records_.normals.size() + smooth;
                normal = smooth_[smooth];
            } else {
                normal_key = records_.normals.size() + smooth_.size() + face_number;
            }
        }
        const auto [number, added] =
            table_.number_of({static_cast<uint32_t>(corner.position), static_cast<uint32_t>(corner.uv),
                              static_cast<uint32_t>(normal_key)});
        if (added) {
            mesh.positions.push_back(position_of(records_, corner));
            if (has_normals_) mesh.normals.push_back(normal);
            if (has_uvs_) mesh.uvs.push_back(uv_of(corner));
            if (!records_.colors.empty()) mesh.colors.push_back(records_.colors[static_cast<size_t>(corner.position)]);
        }
        return number;
    }

    Vec2 uv_of(const Corner& corner) const {
        if (corner.uv == kNone) return {0, 0};
        const Vec2 uv = records_.uvs[static_cast<size_t>(corner.uv)];
        return {uv.x, 1 - uv.y};
    }

    const Records& records_;
    const SmoothNormals& smooth_;
    const FaceList& list_;
    bool has_normals_ = false, has_uvs_ = false;
    CornerTable table_;
    PolygonTriangulator triangulator_;
    std::vector<Vec3> points_;
    std::vector<uint32_t> vertices_, triangles_;
};

}  // namespace

std::vector<FaceList> sort_faces(const Records& records, BuildCounts& counts) {
    std::vector<FaceList> lists;
    std::map<std::optional<std::string_view>, size_t> list_of;
    for (const Run& run : records.runs) {
        const auto [found, added] = list_of.emplace(run.state.material, lists.size());
        if (added)
            lists.push_back(
                {run.state.material.value_or(""), run.state.group.value_or(""), run.state.material.has_value(), {}});
        std::vector<Face>& faces = lists[found->second].faces;
        const Corner* corners = run.corners.data();
        for (const uint32_t size : run.sizes) {
            const Face face{corners, size, run.state.smoothing.value_or(0)};
            corners += size;
            const auto corners_of_face = face.all();
            const auto bad = std::find_if(corners_of_face.begin(), corners_of_face.end(), [&](const Corner& corner) {
                return !usable_position(position_of(records, corner));
            });
            if (bad == corners_of_face.end())
                faces.push_back(face);
            else if (counts.not_finite++ == 0)
                counts.first_not_finite = bad->position;
        }
    }
    std::erase_if(lists, [](const FaceList& list) { return list.faces.empty(); });
    return lists;
}

std::vector<Mesh> build_meshes(const Records& records, std::span<const FaceList> lists, BuildCounts& counts) {
    size_t corners = 0, faces = 0;
    for (const FaceList& list : lists) {
        faces += list.faces.size();
        for (const Face& face : list.faces) corners += face.size;
    }
    if (corners + faces + records.normals.size() >= CornerTable::kMissing)
        throw ParseFailure{0, "more than 2^32 corners of faces", {}, ErrorCode::resources};

    const SmoothNormals smooth(records, needs_smooth_normals(lists) ? lists : std::span<const FaceList>());
    std::vector<Mesh> meshes(lists.size());
    std::vector<uint64_t> fans(lists.size());
    parallel_for(lists.size(), 1, [&](size_t i, size_t) {
        MeshBuilder builder(records, smooth, lists[i]);
        builder.build();
        meshes[i] = std::move(builder.mesh);
        fans[i] = builder.fans;
    });
    for (const uint64_t n : fans) counts.fans += n;
    return meshes;
}

}  // namespace steradian::obj
