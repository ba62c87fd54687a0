// Normal and bump maps: the normals that they say, and lobes about those normals that neither leak nor lose light.
#include "shading/relief.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>

#include "math/elementary.h"
#include "math/transform.h"
#include "shading/material_cases.h"
#include "shading/world.h"
#include "support/chi_square.h"
#include "support/support.h"

namespace steradian {
namespace {

using test::material_scene;
using test::MaterialCase;
using test::Random;

double angle_between(Vec3d a, Vec3d b) { return 2 * std::asin(min_of(length(normalize(a) - normalize(b)) / 2, 1.0)); }

/// What is asked of a normal that has been made visible, for any two normals and directions.
TEST(Relief, NormalsAreTurnedAsLittleAsItTakes) {
    Random random(61);
    int turned = 0, kept = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3d ng = random.direction(), n = random.direction(), wo = random.direction();
        const Vec3d out = visible_normal(n, ng, wo);
        const double side = dot(wo, ng) < 0 ? -1 : 1, least = kLeastSeen * dot(wo, ng) * side;
        const double upright = dot(out, ng), seen = dot(out, wo) * side;
        ASSERT_NEAR(length(out), 1, 1e-12);
        ASSERT_GE(upright, kLeastUpright - 1e-12);
        ASSERT_GE(seen, least - 1e-12);
        if (dot(n, ng) >= kLeastUpright && dot(n, wo) * side >= least) {
            EXPECT_EQ(length(out - n), 0);
            ++kept;
            continue;
        }
        // In the plane of n and ng, between them, and no farther than to where the first of the two conditions holds.
        EXPECT_NEAR(dot(out, cross(n, ng)), 0, 1e-12);
        EXPECT_NEAR(angle_between(n, out) + angle_between(out, ng), angle_between(n, ng), 1e-6);
        EXPECT_NEAR(min_of(upright - kLeastUpright, seen - least), 0, 1e-12);
        ++turned;
    }
    EXPECT_GT(kept, 4000);
    EXPECT_GT(turned, 4000);
}

/// A surface of one material with a relief, seen along -z from above unless said otherwise.
class ReliefScene {
public:
    explicit ReliefScene(decltype(Relief::map) map, Texture texture, Shape shape = Rectangle{},
                         const Affine& world_from_object = {}, RawImage image = {}, Mesh mesh = {}) {
        Scene scene;
        if (!image.data.empty()) scene.images.push_back(std::move(image));
        add<TextureId>(scene.textures, Texture{ConstantTexture{{1, 1, 1}}});
        add<TextureId>(scene.textures, std::move(texture));
        add<MaterialId>(scene.materials, Material{DiffuseMaterial{TextureId{0}, true}});
        if (!mesh.indices.empty()) add<MeshId>(scene.meshes, std::move(mesh));
        std::visit([](auto& m) { m.texture = TextureId{1}; }, map);
        scene.reliefs = {{MaterialId{0}, map}};
        const ShapeId id = add<ShapeId>(scene.shapes, std::move(shape));
        add<InstanceId>(scene.instances, Instance{id, MaterialId{0}, world_from_object});
        world_ = std::make_unique<test::World>(std::move(scene));
    }
    const ShadingScene& shading() const { return world_->shading; }
    SurfacePoint at(Vec3d from, Vec3d towards) const {
        const Ray ray = test::ray_towards(from, towards);
        const Hit hit = world_->accel.intersect(ray);
        EXPECT_TRUE(hit.found());
        return surface_at(world_->shading, ray, hit);
    }
    ReliefNormal normal(const SurfacePoint& point) const {
        return relief_normal(world_->shading, point, world_->shading.scene.reliefs[0]);
    }

private:
    std::unique_ptr<test::World> world_;
};

Rgb texel_of(double x, double y, double z) {
    return {static_cast<float>((x + 1) / 2), static_cast<float>((y + 1) / 2), static_cast<float>((z + 1) / 2)};
}

void expect_direction(Vec3 n, Vec3d expected, double tolerance = 1e-6) {
    EXPECT_LT(angle_between(Vec3d(n), expected), tolerance)
        << n.x << " " << n.y << " " << n.z << " instead of " << normalize(expected).x << " " << normalize(expected).y
        << " " << normalize(expected).z;
}

/// Red to the right, green up in the image, which on a rectangle are half_u and half_v.
TEST(Relief, NormalMapsMeanWhatTheySay) {
    const Texture texture = ConstantTexture{texel_of(0.3, 0.2, 0.8)};
    const auto normal = [&](const NormalMap& map) {
        const ReliefScene scene(map, texture);
        const ReliefNormal out = scene.normal(scene.at({0.1, 0.2, 5}, {0.1, 0.2, 0}));
        EXPECT_TRUE(out.turned);
        return out.n;
    };
    expect_direction(normal({}), {0.3, 0.2, 0.8});
    expect_direction(normal({{}, 0.5f}), {0.15, 0.1, 0.8});
    expect_direction(normal({{}, 1, true}), {0.3, -0.2, 0.8});
}

TEST(Relief, FlatMapsLeaveTheNormalAlone) {
    const auto turned = [&](decltype(Relief::map) map, Rgb texel) {
        const ReliefScene scene(map, ConstantTexture{texel});
        const SurfacePoint point = scene.at({0.1, 0.2, 5}, {0.1, 0.2, 0});
        const ReliefNormal out = scene.normal(point);
        EXPECT_EQ(out.n, point.ns);
        return out.turned;
    };
    EXPECT_FALSE(turned(NormalMap{}, {0.5f, 0.5f, 1}));
    EXPECT_FALSE(turned(NormalMap{{}, 0}, {0.9f, 0.5f, 1}));
    EXPECT_FALSE(turned(NormalMap{{}, 0}, {0.5f, 0.5f, 0.5f}));
    EXPECT_FALSE(turned(BumpMap{{}, 5}, {0.7f, 0.7f, 0.7f}));
}

/// Two triangles about the diagonal of a square in the plane z = 0; the corners' coordinates may be mirrored.
Mesh square_mesh(bool mirrored) {
    Mesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    if (mirrored)
        for (Vec2& uv : mesh.uvs) uv.x = 1 - uv.x;
    mesh.indices = {0, 1, 2, 0, 2, 3};
    return mesh;
}

struct Placed {
    std::string name;
    Shape shape;
    Mesh mesh;
    Affine world_from_object;
    Vec3d from, towards;
};

std::vector<Placed> placed_shapes() {
    const Affine turned = translation(0.3, -0.2, 0.4) * rotation_degrees(50, {1, 2, 0.5}) * scaling(1.5, 0.7, 2);
    const Affine mirrored = rotation_degrees(20, {0, 1, 1}) * scaling(-1, 1, 1);
    const Vec3d from{1, 2, 6};
    std::vector<Placed> out;
    for (const auto& [name, transform] : {std::pair{std::string("as it is"), Affine{}},
                                          {std::string("turned"), turned},
                                          {std::string("mirrored"), mirrored}}) {
        const Vec3d eye = transform_point(transform, from);
        const auto aim = [&](Vec3d target) { return transform_point(transform, target); };
        out.push_back(
            {"rectangle " + name, Rectangle{{}, {1, 0, 0}, {0, 2, 0}}, {}, transform, eye, aim({0.2, -0.3, 0})});
        out.push_back({"disk " + name, Disk{}, {}, transform, eye, aim({0.2, -0.3, 0})});
        out.push_back({"sphere " + name, Sphere{{}, 1.5f}, {}, transform, eye, aim({0.2, -0.3, 0})});
        out.push_back({"mesh " + name, MeshId{}, square_mesh(false), transform, eye, aim({0.2, -0.3, 0})});
        out.push_back({"mirrored mesh " + name, MeshId{}, square_mesh(true), transform, eye, aim({0.2, -0.3, 0})});
    }
    return out;
}

/// p(u, v) itself, by rays a little to the sides.
TEST(Relief, DerivativesAreThoseOfThePoint) {
    for (const Placed& placed : placed_shapes()) {
        SCOPED_TRACE(placed.name);
        const ReliefScene scene(NormalMap{}, ConstantTexture{}, placed.shape, placed.world_from_object, {},
                                placed.mesh);
        const SurfacePoint point = scene.at(placed.from, placed.towards);
        const SurfaceDerivatives d = derivatives_at(scene.shading(), point);
        const Frame3d frame = Frame3d::from_z(point.ng);
        for (const Vec3d step : {frame.x, frame.y, -frame.x}) {
            const double h = 2e-3;
            const SurfacePoint there = scene.at(placed.from, Vec3d(point.p) + step * h);
            const double du = there.uv.x - point.uv.x, dv = there.uv.y - point.uv.y;
            const Vec3d moved = Vec3d(there.p) - Vec3d(point.p);
            const Vec3d expected = d.du * (du / d.determinant) + d.dv * (dv / d.determinant);
            EXPECT_NEAR(length(moved - expected), 0, 5e-3 * length(moved));
        }
    }
}

/// Where u and v are perpendicular on the surface, the three numbers of a map are the cosines with u, -v and the
/// normal.
TEST(Relief, NormalMapsFollowTheTextureCoordinates) {
    for (const Placed& placed : placed_shapes()) {
        SCOPED_TRACE(placed.name);
        const ReliefScene scene(NormalMap{}, ConstantTexture{texel_of(0.3, 0.2, 0.9)}, placed.shape,
                                placed.world_from_object, {}, placed.mesh);
        const SurfacePoint point = scene.at(placed.from, placed.towards);
        const SurfaceDerivatives d = derivatives_at(scene.shading(), point);
        const double sign = d.determinant > 0 ? 1 : -1;
        const Vec3d u = normalize(d.du * sign), v = normalize(d.dv * sign), n = scene.normal(point).n;
        const double size = std::sqrt(0.3 * 0.3 + 0.2 * 0.2 + 0.9 * 0.9);
        EXPECT_NEAR(dot(n, u), 0.3 / size, 1e-6);
        EXPECT_NEAR(dot(n, Vec3d(point.ns)), 0.9 / size, 1e-6);
        if (std::fabs(dot(u, v)) < 1e-6) {
            EXPECT_NEAR(dot(n, v), -0.2 / size, 1e-6);
        }
        EXPECT_LT(dot(n, v - u * dot(u, v)), 0);
    }
}

RawImage heights(uint32_t width, uint32_t height, const std::function<double(double, double)>& h) {
    RawImage image{width, height, 1, TexelFormat::f32, {}};
    std::vector<float> values;
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            values.push_back(static_cast<float>(h((x + 0.5) / width, (y + 0.5) / height)));
    image.data.resize(values.size() * sizeof(float));
    std::memcpy(image.data.data(), values.data(), image.data.size());
    return image;
}

ImageTexture numbers_texture() {
    ImageTexture texture;
    texture.color_space = ColorSpace::linear;
    return texture;
}

/// A plane z = a x + b y over a rectangle of 2 by 4 metres has the normal (-a, -b, 1).
TEST(Relief, SlopesOfBumpMapsAreInMetres) {
    // u = (x + 1) / 2, v = (2 - y) / 4.
    const RawImage image = heights(64, 32, [](double u, double v) { return 3 * u - 2 * v; });
    for (const float scale : {0.4f, -0.1f}) {
        const ReliefScene scene(BumpMap{{}, scale}, numbers_texture(), Rectangle{{}, {1, 0, 0}, {0, 2, 0}}, {}, image);
        const double a = 3.0 / 2 * scale, b = 2.0 / 4 * scale;
        for (const Vec3d at : {Vec3d{0.1, 0.2, 0}, {-0.5, 1.2, 0}, {0.7, -0.9, 0}})
            expect_direction(scene.normal(scene.at(at + Vec3d{0, 0, 5}, at)).n, {-a, -b, 1}, 1e-5);
        // With a texture that is turned by 90 degrees and stretched: (s, t) = (2 v, -u).
        ImageTexture turned = numbers_texture();
        turned.rotation = 90, turned.scale = {1, 2};
        const ReliefScene other(BumpMap{{}, scale}, turned, Rectangle{{}, {1, 0, 0}, {0, 2, 0}}, {}, image);
        // h = 3 · 2 v + 2 u, so dh/dx = 2 / 2, dh/dy = -6 / 4; away from the places where it repeats.
        for (const Vec3d at : {Vec3d{0.1, 1.2, 0}, {-0.5, -0.7, 0}})
            expect_direction(other.normal(other.at(at + Vec3d{0, 0, 5}, at)).n, {-scale, 1.5 * scale, 1}, 1e-5);
    }
}

/// On a sphere, against the normal of the surface moved by the heights.
TEST(Relief, BumpMapsAreTheNormalsOfTheDisplacedSurface) {
    const double pi = std::numbers::pi, radius = 2, scale = 1e-3;
    const auto height = [&](double u, double v) { return std::sin(2 * pi * 7 * u) * std::cos(pi * 9 * v); };
    const ReliefScene scene(BumpMap{{}, static_cast<float>(scale)}, numbers_texture(), Sphere{{}, 2}, {},
                            heights(2048, 1024, height));
    const auto displaced = [&](double u, double v) {
        const double theta = pi * v, phi = 2 * pi * u, r = radius + scale * height(u, v);
        return Vec3d{std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi)} * r;
    };
    Random random(62);
    for (int i = 0; i < 200; ++i) {
        const Vec3d direction = random.direction();
        if (std::fabs(direction.y) > 0.95) continue;
        const SurfacePoint point = scene.at(direction * 10, {});
        const double u = point.uv.x, v = point.uv.y, h = 1e-5;
        const Vec3d pu = displaced(u + h, v) - displaced(u - h, v), pv = displaced(u, v + h) - displaced(u, v - h);
        const Vec3d expected = cross(pv, pu), own = point.ns;
        const double tilt = angle_between(expected, own);
        EXPECT_LT(angle_between(Vec3d(scene.normal(point).n), expected), 0.01 * tilt + 1e-4);
    }
}

