// Which side of an emitter shines, seen directly, in a mirror, through refraction, and by the light that it throws.
#include "analytic/case.h"

namespace steradian::analytic {
namespace {

const Color kGlow{3, 2, 1};

struct EmitterShape {
    const char* name;
    Object object;       ///< at the origin, its front towards +Z
    double form_factor;  ///< from a point 2 m in front of it
};

std::vector<EmitterShape> shapes() {
    const std::vector<V3> square{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    return {
        {"rectangle", rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, "black"), 4 * parallel_corner_form_factor(1, 1, 2)},
        {"disk", disk({0, 0, 0}, {0, 0, 1}, 1, "black"), parallel_disk_form_factor(1, 2, 0)},
        {"mesh", polygon(square, "black"), 4 * parallel_corner_form_factor(1, 1, 2)}};
}

/// A wall of reflectance 1/2 at z, facing the emitter, seen from a place beside it.
SceneText wall_scene(double z) {
    SceneText scene = empty_scene({1.5, 0.5, z * 0.25}, {0, 0, z});
    const double side = z < 0 ? 1 : -1;
    return scene.object(rectangle({0, 0, z}, {4 * side, 0, 0}, {0, 4, 0}, "floor"));
}

void add_flat(std::vector<Case>& out) {
    for (const EmitterShape& s : shapes()) {
        for (const bool two_sided : {false, true}) {
            const std::string id = std::string("emitter_") + s.name + (two_sided ? "_two_sided" : "_one_sided");
            Object emitter = s.object;
            emitter.set("light", emission(kGlow, two_sided));
            const Color behind = two_sided ? kGlow : Color(0.0);
            out.push_back(
                whole(id + "_front", "L", empty_scene({0.25, 0.25, 3}, {0.1, 0.2, 0}).object(emitter).depth(0), kGlow));
            out.push_back(whole(id + "_back", two_sided ? "L" : "0: the back does not shine",
                                empty_scene({0.25, 0.25, -3}, {0.1, 0.2, 0}).object(emitter).depth(0), behind));
            Case lit_in_front =
                whole(id + "_lights_front", "ρ L F", wall_scene(2).object(emitter), kGlow * (kRho * s.form_factor));
            out.push_back(noisy(lit_in_front));
            Case lit_behind = whole(id + "_lights_back", two_sided ? "ρ L F" : "0: the back does not shine",
                                    wall_scene(-2).object(emitter), behind * (kRho * s.form_factor));
            out.push_back(two_sided ? noisy(lit_behind) : lit_behind);
        }
    }
}

void add_spheres(std::vector<Case>& out) {
    for (const bool two_sided : {false, true}) {
        const std::string id = two_sided ? "emitter_sphere_two_sided" : "emitter_sphere_one_sided";
        Object emitter = sphere({0, 0, 0}, 1, "black").set("light", emission(kGlow, two_sided));
        out.push_back(
            whole(id + "_outside", "L", empty_scene({0.25, 0.25, 3}, {0.1, 0.2, 0}).object(emitter).depth(0), kGlow));
        out.push_back(whole(id + "_inside", two_sided ? "L" : "0: the inside does not shine",
                            empty_scene({0, 0, 0}, {0.1, 0.2, 1}).object(emitter).depth(0),
                            two_sided ? kGlow : Color(0.0)));
        SceneText within =
            empty_scene({0.25, 0.5, 0}, {0, 0, 0}).object(ground({0, 0, 0}, 0.25, 0.25, "floor")).object(emitter);
        const Case lit = whole(id + "_lights_inside", two_sided ? "ρ L" : "0: the inside does not shine", within,
                               two_sided ? kGlow * kRho : Color(0.0));
        out.push_back(two_sided ? noisy(lit) : lit);
    }
}

/// The emitter faces +Z; a mirror behind it or before it shows one of its sides.
void add_indirect(std::vector<Case>& out) {
    const Object emitter = rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, "black").set("light", emission(kGlow));
    const auto seen = [&](double mirror_z, Color value, const char* id, const char* formula) {
        // From (3, 0, 1 or -1) over the mirror in the plane z = ±2 to the middle of the emitter.
        const double z = mirror_z / 2;
        const V3 hit{2, 0, mirror_z};
        SceneText scene = empty_scene({3, 0, z}, hit).material("mirror", mirror()).object(emitter);
        scene.object(rectangle({0, 0, mirror_z}, {10, 0, 0}, {0, 10, 0}, "mirror"));
        out.push_back(whole(id, formula, scene, value));
    };
    seen(2, kGlow, "emitter_front_in_mirror", "L");
    seen(-2, 0.0, "emitter_back_in_mirror", "0: the back does not shine");
    for (const double side : {1.0, -1.0}) {
        SceneText scene =
            empty_scene({0.25, 0.25, 3 * side}, {0.1, 0.2, 0}).material("sheet", refraction(1.5)).object(emitter);
        scene.object(rectangle({0, 0, 1.5 * side}, {4, 0, 0}, {0, 4, 0}, "sheet"));
        out.push_back(whole(side > 0 ? "emitter_front_through_refraction" : "emitter_back_through_refraction",
                            side > 0 ? "L: radiance is passed on unchanged" : "0: the back does not shine", scene,
                            side > 0 ? kGlow : Color(0.0)));
    }
    SceneText hidden = floor_scene({2, 0.4, 0.9})
                           .light(point_light({0, 2, 0}, 10))
                           .object(ground({0, 1, 0}, 0.5, 0.5, "black").set("light", emission(1.0)));
    out.push_back(whole("emitter_back_blocks_light", "0: it shines upwards only, and is opaque", hidden, 0.0));
}

/// A light that the camera does not see: what is behind it is, and everything else is as if nothing had been said.
void add_hidden(std::vector<Case>& out) {
    const Object light = emission(kGlow, true).set("visible_to_camera", false);
    for (EmitterShape& s : shapes()) {
        const std::string id = std::string("emitter_") + s.name + "_hidden";
        const Object it = s.object.set("light", light);
        const SceneText pair = empty_scene({0.25, 0.25, 3}, {0.1, 0.2, 0})
                                   .object(it)
                                   .object(sphere({0, 0, -4}, 2, "black").set("light", emission({5, 6, 7})))
                                   .depth(0);
        out.push_back(whole(id, "L of what is behind it", pair, {5, 6, 7}));
        out.push_back(noisy(whole(id + "_lights", "ρ L F", wall_scene(-2).object(it), kGlow * (kRho * s.form_factor))));
        SceneText mirrored = empty_scene({0.5, 0.25, 1}, {0.1, 0, 2})
                                 .material("mirror", mirror())
                                 .object(rectangle({0, 0, 2}, {1, 0, 0}, {0, -1, 0}, "mirror"))
                                 .object(it);
        out.push_back(whole(id + "_mirrored", "L: a mirror shows it", mirrored, kGlow));
    }
    // A body has two surfaces to look through, and two of them four.
    SceneText bodies = empty_scene({0, 0, 4}, {0, 0, 0}).light(environment(0.5)).depth(0);
    bodies.object(sphere({0, 0, 0}, 1, "black").set("light", light))
        .object(sphere({0.2, 0, -1}, 1, "floor").set("light", light));
    out.push_back(whole("emitter_spheres_hidden", "L of the sky behind them", bodies, 0.5));
}

}  // namespace

std::vector<Case> emitter_side_cases() {
    std::vector<Case> out;
    add_hidden(out);
    add_flat(out);
    add_spheres(out);
    add_indirect(out);
    return out;
}

}  // namespace steradian::analytic
