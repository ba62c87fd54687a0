#include "formats/assets.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <system_error>

#include "base/text.h"
#include "formats/ies/ies.h"
#include "image/decode.h"
#include "image/tone.h"
#include "math/vector.h"

namespace steradian {
namespace {

/// About a file as a whole: without a line.
Error path_error(std::string message, std::string hint = {}) {
    return {ErrorCode::bad_input, std::move(message), {}, {}, std::move(hint)};
}

/// "http://…", "file:…": a scheme of at least two letters, so that a drive letter is not one.
bool has_scheme(std::string_view path) {
    const size_t colon = path.find(':');
    if (colon == path.npos || colon < 2) return false;
    for (const char c : path.substr(0, colon)) {
        const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
        if (!letter && !(c >= '0' && c <= '9') && c != '+' && c != '-' && c != '.') return false;
    }
    return path.substr(colon + 1).starts_with("//") || iequals(path.substr(0, colon), "file") ||
           iequals(path.substr(0, colon), "data");
}

Error address_error(std::string_view named) {
    std::string message = "this is an address, expected a path: nothing is fetched: ";
    message += escape_for_display(named);
    return path_error(std::move(message));
}

/// Two names of one file share what was read.
std::string identity(const std::string& path) {
    std::error_code error;
    const auto canonical = std::filesystem::weakly_canonical(path, error);
    return error ? path : canonical.string();
}

/// Appends an element with its name and returns its index. The list of names begins with the first one that says
/// anything: a million objects without names do without.
template <class T>
uint32_t add_named(std::vector<T>& pool, std::vector<std::string>& names, T element, std::string& name) {
    if (!name.empty() || !names.empty()) {
        names.resize(pool.size());
        names.push_back(std::move(name));
    }
    pool.push_back(std::move(element));
    return static_cast<uint32_t>(pool.size() - 1);
}

}  // namespace

void warn_about_reflectance(Diagnostics& diagnostics, Rgb reflectance, SourceLocation where) {
    if (max_component(reflectance) > 1)
        diagnostics.warn("a reflectance above 1 adds energy: surfaces like this do not exist", std::move(where), 1,
                         "albedo-above-one");
}

SourceLocation SceneLocations::of(Element element) const {
    const auto& list = places[static_cast<size_t>(element.kind)];
    SourceLocation out = element.index < list.size() ? list[element.index] : SourceLocation{};
    if (out.file.empty()) out.file = file;
    return out;
}

void Assets::note_place(ElementKind kind, uint32_t index) {
    if (!options_.locations || !here_) return;
    auto& list = loaded_.locations.places[static_cast<size_t>(kind)];
    list.resize(index);
    list.push_back(*here_);
}

void Assets::locate(const json::Document& document, const json::Source& source) {
    std::vector<SourceLocation*> places;
    for (auto& list : loaded_.locations.places)
        for (SourceLocation& place : list)
            if (place.file.empty() && place.byte) places.push_back(&place);
    std::stable_sort(places.begin(), places.end(), [](const auto* a, const auto* b) { return *a->byte < *b->byte; });
    std::vector<size_t> offsets(places.size());
    for (size_t i = 0; i < places.size(); ++i) {
        offsets[i] = *places[i]->byte;
        *places[i] = source.place(offsets[i]);
        places[i]->file.clear();
    }
    document.each_pointer(offsets, [&](size_t i, const std::string& pointer) { places[i]->pointer = pointer; });
}

Status Assets::check_inside(const std::string& path) const {
    std::error_code error;
    const auto root = std::filesystem::weakly_canonical(base_folder_.empty() ? "." : base_folder_, error);
    const auto target = std::filesystem::weakly_canonical(path, error);
    const auto relative = target.lexically_relative(root);
    if (error || relative.empty() || *relative.begin() == "..")
        return path_error("the path '" + escape_for_display(path) + "' leaves the scene's folder",
                          "paths outside it are not allowed here");
    return Ok{};
}

Result<std::string> Assets::resolve(std::string_view named) const {
    if (named.empty()) return path_error("the path is empty, expected the name of a file");
    if (named.find('\0') != named.npos) return path_error("a path cannot contain a NUL character");
    if (has_scheme(named)) return address_error(named);
    std::string path(named);
    if (named.front() != '/' && !base_folder_.empty())
        path = base_folder_ + (base_folder_.back() == '/' ? "" : "/") + path;
    if (!options_.allow_outside_paths.value_or(true)) {
        if (named.front() == '/')
            return path_error("the path '" + escape_for_display(named) + "' is absolute",
                              "paths outside the scene's folder are not allowed here");
        if (auto inside = check_inside(path); !inside) return std::move(inside).error();
    }
    return path;
}

Result<ImageId> Assets::image(std::string_view named) {
    auto path = resolve(named);
    if (!path) return std::move(path).error();
    return open_image(*path);
}

Result<ImageId> Assets::open_image(const std::string& path) {
    const std::string key = identity(path);
    if (const auto known = images_.find(key); known != images_.end()) return known->second;
    auto texels = read_texels(path, options_.images);
    if (!texels) return std::move(texels).error();
    loaded_.files.push_back(path);
    const ImageId id = add_image(std::move(*texels), path);
    images_.emplace(key, id);
    return id;
}

Result<ProfileId> Assets::profile(std::string_view named) {
    auto path = resolve(named);
    if (!path) return std::move(path).error();
    const std::string key = identity(*path);
    if (const auto known = profiles_.find(key); known != profiles_.end()) return known->second;
    auto profile = load_ies(*path);
    if (!profile) return std::move(profile).error();
    loaded_.files.push_back(*path);
    Scene& scene = loaded_.scene;
    const auto id = ProfileId(add_named(scene.profiles, scene.names.profiles, *std::move(profile), *path));
    note_place(ElementKind::profile, index(id));
    profiles_.emplace(key, id);
    return id;
}

ColorSpace Assets::default_color_space(ImageId image) const {
    const TexelFormat format = loaded_.scene.images[index(image)].format;
    return format == TexelFormat::u8 || format == TexelFormat::u16 ? ColorSpace::srgb : ColorSpace::linear;
}

Result<size_t> Assets::load_model(std::string_view named, std::optional<ColorSpace> colors) {
    auto path = resolve(named);
    if (!path) return std::move(path).error();
    const std::string way = !colors ? "" : *colors == ColorSpace::srgb ? "|srgb" : "|linear";
    const std::string key = identity(*path) + way;
    if (const auto known = model_index_.find(key); known != model_index_.end()) return known->second;
    auto file = load_mesh_file(*path, options_);
    if (!file) return std::move(file).error();
    loaded_.diagnostics.append(file->diagnostics);
    loaded_.files.push_back(*path);
    loaded_.files.insert(loaded_.files.end(), file->libraries.begin(), file->libraries.end());
    if (file->parts.empty()) loaded_.diagnostics.warn("the model has no faces", {*path, 0, 0, {}});
    Model model;
    for (MeshPart& part : file->parts) {
        const Here here(*this, part.where.file.empty() ? SourceLocation{*path, 0, 0, {}} : part.where);
        const bool has_colors = !part.mesh.colors.empty();
        if (colors.value_or(file->color_space) == ColorSpace::srgb)
            for (Rgb& c : part.mesh.colors) c = {srgb_decode(c.r), srgb_decode(c.g), srgb_decode(c.b)};
        const MeshId mesh = add_mesh(std::move(part.mesh), part.name.empty() ? std::string(named) : part.name);
        model.parts.push_back({add_shape(mesh, part.name), part.material, part.name, has_colors});
    }
    model.dropped_faces = file->dropped_faces;
    model.materials = std::move(file->materials);
    model.made.resize(model.materials.size());
    models_.push_back(std::move(model));
    model_index_.emplace(key, models_.size() - 1);
    return models_.size() - 1;
}

Result<InstanceRange> Assets::place(size_t model_number, const Placement& placement) {
    Model& model = models_[model_number];
    InstanceRange range{static_cast<uint32_t>(loaded_.scene.instances.size()), 0};
    for (const Model::Part& part : model.parts) {
        MaterialId material{};
        const bool from_file = !placement.material && part.material >= 0;
        if (from_file) {
            auto made = file_material(model, part.material);
            if (!made) return std::move(made).error();
            material = *made;
        } else {
            material = placement.material ? *placement.material : default_material(placement.emitter, part.has_colors);
        }
        const InstanceId instance = add_instance({part.shape, material, placement.world_from_object},
                                                 placement.name.empty() ? part.name : placement.name);
        ++range.count;
        if (!from_file || placement.emitter) continue;
        const Rgb emission = model.materials[static_cast<size_t>(part.material)].emission;
        if (max_component(emission) > 0) add_light(AreaLight{instance, emission, false, 1}, part.name);
    }
    return range;
}

Result<MaterialId> Assets::file_material(Model& model, int number) {
    const auto i = static_cast<size_t>(number);
    if (!model.made[i]) {
        const Here here(*this, model.materials[i].where);
        auto material = convert(model.materials[i]);
        if (!material) return material;
        model.made[i] = *material;
    }
    return *model.made[i];
}

/// MTL in our terms: illum 3 is a mirror; 4, 6, 7, 9 and what is more transparent than opaque is glass; the rest is
/// diffuse and two-sided, since the orientation of faces in OBJ files is not dependable.
Result<MaterialId> Assets::convert(const MeshMaterial& from) {
    const bool glass = from.illum == 4 || from.illum == 6 || from.illum == 7 || from.illum == 9 || from.dissolve < 0.5f;
    const auto tint_or_white = [&](Rgb tint) {
        warn_about_reflectance(loaded_.diagnostics, tint, from.where);
        return max_component(tint) > 0 ? tint : Rgb{1, 1, 1};
    };
    if (glass) return add_material(GlassMaterial{from.ior, {1, 1, 1}, tint_or_white(from.transmission)}, from.name);
    if (from.illum == 3) return add_material(MirrorMaterial{tint_or_white(from.specular)}, from.name);
    if (from.dissolve < 1) loaded_.diagnostics.warn("partly transparent materials (d, Tr) are rendered opaque");
    if (from.diffuse_map.empty()) {
        warn_about_reflectance(loaded_.diagnostics, from.diffuse, from.where);
        return add_diffuse(from.diffuse, true, from.name);
    }

    // The mesh reader resolved it against the MTL file's folder.
    if (has_scheme(from.diffuse_map)) return address_error(from.diffuse_map);
    if (!options_.allow_outside_paths.value_or(true))
        if (auto inside = check_inside(from.diffuse_map); !inside) return std::move(inside).error();
    auto texels = open_image(from.diffuse_map);
    if (!texels) {
        Error error = std::move(texels).error();
        error.message = "texture " + escape_for_display(from.diffuse_map, 4096) + ": " + error.message;
        error.where = from.diffuse_map_where;
        return error;
    }
    ImageTexture texture;
    texture.image = *texels;
    texture.color_space = default_color_space(*texels);
    texture.wrap_u = texture.wrap_v = from.map_clamp ? Wrap::clamp : Wrap::repeat;
    texture.scale = from.map_scale;
    texture.offset = from.map_offset;
    return add_material(DiffuseMaterial{add_texture(texture, from.name), true}, from.name);
}

MaterialId Assets::add_diffuse(Rgb reflectance, bool two_sided, std::string name) {
    const TextureId texture = add_texture(ConstantTexture{reflectance}, name);
    return add_material(DiffuseMaterial{texture, two_sided}, std::move(name));
}

ImageId Assets::add_image(RawImage image, std::string name) {
    note_place(ElementKind::image, static_cast<uint32_t>(loaded_.scene.images.size()));
    return ImageId(add_named(loaded_.scene.images, loaded_.scene.names.images, std::move(image), name));
}

TextureId Assets::add_texture(Texture texture, std::string name) {
    note_place(ElementKind::texture, static_cast<uint32_t>(loaded_.scene.textures.size()));
    return TextureId(add_named(loaded_.scene.textures, loaded_.scene.names.textures, std::move(texture), name));
}

MaterialId Assets::add_material(Material material, std::string name) {
    note_place(ElementKind::material, static_cast<uint32_t>(loaded_.scene.materials.size()));
    return MaterialId(add_named(loaded_.scene.materials, loaded_.scene.names.materials, std::move(material), name));
}

ShapeId Assets::add_shape(Shape shape, std::string name) {
    note_place(ElementKind::shape, static_cast<uint32_t>(loaded_.scene.shapes.size()));
    return ShapeId(add_named(loaded_.scene.shapes, loaded_.scene.names.shapes, std::move(shape), name));
}

MeshId Assets::add_mesh(Mesh mesh, std::string name) {
    note_place(ElementKind::mesh, static_cast<uint32_t>(loaded_.scene.meshes.size()));
    return MeshId(add_named(loaded_.scene.meshes, loaded_.scene.names.meshes, std::move(mesh), name));
}

InstanceId Assets::add_instance(Instance instance, std::string name) {
    note_place(ElementKind::instance, static_cast<uint32_t>(loaded_.scene.instances.size()));
    return InstanceId(add_named(loaded_.scene.instances, loaded_.scene.names.instances, std::move(instance), name));
}

void Assets::add_light(Light light, std::string name) {
    note_place(ElementKind::light, static_cast<uint32_t>(loaded_.scene.lights.size()));
    add_named(loaded_.scene.lights, loaded_.scene.names.lights, std::move(light), name);
}

void Assets::add_camera(Camera camera, std::string name) {
    note_place(ElementKind::camera, static_cast<uint32_t>(loaded_.scene.cameras.size()));
    loaded_.scene.names.cameras.push_back(std::move(name));  // always: they are chosen by it, even by an empty one
    loaded_.scene.cameras.push_back(std::move(camera));
}

MaterialId Assets::default_material(bool emitter, bool has_colors) {
    if (emitter) {
        if (!black_) black_ = add_diffuse({0, 0, 0}, false, "");
        return *black_;
    }

    if (has_colors) {
        if (!painted_) painted_ = add_material(DiffuseMaterial{add_texture(VertexColorTexture{}, ""), true}, "");
        return *painted_;
    }
    if (!neutral_) neutral_ = add_diffuse({0.5f, 0.5f, 0.5f}, true, "");
    return *neutral_;
}

}  // namespace steradian