/// A lobe about a turned normal, as make_bsdf puts it together.
Bsdf folded(size_t material, Vec3 ng, Vec3 n) {
    Bsdf bsdf = material_scene().bsdf(material, ng, n);
    bsdf.folded = true;
    return bsdf;
}

struct Facet {
    Vec3 ng, n;
};
/// From hardly to almost upright.
std::vector<Facet> facets() {
    std::vector<Facet> out;
    const Vec3d ng = normalize(Vec3d{0.2, 0.9, -0.3});
    const Frame3d frame = Frame3d::from_z(ng);
    for (const double degrees : {2.0, 35.0, 65.0, 85.0}) {
        const double t = degrees * std::numbers::pi / 180;
        const Vec3d n = frame.to_world({std::sin(t) * 0.6, std::sin(t) * 0.8, std::cos(t)});
        out.push_back({static_cast<Vec3>(ng), static_cast<Vec3>(normalize(n))});
    }
    return out;
}

/// Directions from which the facet is seen, on either side: the facet is turned for them where it has to be.
template <class Check>
void for_all_facets(const Check& check) {
    Random random(63);
    for (size_t i = 0; i < material_scene().cases().size(); ++i) {
        SCOPED_TRACE(material_scene().cases()[i].name);
        for (const Facet& facet : facets())
            for (const double cosine : {0.95, 0.5, 0.1, -0.6}) {
                const double phi = random.between(0, 2 * std::numbers::pi), sine = std::sqrt(1 - cosine * cosine);
                const Vec3d local{sine * std::cos(phi), sine * std::sin(phi), cosine};
                const Vec3 wo = static_cast<Vec3>(normalize(Frame3d::from_z(facet.ng).to_world(local)));
                const Vec3 n = static_cast<Vec3>(visible_normal(facet.n, facet.ng, wo));
                check(material_scene().cases()[i], i, facet.ng, n, wo, random);
            }
    }
}

