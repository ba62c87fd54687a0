// Ray against triangle, watertight: after Woop, Benthin & Wald 2013, "Watertight Ray/Triangle Intersection", but with
// everything in double on the float ray and the float vertices.
//
// The vertices are moved by the ray's origin, the axis in which the direction is largest becomes z, and a shear maps
// the ray onto the z axis. What is left is whether the 2D origin lies in a 2D triangle, decided by three edge functions
// E(P, Q) = Px Qy - Py Qx. Why no ray slips through between two triangles:
//   - a vertex is sheared by the same operations in every triangle that has it, so the sheared mesh is closed as well;
//   - the sign of a computed edge function is right or 0, because rounding is monotone: p > q gives p' >= q';
//   - where it comes out as 0, the rounding errors of the two products are compared (Dekker's exact product), so that
//   in
//     the end every sign is exact for the sheared vertices. A sliver's three edge functions do not vanish together
//     unless it has no area in projection;
//   - 0 counts as inside, for both triangles of an edge.
// No epsilon, no dependence on scale: with |coordinates| <= 3.4e38 and components of d either 0 or at least 2^-126,
// nothing in here over- or underflows.
//
// The sheared coordinates of a vertex A are off by a few 2^-53 (|A.x - o.x| + |d.x / d.z| |A.z - o.z|), each axis by
// itself. The slack in the slab test's far scale covers that while a hit lies farther from the origin than about 1e-9
// of the triangle's own size.
#pragma once

#include <cmath>

#include "accel/box.h"

namespace steradian {

/// The axis of the largest component of a direction.
inline int dominant_axis(Vec3 d) {
    const Vec3 size = abs(d);
    const int of_x_and_y = size.x >= size.y ? 0 : 1;
    return max_of(size.x, size.y) >= size.z ? of_x_and_y : 2;
}

/// A ray as the triangle test wants it.
struct TriangleRay {
    double o[3];  ///< permuted: the last one is the axis of the largest direction component
    double shear_x, shear_y;
    double d_z;
    int axis[3];

    TriangleRay() = default;
    /// `ray` must be canonical.
    explicit TriangleRay(const Ray& ray) {
        constexpr int kAfter[] = {1, 2, 0, 1};
        const int z = dominant_axis(ray.d);
        axis[0] = kAfter[z], axis[1] = kAfter[z + 1], axis[2] = z;
        // From memory: Vec3's own way to a component that is not known beforehand is to guess it.
        const float *const from = &ray.o.x, *const towards = &ray.d.x;
        for (int i = 0; i < 3; ++i) o[i] = from[axis[i]];
        d_z = towards[z];
        shear_x = towards[axis[0]] / d_z;
        shear_y = towards[axis[1]] / d_z;
    }
};

struct TriangleCandidate {
    float t = 0;         ///< rounded once; may be infinite
    float u = 0, v = 0;  ///< >= 0, and u + v <= 1 exactly
};

namespace detail {

/// a * b - fl(a * b), exactly (Dekker 1971; Veltkamp's splitting).
inline double product_error(double a, double b, double product) {
    constexpr double kSplit = 134217729;  // 2^27 + 1
    const double a_scaled = kSplit * a, b_scaled = kSplit * b;
    const double a_high = a_scaled - (a_scaled - a), a_low = a - a_high;
    const double b_high = b_scaled - (b_scaled - b), b_low = b - b_high;
    return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
}

/// a * b - c * d with the right sign, in particular 0 only where it is 0.
inline double difference_of_products(double a, double b, double c, double d) {
    const double ab = a * b, cd = c * d;
    const double difference = ab - cd;
    if (difference != 0) [[likely]]
        return difference;
    return product_error(a, b, ab) - product_error(c, d, cd);
}

struct Sheared {
    double x, y, z;
    Sheared(const TriangleRay& ray, Vec3 p) {
        z = p[ray.axis[2]] - ray.o[2];
        x = (p[ray.axis[0]] - ray.o[0]) - ray.shear_x * z;
        y = (p[ray.axis[1]] - ray.o[1]) - ray.shear_y * z;
    }
};

}  // namespace detail

/// Both weights may have been rounded up; one float less of the larger one is enough for a sum of at most 1.
inline void limit_weights(float& a, float& b) {
    if (double(a) + double(b) > 1) [[unlikely]] {
        float& larger = a > b ? a : b;
        larger = std::nextafter(larger, 0.0f);
    }
}

/// The edge functions of a triangle, which are the weights of its vertices, and how far its vertices are along z.
struct EdgeFunctions {
    double u, v, w;
    double z[3];

    /// False when the triangle is missed: when two weights have opposite signs, or all of them vanish.
    bool inside() const { return !((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) && u + v + w != 0; }
    /// Of the second and third vertex, where the triangle is not missed: >= 0, and their sum is at most 1 exactly.
    void weights(float& of_p1, float& of_p2) const {
        const double sum = u + v + w;
        of_p1 = static_cast<float>(v / sum);
        of_p2 = static_cast<float>(w / sum);
        limit_weights(of_p1, of_p2);
    }
    /// The candidate of a triangle that is not missed.
    TriangleCandidate candidate(double d_z) const {
        TriangleCandidate out;
        out.t = static_cast<float>((u * z[0] + v * z[1] + w * z[2]) / ((u + v + w) * d_z));
        weights(out.u, out.v);
        return out;
    }
};

inline EdgeFunctions edge_functions(const TriangleRay& ray, Vec3 p0, Vec3 p1, Vec3 p2) {
    const detail::Sheared a(ray, p0), b(ray, p1), c(ray, p2);
    // Each from the edge that faces the vertex.
    return {detail::difference_of_products(c.x, b.y, c.y, b.x),
            detail::difference_of_products(a.x, c.y, a.y, c.x),
            detail::difference_of_products(b.x, a.y, b.y, a.x),
            {a.z, b.z, c.z}};
}

/// True when the line through the ray meets the triangle, edges and vertices included, from either side. Never for a
/// triangle without area or seen exactly edge-on. t is not limited; settle() does that.
inline bool intersect_triangle(const TriangleRay& ray, Vec3 p0, Vec3 p1, Vec3 p2, TriangleCandidate& out) {
    const EdgeFunctions edges = edge_functions(ray, p0, p1, p2);
    if (!edges.inside()) return false;
    out = edges.candidate(ray.d_z);
    return true;
}

inline Box triangle_bounds(Vec3 p0, Vec3 p1, Vec3 p2) {
    Box box;
    box.extend(p0), box.extend(p1), box.extend(p2);
    return box;
}

}  // namespace steradian
