// Lights that light nothing.
#include <fmt/format.h>

#include <cmath>

#include "lint/check.h"
#include "lint/pieces.h"
#include "lint/texels.h"
#include "math/transform.h"
#include "scene/intensity_profile.h"

namespace steradian::lint_detail {
namespace {

bool needs_light(const RenderSettings& settings) {
    return settings.integrator == IntegratorKind::path || settings.integrator == IntegratorKind::direct;
}

class LightCheck {
public:
    explicit LightCheck(Check& check)
        : check_(check), scene_(check.scene), texels_(check.scene), rays_(check.scene, check.world) {}

    void run() {
        bool any = false;
        for (uint32_t i = 0; i < scene_.instances.size(); ++i) any = any || check_.world.emits(i);
        for (uint32_t i = 0; i < scene_.lights.size(); ++i) {
            const Element element{ElementKind::light, i};
            const std::string why = std::visit([&](const auto& light) { return darkness(light); }, scene_.lights[i]);
            if (!why.empty())
                check_.out.add(Rule::dark_light, element, fmt::format("{} is dark: {}", check_.name(element), why));
            any = any || why.empty();
        }
        if (!any && needs_light(check_.settings))
            check_.out.add(Rule::no_light, std::nullopt, "nothing in the scene shines: the picture will be black",
                           check_.is_model
                               ? "'--env 1,1,1' gives it a white sky, '--env sky.hdr' that of a picture"
                               : "add a light, for example {\"type\": \"environment\", \"radiance\": [1, 1, 1]}");
    }

    void look_for_walls() {
        for (uint32_t i = 0; i < scene_.lights.size(); ++i) {
            const std::vector<Vec3d> points = std::visit([&](const auto& l) { return origins(l); }, scene_.lights[i]);
            const auto* area = std::get_if<AreaLight>(&scene_.lights[i]);
            if (points.empty()) continue;
            if (!has_time()) return;
            if (area && covered(i, *area)) continue;
            for (uint32_t k = 0; k < scene_.instances.size(); ++k)
                if (!(area && index(area->instance) == k) && check_.world.box(k).contains(points[0]) && is_wall(k) &&
                    all_inside(k, points) && !seen_inside(k)) {
                    const Element element{ElementKind::light, i};
                    check_.out.add(Rule::light_in_wall, element,
                                   fmt::format("{} is inside of {}, which is closed and opaque ({}), and no camera is",
                                               check_.name(element), check_.object(k),
                                               check_.material(scene_.instances[k].material)));
                    break;
                }
        }
    }

private:
    static std::string dark(Rgb c, const char* what) { return is_black(c) ? fmt::format("its {} is 0", what) : ""; }
    std::string darkness(const PointLight& l) const { return dark(l.intensity, "intensity"); }
    std::string darkness(const SpotLight& l) const { return dark(l.intensity, "intensity"); }
    std::string darkness(const DirectionalLight& l) const { return dark(l.irradiance, "irradiance"); }
    std::string darkness(const GoniometricLight& l) const {
        if (peak_intensity(scene_.profiles[index(l.profile)]) == 0) return "all values of its profile are 0";
        return dark(l.intensity, "intensity");
    }
    std::string darkness(const AreaLight& l) {
        if (is_black(l.radiance)) return dark(l.radiance, "radiance");
        const auto highest = l.texture ? texels_.highest(*l.texture) : std::nullopt;
        return highest && !(max_component(*highest) > 0) ? "its texture is black" : "";
    }
    std::string darkness(const EnvironmentLight& l) {
        if (is_black(l.radiance) || !l.image) return dark(l.radiance, "radiance");
        return max_component(texels_.range(*l.image, l.color_space).highest) > 0 ? "" : "its image is black";
    }

    // --- Walls -------------------------------------------------------------------------------------------------

    /// Points that the light starts from: all of them must be inside.
    static std::vector<Vec3d> origins(const PointLight& l) { return {l.position}; }
    static std::vector<Vec3d> origins(const SpotLight& l) { return {l.position}; }
    static std::vector<Vec3d> origins(const GoniometricLight& l) { return {l.position}; }
    static std::vector<Vec3d> origins(const DirectionalLight&) { return {}; }
    static std::vector<Vec3d> origins(const EnvironmentLight&) { return {}; }
    std::vector<Vec3d> origins(const AreaLight& l) const {
        const Box& box = check_.world.box(index(l.instance));
        std::vector<Vec3d> out;
        for (int corner = 0; corner < 8 && !box.empty(); ++corner) out.push_back(box.corner(corner));
        return out;
    }

