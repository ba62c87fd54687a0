#include "formats/mesh_file.h"

#include <array>

#include "base/file.h"
#include "base/text.h"
#include "formats/mesh/asset_path.h"

namespace steradian {

void note_dropped(MeshFile& file, SourceLocation where, uint64_t faces) {
    file.dropped_faces = faces;
    if (faces)
        file.diagnostics.warn("faces with coordinates that are not finite or beyond 1e15 were dropped",
                              std::move(where), faces, "nan-vertices");
}

Result<MeshFile> load_mesh_file(const std::string& path, const LoadOptions& options) {
    static constexpr std::array<std::string_view, 2> kExtensions{".obj", ".ply"};
    const std::string extension = extension_of(path);
    if (extension != ".obj" && extension != ".ply")
        return Error{ErrorCode::bad_input,
                     "unknown kind of model file, expected .obj or .ply",
                     {path, 0, 0, {}},
                     {},
                     suggestion(extension, kExtensions)};
    auto data = read_file(path, options.max_file_bytes);
    if (!data) return std::move(data).error();
    return extension == ".obj" ? parse_obj(*data, path, folder_of(path), options) : parse_ply(*data, path, options);
}

}  // namespace steradian