TEST(Relief, SamplesOfFoldedLobesFollowTheirDensity) {
    const uint64_t n = test::by_tier<uint64_t>(2000, 200000);
    for_all_facets([&](const MaterialCase& material, size_t index, Vec3 ng, Vec3 ns, Vec3 wo, Random& random) {
        // What is narrow has to be looked at closely, and takes long.
        if (!test::run_everything() && random.bits() % (material.peak < 0.2f ? 32 : 8) != 0) return;
        const Bsdf bsdf = folded(index, ng, ns);
        if (is_specular(bsdf)) return;
        Vec3d peak = material.eta == 1 ? test::mirrored(wo, ns) : test::refracted(wo, ns, material.eta);
        // The peak itself may be folded.
        const double side = dot(Vec3d(wo), Vec3d(ng)) * (material.eta == 1 ? 1 : -1);
        if (dot(peak, Vec3d(ng)) * side < 0) peak = peak - Vec3d(ng) * (2 * dot(peak, Vec3d(ng)));
        const double width = 4.0 * material.peak;
        const test::Magnifier magnifier(width < 0.8 ? peak : Vec3d(ng), width < 0.8 ? width : 1);
        // Half of the directions are uniform, so that no cell expects nothing: the surface cuts some into slivers.
        const auto sampled = [&](uint64_t) -> std::optional<Vec3> {
            if (random.bits() % 2 == 0) return static_cast<Vec3>(random.direction());
            const auto wi = sampled_as_evaluated(bsdf, wo, random);
            return wi ? std::optional(static_cast<Vec3>(magnifier.magnified(*wi))) : std::nullopt;
        };
        const auto density = [&](Vec3 magnified) {
            const Vec3d m = normalize(Vec3d(magnified));
            const double pdf = eval(bsdf, wo, static_cast<Vec3>(magnifier.original(m))).pdf;
            return (pdf * magnifier.solid_angle_ratio(m) + 1 / (4 * std::numbers::pi)) / 2;
        };
        const test::ChiSquare result = test::chi_square_directions(sampled, density, n, 6, 8);
        EXPECT_TRUE(result.passes()) << result << ", cosines " << dot(wo, ng) << " " << dot(ng, ns);
    });
}

