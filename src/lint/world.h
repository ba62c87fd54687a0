// The scene as the checks look at it: bounds, who uses which mesh, what materials let pass.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "math/vector.h"
#include "steradian/scene.h"

namespace steradian::lint_detail {

struct Box {
    Vec3d lo{kInfinity, kInfinity, kInfinity}, hi{-kInfinity, -kInfinity, -kInfinity};

    void add(Vec3d p);
    void add(const Box& box);
    bool empty() const { return !(lo.x <= hi.x); }
    bool contains(Vec3d p) const;
    bool touches(const Box& other) const;
    Vec3d corner(int i) const { return {i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z}; }
    Vec3d center() const { return (lo + hi) * 0.5; }
    /// Of the diagonal; 0 where empty.
    double size() const { return empty() ? 0 : length(hi - lo); }
};

/// How a material treats light that meets it.
struct Optics {
    bool solid = false;      ///< a boundary between two media: which side is inside matters
    bool one_sided = false;  ///< black when seen from behind
    bool opaque = true;      ///< nothing ever passes
};
Optics optics_of(const Scene& scene, MaterialId id);
/// Bodies with priorities may touch and overlap: which of them is seen is said.
bool ordered(const Scene& scene, MaterialId a, MaterialId b);

/// Ids must be valid. Boxes are those of vertices that are used and usable.
class World {
public:
    explicit World(const Scene& scene);

    const Mesh* mesh_of(uint32_t instance) const;
    /// In its own space.
    const Box& mesh_box(MeshId id) const { return mesh_boxes_[index(id)]; }
    /// In the world, as tight as the corners of the shape's own box allow.
    const Box& box(uint32_t instance) const { return boxes_[instance]; }
    const Box& all() const { return all_; }
    /// Instances of a mesh, ascending.
    std::span<const uint32_t> users(MeshId id) const;
    /// Of the instance's own area light or material.
    bool emits(uint32_t instance) const { return emits_[instance]; }
    /// The instance is there for camera rays; false for lights that only shine.
    bool visible_to_camera(uint32_t instance) const { return !hidden_[instance]; }

private:
    const Scene& scene_;
    std::vector<Box> mesh_boxes_, boxes_;
    std::vector<uint32_t> user_begin_, users_;
    std::vector<bool> emits_, hidden_;
    Box all_;
};

}  // namespace steradian::lint_detail
