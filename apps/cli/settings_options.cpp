#include "settings_options.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <limits>

#include "base/names.h"
#include "base/text.h"
#include "math/vector.h"
#include "render/memory_estimate.h"
#include "scene/validate.h"

namespace steradian::cli {

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

namespace {

constexpr std::array<std::string_view, 2> kLightUnits{"radiometric", "photometric"};
constexpr const char* kSizeHint = "for example --size 1920x1080";

/// How the help introduces it: one that is not here does not compile.
std::string_view description(IntegratorKind kind) {
    switch (kind) {
        case IntegratorKind::path:
            return ": all light; ";
        case IntegratorKind::direct:
            return ": what arrives without detours; ";
        case IntegratorKind::ao:
            return ": ambient occlusion. To look at a scene:\n";
        case IntegratorKind::normals:
        case IntegratorKind::albedo:
        case IntegratorKind::uv:
            return ", ";
        case IntegratorKind::depth:
            return " (metres), ";
        case IntegratorKind::primitive:
            return " (a colour each), ";
        case IntegratorKind::cost:
            return " (of the hierarchy, as a heat map)";
    }
    return {};
}

std::string integrator_help() {
    std::string out;
    for (const std::string_view name : names_of<IntegratorKind>())
        out += std::string(name) + std::string(description(*find_name<IntegratorKind>(name)));
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

Result<AovSet> parse_aovs(const std::string& text) {
    if (text == "all") return AovSet::all();
    AovSet out;
    for (size_t begin = 0; text != "none" && begin <= text.size();) {
        const size_t end = std::min(text.find(',', begin), text.size());
        const std::string name = text.substr(begin, end - begin);
        const auto aov = find_name<Aov>(name);
        if (!aov)
            return usage_error(fmt::format("--aovs: unknown AOV '{}'", escape_for_display(name)),
                               suggestion(name, names_of<Aov>()));
        out.add(*aov);
        begin = end + 1;
    }
    return out;
}

/// Three numbers between commas.
std::optional<Rgb> parse_color(std::string_view text) {
    Rgb out;
    for (int c = 0; c < 3; ++c) {
        const size_t end = c < 2 ? text.find(',') : text.size();
        if (end == text.npos) return std::nullopt;
        const auto value = parse_double(text.substr(0, end));
        constexpr double kMax = 1e30;
        if (!value || !(*value >= 0 && *value <= kMax)) return std::nullopt;
        out[c] = static_cast<float>(*value);
        text.remove_prefix(min_of(end + 1, text.size()));
    }
    return out;
}

Status parse_size(const std::string& text, Overrides& said) {
    const auto size = parse_numbers(text, 'x', 2);
    if (!size) return usage_error(fmt::format("--size: '{}' is not WIDTHxHEIGHT", escape_for_display(text)), kSizeHint);
    said.width = (*size)[0], said.height = (*size)[1];
    return Ok{};
}

void override(const SettingsOptions& o, const Overrides& said, RenderSettings& s) {
    if (o.spp) s.samples_per_pixel = *o.spp;
    if (o.seed) s.seed = *o.seed;
    if (o.max_depth) s.max_depth = *o.max_depth;
    if (o.roulette_depth) s.roulette_depth = *o.roulette_depth;
    if (o.ao_distance) s.ao_distance = *o.ao_distance;
    if (o.clamp) s.clamp = *o.clamp;
    if (o.target_error) {
        // The scene's number of samples is meant for pictures with a target, or for those without.
        if (!o.spp && (s.target_error > 0) != (*o.target_error > 0))
            s.samples_per_pixel = *o.target_error > 0 ? kDefaultMostSamples : RenderSettings().samples_per_pixel;
        s.target_error = *o.target_error;
    }
    if (!o.integrator.empty()) s.integrator = *find_name<IntegratorKind>(o.integrator);
    if (!o.light_sampling.empty()) s.light_sampling = *find_name<LightSampling>(o.light_sampling);
    if (!o.light_choice.empty()) s.light_choice = *find_name<LightChoice>(o.light_choice);
    if (!o.sampler.empty()) s.sampler = *find_name<SamplerKind>(o.sampler);
    if (said.width) s.width = *said.width, s.height = *said.height;
    if (said.whole) s.crop.reset();
    if (said.crop) s.crop = said.crop;
    if (said.filter) s.filter = *said.filter;
    if (said.aovs) s.aovs = *said.aovs;
}

}  // namespace

namespace {

Status check_effect_on_format(const SettingsOptions& o, const std::string& scene) {
    const std::string extension = extension_of(scene);
    if (extension == ".gltf" || extension == ".glb") return Ok{};
    const std::pair<const char*, bool> given[] = {{"--variant", !o.variant.empty()},
                                                  {"--gltf-light-units", !o.light_units.empty()},
                                                  {"--gltf-memory", o.gltf_memory.has_value()},
                                                  {"--allow-outside-paths", o.allow_outside_paths}};
    for (const auto& [option, is_given] : given)
        if (is_given)
            return usage_error(fmt::format("{}: this is for glTF files (.gltf, .glb)", option),
                               o.allow_outside_paths ? "scenes of other formats may name files anywhere" : "");
    return Ok{};
}

Status check_environment(const SettingsOptions& o, const Scene& scene) {
    if (!o.environment_rotation && !o.environment_scale) return Ok{};
    for (const Light& light : scene.lights)
        if (std::holds_alternative<EnvironmentLight>(light)) return Ok{};
    return usage_error(
        fmt::format("{}: the scene has no environment", o.environment_rotation ? "--env-rotate" : "--env-scale"),
        "--env gives it one");
}

}  // namespace

Result<LoadOptions> load_options(const SettingsOptions& o, const std::string& scene) {
    if (auto status = check_effect_on_format(o, scene); !status) return std::move(status).error();
    LoadOptions out;
    if (o.allow_outside_paths) out.allow_outside_paths = true;
    out.gltf_variant = o.variant;
    out.animation = o.animation;
    out.frame_time = o.frame_time;
    out.turn = o.turn;
    if (!o.size.empty()) {
        Overrides said;
        if (auto status = parse_size(o.size, said); !status) return std::move(status).error();
        if (*said.width > 0 && *said.height > 0) out.aspect = double(*said.width) / *said.height;
    }
    if (o.gltf_memory) out.gltf_free_bytes = *o.gltf_memory << 20;
    if (o.light_units == kLightUnits[1]) out.gltf_light_units = GltfLightUnits::photometric;
    EnvironmentOptions& environment = out.environment;
    if (o.environment == "none") {
        environment.replace = EnvironmentOptions::None{};
    } else if (const auto color = parse_color(o.environment)) {
        environment.replace = *color;
    } else if (!o.environment.empty()) {
        if (!is_picture(o.environment))
            return usage_error(fmt::format("--env: '{}' is neither 'none' nor a radiance R,G,B nor a picture",
                                           escape_for_display(o.environment)),
                               "for example --env sky.hdr, or --env 0.5,0.5,0.5");
        environment.replace = o.environment;
    }
    if (o.environment_rotation) environment.rotation = static_cast<float>(*o.environment_rotation);
    if (o.environment_scale) environment.scale = static_cast<float>(*o.environment_scale);
    return out;
}

Result<Overrides> parse_overrides(const SettingsOptions& o, const Execution& execution) {
    Overrides said;
    if (o.turn && !o.camera.empty())
        return usage_error("--camera: a model that is turned has a camera of its own", "leave --camera out");
    const auto take = [](auto parsed, auto& into) -> Status {
        if (!parsed) return std::move(parsed).error();
        into = *parsed;
        return Ok{};
    };
    if (!o.size.empty())
        if (auto status = parse_size(o.size, said); !status) return std::move(status).error();
    said.whole = o.crop == "all";
    if (!o.crop.empty() && !said.whole)
        if (auto status = take(parse_crop(o.crop), said.crop); !status) return std::move(status).error();
    if (!o.filter.empty())
        if (auto status = take(parse_filter(o.filter), said.filter); !status) return std::move(status).error();
    if (!o.aovs.empty())
        if (auto status = take(parse_aovs(o.aovs), said.aovs); !status) return std::move(status).error();
    RenderSettings alone;
    if (said.crop) alone.width = said.crop->x1, alone.height = said.crop->y1;  // at least, if the scene says the size
    override(o, said, alone);
    if (auto status = validate(alone); !status) return std::move(status).error();
    if (said.width || said.crop)
        if (auto status = check_picture_memory(alone, execution); !status) return std::move(status).error();
    return said;
}

namespace {

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

}  // namespace

Result<RenderSettings> settings_for(const SettingsOptions& o, const Overrides& said, const LoadedScene& loaded) {
    RenderSettings s = loaded.settings;
    if (said.width && s.crop && o.crop.empty())
        return usage_error("--size: the scene has a crop window for its own size", "give --crop as well, or 'all'");
    override(o, said, s);
    if (auto status = validate(s); !status) return std::move(status).error();
    if (auto status = check_environment(o, loaded.scene); !status) return std::move(status).error();
    if (!o.camera.empty())
        if (auto status = apply_camera(o.camera, loaded.scene, s.camera); !status) return std::move(status).error();
    return s;
}

namespace {

/// As a shell takes it.
std::string shell_word(const std::string& text) {
    const bool plain = !text.empty() && text.find_first_not_of(
                                            "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                            "0123456789_./:,+-") == std::string::npos;
    if (plain) return text;
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

}  // namespace

std::string replay_command(const std::string& scene, const SettingsOptions& o, const PixelSample& sample) {
    std::string out = fmt::format("steradian replay {} --pixel {},{} --sample {}", shell_word(scene), sample.x,
                                  sample.y, sample.sample);
    const auto word = [&](const char* option, const std::string& value) {
        if (!value.empty()) out += fmt::format(" {} {}", option, shell_word(value));
    };
    const auto number = [&](const char* option, const auto& value) {
        if (value) out += fmt::format(" {} {}", option, *value);
    };
    number("--spp", o.spp);
    word("--size", o.size);
    word("--crop", o.crop);
    word("--camera", o.camera);
    word("--env", o.environment);
    number("--env-rotate", o.environment_rotation);
    number("--env-scale", o.environment_scale);
    if (o.allow_outside_paths) out += " --allow-outside-paths";
    word("--variant", o.variant);
    word("--animation", o.animation);
    number("--frame-time", o.frame_time);
    number("--turn", o.turn);
    word("--gltf-light-units", o.light_units);
    number("--gltf-memory", o.gltf_memory);
    word("--integrator", o.integrator);
    number("--max-depth", o.max_depth);
    word("--light-sampling", o.light_sampling);
    word("--light-choice", o.light_choice);
    number("--roulette-depth", o.roulette_depth);
    number("--clamp", o.clamp);
    number("--ao-distance", o.ao_distance);
    number("--target-error", o.target_error);
    word("--filter", o.filter);
    word("--sampler", o.sampler);
    number("--seed", o.seed);
    return escape_for_display(out, 8192);
}

CLI::Option* add_variant_option(CLI::App* c, SettingsOptions& options) {
    return add_text(c, "--variant", options.variant,
                    "steradian info names the variants of a file; without --variant it has its own materials",
                    "Which of the variants of a glTF file's materials, by name")
        ->type_name("NAME");
}

void add_settings_options(CLI::App* c, SettingsOptions& options) {
    add_count<uint64_t>(c, "--spp", options.spp, 1, kMaxSamplesPerPixel,
                        "Samples per pixel; the noise falls with their square root")
        ->group("Picture");
    add_real(c, "--target-error", options.target_error, 0, kMaxTargetError,
             "Samples each part of the picture until √mean(Var / (I + 0.01)²) is at most this with 95 % confidence,\n"
             "for example 0.05, and says in the file what was reached, or why that cannot be said (exit code 4);\n"
             "--spp is then the most samples of a pixel (default 65536). Needs 6 / target² pixels. 0: no target")
        ->group("Picture");
    add_text(c, "--size", options.size, kSizeHint, "Pixels, for example 1920x1080")
        ->type_name("WIDTHxHEIGHT")
        ->group("Picture");
    add_text(c, "--crop", options.crop, "pixels from the top left corner, X0,Y0,X1,Y1, or 'all'",
             "Render only these pixels (X1, Y1 not included; from the top left corner), with the same\n"
             "bits as in the whole picture (but with --target-error, which is for what is rendered);\n"
             "'all' undoes the scene's crop")
        ->type_name("X0,Y0,X1,Y1")
        ->group("Picture");
    add_text(c, "--camera", options.camera, "without --camera it is the one of the scene",
             "Name or number of the camera")
        ->type_name("NAME")
        ->group("Picture");
    add_text(c, "--env", options.environment, "without --env it is that of the scene; 'none' is without one",
             "What shines from far away, in place of the scene's own and of the studio of a bare model: none, a\n"
             "radiance R,G,B, or a latitude-longitude picture (HDR, EXR, PFM, PNG, JPEG, WebP)")
        ->type_name("WHAT")
        ->group("Picture");
    constexpr double kMaxTurn = 1e6, kMaxScale = 1e15;
    add_real(c, "--env-rotate", options.environment_rotation, -kMaxTurn, kMaxTurn,
             "Degrees by which the environment is turned about +Y, counter-clockwise seen from above")
        ->group("Picture");
    add_real(c, "--env-scale", options.environment_scale, 0, kMaxScale, "Factor of the environment's radiance")
        ->group("Picture");
    c->add_flag("--allow-outside-paths", options.allow_outside_paths,
                "Let a glTF file name files outside its own folder")
        ->group("Picture");
    add_variant_option(c, options)->group("Picture");
    add_text(c, "--animation", options.animation,
             "steradian info names the animations of a file; without --animation it stands as the file has it",
             "Which animation of a glTF file moves it, by name or by number from 0; alone: its pose at 0 s.\n"
             "Without this and --frame-time the scene stands as the file has it")
        ->type_name("NAME")
        ->group("Picture");
    constexpr double kMaxTime = 1e9;
    add_real(c, "--frame-time", options.frame_time, 0, kMaxTime,
             "The moment to show, in seconds, of --animation or of the file's first one; before the first and after\n"
             "the last keyframe it stands still")
        ->group("Picture");
    add_real(c, "--turn", options.turn, -kMaxTurn, kMaxTurn,
             "Degrees by which the model is turned before a camera of its own: a picture of render's --turntable")
        ->group("Picture");
    add_choice(c, "--gltf-light-units", options.light_units, kLightUnits,
               "How a glTF file's lights are meant: radiometric (W/sr and W/m², the default) or photometric (683\n"
               "times that, of exporters that turn watts into lumens)")
        ->group("Picture");
    add_count<uint64_t>(c, "--gltf-memory", options.gltf_memory, 0, 1 << 20,
                        "MiB that a glTF file's geometry and texels may take even where that is more than 256 times\n"
                        "the bytes in use: 320 unless said otherwise, against hostile files")
        ->group("Picture");
    add_choice(c, "--integrator", options.integrator, names_of<IntegratorKind>(), integrator_help())->group("Picture");
    add_count<uint32_t>(c, "--max-depth", options.max_depth, 0, kMaxDepth,
                        "Bounces: 0 only what glows, 1 direct light, more for mirrors, glass and indirect light")
        ->group("Picture");
    add_choice(c, "--light-sampling", options.light_sampling, names_of<LightSampling>(),
               "How path finds lights: mis (least noise), or for comparisons light or bsdf alone")
        ->group("Picture");
    add_choice(c, "--light-choice", options.light_choice, names_of<LightChoice>(),
               "How path chooses one of many lights: bvh (by what it may bring to the point), by its power, or uniform")
        ->group("Picture");
    add_count<uint32_t>(c, "--roulette-depth", options.roulette_depth, 0, kMaxDepth,
                        "Bounces of path before Russian roulette begins to end paths; the mean stays")
        ->group("Picture");
    add_real(c, "--clamp", options.clamp, 0, kMaxClamp,
             "Most that one connection of path adds as indirect light: fewer fireflies, but the picture is\nbiased, "
             "and says so in its metadata; 0: no limit")
        ->group("Picture");
    add_real(c, "--ao-distance", options.ao_distance, 0, kMaxAoDistance,
             "Metres up to which ao looks for what is in the way; 0: anywhere")
        ->group("Picture");
    add_text(c, "--filter", options.filter, "for example --filter gaussian:1.5",
             "box, tent, gaussian or mitchell, optionally with a radius in pixels: gaussian:1.5")
        ->type_name("NAME[:RADIUS]")
        ->group("Picture");
    add_choice(c, "--sampler", options.sampler, names_of<SamplerKind>(), "sobol (less noise) or independent")
        ->group("Picture");
    add_count<uint64_t>(c, "--seed", options.seed, 0, std::numeric_limits<uint64_t>::max(),
                        "Another seed gives another, equally good noise pattern")
        ->group("Picture");
}

}  // namespace steradian::cli
