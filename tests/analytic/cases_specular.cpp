// Mirrors, refraction, glass, and how bounces are counted.
#include "analytic/case.h"

namespace steradian::analytic {
namespace {

constexpr double kEta = 1.5;

Object glow(Object shape, Color radiance) { return shape.set("light", emission(radiance)); }

/// Sees the floor plane y = 0 of the given material, and an emitter of radiance 3 above it, by reflection.
void add_mirrors(std::vector<Case>& out) {
    const V3 from{0.4, 1, 0.3};
    const Object above = glow(ceiling({0, 2, 0}, 1, 1, "black"), 3);
    const auto over = [&](const Object& material) {
        return empty_scene(from).material("it", material).object(ground({0, 0, 0}, 5, 5, "it")).object(above);
    };
    out.push_back(as_in_catalogue(whole("mirror", "L", over(mirror()), 3.0), "E01_mirror"));
    const Color tint{0.9, 0.5, 0.25};
    out.push_back(whole("mirror_tinted", "r L per channel", over(mirror(tint)), tint * 3));
    out.push_back(whole("mirror_depth_0", "0: the reflection is a bounce", over(mirror()).depth(0), 0.0));
    SceneText from_below = empty_scene({0.4, -1, 0.3})
                               .material("it", mirror())
                               .object(ground({0, 0, 0}, 5, 5, "it"))
                               .object(glow(ground({0, -2, 0}, 1, 1, "black"), 3));
    out.push_back(whole("mirror_both_sides", "L: a mirror has no back", from_below, 3.0));

    // Two parallel mirrors one metre apart; the ray climbs 1/2 m per crossing and leaves after n reflections.
    for (int n = 2; n <= 12; n += 5) {
        const auto corridor = [&](int depth) {
            SceneText scene = empty_scene()
                                  .look({0, 0, 0.5}, {0, 0.25, 0}, kNarrow)
                                  .material("left", mirror(tint))
                                  .material("right", mirror(0.75))
                                  .depth(depth);
            const double height = 0.5 * n;  // between the last reflection and the one that is no more
            scene.object(rectangle({0, height / 2 - 1, 0}, {5, 0, 0}, {0, height / 2 + 1, 0}, "left"));
            scene.object(rectangle({0, height / 2 - 1, 1}, {0, height / 2 + 1, 0}, {5, 0, 0}, "right"));
            return scene.light(environment({3, 2, 1}));
        };
        Color expected{3, 2, 1};
        for (int i = 0; i < n; ++i) expected = expected * (i % 2 == 0 ? tint : Color(0.75));
        const std::string id = "mirror_corridor_" + std::to_string(n);
        out.push_back(whole(id, "L times the reflectance of each mirror", corridor(n), expected));
        out.push_back(whole(id + "_cut", "0: one bounce too few", corridor(n - 1), 0.0));
    }
}

void add_depth(std::vector<Case>& out) {
    // The light that the diffuse floor receives; then the same floor in a mirror.
    const double direct = kRho / kPi * 10 / 4;
    const auto plain = [&](int depth) { return floor_scene().light(point_light({0, 2, 0}, 10)).depth(depth); };
    out.push_back(whole("depth_0_is_emission_only", "0", plain(0), 0.0));
    for (const int depth : {1, 2, 16})
        out.push_back(whole("depth_" + std::to_string(depth) + "_direct",
                            "ρ/π I / d²: direct light ends at the first diffuse surface", plain(depth), direct));
    const auto seen_in_mirror = [&](int depth) {
        const V3 from{0, 1, 1}, hit{0, 2.0 / 3, 2};  // over the mirror in the plane z = 2 down to the origin
        return floor_scene(from, hit)
            .material("mirror", mirror(0.5))
            .object(rectangle({0, 1, 2}, {1, 0, 0}, {0, 1, 0}, "mirror"))
            .light(point_light({0, 2, 0}, 10))
            .depth(depth);
    };
    out.push_back(
        whole("depth_counts_specular_bounces", "0: the mirror has used up the only bounce", seen_in_mirror(1), 0.0));
    out.push_back(whole("depth_after_mirror", "r ρ/π I / d²", seen_in_mirror(2), direct / 2));
    SceneText sheet = floor_scene({0, 2, 0.25}, {0, 0, 0})
                          .material("sheet", refraction(1.0))
                          .object(ground({0, 1.5, 0}, 1, 1, "sheet"))
                          .light(point_light({0, 1, 1}, 10));
    const double below = kRho / kPi * 10 * point_irradiance({0, 1, 1}, {}, kUp);
    out.push_back(whole("depth_1_refraction", "0: refraction has used up the only bounce", sheet, 0.0));
    out.push_back(whole("depth_2_refraction", "ρ/π I cos θ / d²", sheet.depth(2), below));
    for (const auto& [name, material] : {std::pair("refraction", refraction(kEta)), std::pair("glass", glass(kEta))}) {
        SceneText scene = floor_scene()
                              .material("sheet", material)
                              .object(ground({0, 1, 0}, 1, 1, "sheet"))
                              .light(point_light({0, 2, 0}, 10))
                              .depth(16);
        scene.look({0.6, 0.6, 0.9}, {0, 0, 0}, kNarrow);
        out.push_back(whole(std::string(name) + "_blocks_shadow_rays", "0: by convention", scene, 0.0));
    }
}

/// A small emitter (0.1 across) stands where the refracted ray must arrive; straight on it would be missed by far.
void add_refraction(std::vector<Case>& out) {
    const double incident = radians(45), refracted = std::asin(std::sin(incident) / kEta);
    const V3 from{-1, 1, 0};  // looks down at the origin under 45°
    const auto target = [&](double depth_below) { return V3{depth_below * std::tan(refracted), -depth_below, 0}; };
    const auto sheet = [&](const Object& material) {
        return empty_scene(from).material("it", material).object(ground({0, 0, 0}, 5, 5, "it"));
    };
    out.push_back(whole("refraction_bends", "L: unchanged, at the place that Snell's law names",
                        sheet(refraction(kEta)).object(glow(ground(target(2), 0.05, 0.05, "black"), 3)), 3.0));
    out.push_back(whole("refraction_not_straight", "0: nothing in the straight direction",
                        sheet(refraction(kEta)).object(glow(ground({2, -2, 0}, 0.05, 0.05, "black"), 3)), 0.0));
    SceneText sheet_disk = empty_scene(from)
                               .material("it", refraction(kEta))
                               .object(disk({0, 0, 0}, {0, 1, 0}, 1, "it"))
                               .object(glow(ground(target(2), 0.05, 0.05, "black"), 3));
    out.push_back(whole("refraction_one_sheet_disk", "L: unchanged", sheet_disk, 3.0));

    // Through a plate of thickness 1/2 the ray goes on in its old direction, shifted.
    SceneText plate = sheet(refraction(kEta)).object(ceiling({0, -0.5, 0}, 5, 5, "it")).depth(2);
    const V3 shifted{0.5 * std::tan(refracted) + 1.5, -2, 0};
    out.push_back(whole("refraction_plate_shifts", "L: unchanged, shifted by the plate",
                        plate.object(glow(ground(shifted, 0.05, 0.05, "black"), 3)), 3.0));

    // From the dense side, beyond the critical angle of 41.8°, all is reflected: by refraction and by glass alike.
    const V3 below{-2, -1, 0};
    for (const auto& [name, material] : {std::pair("refraction", refraction(kEta)), std::pair("glass", glass(kEta))}) {
        SceneText dense = empty_scene(below).material("it", material).object(ground({0, 0, 0}, 50, 50, "it"));
        dense.object(glow(ground({4, -2, 0}, 0.05, 0.05, "black"), 3)).light(environment(7.0));
        out.push_back(whole(std::string(name) + "_total_internal_reflection", "L: the mirror image", dense, 3.0));
    }
}

void add_glass(std::vector<Case>& out) {
    // One interface: share R of what is above, (1 - R) of what is below scaled by (1/η)², at 0°, 45° and 80°.
    for (const int degrees : {0, 45, 80}) {
        const double angle = radians(degrees), r = fresnel(std::cos(angle), kEta),
                     refracted = std::asin(std::sin(angle) / kEta);
        const V3 from{-std::sin(angle), std::cos(angle), 0};
        SceneText scene = empty_scene()
                              .look(from, {0, 0, 0}, kNarrow, {0, 0, 1})
                              .material("it", glass(kEta))
                              .object(ground({0, 0, 0}, 50, 50, "it"));
        scene.object(glow(ground({std::tan(refracted), -1, 0}, 0.05, 0.05, "black"), Color{0, 5, 0}));
        scene.object(glow(ceiling({2 * std::tan(angle), 2, 0}, 0.05, 0.05, "black"), Color{0, 0, 7}));
        const std::string id = "glass_interface_" + std::to_string(degrees);
        out.push_back(noisy(whole(id, "R L above + (1 - R) / η² L below, R by Fresnel", scene,
                                  {0, 5 * (1 - r) / (kEta * kEta), 7 * r})));
    }
    for (const int depth : {2, 4, 16}) {
        SceneText scene = empty_scene({0.37, 0.21, 3}, {0.37, 0.21, 0}).material("it", glass(kEta)).depth(depth);
        scene.object(rectangle({0, 0, 0.5}, {8, 0, 0}, {0, 8, 0}, "it"))
            .object(rectangle({0, 0, -0.5}, {0, 8, 0}, {8, 0, 0}, "it"));
        scene.object(glow(rectangle({0, 0, -3}, {60, 0, 0}, {0, 60, 0}, "black"), 1));
        Case c = noisy(whole("glass_slab_depth_" + std::to_string(depth), "(1 - R)² Σ R^(2j), 2 + 2j up to the depth",
                             scene, slab_transmission(kEta, depth)));
        if (depth == 16) c.catalogue = "E03b_slab_normal_offedge";
        out.push_back(c);
    }
    // A glass sphere in a white sky, hit under a known angle: 0° and 80°.
    for (const int degrees : {0, 80}) {
        for (const int depth : {1, 2, 3, 16}) {
            const double x = std::sin(radians(degrees));
            SceneText scene = empty_scene({x, 0, 4}, {x, 0, 0})
                                  .material("it", glass(kEta))
                                  .object(sphere({0, 0, 0}, 1, "it"))
                                  .light(environment(1.0))
                                  .depth(depth);
            scene.look({x, 0, 4}, {x, 0, 0}, 0.005);
            out.push_back(noisy(whole("glass_sphere_" + std::to_string(degrees) + "deg_depth_" + std::to_string(depth),
                                      "1 - (1 - R) R^(depth-1)", scene,
                                      glass_sphere_radiance(std::cos(radians(degrees)), kEta, depth))));
        }
    }
    // The camera in the middle of the sphere: η² times the sky, less what has not got out yet.
    SceneText inside = empty_scene({0, 0, 0}, {0.6, 0.8, 0})
                           .look({0, 0, 0}, {0.6, 0.8, 0}, 40)
                           .material("it", glass(kEta))
                           .object(sphere({0, 0, 0}, 1, "it"))
                           .light(environment(1.0))
                           .depth(3);
    out.push_back(
        noisy(whole("glass_seen_from_inside", "η² (1 - R³) L", inside, kEta * kEta * (1 - std::pow(0.04, 3)))));
}

/// The whole glass sphere in a picture: every pixel 1, less the energy that has not come out within the depth.
void add_glass_picture(std::vector<Case>& out) {
    const int depth = 16;
    SceneText scene = empty_scene()
                          .look({0, 0, 4}, {0, 0, 0}, 40)
                          .size(32, 32)
                          .depth(depth)
                          .material("it", glass(kEta))
                          .object(sphere({0, 0, 0}, 1, "it"))
                          .light(environment(1.0));
    // A ray at the angle α from the axis meets the sphere at 4 m at sin i = 4 sin α; the film has an area of (2 tan
    // 20°)².
    const auto missing = [&](double sine) {  // over sin i, so that the grazing end is finely resolved
        const double alpha = std::asin(sine / 4), t = std::tan(alpha), cosine = std::sqrt(1 - sine * sine);
        const double dt = (1 + t * t) / (4 * std::cos(alpha));
        return (1 - glass_sphere_radiance(cosine, kEta, depth)) * 2 * kPi * t * dt;
    };
    const double deficit = integrate([&](double a) { return missing(std::sin(a)) * std::cos(a); }, 0, kPi / 2, 2048);
    const double film = 2 * std::tan(radians(20));
    out.push_back(
        as_in_catalogue(noisy(whole("furnace_glass_sphere", "1, less (1 - R) R^15 integrated over the picture", scene,
                                    1 - deficit / (film * film))),
                        "C05_furnace_glass_sphere"));
}

}  // namespace

std::vector<Case> specular_cases() {
    std::vector<Case> out;
    add_mirrors(out);
    add_depth(out);
    add_refraction(out);
    add_glass(out);
    add_glass_picture(out);
    return out;
}

}  // namespace steradian::analytic
