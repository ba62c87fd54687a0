// How much of the light that a sky casts on a surface comes from its bright part.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "math/vector.h"

namespace steradian {

/// A part of a sky, small enough to be one direction.
struct SkyPart {
    Vec3d direction;   ///< unit
    double all = 0;    ///< its light
    double above = 0;  ///< what of it counts as bright
};

/// Irradiance by `above` as a share of that by `all`, over normals: a table of what the parts send.
class IrradianceShare {
public:
    IrradianceShare() = default;
    /// May throw std::bad_alloc.
    explicit IrradianceShare(std::span<const SkyPart> parts);

    /// On a surface of normal n (unit), or on both of its sides together. 1 where nothing arrives, and in space (n =
    /// 0).
    double of(Vec3 n, bool both_sides) const noexcept;

private:
    struct Irradiance {
        double all = 0, above = 0;
    };
    const Irradiance& at(Vec3 n) const noexcept;

    std::vector<Irradiance> table_;  ///< over the octahedron unfolded to a square
};

}  // namespace steradian
