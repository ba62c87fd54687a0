// Triangles as the leaves keep them: four at a time, coordinate by coordinate, and a filter in float over all four that
// leaves few for the exact test.
//
// The filter computes what the exact test computes (triangle.h), in float, with a bound on the error of every edge
// function, and drops a triangle only where two of them certainly have opposite signs. So it never changes an answer.
// With u = 2^-24, computed values in lower case, and M the largest max(|P.x - o.x|, |P.y - o.y|) + |P.z - o.z| of the
// three vertices:
//   - a sheared coordinate has five roundings of values that sum to at most M: off by less than 5 u M;
//   - an edge function b.x c.y - b.y c.x then is off by at most 5 u M S + 50 (u M)² for these errors, with
//     S = |b.x| + |b.y| + |c.x| + |c.y|, and by u M S for its own three roundings, as no coordinate is larger than M;
//   - with E = 8 u M, E (S + E) is a third more than that sum: enough for the roundings of the bound itself.
// Products below the range of float are covered by a constant, and origins so far away that they could exceed it turn
// the filter off.
#pragma once

#include <cstdint>

#include "accel/bvh.h"
#include "accel/simd.h"
#include "accel/triangle.h"

namespace steradian {

struct alignas(32) TriangleBlock {
    float vertex[3][3][kBlock];  ///< [which][axis][lane]
    uint32_t prim[kBlock];       ///< kNoHit where the block is not full; the vertices repeat the first triangle then

    Vec3 corner(int which, uint32_t lane) const {
        return {vertex[which][0][lane], vertex[which][1][lane], vertex[which][2][lane]};
    }
};
static_assert(sizeof(TriangleBlock) == 160);

/// What the filter needs of a ray.
struct BlockRay {
    Float4 o[3];  ///< permuted like that of the TriangleRay
    Float4 shear_x, shear_y;
    Float4 least_error;
    int axis[3];

    explicit BlockRay(const TriangleRay& ray)
        : o{Float4::all(static_cast<float>(ray.o[0])), Float4::all(static_cast<float>(ray.o[1])),
            Float4::all(static_cast<float>(ray.o[2]))},
          shear_x(Float4::all(static_cast<float>(ray.shear_x))),
          shear_y(Float4::all(static_cast<float>(ray.shear_y))),
          least_error(Float4::all(reaches_too_far(ray) ? kInfinity : 0x1p-120f)),
          axis{ray.axis[0], ray.axis[1], ray.axis[2]} {}

private:
    static bool reaches_too_far(const TriangleRay& ray) {
        return std::fabs(ray.o[0]) > 1e17 || std::fabs(ray.o[1]) > 1e17 || std::fabs(ray.o[2]) > 1e17;
    }
};

/// A bit for every triangle of the block that the ray may hit.
inline uint32_t filter_block(const TriangleBlock& block, const BlockRay& ray) {
    Float4 x[3], y[3], size_xy = Float4::all(0), size_z = Float4::all(0);
    for (int i = 0; i < 3; ++i) {
        const Float4 dx = Float4::load(block.vertex[i][ray.axis[0]]) - ray.o[0];
        const Float4 dy = Float4::load(block.vertex[i][ray.axis[1]]) - ray.o[1];
        const Float4 dz = Float4::load(block.vertex[i][ray.axis[2]]) - ray.o[2];
        size_xy = larger(size_xy, larger(abs(dx), abs(dy)));
        size_z = larger(size_z, abs(dz));
        x[i] = dx - ray.shear_x * dz;
        y[i] = dy - ray.shear_y * dz;
    }
    const Float4 e = (size_xy + size_z) * Float4::all(0x1p-21f);
    Float4 sum[3];
    for (int i = 0; i < 3; ++i) sum[i] = abs(x[i]) + abs(y[i]);
    uint32_t negative = 0, positive = 0;
    for (int i = 0; i < 3; ++i) {
        const int b = (i + 1) % 3, c = (i + 2) % 3;
        const Float4 edge = x[c] * y[b] - y[c] * x[b];
        const Float4 error = e * (sum[b] + sum[c] + e) + ray.least_error;
        negative |= bits(edge + error < Float4::all(0));
        positive |= bits(error < edge);
    }
    return ~(negative & positive) & 15u;
}

}  // namespace steradian
