// Every kind of material with the parameters at which it may behave differently. What iterates over material_cases()
// tests a new kind from the start: a test fails while a kind has no case.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "shading/bsdf.h"
#include "shading/shading_scene.h"
#include "shading/world.h"

namespace steradian::test {

struct MaterialCase {
    std::string name;
    Material material;
    bool lossless = false;  ///< what arrives leaves again: in a white furnace each side shows 1
    /// The sine of the half angle of the narrowest peak, roughly; 1 where there is none.
    float peak = 1;
    float eta = 1;  ///< index inside over outside
    double energy_error = 1e-3;
    bool reciprocal = true;  ///< layers that let pass what they do not reflect are not
};

/// Cases of one scene; a Bsdf refers to its tables.
class MaterialScene {
public:
    MaterialScene();
    const std::vector<MaterialCase>& cases() const { return cases_; }
    /// At a point with these normals, u along `tangent` of the shading frame.
    Bsdf bsdf(size_t i, Vec3 ng, Vec3 ns) const;

private:
    std::vector<MaterialCase> cases_;
    ShadingScene scene_;
};

const MaterialScene& material_scene();

struct Normals {
    Vec3 ng, ns;
};
/// Equal, and bent against each other.
std::vector<Normals> normal_pairs();

/// Turns the sphere's cap around `axis` into most of it: directions at the angle θ from the axis go to θ',
/// tan(θ'/2) = tan(θ/2) / scale, so that narrow peaks can be binned and integrated.
class Magnifier {
public:
    Magnifier(Vec3d axis, double scale);
    Vec3d magnified(Vec3d w) const;
    Vec3d original(Vec3d magnified) const;
    /// Solid angle at the original over that at the magnified direction.
    double solid_angle_ratio(Vec3d magnified) const;

private:
    Frame3d frame_;
    double scale_;
};

/// Where the highlight of a flat mirror is seen.
Vec3d mirrored(Vec3 wo, Vec3 n);
/// Where one looks through a flat boundary of index eta on the side that n does not point to; straight on where not at
/// all.
Vec3d refracted(Vec3 wo, Vec3 n, double eta);

/// A direction of sample(), of which eval() says the same.
std::optional<Vec3> sampled_as_evaluated(const Bsdf& bsdf, Vec3 wo, Random& random);

}  // namespace steradian::test
