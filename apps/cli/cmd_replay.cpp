// steradian replay: one sample of one pixel, vertex by vertex.
#include <fmt/format.h>

#include <bit>
#include <iostream>

#include "base/names.h"
#include "base/parallel.h"
#include "base/text.h"
#include "command.h"
#include "settings_options.h"
#include "steradian/replay.h"

namespace steradian::cli {
namespace {

struct ReplayOptions {
    std::string scene, pixel;
    uint64_t sample = 0;
    SettingsOptions settings;
};

std::string text_of(Vec3 v) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z); }
std::string text_of(Rgb c) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", c.r, c.g, c.b); }

std::string named(const std::string& name) { return name.empty() ? "" : " '" + escape_for_display(name) + "'"; }

std::string outcome(const TracedLight& l) {
    if (!l.shadow_ray) return "brings nothing";
    return (l.occluded ? "occluded, would add " : "adds ") + text_of(l.contribution);
}

void print_surface(const TracedVertex& v, size_t bounces) {
    if (v.escaped)
        std::cout << fmt::format("{} the ray along {} leaves the scene\n", bounces, text_of(v.direction));
    else if (v.in_medium)
        std::cout << fmt::format("{} scattered by a medium, at {}\n", bounces, text_of(v.position));
    else
        std::cout << fmt::format("{} instance {}{}, primitive {}, at {}, normal {}\n", bounces, v.instance,
                                 named(v.object), v.primitive, text_of(v.position), text_of(v.normal));
    std::cout << fmt::format("    throughput {}{}\n", text_of(v.throughput),
                             v.transmittance == Rgb{1, 1, 1} ? "" : ", the medium leaves " + text_of(v.transmittance));
}

void print_vertex(const TracedVertex& v, size_t bounces) {
    print_surface(v, bounces);
    if (v.emission != Rgb{})
        std::cout << fmt::format(
            "    emission {}: pdf {:.6g} of the bsdf, {:.6g} of light samples, weight {:.6g}, adds {}\n",
            text_of(v.emission), v.bsdf_pdf, v.light_pdf, v.mis_weight, text_of(v.contribution));
    if (v.wavelength > 0)
        std::cout << fmt::format("    wavelength {:.6g} nm, weight {}\n", v.wavelength, text_of(v.wavelength_weight));
    for (const TracedLight& l : v.lights)
        std::cout << fmt::format("    light {}{} along {}: pdf {}, {:.6g} of the bsdf, weight {:.6g}, {}\n", l.light,
                                 named(l.name), text_of(l.direction),
                                 l.light_pdf > 0 ? fmt::format("{:.6g}", l.light_pdf) : "of a delta", l.bsdf_pdf,
                                 l.mis_weight, outcome(l));
    if (const auto& b = v.bounce)
        std::cout << fmt::format("    {} along {}: pdf {}, weight {}, survival {:.6g}{}\n",
                                 b->transmitted ? "transmitted" : "reflected", text_of(b->direction),
                                 b->specular ? "of a delta" : fmt::format("{:.6g}", b->pdf), text_of(b->weight),
                                 b->survival, b->survived ? "" : ": the path ends");
}

void print(const SampleTrace& t, const RenderSettings& s) {
    std::cout << fmt::format("sample {} of pixel {},{} by {}, through {:.6g},{:.6g}, filter weight {:.6g}\n", t.sample,
                             t.x, t.y, name_of(s.integrator), t.film.x, t.film.y, t.filter_weight);
    for (size_t i = 0; i < t.vertices.size(); ++i) print_vertex(t.vertices[i], i);
    const auto bits = [](float v) { return std::bit_cast<uint32_t>(v); };
    std::cout << fmt::format("radiance {} {} {}{}\nbits     {:08x} {:08x} {:08x}\n", t.radiance.r, t.radiance.g,
                             t.radiance.b, t.bad ? " (bad: a render drops it)" : "", bits(t.radiance.r),
                             bits(t.radiance.g), bits(t.radiance.b));
}

int run_replay(const ReplayOptions& o) {
    const auto pixel = parse_numbers(o.pixel, ',', 2);
    if (!pixel)
        return report(usage_error(fmt::format("--pixel: '{}' is not X,Y", escape_for_display(o.pixel)),
                                  "from the top left corner of the whole picture, for example --pixel 12,34"));
    Execution execution;
    execution.threads = 1;
    const auto said = parse_overrides(o.settings, execution);
    if (!said) return report(said.error());
    const auto loading = load_options(o.settings, o.scene);
    if (!loading) return report(loading.error());
    const ThreadLimit limit(std::min(hardware_threads(), kMaxThreads));
    auto loaded = load_scene(o.scene, *loading);
    if (!loaded) return report(loaded.error());
    const auto settings = settings_for(o.settings, *said, *loaded);
    if (!settings) return report(settings.error());
    Diagnostics diagnostics = std::move(loaded->diagnostics);
    const auto scene = prepare(std::move(loaded->scene), Execution{}, diagnostics);
    if (!scene) return report(scene.error());
    report(diagnostics);
    const auto trace = replay(*scene, *settings, (*pixel)[0], (*pixel)[1], o.sample);
    if (!trace) return report(trace.error());
    print(*trace, *settings);
    if (auto status = finish_stdout(); !status) return report(status.error());
    return kDone;
}

}  // namespace

void add_replay(CLI::App& app, Action& action) {
    auto o = std::make_shared<ReplayOptions>();
    CLI::App* c = add_command(app, action, "replay", "How one sample of one pixel came to its value", o, run_replay);
    c->footer(
        "Computes the sample again with the code that renders pictures, and prints its path: each surface, what it\n"
        "emits, the lights that were asked, and how the path goes on, with densities (per solid angle) and weights.\n"
        "The last lines are its radiance, which is what `render` adds, to the bit; give the options that the picture\n"
        "was rendered with.");
    c->add_option("SCENE", o->scene, "The scene or model")->required()->type_name("FILE");
    c->add_option("--pixel", o->pixel, "From the top left corner of the whole picture")->required()->type_name("X,Y");
    add_count<uint64_t>(c, "--sample", o->sample, 0, kMaxSamplesPerPixel - 1, "Which of its samples, from 0")
        ->required();
    add_settings_options(c, o->settings);
}

}  // namespace steradian::cli
