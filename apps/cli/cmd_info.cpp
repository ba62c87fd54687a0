// steradian info: what is in a scene or in a picture.
#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <span>

#include "base/names.h"
#include "base/text.h"
#include "command.h"
#include "findings.h"
#include "math/transform.h"
#include "picture_info.h"
#include "progress.h"
#include "render/memory_estimate.h"
#include "steradian/lint.h"
#include "steradian/load.h"
#include "steradian/render.h"

namespace steradian::cli {
namespace {

struct SceneSummary {
    uint64_t triangles = 0;         ///< stored once however often they are used
    uint64_t placed_triangles = 0;  ///< as they appear in the world
    uint64_t vertices = 0;
    uint64_t geometry_bytes = 0, texel_bytes = 0;
    Vec3 lo{kInfinity, kInfinity, kInfinity}, hi{-kInfinity, -kInfinity, -kInfinity};
};

void grow(SceneSummary& s, Vec3 p) {
    for (int a = 0; a < 3; ++a) s.lo[a] = min_of(s.lo[a], p[a]), s.hi[a] = max_of(s.hi[a], p[a]);
}

/// World bounds by the corners of each shape's own box: exact for boxes, slightly large for rotated ones.
void grow(SceneSummary& s, const Instance& instance, Vec3 lo, Vec3 hi) {
    for (int corner = 0; corner < 8; ++corner)
        grow(s,
             Vec3(transform_point(instance.world_from_object,
                                  Vec3{corner & 1 ? hi.x : lo.x, corner & 2 ? hi.y : lo.y, corner & 4 ? hi.z : lo.z})));
}

/// What the file has of its own: not the studio that a bare model gets.
LoadedScene::OwnElements own_elements(const LoadedScene& loaded) {
    const Scene& s = loaded.scene;
    return loaded.before_studio.value_or(LoadedScene::OwnElements{
        s.instances.size(), s.shapes.size(), s.materials.size(), s.textures.size(), s.lights.size()});
}

SceneSummary summarize(const LoadedScene& loaded) {
    const Scene& scene = loaded.scene;
    SceneSummary s;
    std::vector<SceneSummary> meshes(scene.meshes.size());
    for (size_t i = 0; i < scene.meshes.size(); ++i) {
        const Mesh& m = scene.meshes[i];
        for (const Vec3& p : m.positions) grow(meshes[i], p);
        s.triangles += m.indices.size() / 3;
        s.vertices += m.positions.size();
        s.geometry_bytes += mesh_bytes(m);
    }
    for (const RawImage& image : scene.images) s.texel_bytes += image.data.size();
    for (const Instance& i : std::span(scene.instances).first(own_elements(loaded).instances)) {
        const Shape& shape = scene.shapes[index(i.shape)];
        if (const auto* id = std::get_if<MeshId>(&shape)) {
            const SceneSummary& m = meshes[index(*id)];
            s.placed_triangles += scene.meshes[index(*id)].indices.size() / 3;
            if (m.lo.x <= m.hi.x) grow(s, i, m.lo, m.hi);
        } else if (const auto* sphere = std::get_if<Sphere>(&shape)) {
            const Vec3 r{sphere->radius, sphere->radius, sphere->radius};
            grow(s, i, sphere->center - r, sphere->center + r);
        } else if (const auto* rect = std::get_if<Rectangle>(&shape)) {
            const Vec3 r = abs(rect->half_u) + abs(rect->half_v);
            grow(s, i, rect->center - r, rect->center + r);
        } else {
            const Disk& disk = std::get<Disk>(shape);
            const Vec3 r{disk.radius, disk.radius, disk.radius};
            grow(s, i, disk.center - r, disk.center + r);
        }
    }
    return s;
}

const char* kind_of(const Light& light) {
    static constexpr const char* kNames[] = {"point", "spot", "directional", "area", "environment", "goniometric"};
    return kNames[light.index()];
}

std::string camera_name(const Scene& scene, size_t i) {
    return i < scene.names.cameras.size() ? scene.names.cameras[i] : std::to_string(i);
}

/// What is unused, out of range, approximated or ignored: what can be said without a look at the geometry.
Result<LintReport> quick_findings(const LoadedScene& loaded) {
    static constexpr std::string_view kQuick[] = {"not-honoured", "input",        "unused",
                                                  "no-effect",    "out-of-range", "nan-vertices"};
    LintOptions options;
    for (const LintRule& rule : lint_rules())
        if (std::find(std::begin(kQuick), std::end(kQuick), rule.name) == std::end(kQuick))
            options.disabled.emplace_back(rule.name);
    return lint(loaded, options);
}

void print_text(const std::string& path, const LoadedScene& loaded, const SceneSummary& s, const LintReport& findings) {
    const Scene& scene = loaded.scene;
    const LoadedScene::OwnElements own = own_elements(loaded);
    const RenderSettings& r = loaded.settings;
    std::cout << fmt::format("{}: a scene\n", escape_for_display(path, 4096));
    std::cout << fmt::format("  hash       {}\n", scene_hash(scene));
    std::cout << fmt::format("  objects    {} ({} shapes, {} meshes)\n", own.instances, own.shapes,
                             scene.meshes.size());
    std::cout << fmt::format("  triangles  {} stored, {} placed, {} vertices\n", s.triangles, s.placed_triangles,
                             s.vertices);
    if (s.lo.x <= s.hi.x)
        std::cout << fmt::format("  bounds     ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g}) m\n", s.lo.x,
                                 s.lo.y, s.lo.z, s.hi.x, s.hi.y, s.hi.z);
    std::cout << fmt::format("  materials  {}, textures {}, images {}\n", own.materials, own.textures,
                             scene.images.size());
    const auto lights = std::span(scene.lights).first(own.lights);
    std::cout << fmt::format("  lights     {}", lights.size());
    for (size_t kind = 0; kind < std::variant_size_v<Light>; ++kind) {
        const auto is_that = [&](const Light& l) { return l.index() == kind; };
        if (const auto n = std::count_if(lights.begin(), lights.end(), is_that))
            std::cout << fmt::format(", {} {}", n, kind_of(*std::find_if(lights.begin(), lights.end(), is_that)));
    }
    if (loaded.before_studio) std::cout << (lights.empty() ? "" : ";") << " (a neutral studio is added)";
    std::cout << "\n  cameras    " << scene.cameras.size();
    for (size_t i = 0; i < scene.cameras.size(); ++i)
        std::cout << (i ? ", " : ": ") << escape_for_display(camera_name(scene, i));
    if (!loaded.animations.empty()) std::cout << "\n  animations " << loaded.animations.size();
    for (size_t i = 0; i < loaded.animations.size(); ++i)
        std::cout << (i ? ", " : ": ") << escape_for_display(loaded.animations[i]);
    if (!loaded.variants.empty()) std::cout << "\n  variants   " << loaded.variants.size();
    for (size_t i = 0; i < loaded.variants.size(); ++i)
        std::cout << (i ? ", " : ": ") << escape_for_display(loaded.variants[i]);
    const auto bytes = [](uint64_t n) { return format_quantity(double(n)) + "B"; };
    const MemoryEstimate m = estimate_memory(scene, r);
    std::cout << fmt::format("\n  memory     {} of geometry, {} of texels\n", bytes(s.geometry_bytes),
                             bytes(s.texel_bytes));
    std::cout << fmt::format(
        "  to render  about {}: {} for the scene, {} for its hierarchy and tables (for a while {} more, to build "
        "them), "
        "{} for the picture\n",
        bytes(m.peak()), bytes(m.scene), bytes(m.hierarchy), bytes(m.build), bytes(m.picture));
    std::cout << fmt::format(
        "  settings   {}x{}, {} samples per pixel, {} integrator, depth {}, {} filter of radius {:.3g}, {} sampler, "
        "seed {}\n",
        r.width, r.height, r.samples_per_pixel, name_of(r.integrator), r.max_depth, name_of(r.filter.kind),
        r.filter.radius, name_of(r.sampler), r.seed);
    print_findings(std::cout, findings, "  ");
}

void print_json(const std::string& path, const LoadedScene& loaded, const SceneSummary& s, const LintReport& findings) {
    const Scene& scene = loaded.scene;
    const LoadedScene::OwnElements own = own_elements(loaded);
    rapidjson::StringBuffer buffer;
    JsonWriter w(buffer);
    const auto number = [&](const char* key, uint64_t value) { w.Key(key), w.Uint64(value); };
    const auto text = [&](const char* key, std::string_view value) { write_field(w, key, value); };
    w.StartObject();
    text("file", path), text("kind", "scene"), text("hash", scene_hash(scene));
    number("objects", own.instances), number("shapes", own.shapes), number("meshes", scene.meshes.size());
    number("triangles", s.triangles), number("placed_triangles", s.placed_triangles), number("vertices", s.vertices);
    number("materials", own.materials), number("textures", own.textures), number("images", scene.images.size());
    number("geometry_bytes", s.geometry_bytes), number("texel_bytes", s.texel_bytes);
    const MemoryEstimate m = estimate_memory(scene, loaded.settings);
    w.Key("memory"), w.StartObject();
    number("scene_bytes", m.scene), number("hierarchy_bytes", m.hierarchy), number("build_bytes", m.build);
    number("picture_bytes", m.picture), number("peak_bytes", m.peak());
    w.EndObject();
    w.Key("lights"), w.StartArray();
    for (const Light& light : std::span(scene.lights).first(own.lights)) w.String(kind_of(light));
    w.EndArray();
    w.Key("studio"), w.Bool(loaded.before_studio.has_value());
    w.Key("cameras"), w.StartArray();
    for (size_t i = 0; i < scene.cameras.size(); ++i) write_text(w, camera_name(scene, i));
    w.EndArray();
    w.Key("animations"), w.StartArray();
    for (const std::string& name : loaded.animations) write_text(w, name);
    w.EndArray();
    w.Key("variants"), w.StartArray();
    for (const std::string& name : loaded.variants) write_text(w, name);
    w.EndArray();
    if (s.lo.x <= s.hi.x) {
        w.Key("bounds"), w.StartArray();
        for (const Vec3 p : {s.lo, s.hi}) {
            w.StartArray();
            for (int a = 0; a < 3; ++a) w.Double(double(p[a]));
            w.EndArray();
        }
        w.EndArray();
    }
    const RenderSettings& r = loaded.settings;
    w.Key("settings"), w.StartObject();
    number("width", r.width), number("height", r.height), number("spp", r.samples_per_pixel);
    text("integrator", name_of(r.integrator)), number("max_depth", r.max_depth);
    text("filter", name_of(r.filter.kind)), w.Key("filter_radius"), w.Double(double(r.filter.radius));
    text("sampler", name_of(r.sampler)), number("seed", r.seed);
    w.EndObject();
    write_findings(w, findings);
    w.EndObject();
    std::cout << buffer.GetString() << '\n';
}

Status print_scene_info(const std::string& path, bool json) {
    LoadOptions options;
    options.locations = true;
    const auto loaded = load_scene(path, options);
    if (!loaded) return loaded.error();
    const auto findings = quick_findings(*loaded);
    if (!findings) return findings.error();
    const SceneSummary summary = summarize(*loaded);
    json ? print_json(path, *loaded, summary, *findings) : print_text(path, *loaded, summary, *findings);
    return Ok{};
}

struct InfoOptions {
    std::string path;
    bool json = false;
};

int run_info(const InfoOptions& o) {
    Status status =
        is_picture(o.path) ? print_picture_info(o.path, o.json, std::cout) : print_scene_info(o.path, o.json);
    if (status) status = finish_stdout();
    return status ? kDone : report(status.error());
}

}  // namespace

void add_info(CLI::App& app, Action& action) {
    auto o = std::make_shared<InfoOptions>();
    CLI::App* c =
        add_command(app, action, "info",
                    "What is in a scene (counts, bounds, memory, settings) or a picture (metadata, hash)", o, run_info);
    c->add_option("FILE", o->path, "A scene, a model or a picture")->required();
    c->add_flag("--json", o->json, "As JSON");
}

}  // namespace steradian::cli
