// steradian render: a scene or a model in, pictures out.
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <iostream>
#include <optional>
#include <set>
#include <vector>

#include "base/names.h"
#include "base/parallel.h"
#include "base/text.h"
#include "command.h"
#include "progress.h"
#include "render/memory_estimate.h"
#include "render/metadata.h"
#include "sequence.h"
#include "settings_options.h"
#include "steradian/image_io.h"
#include "steradian/load.h"
#include "steradian/render.h"

namespace steradian::cli {
namespace {

struct RenderOptions {
    std::string scene;
    std::vector<std::string> outputs;
    SettingsOptions settings;
    std::string time_limit;
    std::string bvh = "sah", bvh_layout = "full", isa = "auto";
    Execution execution;
    PictureOptions picture;
    bool quiet = false, json = false;
    SequenceOptions sequence;
    std::optional<Shot> shot = std::nullopt;  ///< which one of a sequence
};

/// What one picture of a sequence leaves for the next one.
struct Said {
    bool list = false;  ///< standard output gets an array of what it gets of each picture
    size_t pictures = 0;
    std::set<std::string> lines;

    /// False for what has been said of a picture before.
    bool is_new(const std::string& line) { return lines.insert(line).second; }
    void next_json() {
        if (list) std::cout << (pictures == 0 ? "[\n" : ",\n");
        ++pictures;
    }
    void end_json() const {
        if (list) std::cout << (pictures == 0 ? "[]\n" : "]\n");
    }
};

// --- Signals: the first one asks the job to stop, the second one ends the process at once. ---------------------

std::atomic<int> g_signal{0};
std::atomic<RenderJob*> g_job{nullptr};

extern "C" void on_signal(int number) {
    if (g_signal.exchange(number) != 0) ::_exit(128 + number);
    if (RenderJob* job = g_job.load()) job->cancel();
}

/// Watches SIGINT, SIGTERM and SIGHUP while a job runs. Those that whoever started us has set to be ignored (nohup, a
/// script's background job) stay ignored.
class SignalScope {
public:
    SignalScope() {
        struct sigaction action {};
        action.sa_handler = on_signal;
        for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
            struct sigaction inherited {};
            ::sigaction(number, nullptr, &inherited);
            if (inherited.sa_handler != SIG_IGN) ::sigaction(number, &action, nullptr);
        }
    }
    ~SignalScope() { g_job = nullptr; }
    void watch(RenderJob* job) {
        g_job = job;
        if (g_signal != 0) job->cancel();
    }
};

std::string default_output(const std::string& scene, const char* format) {
    const size_t slash = scene.find_last_of('/');
    std::string name = slash == std::string::npos ? scene : scene.substr(slash + 1);
    const std::string extension = extension_of(name);
    name.resize(name.size() - extension.size());
    return name + format;
}

/// In seconds: 90, 90s, 1.5m or 2h.
Result<double> parse_time_limit(std::string_view text) {
    const std::string_view units = "smh";
    std::string_view number = text;
    double unit = 1;
    if (!text.empty() && units.find(text.back()) != std::string_view::npos) {
        unit = text.back() == 's' ? 1 : text.back() == 'm' ? 60 : 3600;
        number.remove_suffix(1);
    }
    const auto value = parse_double(number);
    if (value && *value * unit >= kMinTimeLimit && *value * unit <= kMaxTimeLimit) return *value * unit;
    return usage_error(fmt::format("--time-limit: '{}' is not a time", escape_for_display(text)),
                       fmt::format("a number with s, m or h, such as 60s or 1.5h; {} s at least, {} s at most",
                                   kMinTimeLimit, kMaxTimeLimit));
}

// --- Running ---------------------------------------------------------------------------------------------------

/// JSON has no numbers that are not finite: those of a bad sample appear as text.
void write_sample(JsonWriter& w, const RenderOptions& o, const PixelSample& s) {
    w.StartObject();
    w.Key("x"), w.Uint(s.x), w.Key("y"), w.Uint(s.y), w.Key("sample"), w.Uint64(s.sample);
    w.Key("value"), w.StartArray();
    for (const float v : {s.value.r, s.value.g, s.value.b})
        std::isfinite(v) ? w.Double(double(v)) : w.String(fmt::format("{}", v).c_str());
    w.EndArray();
    write_field(w, "replay", replay_command(o.scene, o.settings, s));
    w.EndObject();
}

void write_error_report(JsonWriter& w, const RenderSettings& s, const ErrorReport& e) {
    w.Key("error"), w.StartObject();
    w.Key("target"), w.Double(double(s.target_error));
    w.Key("estimate"), w.Double(e.estimate);
    // What is not finite is no number in JSON.
    if (std::isfinite(e.bound)) w.Key("bound"), w.Double(e.bound);
    w.Key("confidence"), w.Double(ErrorReport::confidence);
    w.Key("certified"), w.Bool(e.certified);
    if (!e.certified) write_field(w, "reason", e.reason);
    w.EndObject();
}

void print_json(const RenderOptions& o, const RenderSettings& s, const RenderResult& r,
                const std::vector<std::string>& written, const Diagnostics& diagnostics, const Diagnostics& fidelity) {
    rapidjson::StringBuffer buffer;
    JsonWriter w(buffer);
    const auto number = [&](const char* key, uint64_t value) { w.Key(key), w.Uint64(value); };
    w.StartObject();
    write_field(w, "scene", o.scene);
    if (o.shot) number("number", o.shot->number);
    if (o.settings.frame_time) w.Key("frame_time"), w.Double(*o.settings.frame_time);
    if (o.settings.turn) w.Key("turn"), w.Double(*o.settings.turn);
    write_field(w, "hash", image_hash(r.image));
    if (!s.aovs.empty()) write_field(w, "color_hash", image_hash(color_channels(r.image)));
    number("width", r.image.width), number("height", r.image.height);
    number("spp", r.out_of_time ? r.min_samples : s.samples_per_pixel);
    w.Key("complete"), w.Bool(r.complete);
    w.Key("out_of_time"), w.Bool(r.out_of_time);
    if (r.error) write_error_report(w, s, *r.error);
    number("min_samples", r.min_samples), number("max_samples", r.max_samples);
    w.Key("mean_samples"), w.Double(r.mean_samples);
    number("samples", r.statistics.samples);
    number("camera_rays", r.statistics.camera_rays);
    number("bounce_rays", r.statistics.bounce_rays);
    number("shadow_rays", r.statistics.shadow_rays);
    number("bad_samples", r.statistics.bad_samples);
    number("threads", r.statistics.threads);
    w.Key("seconds"), w.Double(r.statistics.seconds);
    if (r.statistics.first_bad_sample) {
        w.Key("first_bad_sample");
        write_sample(w, o, *r.statistics.first_bad_sample);
    }
    if (o.execution.fireflies > 0) {
        w.Key("fireflies"), w.StartArray();
        for (const PixelSample& sample : r.statistics.fireflies) write_sample(w, o, sample);
        w.EndArray();
    }
    w.Key("outputs"), w.StartArray();
    for (const std::string& path : written) write_text(w, path);
    w.EndArray();
    for (const auto& [key, list] : {std::pair("warnings", &diagnostics), std::pair("not_honoured", &fidelity)}) {
        w.Key(key), w.StartArray();
        for (const Warning& warning : list->warnings()) write_text(w, warning.str());
        w.EndArray();
    }
    w.EndObject();
    std::cout << buffer.GetString() << '\n';
}

std::string samples_text(const RenderSettings& s, const RenderResult& r) {
    if (r.complete && r.min_samples == r.max_samples) return fmt::format("{} samples", r.min_samples);
    if (s.target_error > 0)
        return fmt::format("{} to {}, on average {:.1f} samples", r.min_samples, r.max_samples, r.mean_samples);
    return partial_samples(s, r.min_samples, r.max_samples);
}

void print_error_report(const RenderSettings& s, const RenderResult& r) {
    if (!r.error) return;
    const ErrorReport& e = *r.error;
    std::cerr << (e.certified
                      ? fmt::format("target error {} reached: with {:.0f} % confidence at most {:.4g}, about {:.4g}\n",
                                    s.target_error, 100 * ErrorReport::confidence, e.bound, e.estimate)
                      : fmt::format("target error {} not certified (about {:.4g} was reached): {}\n", s.target_error,
                                    e.estimate, e.reason));
}

void print_summary(const RenderSettings& s, const RenderResult& r, const std::vector<std::string>& written) {
    const uint64_t rays = r.statistics.camera_rays + r.statistics.bounce_rays + r.statistics.shadow_rays;
    const double seconds = std::max(r.statistics.seconds, 1e-9);
    std::string outputs;
    for (const std::string& path : written) outputs += (outputs.empty() ? "" : ", ") + escape_for_display(path, 4096);
    std::cerr << fmt::format("{}x{}, {} per pixel in {} ({} rays/s, {} thread{}){}{}\n", r.image.width, r.image.height,
                             samples_text(s, r), format_duration(seconds), format_quantity(double(rays) / seconds),
                             r.statistics.threads, r.statistics.threads == 1 ? "" : "s", outputs.empty() ? "" : " -> ",
                             outputs);
}

/// The count goes first: the command ends the line, to be copied.
void warn_bad_samples(const RenderOptions& o, const RenderStatistics& s, Diagnostics& diagnostics) {
    if (!s.first_bad_sample) return;
    const PixelSample& b = *s.first_bad_sample;
    const bool one = s.bad_samples == 1;
    diagnostics.warn(
        fmt::format("{} sample{} not finite or negative and {} dropped; {} sample {} of pixel {},{} with "
                    "({}, {}, {}); to look at it: {}",
                    s.bad_samples, one ? " was" : "s were", one ? "was" : "were", one ? "it is" : "the first is",
                    b.sample, b.x, b.y, b.value.r, b.value.g, b.value.b, replay_command(o.scene, o.settings, b)));
}

void print_fireflies(const RenderOptions& o, const RenderStatistics& s) {
    for (const PixelSample& f : s.fireflies)
        std::cerr << fmt::format("firefly ({}, {}, {}): {}\n", f.value.r, f.value.g, f.value.b,
                                 replay_command(o.scene, o.settings, f));
}

/// What the file asks for and the picture does not show.
void print_fidelity(const Diagnostics& fidelity, Said& said) {
    std::string list;
    for (const Warning& w : fidelity.warnings()) {
        const std::string place = w.where.str();
        const std::string line = fmt::format("  {}{}{}\n", w.message, place.empty() ? "" : ": " + place,
                                             w.count > 1 ? fmt::format(" ({} times)", w.count) : std::string());
        if (said.is_new(line)) list += line;
    }
    if (!list.empty()) std::cerr << "not honoured:\n" << list;
}

void print_warnings(const Diagnostics& diagnostics, Said& said) {
    for (const Warning& warning : diagnostics.warnings())
        if (const std::string line = warning.str(); said.is_new(line)) std::cerr << line << '\n';
    std::cerr.flush();
}

/// Shows how the hierarchy gets on; render_failed when a signal came.
Result<std::shared_ptr<const RenderScene>> prepare_scene(const RenderOptions& o, Scene scene,
                                                         Diagnostics& diagnostics) {
    using Clock = std::chrono::steady_clock;
    ProgressMeter meter(o.quiet);
    std::optional<Clock::time_point> begin;
    PrepareHooks hooks;
    hooks.cancelled = [] { return g_signal != 0; };
    hooks.progress = [&](double fraction) {
        const Clock::time_point now = Clock::now();
        if (!begin) begin = now;
        meter.show_build(fraction, std::chrono::duration<double>(now - *begin).count());
    };
    auto prepared = prepare(std::move(scene), o.execution, diagnostics, hooks);
    meter.finish();
    return prepared;
}

Result<RenderResult> run_job(const RenderOptions& o, std::shared_ptr<const RenderScene> scene,
                             const RenderSettings& settings, SignalScope& signals) {
    auto job = RenderJob::start(std::move(scene), settings, o.execution);
    if (!job) return std::move(job).error();
    signals.watch(job->get());
    ProgressMeter meter(o.quiet);
    while (!(*job)->wait_for(0.2)) meter.show((*job)->progress());
    meter.finish();
    auto result = (*job)->take();
    g_job = nullptr;
    return result;
}

/// Only EXR holds more than colour.
Status check_aovs(const std::vector<std::string>& outputs, AovSet aovs) {
    const auto is_exr = [](const std::string& path) { return extension_of(path) == ".exr"; };
    if (aovs.empty() || outputs.empty() || std::any_of(outputs.begin(), outputs.end(), is_exr)) return Ok{};
    return usage_error(
        fmt::format("output {}: the AOVs {} need an EXR file", escape_for_display(outputs[0], 4096), names_in(aovs)),
        "--output FILE.exr as well, or --aovs none");
}

/// Tries every output, whatever becomes of the others, and reports the failures. Returns those that were written.
std::vector<std::string> write_outputs(const RenderOptions& o, const Image& image, Diagnostics& diagnostics) {
    std::vector<std::string> written;
    for (const std::string& path : o.outputs) {
        const bool whole = image.channels.size() == 3 || extension_of(path) == ".exr";
        const Status status = write_image(path, whole ? image : color_channels(image), o.picture.write(), &diagnostics);
        status ? written.push_back(path) : void(report(status.error()));
    }
    return written;
}

/// What there is to say and to save once the picture is there.
int finish(const RenderOptions& o, const RenderSettings& settings, const RenderResult& result, Diagnostics diagnostics,
           const Diagnostics& fidelity, Said& said) {
    Diagnostics afterwards;
    warn_bad_samples(o, result.statistics, afterwards);
    const std::vector<std::string> written = write_outputs(o, result.image, afterwards);
    if (!o.quiet) {
        report(afterwards), print_summary(settings, result, written);
        print_fireflies(o, result.statistics), print_fidelity(fidelity, said);
    }
    const bool missed = result.error && !result.error->certified;
    if (!o.quiet || missed) print_error_report(settings, result);
    diagnostics.append(afterwards);
    if (o.json) said.next_json(), print_json(o, settings, result, written, diagnostics, fidelity);
    if (auto status = finish_stdout(); !status) return report(status.error());
    if (written.size() < o.outputs.size()) return kResources;
    const int signal = g_signal.load();
    if (signal != 0) return 128 + signal;
    return missed ? kResources : kDone;
}

/// Their names over lines of the help.
std::string aov_list() {
    std::string out;
    size_t column = 60;
    for (const std::string_view name : names_of<Aov>()) {
        if (column + name.size() > 90) out += out.empty() ? "" : "\n", column = 0;
        out += std::string(name) + (name == names_of<Aov>().back() ? "" : ", ");
        column += name.size() + 2;
    }
    return out;
}

/// By a signal.
int stopped_early(const char* when, const char* what = "nothing was written") {
    std::cerr << fmt::format("stopped {}: {}\n", when, what);
    return 128 + g_signal;
}

/// Their names, with the number of the picture where there are several.
void number_outputs(RenderOptions& o) {
    if (o.shot)
        for (std::string& path : o.outputs) path = numbered(path, o.shot->number);
}

int render_one(const RenderOptions& given, SignalScope& signals, Said& told) {
    RenderOptions o = given;
    const bool by_default = o.outputs.empty() && !o.json;
    if (by_default) o.outputs.push_back(default_output(o.scene, ".png"));
    number_outputs(o);
    o.execution.bvh = *find_name<BvhBuilder>(o.bvh);
    o.execution.bvh_layout = *find_name<BvhLayout>(o.bvh_layout);
    o.execution.isa = *find_name<Isa>(o.isa);
    if (!o.time_limit.empty()) {
        const auto limit = parse_time_limit(o.time_limit);
        if (!limit) return report(limit.error());
        o.execution.time_limit = *limit;
    }
    if (auto status = check_outputs(o.outputs, o.picture); !status) return report(status.error());
    const auto said = parse_overrides(o.settings, o.execution);
    if (!said) return report(said.error());
    if (auto status = check_aovs(by_default ? std::vector<std::string>() : o.outputs, said->aovs.value_or(AovSet()));
        !status)
        return report(status.error());
    const auto loading = load_options(o.settings, o.scene);
    if (!loading) return report(loading.error());

    const uint32_t threads = o.execution.threads ? o.execution.threads : hardware_threads();
    const ThreadLimit limit(std::min(threads, kMaxThreads));
    auto loaded = load_scene(o.scene, *loading);
    if (!loaded) return report(loaded.error());
    if (auto status = check_not_inputs(o.outputs, loaded->files); !status) return report(status.error());
    auto settings = settings_for(o.settings, *said, *loaded);
    if (!settings) return report(settings.error());
    if (by_default && !settings->aovs.empty()) {
        o.outputs = {default_output(o.scene, ".exr")};
        number_outputs(o);
        if (auto status = check_outputs(o.outputs, o.picture); !status) return report(status.error());
    }
    if (auto status = check_aovs(o.outputs, settings->aovs); !status) return report(status.error());
    // The scene's own number of samples is for those who do not say when to stop.
    if (o.execution.time_limit > 0 && !o.settings.spp) settings->samples_per_pixel = kMaxSamplesPerPixel;
    Diagnostics diagnostics = std::move(loaded->diagnostics);
    if (auto status = check_scene_memory(estimate_memory(loaded->scene, *settings, o.execution)); !status)
        return report(status.error());
    auto scene = prepare_scene(o, std::move(loaded->scene), diagnostics);
    if (!scene) return g_signal != 0 ? stopped_early("before the hierarchy was built") : report(scene.error());
    if (!o.quiet) print_warnings(diagnostics, told);

    const auto result = run_job(o, std::move(*scene), *settings, signals);
    if (!result) return report(result.error());
    if (g_signal != 0 && result->max_samples == 0) return stopped_early("before the first samples were done");
    // A film must not have a frame in it that is noisier than the others.
    if (g_signal != 0 && o.shot && !result->complete)
        return stopped_early("in the middle of a picture", "it was not written");
    return finish(o, *settings, *result, std::move(diagnostics), loaded->fidelity, told);
}

/// The pictures of a sequence one after the other, up to the first that fails.
int run_render(const RenderOptions& o) {
    SignalScope signals;
    Said said;
    const auto shots = parse_sequence(o.sequence, o.settings);
    if (!shots) return report(shots.error());
    if (shots->empty()) return render_one(o, signals, said);
    said.list = o.json;
    int code = kDone;
    for (size_t i = 0; i < shots->size() && code == kDone; ++i) {
        RenderOptions one = o;
        one.shot = (*shots)[i];
        one.settings = settings_of(*one.shot, o.settings);
        if (!o.quiet) std::cerr << one.shot->describe(i + 1, shots->size()) << std::endl;
        code = g_signal != 0 ? stopped_early("before the next picture") : render_one(one, signals, said);
    }
    said.end_json();
    const Status status = finish_stdout();
    return code == kDone && !status ? report(status.error()) : code;
}

}  // namespace