/// Nothing passes through what does not transmit, and what transmits says so.
TEST(Relief, FoldedLobesDoNotLeak) {
    for_all_facets([&](const MaterialCase&, size_t index, Vec3 ng, Vec3 ns, Vec3 wo, Random& random) {
        const Bsdf bsdf = folded(index, ng, ns);
        for (int i = 0; i < 100; ++i) {
            const Vec3 wi = static_cast<Vec3>(random.direction());
            const bool through = dot(wi, ng) * dot(wo, ng) < 0;
            if (through && only_reflects(bsdf)) {
                EXPECT_TRUE(is_black(eval(bsdf, wo, wi).f_cos));
            }
            const float uc = random.uniform();
            const auto s = sample(bsdf, wo, uc, random.uniform2());
            if (!s) continue;
            EXPECT_EQ(s->transmitted, dot(s->wi, ng) * dot(wo, ng) < 0);
            EXPECT_FALSE(s->transmitted && only_reflects(bsdf));
            EXPECT_NEAR(length(s->wi), 1, 1e-6);
        }
    });
}

/// In a white furnace a folded lobe shows what the lobe shows on a flat surface: all of it where nothing is lost.
TEST(Relief, FoldedLobesLoseNothing) {
    const int n = test::by_tier(400, 20000);
    for_all_facets([&](const MaterialCase& material, size_t index, Vec3 ng, Vec3 ns, Vec3 wo, Random& random) {
        const Bsdf bent = folded(index, ng, ns), flat = material_scene().bsdf(index, ns, ns);
        if (is_specular(bent) && !material.lossless) return;
        const auto mean = [&](const Bsdf& bsdf, double& variance) {
            double sum = 0, squares = 0;
            for (int i = 0; i < n; ++i) {
                const float uc = random.uniform();
                const auto s = sample(bsdf, wo, uc, random.uniform2());
                const double w = s ? double(s->weight.g) / s->radiance_scale : 0;
                sum += w, squares += w * w;
            }
            variance += max_of(squares / n - sum / n * sum / n, 0.0) / n;
            return sum / n;
        };
        double variance = 0;
        const double a = mean(bent, variance), b = mean(flat, variance);
        EXPECT_NEAR(a, b, 5 * std::sqrt(variance) + 1e-5) << dot(wo, ng) << " " << dot(wo, ns);
        if (material.lossless && (dot(wo, ns) > 0 || material.eta != 1)) {
            EXPECT_NEAR(a, 1, 5 * std::sqrt(variance) + material.energy_error) << dot(wo, ng) << " " << dot(wo, ns);
        }
    });
}

}  // namespace
}  // namespace steradian
