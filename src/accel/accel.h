// The bounding volume hierarchy: geometry in, hits out. It knows nothing of scenes, materials or lights.
//
// The closest hit is defined by arithmetic and not by traversal, so it is the same for every builder, kernel and batch:
// the accepted candidate with the smallest (t, instance, prim), compared in that order. See docs/architecture.md.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "math/ray.h"
#include "math/vector.h"
#include "steradian/result.h"
#include "steradian/settings.h"

namespace steradian {

struct SphereGeometry {
    Vec3 center;
    float radius = 1;
};
struct RectangleGeometry {
    Vec3 center, half_u, half_v;
};
/// The ellipse center + a * axis_u + b * axis_v with a² + b² <= 1.
struct DiskGeometry {
    Vec3 center, axis_u, axis_v;
};
/// Three indices a triangle.
struct TriangleGeometry {
    std::span<const Vec3> positions;
    std::span<const uint32_t> indices;
};

/// One kind of primitive per geometry. The spans must outlive the Accel; `prim` of a hit is the index within the span.
using Geometry = std::variant<TriangleGeometry, std::span<const SphereGeometry>, std::span<const RectangleGeometry>,
                              std::span<const DiskGeometry>>;

/// A geometry placed in the world. `instance` of a hit is the index within the span given to build.
/// With an identity transform rays are used as they are; otherwise the ray is transformed into the geometry's space in
/// double and rounded to float once, and t means the same in both spaces.
struct GeometryInstance {
    uint32_t geometry = 0;
    Affine world_from_object;
    /// Primitives that may let rays pass here, such as leaves with an alpha texture: bit i % 8 of byte i / 8 for
    /// primitive i, in ceil(primitives / 8) bytes, which must outlive the Accel. Empty: all of them are opaque.
    std::span<const uint8_t> cut_outs = {};
};

/// Whether parts of instances stand on the upper level in the places of instances; never changes an answer.
enum class OpenInstances : uint8_t {
    automatic,  ///< where instances lie within each other so much that rays get faster
    never,
    always,  ///< for tests
};

struct AccelOptions {
    BvhBuilder builder = BvhBuilder::sah;
    BvhLayout layout = BvhLayout::full;
    uint32_t max_depth = 64;  ///< 1 … 64 levels below a root; a leaf there takes whatever is left
    Isa isa = Isa::automatic;
    OpenInstances open = OpenInstances::automatic;
    std::function<bool()> cancelled;  ///< asked now and then during the build, by one thread at a time
    /// Told now and then how much of the work is done: more each time, above 0 and up to 1, which only a build that
    /// succeeds reaches. By one thread at a time, never while `cancelled` is asked; never changes the result.
    std::function<void(double fraction)> progress;
};

struct AccelStatistics {
    uint64_t primitives = 0, nodes = 0, leaves = 0;
    uint64_t instance_parts = 0;  ///< on the upper level, in the places of instances; 0 unless these are opened
    uint32_t depth = 0;           ///< splits above the deepest leaf of either level
    uint64_t bytes = 0;           ///< everything the Accel holds; the caller's arrays are not counted
    /// Visits of nodes and tests of items that the surface-area heuristic expects for a ray that meets the bounds,
    /// those within instances included. Compare it after a refit with what it was: twice the cost is about twice the
    /// time.
    double cost = 0;
    double build_seconds = 0;
};

/// What the caller knows of the rays in a span; never changes an answer.
enum class RayKind : uint8_t {
    incoherent,
    coherent,  ///< rays that follow each other go much the same way: camera rays, shadow rays towards one point
};

class Accel {
public:
    /// Primitives with coordinates that are not finite or beyond kMaxCoordinate, or with a negative radius, are refused
    /// (bad_input); zero-area ones are fine and are never hit. Refused as well (bad_input): indices of vertices or
    /// geometries that do not exist; cut_outs of another size; a transform that is singular, scales beyond 1e±30 or
    /// leads beyond kMaxCoordinate. `usage` for a max_depth out of range or an instruction set that the machine lacks,
    /// `resources` when memory runs out or there are 2^27 primitives and instances or more (76 million in the compact
    /// layout), `render_failed` when cancelled. Uses the workers of the caller's arena (base/parallel.h).
    static Result<Accel> build(std::span<const Geometry> geometries, std::span<const GeometryInstance> instances,
                               const AccelOptions& options = {});
    /// The same geometries and instances with other vertices, parameters and transforms: much faster than a
    /// new build, and the answers are exactly those of a new build; but the further things move against each other, the
    /// more boxes overlap, and the slower rays become (statistics().cost). The spans replace those given to build.
    ///
    /// On failure nothing has changed. bad_input for what build refuses; for other numbers of geometries, primitives or
    /// instances, other kinds of geometries or other geometries in the instances; and for a transform of a geometry
    /// that is in one place only and was not transformed when the hierarchy was built. `resources` when memory runs
    /// out: the compact layout is packed anew, where the old one still is. Not while anybody else uses the Accel. Uses
    /// the workers of the caller's arena.
    Status refit(std::span<const Geometry> geometries, std::span<const GeometryInstance> instances);

    Accel(Accel&&) noexcept;
    Accel& operator=(Accel&&) noexcept;
    ~Accel();

    /// The closest hits, of cut-outs as of anything else: what passes is for the caller to decide, who goes on with
    /// next_hit(). hits.size() == rays.size() < 2^32. A ray that hits nothing gets Hit{}. Takes about 400 kB of the
    /// caller's stack, as the other calls do.
    void intersect(std::span<const Ray> rays, std::span<Hit> hits, RayKind kind = RayKind::incoherent) const noexcept;
    /// What lies within [tmin, tmax] of a ray.
    enum Occlusion : uint8_t {
        clear = 0,    ///< nothing
        blocked = 1,  ///< something opaque, whatever else there is
        cut_out = 2,  ///< nothing but cut-outs: intersect() finds the first of them, next_hit() the others
    };
    /// An Occlusion for every ray. Without cut-outs, and only then, coherent rays are faster than others.
    void occluded(std::span<const Ray> rays, std::span<uint8_t> result,
                  RayKind kind = RayKind::incoherent) const noexcept;
    /// The hit that follows `after[i]` in the order (t, instance, prim) along the same ray, opaque or not; for
    /// cut-outs.
    void next_hit(std::span<const Ray> rays, std::span<const Hit> after, std::span<Hit> hits) const noexcept;

    Hit intersect(const Ray& ray) const noexcept;
    Occlusion occluded(const Ray& ray) const noexcept;
    /// The same for every instruction set; depends on the builder and the layout.
    RayVisits visits(const Ray& ray) const noexcept;

    /// World bounds of everything; lo > hi when there is nothing.
    struct Bounds {
        Vec3 lo{kInfinity, kInfinity, kInfinity}, hi{-kInfinity, -kInfinity, -kInfinity};
    };
    Bounds bounds() const noexcept;
    const AccelStatistics& statistics() const noexcept;
    /// What AccelStatistics::bytes counts where there is nothing in it.
    static size_t object_bytes() noexcept;

private:
    struct Data;
    explicit Accel(std::unique_ptr<Data> data);
    std::unique_ptr<Data> data_;
};

}  // namespace steradian
