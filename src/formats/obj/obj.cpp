// Wavefront OBJ: text to records, records to meshes, and the materials that they use.
#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "base/file.h"
#include "base/text.h"
#include "formats/mesh/asset_path.h"
#include "formats/mesh/parse_failure.h"
#include "formats/mesh_file.h"
#include "formats/obj/build.h"
#include "formats/obj/mtl.h"
#include "formats/obj/records.h"

namespace steradian {
namespace {

/// More files than any exporter writes; a hostile one could name thousands of large ones.
constexpr size_t kMaxLibraries = 256;

std::string describe(obj::Remark kind, std::string_view word) {
    switch (kind) {
        case obj::Remark::points:
            return "points (p) are not drawn";
        case obj::Remark::lines:
            return "lines (l) are not drawn";
        case obj::Remark::free_form:
            return "free-form curves and surfaces are not supported";
        case obj::Remark::unknown_keyword:
            return word.empty() ? "other unknown keywords ignored"
                                : "unknown keyword '" + escape_for_display(word, 60) + "' ignored";
        case obj::Remark::uvs_missing:
            return "faces refer to texture coordinates, but the file has no vt lines; they have none";
        case obj::Remark::normals_missing:
            return "faces refer to normals, but the file has no vn lines; smoothing groups count";
        case obj::Remark::bad_smoothing:
            return "not a smoothing group (expected a whole number, on or off); taken as off";
    }
    return {};
}

/// The names after `mtllib`: separated by white space, where a backslash keeps the blank after it in the name.
std::vector<std::string> split_names(std::string_view names) {
    std::vector<std::string> out;
    std::string name;
    for (size_t i = 0; i < names.size(); ++i) {
        const char c = names[i];
        const bool blank = c == ' ' || c == '\t' || c == '\r' || c == '\n';
        const char following = i + 1 < names.size() ? names[i + 1] : '\0';
        if (c == '\\' && (following == ' ' || following == '\t')) {
            name += names[++i];
        } else if (blank || (c == '\\' && (following == '\r' || following == '\n'))) {
            if (!name.empty()) out.push_back(std::move(name));
            name.clear();
        } else {
            name += c;
        }
    }
    if (!name.empty()) out.push_back(std::move(name));
    return out;
}

/// Materials of all libraries by name; the first definition counts.
class Materials {
public:
    Materials(std::string_view text, const std::string& name, const std::string& folder, const LoadOptions& options,
              Diagnostics& diagnostics)
        : text_(text), name_(name), folder_(folder), options_(options), diagnostics_(diagnostics) {}

    Status load(const std::vector<obj::Library>& libraries) {
        for (const obj::Library& library : libraries) {
            // A name with blanks is often written as it is; so the whole rest of the line is tried first.
            const std::vector<std::string> names = split_names(library.names);
            if (names.size() > 1 && (options_.allow_outside_paths.value_or(true) || !leaves_folder(library.names))) {
                const std::string path = resolve_asset(library.names, folder_);
                if (auto whole = read_file(path, options_.max_file_bytes)) {
                    if (const Status done = load_file(std::string(library.names), library.offset, &*whole); !done)
                        return done;
                    continue;
                }
            }
            for (const std::string& file : names)
                if (const Status done = load_file(file, library.offset, nullptr); !done) return done;
        }
        return Ok{};
    }

    /// Index into `used`, which grows in order of first use; -1 with a warning when no library defines it.
    int find(const obj::FaceList& list) {
        const auto found = by_name_.find(list.material);
        if (found == by_name_.end()) {
            warn_undefined(list.material);
            return -1;
        }
        used.push_back(found->second);
        return static_cast<int>(used.size() - 1);
    }

    std::vector<MeshMaterial> used;
    std::vector<std::string> read;  ///< the libraries' paths

private:
    static constexpr size_t kMaxNamed = 32;

    size_t offset_of(std::string_view part) const { return static_cast<size_t>(part.data() - text_.data()); }
    SourceLocation place(size_t offset) const { return text_location(text_, name_, offset); }

    void warn_undefined(std::string_view material) {
        ++undefined_;
        if (undefined_ <= kMaxNamed)
            diagnostics_.warn(
                "material '" + escape_for_display(material, 100) + "' is not defined; the default is used",
                place(offset_of(material)));
        else  // finding the place takes a walk through the text: once is enough
            diagnostics_.warn("other materials are not defined; the default is used",
                              undefined_ == kMaxNamed + 1 ? place(offset_of(material)) : SourceLocation{});
    }

