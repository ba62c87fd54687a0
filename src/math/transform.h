// Applying and inverting Affine. Everything is computed in double and rounded once.
#pragma once

#include <optional>

#include "math/vector.h"

namespace steradian {

Vec3d transform_point(const Affine& a, Vec3d p);
Vec3d transform_vector(const Affine& a, Vec3d v);
/// By the transposed inverse: pass the inverse of the transform that moves points. Not normalised.
Vec3d transform_normal_by_inverse(const Affine& inverse, Vec3d n);

/// Nothing when the matrix is singular or not finite.
std::optional<Affine> inverse(const Affine& a);
/// The inverse, when it exists and no element of either matrix is beyond kMaxTransform: the numbers of rays in the
/// object's space then stay within the range of float.
inline constexpr double kMaxTransform = 1e30;
std::optional<Affine> usable_inverse(const Affine& a);
double determinant(const Affine& a);
bool is_identity(const Affine& a);
bool is_finite(const Affine& a);
/// The uniform scale factor when `a` is a rotation or reflection times one (relative tolerance 1e-6) that is not 0;
/// else nothing.
std::optional<double> uniform_scale(const Affine& a);

}  // namespace steradian
