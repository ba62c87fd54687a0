// Files that a scene refers to: each image and each model is read once, however often it is named.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/json/reader.h"
#include "formats/mesh_file.h"
#include "steradian/load.h"

namespace steradian {

/// A model file whose meshes have moved into the scene.
struct Model {
    struct Part {
        ShapeId shape;
        int material = -1;  ///< index into `materials`, -1: none given
        std::string name;
        bool has_colors = false;  ///< of its vertices
    };
    std::vector<Part> parts;
    std::vector<MeshMaterial> materials;
    std::vector<std::optional<MaterialId>> made;  ///< scene materials made of `materials` so far
    uint64_t dropped_faces = 0;                   ///< whose coordinates are not usable
};

/// Where an instance's look comes from.
struct Placement {
    Affine world_from_object;
    std::optional<MaterialId> material;  ///< overrides what the file says
    /// The caller makes area lights of the instances: emissive materials of the file make none of their own, and a
    /// surface that nothing is said about reflects nothing instead of being neutral grey.
    bool emitter = false;
    std::string name;
};

struct InstanceRange {
    uint32_t first = 0, count = 0;
};

/// Warns when a surface would reflect more than it receives.
void warn_about_reflectance(Diagnostics& diagnostics, Rgb reflectance, SourceLocation where);

/// Fills a scene. Errors about a file as a whole (missing, refused path) have no line, so that the caller can point at
/// the place that named the file.
class Assets {
public:
    Assets(LoadedScene& loaded, std::string base_folder, const LoadOptions& options)
        : loaded_(loaded), base_folder_(std::move(base_folder)), options_(options) {}

    /// While it lives, what is added stands at one place: a byte of the JSON text, whose line and pointer are found
    /// once all is there (locate), or a place in another file.
    class Here {
    public:
        Here(Assets& assets, size_t offset) : Here(assets, SourceLocation{{}, 0, 0, offset, {}}) {}
        Here(Assets& assets, SourceLocation place) : here_(assets.here_), before_(std::move(here_)) {
            here_ = std::move(place);
        }
        ~Here() { here_ = std::move(before_); }
        Here(const Here&) = delete;
        Here& operator=(const Here&) = delete;

    private:
        std::optional<SourceLocation>& here_;
        std::optional<SourceLocation> before_;
    };
    /// Lines, columns and pointers of what has been added at bytes of this text.
    void locate(const json::Document& document, const json::Source& source);

    /// A named file as a path to open: relative ones against the base folder. Refuses network addresses always, and
    /// paths out of the base folder (absolute, through "..", through symbolic links) where the options say so.
    Result<std::string> resolve(std::string_view named) const;

    Result<ImageId> image(std::string_view named);
    /// A photometric file (IES).
    Result<ProfileId> profile(std::string_view named);
    /// How the texels of an image are meant when nobody says: integers as sRGB, floating point as linear.
    ColorSpace default_color_space(ImageId image) const;

    /// Index for model().
    /// `colors` is how the colours of its vertices are meant, if it has some; nothing: as MeshFile says.
    Result<size_t> load_model(std::string_view named, std::optional<ColorSpace> colors = std::nullopt);
    Model& model(size_t i) { return models_[i]; }
    /// One instance for each part. Fails when an image of the file's materials does.
    Result<InstanceRange> place(size_t model, const Placement& placement);

    MaterialId add_diffuse(Rgb reflectance, bool two_sided, std::string name);
    ImageId add_image(RawImage image, std::string name);
    TextureId add_texture(Texture texture, std::string name);
    MaterialId add_material(Material material, std::string name);
    ShapeId add_shape(Shape shape, std::string name);
    MeshId add_mesh(Mesh mesh, std::string name);
    InstanceId add_instance(Instance instance, std::string name);
    void add_light(Light light, std::string name);
    void add_camera(Camera camera, std::string name);

    /// For surfaces that nothing is said about: two-sided grey of reflectance 0.5, or what colour its vertices
    /// have; black for emitters.
    MaterialId default_material(bool emitter, bool has_colors = false);

private:
    Result<MaterialId> file_material(Model& model, int index);
    Result<MaterialId> convert(const MeshMaterial& from);
    Result<ImageId> open_image(const std::string& path);
    Status check_inside(const std::string& path) const;
    void note_place(ElementKind kind, uint32_t index);

    LoadedScene& loaded_;
    std::string base_folder_;
    const LoadOptions& options_;
    std::map<std::string, ImageId> images_;
    std::map<std::string, ProfileId> profiles_;
    std::map<std::string, size_t> model_index_;
    std::vector<Model> models_;
    std::optional<MaterialId> neutral_, black_, painted_;
    std::optional<SourceLocation> here_;
};

}  // namespace steradian
