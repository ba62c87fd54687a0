// steradian render: a scene or a model in, pictures out.
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <iostream>
#include <limits>
#include <optional>
#include <vector>

#include "base/names.h"
#include "base/parallel.h"
#include "base/text.h"
#include "command.h"
#include "progress.h"
#include "render/memory_estimate.h"
#include "scene/validate.h"
#include "steradian/image_io.h"
#include "steradian/load.h"
#include "steradian/render.h"

namespace steradian::cli {
namespace {

constexpr uint32_t kMaxThreads = 1024;

struct RenderOptions {
    std::string scene;
    std::vector<std::string> outputs;
    std::optional<uint64_t> spp, seed;
    std::optional<uint32_t> max_depth;
    std::string size, camera, integrator, filter, sampler, crop, bvh = "sah", isa = "auto";
    Execution execution;
    PictureOptions picture;
    bool quiet = false, json = false;
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

// --- Arguments -------------------------------------------------------------------------------------------------

std::optional<std::vector<uint32_t>> parse_numbers(std::string_view text, char separator, size_t count) {
    std::vector<uint32_t> out;
    while (true) {
        const size_t end = std::min(text.find(separator), text.size());
        uint32_t value = 0;
        const auto [p, error] = std::from_chars(text.data(), text.data() + end, value);
        if (error != std::errc() || p != text.data() + end) return std::nullopt;
        out.push_back(value);
        if (end == text.size()) break;
        text.remove_prefix(end + 1);
    }
    if (out.size() != count) return std::nullopt;
    return out;
}

Result<Filter> parse_filter(const std::string& text) {
    const size_t colon = text.find(':');
    const auto kind = find_name<FilterKind>(text.substr(0, colon));
    if (!kind)
        return usage_error(fmt::format("--filter: unknown filter '{}'", escape_for_display(text)),
                           suggestion(text.substr(0, colon), names_of<FilterKind>()));
    if (colon == std::string::npos) return Filter{*kind, default_filter_radius(*kind)};
    const auto radius = parse_double(text.substr(colon + 1));
    if (!radius)
        return usage_error(
            fmt::format("--filter: '{}' is not a radius in pixels", escape_for_display(text.substr(colon + 1))),
            "for example --filter gaussian:1.5");
    return Filter{*kind, static_cast<float>(std::clamp(*radius, -1e30, 1e30))};
}

Result<Crop> parse_crop(const std::string& text) {
    const auto crop = parse_numbers(text, ',', 4);
    if (!crop)
        return usage_error(fmt::format("--crop: '{}' is not X0,Y0,X1,Y1", escape_for_display(text)),
                           "pixels from the top left corner, X1 and Y1 not included");
    const Crop c{(*crop)[0], (*crop)[1], (*crop)[2], (*crop)[3]};
    if (c.x0 >= c.x1 || c.y0 >= c.y1) return usage_error(fmt::format("--crop: {} is an empty window", text));
    return c;
}

struct Size {
    uint32_t width, height;
};

Result<Size> parse_size(const std::string& text) {
    const auto size = parse_numbers(text, 'x', 2);
    if (!size)
        return usage_error(fmt::format("--size: '{}' is not WIDTHxHEIGHT", escape_for_display(text)),
                           "for example --size 1920x1080");
    return Size{(*size)[0], (*size)[1]};
}

/// What the command line says about the picture. It wins over what the scene says.
struct Overrides {
    std::optional<Size> size;
    std::optional<Crop> crop;
    bool whole = false;  ///< --crop all
    std::optional<Filter> filter;
};

void override(const RenderOptions& o, const Overrides& said, RenderSettings& s) {
    if (o.spp) s.samples_per_pixel = *o.spp;
    if (o.seed) s.seed = *o.seed;
    if (o.max_depth) s.max_depth = *o.max_depth;
    if (!o.integrator.empty()) s.integrator = *find_name<IntegratorKind>(o.integrator);
    if (!o.sampler.empty()) s.sampler = *find_name<SamplerKind>(o.sampler);
    if (said.size) s.width = said.size->width, s.height = said.size->height;
    if (said.whole) s.crop.reset();
    if (said.crop) s.crop = said.crop;
    if (said.filter) s.filter = *said.filter;
}

/// Parses, and refuses what no scene could make right: loading one may take long.
Result<Overrides> parse_overrides(const RenderOptions& o) {
    Overrides said;
    const auto take = [](auto parsed, auto& into) -> Status {
        if (!parsed) return std::move(parsed).error();
        into = *parsed;
        return Ok{};
    };
    if (!o.size.empty())
        if (auto status = take(parse_size(o.size), said.size); !status) return std::move(status).error();
    said.whole = o.crop == "all";
    if (!o.crop.empty() && !said.whole)
        if (auto status = take(parse_crop(o.crop), said.crop); !status) return std::move(status).error();
    if (!o.filter.empty())
        if (auto status = take(parse_filter(o.filter), said.filter); !status) return std::move(status).error();
    RenderSettings alone;
    if (said.crop) alone.width = said.crop->x1, alone.height = said.crop->y1;  // at least, if the scene says the size
    override(o, said, alone);
    if (auto status = validate(alone); !status) return std::move(status).error();
    if (said.size || said.crop)
        if (auto status = check_picture_memory(alone, o.execution); !status) return std::move(status).error();
    return said;
}

std::string camera_hint(const std::string& name, const Scene& scene) {
    const std::vector<std::string_view> names(scene.names.cameras.begin(), scene.names.cameras.end());
    if (const auto match = closest_match(name, names)) return "did you mean '" + *match + "'?";
    if (names.empty()) return fmt::format("the scene's cameras are numbered 0 to {}", scene.cameras.size() - 1);
    return "the scene has: " + escape_for_display(fmt::format("{}", fmt::join(names, ", ")), 400);
}

Status apply_camera(const std::string& name, const Scene& scene, uint32_t& camera) {
    const auto& names = scene.names.cameras;
    for (size_t i = 0; i < names.size(); ++i)
        if (names[i] == name) {
            camera = static_cast<uint32_t>(i);
            return Ok{};
        }
    if (const auto number = parse_numbers(name, ',', 1); number && (*number)[0] < scene.cameras.size()) {
        camera = (*number)[0];
        return Ok{};
    }
    return usage_error(fmt::format("--camera: the scene has no camera '{}'", escape_for_display(name)),
                       camera_hint(name, scene));
}

/// The scene's settings with the command line's, checked before anything is derived from the scene.
Result<RenderSettings> settings_for(const RenderOptions& o, const Overrides& said, const LoadedScene& loaded) {
    RenderSettings s = loaded.settings;
    if (said.size && s.crop && o.crop.empty())
        return usage_error("--size: the scene has a crop window for its own size", "give --crop as well, or 'all'");
    override(o, said, s);
    if (auto status = validate(s); !status) return std::move(status).error();
    if (!o.camera.empty())
        if (auto status = apply_camera(o.camera, loaded.scene, s.camera); !status) return std::move(status).error();
    return s;
}

std::string default_output(const std::string& scene) {
    const size_t slash = scene.find_last_of('/');
    std::string name = slash == std::string::npos ? scene : scene.substr(slash + 1);
    const std::string extension = extension_of(name);
    name.resize(name.size() - extension.size());
    return name + ".png";
}

// --- Running ---------------------------------------------------------------------------------------------------

void print_json(const RenderOptions& o, const RenderSettings& s, const RenderResult& r,
                const std::vector<std::string>& written, const Diagnostics& diagnostics) {
    rapidjson::StringBuffer buffer;
    JsonWriter w(buffer);
    const auto number = [&](const char* key, uint64_t value) { w.Key(key), w.Uint64(value); };
    w.StartObject();
    write_field(w, "scene", o.scene);
    write_field(w, "hash", image_hash(r.image));
    number("width", r.image.width), number("height", r.image.height);
    number("spp", s.samples_per_pixel);
    w.Key("complete"), w.Bool(r.complete);
    number("min_samples", r.min_samples), number("max_samples", r.max_samples);
    number("samples", r.statistics.samples);
    number("camera_rays", r.statistics.camera_rays);
    number("specular_rays", r.statistics.specular_rays);
    number("shadow_rays", r.statistics.shadow_rays);
    number("bad_samples", r.statistics.bad_samples);
    number("threads", r.statistics.threads);
    w.Key("seconds"), w.Double(r.statistics.seconds);
    w.Key("outputs"), w.StartArray();
    for (const std::string& path : written) write_text(w, path);
    w.EndArray();
    w.Key("warnings"), w.StartArray();
    for (const Warning& warning : diagnostics.warnings()) write_text(w, warning.str());
    w.EndArray();
    w.EndObject();
    std::cout << buffer.GetString() << '\n';
}

void print_summary(const RenderSettings& s, const RenderResult& r, const std::vector<std::string>& written) {
    const uint64_t rays = r.statistics.camera_rays + r.statistics.specular_rays + r.statistics.shadow_rays;
    const double seconds = std::max(r.statistics.seconds, 1e-9);
    std::string outputs;
    for (const std::string& path : written) outputs += (outputs.empty() ? "" : ", ") + escape_for_display(path, 4096);
    std::cerr << fmt::format(
        "{}x{}, {} samples per pixel in {} ({} rays/s, {} thread{}){}{}\n", r.image.width, r.image.height,
        r.complete ? fmt::format("{}", s.samples_per_pixel)
                   : fmt::format("{} to {} of {}", r.min_samples, r.max_samples, s.samples_per_pixel),
        format_duration(seconds), format_quantity(double(rays) / seconds), r.statistics.threads,
        r.statistics.threads == 1 ? "" : "s", outputs.empty() ? "" : " -> ", outputs);
}

void warn_bad_samples(const RenderStatistics& s, Diagnostics& diagnostics) {
    if (!s.first_bad_sample) return;
    const BadSample& b = *s.first_bad_sample;
    diagnostics.warn(fmt::format("samples that were not finite or negative were dropped; the first is sample {} of "
                                 "pixel {},{} with ({}, {}, {})",
                                 b.sample, b.x, b.y, b.value.r, b.value.g, b.value.b),
                     {}, s.bad_samples);
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

/// Tries every output, whatever becomes of the others, and reports the failures. Returns those that were written.
std::vector<std::string> write_outputs(const RenderOptions& o, const Image& image, Diagnostics& diagnostics) {
    std::vector<std::string> written;
    for (const std::string& path : o.outputs) {
        const Status status = write_image(path, image, o.picture.write(), &diagnostics);
        status ? written.push_back(path) : void(report(status.error()));
    }
    return written;
}

/// What there is to say and to save once the picture is there.
int finish(const RenderOptions& o, const RenderSettings& settings, const RenderResult& result,
           Diagnostics diagnostics) {
    Diagnostics afterwards;
    warn_bad_samples(result.statistics, afterwards);
    const std::vector<std::string> written = write_outputs(o, result.image, afterwards);
    if (!o.quiet) report(afterwards), print_summary(settings, result, written);
    diagnostics.append(afterwards);
    if (o.json) print_json(o, settings, result, written, diagnostics);
    if (auto status = finish_stdout(); !status) return report(status.error());
    if (written.size() < o.outputs.size()) return kResources;
    const int signal = g_signal.load();
    return signal != 0 ? 128 + signal : kDone;
}

int run_render(const RenderOptions& given) {
    SignalScope signals;
    RenderOptions o = given;
    if (o.outputs.empty() && !o.json) o.outputs.push_back(default_output(o.scene));
    o.execution.bvh = *find_name<BvhBuilder>(o.bvh);
    o.execution.isa = *find_name<Isa>(o.isa);
    if (auto status = check_outputs(o.outputs, o.picture); !status) return report(status.error());
    const auto said = parse_overrides(o);
    if (!said) return report(said.error());

    const uint32_t threads = o.execution.threads ? o.execution.threads : hardware_threads();
    const ThreadLimit limit(std::min(threads, kMaxThreads));
    auto loaded = load_scene(o.scene);
    if (!loaded) return report(loaded.error());
    if (auto status = check_not_inputs(o.outputs, loaded->files); !status) return report(status.error());
    const auto settings = settings_for(o, *said, *loaded);
    if (!settings) return report(settings.error());
    Diagnostics diagnostics = std::move(loaded->diagnostics);
    if (auto status = check_scene_memory(estimate_memory(loaded->scene, *settings, o.execution)); !status)
        return report(status.error());
    auto scene = prepare(std::move(loaded->scene), o.execution, diagnostics);
    if (!scene) return report(scene.error());
    if (!o.quiet) report(diagnostics);

    const auto result = run_job(o, std::move(*scene), *settings, signals);
    if (!result) return report(result.error());
    if (g_signal != 0 && result->max_samples == 0) {
        std::cerr << "stopped before the first samples were done: nothing was written\n";
        return 128 + g_signal;
    }
    return finish(o, *settings, *result, std::move(diagnostics));
}

}  // namespace

void add_render(CLI::App& app, Action& action) {
    auto o = std::make_shared<RenderOptions>();
    CLI::App* c = add_command(app, action, "render", "Render a scene (.json) or a model (.obj, .ply)", o, run_render);
    c->footer(
        "What is not given comes from the scene file, and what that does not say is 512x512 pixels with 64 samples.\n"
        "A model without a scene gets a camera that frames it and a neutral studio light. Ctrl-C stops and writes "
        "what\n"
        "is done; the file's metadata then says that it is partial.");
    c->add_option("SCENE", o->scene, "The scene or model to render")->required()->type_name("FILE");
    c->add_option("-o,--output", o->outputs,
                  "Where the picture goes: .exr, .hdr, .pfm or .png; may be repeated. Default: the scene's\nname with "
                  ".png in the current folder (with --json: no file)")
        ->allow_extra_args(false)
        ->type_name("FILE")
        ->group("Output");
    add_picture_options(c, o->picture, "Output");
    add_count<uint64_t>(c, "--spp", o->spp, 1, kMaxSamplesPerPixel,
                        "Samples per pixel; the noise falls with their square root")
        ->group("Picture");
    c->add_option("--size", o->size, "Pixels, for example 1920x1080")->type_name("WIDTHxHEIGHT")->group("Picture");
    c->add_option("--crop", o->crop,
                  "Render only these pixels (X1, Y1 not included; from the top left corner), with the same\n"
                  "bits as in the whole picture; 'all' undoes the scene's crop")
        ->type_name("X0,Y0,X1,Y1")
        ->group("Picture");
    c->add_option("--camera", o->camera, "Name or number of the camera")->type_name("NAME")->group("Picture");
    add_choice(c, "--integrator", o->integrator, names_of<IntegratorKind>(), "How light is computed: direct")
        ->group("Picture");
    add_count<uint32_t>(c, "--max-depth", o->max_depth, 0, kMaxDepth,
                        "Bounces: 0 only what glows, 1 direct light, more for mirrors and glass")
        ->group("Picture");
    c->add_option("--filter", o->filter,
                  "box, tent, gaussian or mitchell, optionally with a radius in pixels: gaussian:1.5")
        ->type_name("NAME[:RADIUS]")
        ->group("Picture");
    add_choice(c, "--sampler", o->sampler, names_of<SamplerKind>(), "sobol (less noise) or independent")
        ->group("Picture");
    add_count<uint64_t>(c, "--seed", o->seed, 0, std::numeric_limits<uint64_t>::max(),
                        "Another seed gives another, equally good noise pattern")
        ->group("Picture");
    add_count<uint32_t>(c, "--threads", o->execution.threads, 0, kMaxThreads,
                        "0: all the machine has; never changes the picture")
        ->group("Execution");
    add_count<uint32_t>(c, "--tile-size", o->execution.tile_size, 1, 256, "Pixels, 1 to 256; never changes the picture")
        ->default_str(std::to_string(o->execution.tile_size))
        ->group("Execution");
    add_choice(c, "--bvh", o->bvh, names_of<BvhBuilder>(),
               "Builder of the hierarchy: sah, median, fast (for previews) or high-quality (slow to build, fast to "
               "trace); never changes the picture")
        ->default_str(o->bvh)
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
    c->add_flag("-q,--quiet", o->quiet, "Only errors");
    c->add_flag("--json", o->json, "Statistics and the picture's hash as JSON on standard output");
}

}  // namespace steradian::cli