    // --- Lights on walls ---------------------------------------------------------------------------------------

    /// Points of a flat light, and where it shines.
    struct Sheet {
        std::vector<Vec3d> points;
        Vec3d normal;
        double size = 0;
    };
    std::optional<Sheet> sheet_of(uint32_t instance) const {
        constexpr uint64_t kMostPieces = 64;
        const uint64_t count = count_pieces(scene_, instance);
        if (count == 0 || count > kMostPieces) return std::nullopt;
        Sheet out;
        Vec3d sum;
        for (uint32_t k = 0; k < count; ++k) {
            const auto c = piece(scene_, instance, k);
            if (!c) return std::nullopt;
            const Vec3d middle = ((*c)[0] + (*c)[1] + (*c)[2]) * (1.0 / 3);
            // Near to the corners, so that a hole in the middle is no finding, nor is a wall that covers a part.
            out.points.push_back(middle);
            for (const Vec3d corner : *c) out.points.push_back(corner + (middle - corner) * 0.05);
            sum = sum + cross((*c)[1] - (*c)[0], (*c)[2] - (*c)[0]);
        }
        const bool mirrored = determinant(scene_.instances[instance].world_from_object) < 0;
        out.size = std::sqrt(length(sum) / 2);
        out.normal = normalize(sum) * (mirrored ? -1.0 : 1.0);
        for (const Vec3d p : out.points)
            if (std::fabs(dot(p - out.points[0], out.normal)) > 1e-4 * out.size) return std::nullopt;
        return out.size > 0 ? std::optional(out) : std::nullopt;
    }

    /// Something opaque is in the light's plane, or so close before it that nothing comes out, everywhere.
    bool covered(uint32_t i, const AreaLight& light) {
        constexpr double kCloseBy = 0.01, kRounding = 0x1p-20;
        const uint32_t own = index(light.instance);
        const auto sheet = sheet_of(own);
        if (!sheet) return false;
        const double slack = kRounding * (reach(sheet->points[0]) + sheet->size);
        std::optional<uint32_t> by;
        for (const double side : {1.0, -1.0}) {
            if (side < 0 && !light.two_sided) break;
            for (const Vec3d p : sheet->points) {
                by = rays_.cover(p, sheet->normal * side, -slack, kCloseBy * sheet->size, own);
                if (!by) return false;
            }
        }
        const Element element{ElementKind::light, i};
        check_.out.add(
            Rule::light_in_wall, element,
            fmt::format("{} lies in or just behind the surface of {} ({}), which hides it", check_.name(element),
                        check_.object(*by), check_.material(scene_.instances[*by].material)),
            "move it a little before the surface");
        return true;
    }

    /// Of many lights among many objects only the first ones are looked at.
    bool has_time() {
        constexpr uint64_t kMostPairs = uint64_t(1) << 28;
        pairs_ += scene_.instances.size();
        return pairs_ <= kMostPairs;
    }
    bool is_wall(uint32_t instance) {
        return check_.world.visible_to_camera(instance) &&
               optics_of(scene_, scene_.instances[instance].material).opaque && check_.bodies.closed(instance);
    }
    bool all_inside(uint32_t wall, const std::vector<Vec3d>& points) {
        for (const Vec3d& p : points)
            if (!check_.bodies.inside(wall, p).value_or(false)) return false;
        return true;
    }
    /// A room, or something whose walls a camera is near to.
    bool seen_inside(uint32_t wall) {
        for (const Camera& camera : scene_.cameras) {
            const Vec3d p = std::visit([](const auto& c) { return Vec3d(c.position); }, camera);
            if (check_.bodies.inside(wall, p).value_or(true)) return true;
        }
        return false;
    }

    Check& check_;
    const Scene& scene_;
    Texels texels_;
    Rays rays_;
    uint64_t pairs_ = 0;
};

}  // namespace

void check_lights(Check& check) {
    LightCheck lights(check);
    if (check.out.wants(Rule::no_light) || check.out.wants(Rule::dark_light)) lights.run();
    if (check.out.wants(Rule::light_in_wall)) lights.look_for_walls();
}

}  // namespace steradian::lint_detail
