// Which dielectric bodies the rays of a batch go through, and which of the boundaries on their way are there.
//
// A body with a priority may overlap others. Its boundary is there only where the dielectric on one side is another
// than on the other side; elsewhere rays go on as through a hole. Boundaries that are one within the rounding of a hit
// count as one, so that bodies may touch.
#pragma once

#include <vector>

#include "render/integrator.h"
#include "shading/interior.h"

namespace steradian {

class Interiors {
public:
    /// For `paths` paths at a time; for none where the scene has no body to keep track of.
    Interiors(const RenderContext& context, uint32_t paths);
    static constexpr uint64_t bytes_per_path() noexcept { return sizeof(State); }

    bool wanted() const noexcept { return !states_.empty(); }
    /// A new camera sample: what its ray starts in.
    void begin(uint32_t path, const Ray& ray) noexcept;
    /// The path's next ray has been traced, and is to be told of what it hits.
    void start(uint32_t path) noexcept;
    /// Whether the ray goes on through `hit` because no boundary is there. Then `hit` may have become a later one,
    /// behind which it goes on; otherwise that, of several in the same place, which is to be shaded.
    bool passes(uint32_t path, const Ray& ray, Hit& hit) noexcept;
    /// Likewise all the way along a shadow ray from the path's vertex: whether nothing is there. `beyond`: it starts
    /// on the other side of the vertex's surface than the path has arrived on. Cut-outs are the caller's.
    class Walk;
    Walk walk(uint32_t path, bool beyond) const noexcept;
    bool passes(Walk& walk, const Ray& ray, Hit& hit) const noexcept;

    /// The path goes on from its vertex, to the other side of the surface or not.
    void turn(uint32_t path, bool beyond) noexcept { states_[path].beyond = beyond; }
    /// What the path's vertex has to know of the boundary that it lies on.
    void describe(uint32_t path, const Ray& ray, const Hit& hit, SurfacePoint& point) const noexcept;
    /// Of the path's next ray, which leaves its vertex, or of the camera ray: `ray` ends where it is scattered, if that
    /// comes before what it hits.
    void end_in_medium(uint32_t path, Rgb throughput, Vec2 u, Ray& ray) const noexcept;
    /// What becomes of the throughput of a path whose ray may have been shortened so, up to its hit or its end.
    Rgb weight(uint32_t path, Rgb throughput, const Ray& ray, const Hit& hit) const noexcept;
    /// What fills the path's vertex; null for vacuum.
    const Medium* medium(uint32_t path) const noexcept { return states_[path].walk.before.medium(shading_); }

    /// What is left of light on so many metres of the ray that has arrived at the path's vertex, or of one that leaves
    /// it to the other side.
    Rgb transmittance(uint32_t path, bool beyond, double distance) const noexcept;

    class Walk {
        friend class Interiors;
        Interior now;                            ///< where the ray has come to
        Interior group;                          ///< before the boundaries that may be in one place with the next
        float group_begin = -1, group_end = -1;  ///< along the ray
        uint32_t group_size = 0;
        Hit last;                ///< of a boundary that is not there
        Interior before, after;  ///< at the boundary that has been found; no boundary: the same
        float outer_index = 1;   ///< of what is around the body whose boundary that is
        double reach = 0;        ///< along the ray, how far from its hit the others of the group may be
    };

private:
    struct State {
        Walk walk;
        bool beyond = false;
    };
    Interior around(Vec3 origin) const noexcept;
    void cross(Interior& inside, const Ray& ray, const Hit& hit, float& reach) const noexcept;
    bool passes_priority(Walk& walk, const Ray& ray, Hit& hit) const noexcept;

    const RenderContext& c_;
    const ShadingScene& shading_;
    std::vector<State> states_;
    Vec3 last_origin_;      ///< of the last camera ray
    Interior last_around_;  ///< what that starts in
    bool has_last_ = false;
};

}  // namespace steradian