void add_render(CLI::App& app, Action& action) {
    auto o = std::make_shared<RenderOptions>();
    CLI::App* c = add_command(app, action, "render", "Render a scene (.json, .gltf, .glb) or a model (.obj, .ply)", o,
                              run_render);
    c->footer(
        "What is not given comes from the scene file, and what that does not say is 512x512 pixels with 64 samples.\n"
        "A model without a scene gets a camera that frames it and a neutral studio light. Ctrl-C stops and writes "
        "what\n"
        "is done; the file's metadata then says that it is partial. Of several pictures (--frames, --turntable) those\n"
        "that are whole are there, and the one in work is left out.");
    c->add_option("SCENE", o->scene, "The scene or model to render")->required()->type_name("FILE");
    c->add_option("-o,--output", o->outputs,
                  "Where the picture goes: .exr, .hdr, .pfm or .png; may be repeated. Default: the scene's\nname with "
                  ".png (.exr with AOVs) in the current folder (with --json: no file)")
        ->allow_extra_args(false)
        ->type_name("FILE")
        ->group("Output");
    add_text(c, "--aovs", o->settings.aovs, "without --aovs they are those of the scene; 'none' is without any",
             fmt::format("Channels beside colour, for EXR; 'all', 'none' or some of: {}", aov_list()))
        ->type_name("NAME,...")
        ->group("Output");
    add_picture_options(c, o->picture, "Output");
    add_settings_options(c, o->settings);
    add_sequence_options(c, o->sequence);
    add_count<uint32_t>(c, "--threads", o->execution.threads, 0, kMaxThreads,
                        "0: all the machine has; never changes the picture")
        ->group("Execution");
    add_text(c, "--time-limit", o->time_limit, "for example --time-limit 60s",
             "Render for so long (60s, 5m, 1.5h; preparing the scene not counted) instead of up to the scene's\n"
             "number of samples. All pixels get the same number, at least 1 and at most --spp where that is given;\n"
             "the file says how many, and --spp with that number makes the same picture")
        ->type_name("TIME")
        ->group("Execution");
    add_count<uint32_t>(c, "--tile-size", o->execution.tile_size, 1, 256, "Pixels, 1 to 256; never changes the picture")
        ->default_str(std::to_string(o->execution.tile_size))
        ->group("Execution");
    add_choice(c, "--bvh", o->bvh, names_of<BvhBuilder>(),
               "Builder of the hierarchy: sah, median, fast (for previews) or high-quality (slow to build, fast to "
               "trace); never changes the picture")
        ->default_str(o->bvh)
        ->group("Execution");
    add_choice(c, "--bvh-layout", o->bvh_layout, names_of<BvhLayout>(),
               "Memory of the hierarchy: full, or compact for scenes that are large (about two thirds of\n"
               "the bytes, slower); never changes the picture")
        ->default_str(o->bvh_layout)
        ->group("Execution");
    add_choice(c, "--isa", o->isa, names_of<Isa>(),
               "Instructions of the ray kernels: scalar, sse4, avx2, avx512, neon or auto (the best that\n"
               "the machine has, or what the environment variable STERADIAN_ISA says); never changes the\npicture")
        ->default_str(o->isa)
        ->group("Execution");
    add_count<uint32_t>(c, "--bvh-max-depth", o->execution.bvh_max_depth, 1, 64,
                        "Levels of the hierarchy; never changes the picture")
        ->default_str(std::to_string(o->execution.bvh_max_depth))
        ->group("Execution");
    add_count<uint32_t>(c, "--fireflies", o->execution.fireflies, 0, kMaxFireflies,
                        "List so many of the brightest samples, each with the command that replays it")
        ->group("Output");
    c->add_flag("-q,--quiet", o->quiet, "Only errors");
    c->add_flag("--json", o->json, "Statistics and the picture's hash as JSON on standard output");
}

}  // namespace steradian::cli
