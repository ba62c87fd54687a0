// What our own vocabulary and the course's have in common.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "formats/assets.h"
#include "formats/json/reader.h"
#include "formats/scene_json/keys.h"
#include "math/vector.h"

namespace steradian::scene_json {

using json::Kind;
using json::Member;
using json::ObjectReader;
using json::quoted;
using json::Range;
using json::Source;
using json::Value;

/// Everything that reading one scene needs at hand.
struct Context {
    const Source& source;
    LoadedScene& loaded;
    Assets& assets;

    void warn(std::string message, size_t offset) const {
        loaded.diagnostics.warn(std::move(message), source.where(offset));
    }
    void warn_about_reflectance(Rgb reflectance, size_t offset) const {
        steradian::warn_about_reflectance(loaded.diagnostics, reflectance, source.where(offset));
    }
};

/// The closest of the names, or all of them while they are few.
std::string name_hint(std::string_view name, std::span<const std::string_view> names);

/// Things that other parts of the file call by name.
template <class T>
class NameTable {
public:
    /// `what` for messages: "texture".
    explicit NameTable(std::string what) : what_(std::move(what)) {}

    void insert(std::string_view name, T value) { entries_.emplace(std::string(name), std::move(value)); }
    void replace(std::string_view name, T value) { entries_.find(name)->second = std::move(value); }
    bool contains(std::string_view name) const { return entries_.find(name) != entries_.end(); }
    /// Fails at `offset` when nothing has that name.
    const T& get(const Source& source, std::string_view name, size_t offset) const {
        const auto found = entries_.find(name);
        if (found != entries_.end()) return found->second;
        std::vector<std::string_view> names;
        for (const auto& [known, value] : entries_) names.push_back(known);
        std::string hint = names.empty() ? "the file defines no " + what_ : name_hint(name, names);
        source.fail(offset, "there is no " + what_ + " called " + quoted(name), std::move(hint));
    }

private:
    std::string what_;
    std::map<std::string, T, std::less<>> entries_;
};

/// The value of "type" as an index into `types`.
size_t read_type(const Source& source, Value object, std::string_view what, std::span<const std::string_view> types);

/// "resolution": [width, height].
void read_resolution(ObjectReader& film, RenderSettings& settings);
/// "filter": {"type", "radius"}.
Filter read_filter(const Source& source, Value value);

/// Fails at the keys that name them when the camera cannot see: position equal to look_at, up along the view.
void check_camera(ObjectReader& camera, Vec3 position, Vec3 look_at, Vec3 up, std::string_view up_key);

inline constexpr Range kFieldOfView{0, 180, true, true};
inline constexpr Range kEta{1e-3, 1e3};
inline constexpr double kInverseSphere = 0.0795774715459476678844;  ///< 1 / 4π

/// A list of steps, applied in the order of the list; an object with one or more steps, applied in the order in which
/// they stand in the file; or a matrix by itself. Fails where the result would be singular or beyond
/// kMaxTransform.
Affine read_transform(const Source& source, Value value);

/// A file that the scene names, and the place to blame for it.
struct NamedPath {
    std::string_view path;
    size_t offset;
};
NamedPath read_path(ObjectReader& reader);

void load_native(const Context& context, Value root);
void load_course(const Context& context, Value root);

}  // namespace steradian::scene_json
