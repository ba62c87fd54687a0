#include "shading/irradiance_share.h"

#include <cmath>

#include "base/parallel.h"
#include "math/vector.h"

namespace steradian {
namespace {

/// Normals a side: four degrees from one to the next, where a part of the sky is five wide.
constexpr uint32_t kSide = 32;

/// The sphere as an octahedron whose lower half is folded outwards: x and y in [-1, 1].
struct OnSquare {
    double x, y;
};
double sign_of(double x) { return x < 0 ? -1 : 1; }

OnSquare unfold(Vec3d n) {
    const double sum = std::fabs(n.x) + std::fabs(n.y) + std::fabs(n.z);
    const double x = n.x / sum, y = n.y / sum;
    if (!(n.z < 0)) return {x, y};
    return {(1 - std::fabs(y)) * sign_of(x), (1 - std::fabs(x)) * sign_of(y)};
}

Vec3d fold(OnSquare at) {
    const double z = 1 - std::fabs(at.x) - std::fabs(at.y);
    if (z >= 0) return normalize(Vec3d{at.x, at.y, z});
    return normalize(Vec3d{(1 - std::fabs(at.y)) * sign_of(at.x), (1 - std::fabs(at.x)) * sign_of(at.y), z});
}

uint32_t cell_of(double x) {
    return static_cast<uint32_t>(clamp_to(std::floor((x + 1) * (kSide / 2)), 0.0, kSide - 1.0));
}
double middle_of(uint32_t cell) { return (cell + 0.5) / (kSide / 2) - 1; }

}  // namespace

IrradianceShare::IrradianceShare(std::span<const SkyPart> parts) : table_(size_t{kSide} * kSide) {
    parallel_for(table_.size(), 16, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const Vec3d n = fold({middle_of(uint32_t(i % kSide)), middle_of(uint32_t(i / kSide))});
            for (const SkyPart& part : parts) {
                const double cosine = dot(n, part.direction);
                if (!(cosine > 0)) continue;
                table_[i].all += cosine * part.all;
                table_[i].above += cosine * part.above;
            }
        }
    });
}

const IrradianceShare::Irradiance& IrradianceShare::at(Vec3 n) const noexcept {
    const OnSquare square = unfold(Vec3d(n));
    return table_[cell_of(square.y) * size_t{kSide} + cell_of(square.x)];
}

double IrradianceShare::of(Vec3 n, bool both_sides) const noexcept {
    if (n == Vec3{}) return 1;
    Irradiance sum = at(n);
    if (both_sides) {
        const Irradiance& behind = at(-n);
        sum.all += behind.all;
        sum.above += behind.above;
    }
    return sum.all > 0 ? sum.above / sum.all : 1;
}

}  // namespace steradian
