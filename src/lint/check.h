// What the checks share: the scene, what is where, and the list that findings go to.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lint/bodies.h"
#include "lint/rules.h"
#include "lint/world.h"

namespace steradian::lint_detail {

/// Findings up to a number for each rule; the others are counted.
class Findings {
public:
    explicit Findings(uint32_t max_per_rule) : max_(max_per_rule) {}

    void disable(Rule rule) { disabled_[static_cast<size_t>(rule)] = true; }
    /// Whether a check is worth its time.
    bool wants(Rule rule) const { return !disabled_[static_cast<size_t>(rule)]; }

    void add(Rule rule, std::optional<Element> element, std::string message, std::string hint = {},
             SourceLocation where = {}, uint64_t times = 1);
    LintReport take();

private:
    uint32_t max_;
    std::array<bool, kRuleCount> disabled_{};
    std::array<uint64_t, kRuleCount> kept_{}, left_out_{};
    std::vector<Finding> list_;
};

struct Check {
    const Scene& scene;
    const RenderSettings& settings;
    Findings& out;
    std::span<const Element> consumed;  ///< used, although nothing in the scene says so
    uint32_t own_instances;             ///< those behind are the studio of a bare model
    bool is_model = false;              ///< of a format that has no environment: options give it one
    World world;
    Bodies bodies;

    Check(const Scene& s, const RenderSettings& r, Findings& f, std::span<const Element> c, size_t own)
        : scene(s),
          settings(r),
          out(f),
          consumed(c),
          own_instances(static_cast<uint32_t>(own)),
          world(s),
          bodies(s, world) {}

    /// "material 'gold'" or "material 3", for messages.
    std::string name(Element element) const;
    std::string object(uint32_t instance) const { return name({ElementKind::instance, instance}); }
    std::string material(MaterialId id) const { return name({ElementKind::material, index(id)}); }
};

// Each a file of its own.
void check_usage(Check& check);
void check_materials(Check& check);
void check_textures(Check& check);
void check_meshes(Check& check);
void check_open_glass(Check& check);
void check_orientation(Check& check);
void check_coincidence(Check& check);
void check_overlap(Check& check);
void check_lights(Check& check);
void check_cameras(Check& check);
void check_scale(Check& check);

}  // namespace steradian::lint_detail
