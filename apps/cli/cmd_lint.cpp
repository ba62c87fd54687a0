// steradian lint: mistakes in a scene that can be rendered nevertheless.
#include <fmt/format.h>

#include <iostream>
#include <memory>

#include "base/parallel.h"
#include "base/text.h"
#include "command.h"
#include "findings.h"
#include "settings_options.h"
#include "steradian/load.h"

namespace steradian::cli {
namespace {

constexpr int kFindings = 1;

struct LintCommand {
    std::string scene;
    LintOptions lint;
    SettingsOptions settings;
    bool strict = false, json = false, list = false;
};

int list_rules() {
    size_t width = 0;
    for (const LintRule& rule : lint_rules()) width = std::max(width, rule.name.size());
    for (const LintRule& rule : lint_rules())
        std::cout << fmt::format("{:{}}  {:7}  {}\n", rule.name, width,
                                 rule.severity == Severity::warning ? "warning" : "note", rule.summary);
    const Status status = finish_stdout();
    return status ? kDone : report(status.error());
}

std::string count_text(uint64_t n, const char* what) { return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s"); }

void print_text(const LintCommand& o, const LintReport& found) {
    print_findings(std::cout, found, "");
    std::cout << fmt::format("{}: {}, {}\n", escape_for_display(o.scene, 4096),
                             count_text(found.count(Severity::warning), "warning"),
                             count_text(found.count(Severity::note), "note"));
}

void print_json(const LintCommand& o, const LintReport& found) {
    rapidjson::StringBuffer buffer;
    JsonWriter w(buffer);
    w.StartObject();
    write_field(w, "scene", o.scene);
    write_findings(w, found);
    w.EndObject();
    std::cout << buffer.GetString() << '\n';
}

int run_lint(const LintCommand& o) {
    if (o.list) return list_rules();
    if (o.scene.empty()) return report(usage_error("a scene is missing", "steradian lint --help shows what there is"));
    auto loading = load_options(o.settings, o.scene);
    if (!loading) return report(loading.error());
    loading->locations = true;
    const ThreadLimit limit(std::min(hardware_threads(), kMaxThreads));
    const auto loaded = load_scene(o.scene, *loading);
    if (!loaded) return report(loaded.error());
    const auto found = lint(*loaded, o.lint);
    if (!found) return report(found.error());
    o.json ? print_json(o, *found) : print_text(o, *found);
    if (auto status = finish_stdout(); !status) return report(status.error());
    return o.strict && found->count(Severity::warning) > 0 ? kFindings : kDone;
}

constexpr const char* kFooter =
    "Each finding is a line, FILE:LINE:COLUMN (JSON POINTER): warning: what is wrong [rule], with a hint below it, in\n"
    "the order of the file. A warning says that the picture is probably not what was meant, a note that something has\n"
    "no effect. docs/lint.md describes the rules.\n"
    "Exit code: 0, with --strict 1 where there is a warning; 2 usage, 3 the scene cannot be read, 4 memory or a "
    "limit.\n"
    "\n"
    "Examples:\n"
    "  steradian lint scene.json                              what is wrong with it?\n"
    "  steradian lint model.glb --strict --disable unused     in a script: fails where there is a warning\n"
    "  steradian lint model.obj --json                        for other programs";

}  // namespace

void add_lint(CLI::App& app, Action& action) {
    auto o = std::make_shared<LintCommand>();
    CLI::App* c = add_command(app, action, "lint",
                              "Mistakes in a scene that can be rendered nevertheless: open glass, lights in walls, …",
                              o, run_lint);
    c->footer(kFooter);
    c->add_option("SCENE", o->scene, "A scene or a model")->type_name("FILE");
    c->add_option("--disable", o->lint.disabled, "Rules that are not of interest; may be given several times")
        ->type_name("RULE")
        ->delimiter(',')
        ->allow_extra_args(false);
    c->add_flag("--strict", o->strict, "Exit with 1 where there is a warning");
    add_count<uint32_t>(c, "--max-per-rule", o->lint.max_per_rule, 0, 1000000,
                        "Findings of one rule to list before the others are counted; 0: all")
        ->default_str("10");
    c->add_flag("--list-rules", o->list, "Show the rules, and end");
    c->add_flag("--json", o->json, "As JSON");
    add_variant_option(c, o->settings);
    c->add_flag("--allow-outside-paths", o->settings.allow_outside_paths,
                "Let a glTF file name files outside its own folder");
    add_count<uint64_t>(c, "--gltf-memory", o->settings.gltf_memory, 0, 1 << 20,
                        "MiB that a glTF file's geometry and texels may take, as for render");
}

}  // namespace steradian::cli