    Status load_file(const std::string& file, size_t offset, const std::string* content) {
        const std::string path = resolve_asset(file, folder_);
        if (!options_.allow_outside_paths.value_or(true) && leaves_folder(file))
            return text_error(text_, name_,
                              {offset, "the material library lies outside of the model's folder",
                               "move it there, or allow outside paths"});
        if (!seen_.insert(path).second) return Ok{};
        if (seen_.size() > kMaxLibraries)
            return text_error(text_, name_,
                              {offset,
                               "more than " + std::to_string(kMaxLibraries) + " material libraries",
                               {},
                               ErrorCode::resources});
        Result<std::string> data = content ? Result<std::string>(*content) : read_file(path, options_.max_file_bytes);
        if (!data) {
            diagnostics_.warn("material library '" + escape_for_display(file, 100) + "': " + data.error().message,
                              place(offset));
            return Ok{};
        }
        read.push_back(path);
        auto library = parse_mtl(*data, path, folder_of(path), options_);
        if (!library) return std::move(library).error();
        diagnostics_.append(library->diagnostics);
        for (MeshMaterial& material : library->materials) {
            std::string key = material.name;
            by_name_.emplace(std::move(key), std::move(material));
        }
        return Ok{};
    }

    std::string_view text_;
    const std::string& name_;
    const std::string& folder_;
    const LoadOptions& options_;
    Diagnostics& diagnostics_;
    std::map<std::string, MeshMaterial, std::less<>> by_name_;
    std::set<std::string> seen_;
    size_t undefined_ = 0;
};

/// The line of the position with this number, from 0.
SourceLocation place_of_vertex(std::string_view text, const std::string& name, uint64_t number) {
    SourceLocation out{name, 0, 0, {}};
    uint32_t line = 1;
    for (size_t at = 0; at < text.size(); ++line) {
        const size_t word = std::min(text.find_first_not_of(" \t", at), text.size());
        const std::string_view record = text.substr(word, 2);
        if ((record == "v " || record == "v\t") && number-- == 0) return {name, line, 0, {}};
        const size_t end = text.find('\n', word);
        at = end == text.npos ? text.size() : end + 1;
    }
    return out;
}

/// Lines of words of the text that come in its order, in one walk.
class LineCounter {
public:
    LineCounter(std::string_view text, const std::string& name) : text_(text), name_(name) {}

    /// The file alone for a word that is not part of the text or comes before an earlier one.
    SourceLocation place(std::string_view word) {
        const size_t to = word.empty() ? 0 : static_cast<size_t>(word.data() - text_.data());
        if (word.empty() || to < at_) return {name_, 0, 0, {}};
        line_ += static_cast<uint32_t>(
            std::count(text_.begin() + std::ptrdiff_t(at_), text_.begin() + std::ptrdiff_t(to), '\n'));
        at_ = to;
        return {name_, line_, 0, {}};
    }

private:
    std::string_view text_;
    const std::string& name_;
    size_t at_ = 0;
    uint32_t line_ = 1;
};

MeshFile read_obj(std::string_view text, const std::string& name, const std::string& folder, const LoadOptions& options,
                  std::optional<Error>& error) {
    const obj::Records records = obj::read_records(text);
    MeshFile file;
    for (const auto& note : records.notes.all())
        file.diagnostics.warn(describe(note.kind, note.word), text_location(text, name, note.offset), note.count);

    obj::BuildCounts counts;
    const std::vector<obj::FaceList> lists = obj::sort_faces(records, counts);
    Materials materials(text, name, folder, options, file.diagnostics);
    if (Status loaded = materials.load(records.libraries); !loaded) {
        error = std::move(loaded).error();
        return file;
    }
    std::vector<Mesh> meshes = obj::build_meshes(records, lists, counts);
    LineCounter lines(text, name);
    for (size_t i = 0; i < lists.size(); ++i) {
        const obj::FaceList& list = lists[i];
        const int material = list.has_material ? materials.find(list) : -1;
        file.parts.push_back(
            {std::move(meshes[i]), material, std::string(list.has_material ? list.material : list.group)});
        if (options.locations) file.parts.back().where = lines.place(list.has_material ? list.material : list.group);
    }
    file.materials = std::move(materials.used);
    file.libraries = std::move(materials.read);
    note_dropped(file,
                 counts.not_finite ? place_of_vertex(text, name, uint64_t(counts.first_not_finite)) : SourceLocation{},
                 counts.not_finite);
    if (counts.fans)
        file.diagnostics.warn("polygons that cross themselves were cut into triangles as fans", {name, 0, 0, {}},
                              counts.fans);
    return file;
}

}  // namespace

Result<MeshFile> parse_obj(std::string_view text, const std::string& name, const std::string& folder,
                           const LoadOptions& options) {
    try {
        std::optional<Error> error;
        MeshFile file = read_obj(text, name, folder, options, error);
        if (error) return std::move(*error);
        return file;
    } catch (const ParseFailure& failure) {
        return text_error(text, name, failure);
    } catch (const std::bad_alloc&) {
        return out_of_memory(name);
    }
}

}  // namespace steradian
