#include "steradian/lint.h"

#include <algorithm>
#include <new>
#include <tuple>

#include <fmt/format.h>

#include "base/parallel.h"
#include "base/text.h"
#include "lint/check.h"
#include "scene/validate.h"

namespace steradian {
namespace lint_detail {

void Findings::add(Rule rule, std::optional<Element> element, std::string message, std::string hint,
                   SourceLocation where, uint64_t times) {
    const auto i = static_cast<size_t>(rule);
    if (disabled_[i]) return;
    if (max_ != 0 && kept_[i] >= max_) {
        ++left_out_[i];
        return;
    }
    ++kept_[i];
    if (times > 1) message += fmt::format(" ({} times)", times);
    list_.push_back(
        {kRules[i].name, kRules[i].severity, std::move(message), std::move(hint), element, std::move(where)});
}

LintReport Findings::take() {
    LintReport out;
    out.findings = std::move(list_);
    for (size_t i = 0; i < kRuleCount; ++i)
        if (left_out_[i] > 0) out.more.push_back({kRules[i].name, kRules[i].severity, left_out_[i]});
    return out;
}

std::string Check::name(Element element) const {
    static constexpr const char* kKinds[kElementKinds] = {"image",  "texture", "material", "mesh",   "shape",
                                                          "object", "light",   "camera",   "profile"};
    const std::vector<std::string>* const lists[kElementKinds] = {
        &scene.names.images, &scene.names.textures, &scene.names.materials,
        &scene.names.meshes, &scene.names.shapes,   &scene.names.instances,
        &scene.names.lights, &scene.names.cameras,  &scene.names.profiles};
    const auto kind = static_cast<size_t>(element.kind);
    const std::vector<std::string>& names = *lists[kind];
    if (element.index < names.size() && !names[element.index].empty())
        return fmt::format("{} '{}'", kKinds[kind], escape_for_display(names[element.index], 100));
    return fmt::format("{} {}", kKinds[kind], element.index);
}

namespace {

std::optional<Rule> rule_called(std::string_view name) {
    const auto found =
        std::find_if(kRules.begin(), kRules.end(), [&](const LintRule& rule) { return rule.name == name; });
    if (found == kRules.end()) return std::nullopt;
    return static_cast<Rule>(found - kRules.begin());
}

Status disable(Findings& findings, const std::vector<std::string>& names) {
    for (const std::string& name : names) {
        const auto rule = rule_called(name);
        if (!rule) {
            std::vector<std::string_view> known;
            for (const LintRule& r : kRules) known.push_back(r.name);
            return make_error(ErrorCode::usage, "there is no rule called '" + escape_for_display(name) + "'",
                              suggestion(name, known));
        }
        findings.disable(*rule);
    }
    return Ok{};
}

/// Numbers of meshes that are not finite are findings, not faults: prepare leaves those triangles out.
Status check_scene(const Scene& scene, const RenderSettings& settings, Findings& findings,
                   const LoadedScene* loaded = nullptr) {
    if (Status status = validate(scene, MeshNumbers::any); !status) return status;
    const bool studio = loaded && loaded->before_studio;
    Check check(scene, settings, findings,
                loaded ? std::span<const Element>(loaded->locations.consumed) : std::span<const Element>(),
                studio ? loaded->before_studio->instances : scene.instances.size());
    check.is_model = loaded && !loaded->locations.file.empty() && extension_of(loaded->locations.file) != ".json";
    check_usage(check);
    check_materials(check);
    check_textures(check);
    check_meshes(check);
    check_open_glass(check);
    check_orientation(check);
    check_coincidence(check);
    check_overlap(check);
    check_lights(check);
    check_cameras(check);
    check_scale(check);
    return Ok{};
}

/// The first files first; within one by line or byte, then in the order in which they were found.
void sort_by_place(std::vector<Finding>& findings, const std::vector<std::string>& files) {
    const auto key = [&](const Finding& f) {
        const auto file = std::find(files.begin(), files.end(), f.where.file) - files.begin();
        return std::tuple(file, f.where.line, f.where.column, f.where.byte.value_or(0));
    };
    std::stable_sort(findings.begin(), findings.end(),
                     [&](const Finding& a, const Finding& b) { return key(a) < key(b); });
}

/// The one place where what goes wrong inside becomes a value.
template <class Body>
Result<LintReport> guarded(const LintOptions& options, Body body) {
    const FloatMode mode;
    try {
        Findings findings(options.max_per_rule);
        if (Status status = disable(findings, options.disabled); !status) return std::move(status).error();
        return body(findings);
    } catch (const std::bad_alloc&) {
        return make_error(ErrorCode::resources, "not enough memory to look for mistakes in the scene");
    }
}

void add_reader_warnings(const LoadedScene& loaded, Findings& findings) {
    for (const Warning& w : loaded.diagnostics.warnings()) {
        const Rule rule = rule_called(w.rule).value_or(Rule::input);
        // The scene still has these, and its own check says more of them.
        if (rule != Rule::albedo_above_one) findings.add(rule, std::nullopt, w.message, {}, w.where, w.count);
    }
    for (const Warning& w : loaded.fidelity.warnings())
        findings.add(Rule::not_honoured, std::nullopt, w.message, {}, w.where, w.count);
    for (const Warning& w : loaded.unused.warnings())
        findings.add(rule_called(w.rule).value_or(Rule::unused), std::nullopt, w.message, {}, w.where, w.count);
}

}  // namespace
}  // namespace lint_detail

std::span<const LintRule> lint_rules() noexcept { return lint_detail::kRules; }

std::string Finding::str() const {
    const std::string place = where.str();
    return fmt::format("{}{}{}: {} [{}]", place, place.empty() ? "" : ": ",
                       severity == Severity::warning ? "warning" : "note", message, rule);
}

uint64_t LintReport::count(Severity severity) const noexcept {
    uint64_t n = 0;
    for (const Finding& finding : findings) n += finding.severity == severity ? 1 : 0;
    for (const More& rest : more) n += rest.severity == severity ? rest.count : 0;
    return n;
}

Result<LintReport> lint(const Scene& scene, const RenderSettings& settings, const LintOptions& options) {
    using namespace lint_detail;
    return guarded(options, [&](Findings& findings) -> Result<LintReport> {
        if (Status status = check_scene(scene, settings, findings); !status) return std::move(status).error();
        return findings.take();
    });
}

Result<LintReport> lint(const LoadedScene& loaded, const LintOptions& options) {
    using namespace lint_detail;
    return guarded(options, [&](Findings& findings) -> Result<LintReport> {
        add_reader_warnings(loaded, findings);
        if (Status status = check_scene(loaded.scene, loaded.settings, findings, &loaded); !status)
            return std::move(status).error();
        LintReport out = findings.take();
        for (Finding& finding : out.findings) {
            if (finding.element) finding.where = loaded.locations.of(*finding.element);
            if (finding.where.file.empty()) finding.where.file = loaded.locations.file;
        }
        sort_by_place(out.findings, loaded.files);
        return out;
    });
}

}  // namespace steradian
