// steradian render: a scene or a model in, pictures out.
#include <fmt/format.h>
#include <rapidjson/prettywriter.h>
#include <rapidjson/stringbuffer.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <iostream>
#include <optional>
#include <vector>

#include "base/file.h"
#include "base/parallel.h"
#include "base/text.h"
#include "command.h"
#include "image/tone.h"
#include "progress.h"
#include "scene/names.h"
#include "steradian/image_io.h"
#include "steradian/load.h"
#include "steradian/render.h"

namespace steradian::cli {
namespace {

struct RenderOptions {
    std::string scene;
    std::vector<std::string> outputs;
    std::optional<uint64_t> spp, seed;
    std::optional<uint32_t> max_depth;
    std::string size, camera, integrator, filter, sampler, crop, bvh = "sah";
    Execution execution;
    ImageWriteOptions write;
    bool half = false, quiet = false, json = false;
};

// --- Signals: the first one asks the job to stop, the second one ends the process at once. ---------------------

std::atomic<int> g_signal{0};
std::atomic<RenderJob*> g_job{nullptr};

extern "C" void on_signal(int number) {
    if (g_signal.exchange(number) != 0) ::_exit(128 + number);
    if (RenderJob* job = g_job.load()) job->cancel();
}

/// Watches SIGINT, SIGTERM and SIGHUP while a job runs.
class SignalScope {
public:
    SignalScope() {
        struct sigaction action {};
        action.sa_handler = on_signal;
        for (const int number : {SIGINT, SIGTERM, SIGHUP}) ::sigaction(number, &action, nullptr);
    }
    ~SignalScope() { g_job = nullptr; }
    void watch(RenderJob* job) {
        g_job = job;
        if (g_signal != 0) job->cancel();
    }
};

// --- Arguments -------------------------------------------------------------------------------------------------

Error usage_error(std::string message, std::string hint = {}) {
    return {ErrorCode::usage, std::move(message), {}, {}, std::move(hint)};
}

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

Status apply_filter(const std::string& text, Filter& filter) {
    const size_t colon = text.find(':');
    const auto kind = find_name<FilterKind>(text.substr(0, colon));
    if (!kind)
        return usage_error(fmt::format("--filter: unknown filter '{}'", escape_for_display(text)),
                           suggestion(text.substr(0, colon), names_of<FilterKind>()));
    filter = {*kind, default_filter_radius(*kind)};
    if (colon == std::string::npos) return Ok{};
    const auto radius = parse_double(text.substr(colon + 1));
    if (!radius)
        return usage_error(
            fmt::format("--filter: '{}' is not a radius in pixels", escape_for_display(text.substr(colon + 1))),
            "for example --filter gaussian:1.5");
    filter.radius = static_cast<float>(std::clamp(*radius, -1e30, 1e30));
    return Ok{};
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
    const std::vector<std::string_view> views(names.begin(), names.end());
    return usage_error(fmt::format("--camera: the scene has no camera '{}'", escape_for_display(name)),
                       suggestion(name, views));
}

/// What the command line says wins over what the scene says.
Status apply(const RenderOptions& o, const Scene& scene, RenderSettings& s) {
    if (o.spp) s.samples_per_pixel = *o.spp;
    if (o.seed) s.seed = *o.seed;
    if (o.max_depth) s.max_depth = *o.max_depth;
    if (!o.size.empty()) {
        const auto size = parse_numbers(o.size, 'x', 2);
        if (!size)
            return usage_error(fmt::format("--size: '{}' is not WIDTHxHEIGHT", escape_for_display(o.size)),
                               "for example --size 1920x1080");
        if (s.crop)
            return usage_error("--size: the scene has a crop window for its own size", "give --crop as well, or 'all'");
        s.width = (*size)[0], s.height = (*size)[1];
    }
    if (o.crop == "all") {
        s.crop.reset();
    } else if (!o.crop.empty()) {
        const auto crop = parse_numbers(o.crop, ',', 4);
        if (!crop)
            return usage_error(fmt::format("--crop: '{}' is not X0,Y0,X1,Y1", escape_for_display(o.crop)),
                               "pixels from the top left corner, X1 and Y1 not included");
        s.crop = Crop{(*crop)[0], (*crop)[1], (*crop)[2], (*crop)[3]};
    }
    if (!o.integrator.empty()) s.integrator = *find_name<IntegratorKind>(o.integrator);
    if (!o.sampler.empty()) s.sampler = *find_name<SamplerKind>(o.sampler);
    if (!o.filter.empty())
        if (auto status = apply_filter(o.filter, s.filter); !status) return status;
    if (!o.camera.empty()) return apply_camera(o.camera, scene, s.camera);
    return Ok{};
}

bool same_file(const std::string& a, const std::string& b) {
    struct stat x {
    }, y{};
    return ::stat(a.c_str(), &x) == 0 && ::stat(b.c_str(), &y) == 0 && x.st_dev == y.st_dev && x.st_ino == y.st_ino;
}

/// Everything about the outputs that can be known before hours of rendering.
Status check_outputs(const RenderOptions& o) {
    static constexpr std::string_view kExtensions[] = {".exr", ".hdr", ".pfm", ".png"};
    for (size_t i = 0; i < o.outputs.size(); ++i) {
        const std::string& path = o.outputs[i];
        const std::string extension = extension_of(path);
        if (std::find(std::begin(kExtensions), std::end(kExtensions), extension) == std::end(kExtensions))
            return usage_error(fmt::format("-o {}: unknown picture format '{}'", escape_for_display(path),
                                           escape_for_display(extension)),
                               suggestion(extension, kExtensions));
        if (same_file(path, o.scene))
            return usage_error(fmt::format("-o {}: this is the scene itself", escape_for_display(path)));
        for (size_t j = 0; j < i; ++j)
            if (o.outputs[j] == path || same_file(o.outputs[j], path))
                return usage_error(fmt::format("-o {}: given twice", escape_for_display(path)));
        if (auto status = check_writable(path); !status) return status;
    }
    return Ok{};
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
                const Diagnostics& diagnostics) {
    rapidjson::StringBuffer buffer;
    rapidjson::PrettyWriter<rapidjson::StringBuffer> w(buffer);
    const auto text = [&](const char* key, const std::string& value) {
        w.Key(key), w.String(value.data(), rapidjson::SizeType(value.size()));
    };
    const auto number = [&](const char* key, uint64_t value) { w.Key(key), w.Uint64(value); };
    w.StartObject();
    text("scene", o.scene);
    text("hash", image_hash(r.image));
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
    for (const std::string& path : o.outputs) w.String(path.c_str());
    w.EndArray();
    w.Key("warnings"), w.StartArray();
    for (const Warning& warning : diagnostics.warnings()) w.String(warning.str().c_str());
    w.EndArray();
    w.EndObject();
    std::cout << buffer.GetString() << std::endl;
}

void print_summary(const RenderOptions& o, const RenderSettings& s, const RenderResult& r) {
    const uint64_t rays = r.statistics.camera_rays + r.statistics.specular_rays + r.statistics.shadow_rays;
    const double seconds = std::max(r.statistics.seconds, 1e-9);
    std::string outputs;
    for (const std::string& path : o.outputs) outputs += (outputs.empty() ? "" : ", ") + escape_for_display(path, 4096);
    std::cerr << fmt::format(
        "{}x{}, {} samples per pixel in {} ({} rays/s, {} threads){}{}\n", r.image.width, r.image.height,
        r.complete ? fmt::format("{}", s.samples_per_pixel)
                   : fmt::format("{} to {} of {}", r.min_samples, r.max_samples, s.samples_per_pixel),
        format_duration(seconds), format_quantity(double(rays) / seconds), r.statistics.threads,
        outputs.empty() ? "" : " -> ", outputs);
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

int run_render(RenderOptions o) {
    SignalScope signals;
    if (o.outputs.empty() && !o.json) o.outputs.push_back(default_output(o.scene));
    o.execution.bvh = *find_name<BvhBuilder>(o.bvh);
    if (o.half) o.write.exr = ExrPrecision::half;
    if (auto status = check_outputs(o); !status) return report(status.error());

    const uint32_t threads = o.execution.threads ? o.execution.threads : hardware_threads();
    const ThreadLimit limit(std::min(threads, 1024u));
    auto loaded = load_scene(o.scene);
    if (!loaded) return report(loaded.error());
    RenderSettings settings = loaded->settings;
    if (auto status = apply(o, loaded->scene, settings); !status) return report(status.error());
    Diagnostics diagnostics = std::move(loaded->diagnostics);
    auto scene = prepare(std::move(loaded->scene), o.execution, diagnostics);
    if (!scene) return report(scene.error());
    if (!o.quiet) report(diagnostics);

    auto result = run_job(o, std::move(*scene), settings, signals);
    if (!result) return report(result.error());
    const int signal = g_signal.load();
    if (signal != 0 && result->max_samples == 0) {
        std::cerr << "stopped before the first samples were done: nothing was written\n";
        return 128 + signal;
    }
    Diagnostics afterwards;
    warn_bad_samples(result->statistics, afterwards);
    for (const std::string& path : o.outputs)
        if (auto status = write_image(path, result->image, o.write, &afterwards); !status)
            return report(status.error());
    if (!o.quiet) report(afterwards), print_summary(o, settings, *result);
    diagnostics.append(afterwards);
    if (o.json) print_json(o, settings, *result, diagnostics);
    return signal != 0 ? 128 + signal : kDone;
}

/// CLI11 reads "-1" as a huge unsigned number.
std::string not_negative(const std::string& text) { return text.starts_with('-') ? "must not be negative" : ""; }

template <class Kind>
CLI::IsMember one_of() {
    const auto names = names_of<Kind>();
    return CLI::IsMember(std::vector<std::string>(names.begin(), names.end()));
}

}  // namespace

void add_render(CLI::App& app, Action& action) {
    auto o = std::make_shared<RenderOptions>();
    CLI::App* c = app.add_subcommand("render", "Render a scene (.json) or a model (.obj, .ply)");
    c->footer(
        "What is not given comes from the scene file. A model without a scene gets a camera that frames it and a "
        "neutral\n"
        "studio light. Ctrl-C stops and writes what is done; the file's metadata then says that it is partial.");
    c->add_option("SCENE", o->scene, "The scene or model to render")->required();
    c->add_option("-o,--output", o->outputs,
                  "Where the picture goes: .exr, .hdr, .pfm or .png; may be repeated. Default: the scene's\nname with "
                  ".png in the current folder (with --json: no file)")
        ->allow_extra_args(false)
        ->group("Output");
    c->add_flag("--half", o->half, "EXR with 16-bit instead of 32-bit floats")->group("Output");
    c->add_option("--exposure", o->write.exposure, "Stops, for PNG (+1: twice as bright)")
        ->check(CLI::Range(-100.0, 100.0))
        ->group("Output");
    std::vector<std::string> views(view_names().begin(), view_names().end());
    c->add_option("--view", o->write.view, "View transform for PNG")
        ->check(CLI::IsMember(views))
        ->capture_default_str()
        ->group("Output");
    c->add_option("--spp", o->spp, "Samples per pixel; the noise falls with their square root")
        ->check(not_negative)
        ->group("Picture");
    c->add_option("--size", o->size, "WIDTHxHEIGHT in pixels")->group("Picture");
    c->add_option("--crop", o->crop,
                  "X0,Y0,X1,Y1: render only these pixels (X1, Y1 not included), with the same bits as in the "
                  "whole\npicture; 'all' undoes the scene's crop")
        ->group("Picture");
    c->add_option("--camera", o->camera, "Name or number of the camera")->group("Picture");
    c->add_option("--integrator", o->integrator, "How light is computed: direct")
        ->check(one_of<IntegratorKind>())
        ->group("Picture");
    c->add_option("--max-depth", o->max_depth, "Bounces: 0 only what glows, 1 direct light, more for mirrors and glass")
        ->check(not_negative)
        ->group("Picture");
    c->add_option("--filter", o->filter,
                  "box, tent, gaussian or mitchell, optionally with a radius in pixels: gaussian:1.5")
        ->group("Picture");
    c->add_option("--sampler", o->sampler, "sobol (less noise) or independent")
        ->check(one_of<SamplerKind>())
        ->group("Picture");
    c->add_option("--seed", o->seed, "Another seed gives another, equally good noise pattern")
        ->check(not_negative)
        ->group("Picture");
    c->add_option("--threads", o->execution.threads, "0: all the machine has; never changes the picture")
        ->check(CLI::Range(0, 1024))
        ->group("Execution");
    c->add_option("--tile-size", o->execution.tile_size, "Pixels, 1 to 256; never changes the picture")
        ->check(CLI::Range(1, 256))
        ->capture_default_str()
        ->group("Execution");
    c->add_option("--bvh", o->bvh, "Builder of the hierarchy, sah or median; never changes the picture")
        ->check(one_of<BvhBuilder>())
        ->capture_default_str()
        ->group("Execution");
    c->add_option("--bvh-max-depth", o->execution.bvh_max_depth, "Levels of the hierarchy; never changes the picture")
        ->check(CLI::Range(1, 64))
        ->capture_default_str()
        ->group("Execution");
    c->add_flag("-q,--quiet", o->quiet, "Only errors");
    c->add_flag("--json", o->json, "Statistics and the picture's hash as JSON on standard output");
    c->callback([o, &action] { action = [o] { return run_render(*o); }; });
}

}  // namespace steradian::cli
