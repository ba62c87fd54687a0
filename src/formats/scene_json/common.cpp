#include "formats/scene_json/common.h"

#include <algorithm>

#include "base/names.h"
#include "base/text.h"

namespace steradian::scene_json {

std::string name_hint(std::string_view name, std::span<const std::string_view> names) {
    constexpr size_t kMostToList = 20;
    if (names.size() <= kMostToList) return suggestion(name, names);
    const auto match = closest_match(name, names);
    return match ? "did you mean '" + *match + "'?" : std::string();
}

size_t read_type(const Source& source, Value object, std::string_view what, std::span<const std::string_view> types) {
    if (!object.is(Kind::object))
        source.fail(object.offset(), std::string(what) + " must be an object, got " + json::describe(object));
    for (const Member member : object.members())
        if (member.key == "type")
            return json::read_choice(source, member.value, "the type of " + std::string(what), types);
    source.fail(object.offset(), "missing key 'type' in " + std::string(what), suggestion("", types));
}

void read_resolution(ObjectReader& film, RenderSettings& settings) {
    const auto value = film.find("resolution");
    if (!value) return;
    const Source& source = film.source();
    static constexpr size_t kTwo[] = {2};
    json::expect_array(source, *value, "'resolution'", kTwo);
    auto side = value->elements().begin();
    settings.width = static_cast<uint32_t>(json::read_integer(source, *side, "the width", 1, kMaxResolution));
    settings.height = static_cast<uint32_t>(json::read_integer(source, *++side, "the height", 1, kMaxResolution));
    if (uint64_t(settings.width) * settings.height > kMaxPixels)
        source.fail(value->offset(),
                    "the picture has more than the limit of " + std::to_string(kMaxPixels) + " pixels");
}

Filter read_filter(const Source& source, Value value) {
    static constexpr Range kRadius{kMinFilterRadius, kMaxFilterRadius};
    ObjectReader reader(source, value, kFilterSpec, "the filter");
    const auto kind = static_cast<FilterKind>(
        json::read_choice(source, reader.require("type"), "the type of the filter", names_of<FilterKind>()));
    const Filter filter{kind, reader.number_or("radius", default_filter_radius(kind), kRadius)};
    reader.finish();
    return filter;
}

void check_camera(ObjectReader& camera, Vec3 position, Vec3 look_at, Vec3 up_vector, std::string_view up_key) {
    const Source& source = camera.source();
    const Vec3d view = Vec3d(look_at) - Vec3d(position);
    const Vec3d up(up_vector);
    const size_t look_at_offset = camera.find("look_at") ? camera.find("look_at")->offset() : camera.offset();
    const size_t up_offset = camera.find(up_key) ? camera.find(up_key)->offset() : look_at_offset;
    if (!(length(view) > 0))
        source.fail(look_at_offset,
                    "the camera's 'look_at' is equal to its 'position': there is no direction to look in");
    if (!(length(up) > 0)) source.fail(up_offset, quoted(up_key) + " must not be the zero vector");
    if (!(length(cross(normalize(view), normalize(up))) > 1e-6))
        source.fail(up_offset, quoted(up_key) + " is parallel to the camera's view",
                    "choose another direction, such as [0, 0, 1] when looking straight down");
}

NamedPath read_path(ObjectReader& reader) {
    const Value value = reader.require("path");
    return {json::read_string(reader.source(), value, "'path'"), value.offset()};
}

}  // namespace steradian::scene_json
