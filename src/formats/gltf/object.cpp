#include "formats/gltf/object.h"

#include <charconv>
#include <compare>

#include "base/text.h"

namespace steradian::gltf {

Object::Object(const Source& source, Value value, std::string_view what)
    : source_(&source), value_(value), what_(what) {
    if (!value.is(Kind::object))
        source.fail(value.offset(), std::string(what) + " must be an object, got " + json::describe(value));
}

std::optional<Value> Object::find(std::string_view key) const {
    for (const json::Member member : value_.members()) {
        source_->count_lookup_step();
        if (member.key == key) return member.value;
    }
    return std::nullopt;
}

size_t Object::offset_of(std::string_view key) const {
    const auto value = find(key);
    return value ? value->offset() : offset();
}

Value Object::require(std::string_view key) const {
    if (const auto value = find(key)) return *value;
    source_->fail(offset(), "missing key " + quoted(key) + " in " + std::string(what_));
}

std::optional<Object> Object::object(std::string_view key) const {
    const auto value = find(key);
    if (!value) return std::nullopt;
    return Object(*source_, *value, key);
}

std::optional<Object> Object::extension(std::string_view name) const {
    const auto all = object("extensions");
    return all ? all->object(name) : std::nullopt;
}

std::vector<Value> Object::array(std::string_view key) const {
    const auto value = find(key);
    if (!value) return {};
    json::expect_array(*source_, *value, quoted(key));
    std::vector<Value> out;
    out.reserve(value->size());
    for (const Value element : value->elements()) out.push_back(element);
    return out;
}

double Object::number_or(std::string_view key, double fallback, Range range) const {
    const auto value = find(key);
    return value ? json::read_double(*source_, *value, quoted(key), range) : fallback;
}

double Object::number(std::string_view key, Range range) const {
    return json::read_double(*source_, require(key), quoted(key), range);
}

uint64_t Object::integer_or(std::string_view key, uint64_t fallback, uint64_t min, uint64_t max) const {
    const auto value = find(key);
    return value ? json::read_integer(*source_, *value, quoted(key), min, max) : fallback;
}

bool Object::boolean_or(std::string_view key, bool fallback) const {
    const auto value = find(key);
    if (!value) return fallback;
    if (!value->is(Kind::boolean))
        source_->fail(value->offset(), quoted(key) + " must be true or false, got " + json::describe(*value));
    return value->boolean();
}

std::string_view Object::string_or(std::string_view key, std::string_view fallback) const {
    const auto value = find(key);
    return value ? json::read_string(*source_, *value, quoted(key)) : fallback;
}

std::optional<std::vector<double>> Object::numbers(std::string_view key, size_t count, Range range) const {
    const auto value = find(key);
    if (!value) return std::nullopt;
    json::expect_array(*source_, *value, quoted(key), std::span(&count, 1));
    std::vector<double> out;
    for (const Value element : value->elements())
        out.push_back(json::read_double(*source_, element, quoted(key), range));
    return out;
}

Vec2 Object::vec2_or(std::string_view key, Vec2 fallback, Range range) const {
    const auto v = numbers(key, 2, range);
    return v ? Vec2{static_cast<float>((*v)[0]), static_cast<float>((*v)[1])} : fallback;
}

Vec3 Object::vec3_or(std::string_view key, Vec3 fallback, Range range) const {
    const auto v = numbers(key, 3, range);
    if (!v) return fallback;
    return {static_cast<float>((*v)[0]), static_cast<float>((*v)[1]), static_cast<float>((*v)[2])};
}

Rgb Object::color_or(std::string_view key, Rgb fallback, Range range) const {
    const Vec3 v = vec3_or(key, {fallback.r, fallback.g, fallback.b}, range);
    return {v.x, v.y, v.z};
}

uint32_t read_reference(const Source& source, Value value, std::string_view what, const Table& table) {
    constexpr uint64_t kLargest = 0xfffffffeu;
    const uint64_t number = json::read_integer(source, value, quoted(what), 0, kLargest);
    if (number >= table.elements.size())
        source.fail(value.offset(), quoted(what) + " refers to " + std::string(table.what) + " " +
                                        std::to_string(number) + ", but the file has " +
                                        std::to_string(table.elements.size()) + " of them, counted from 0");
    return static_cast<uint32_t>(number);
}

std::optional<uint32_t> Object::reference(std::string_view key, const Table& table) const {
    const auto value = find(key);
    if (!value) return std::nullopt;
    return read_reference(*source_, *value, key, table);
}

uint32_t Object::require_reference(std::string_view key, const Table& table) const {
    return read_reference(*source_, require(key), key, table);
}

namespace {

/// "2.0": two whole numbers, compared one after the other.
struct Version {
    uint32_t major = 0, minor = 0;
    auto operator<=>(const Version&) const = default;
};
constexpr Version kOurs{2, 0};

Version read_version(const Object& asset, std::string_view key) {
    const std::string_view text = json::read_string(asset.source(), asset.require(key), quoted(key));
    const char* const end = text.data() + text.size();
    Version out;
    const auto major = std::from_chars(text.data(), end, out.major);
    if (major.ec == std::errc() && major.ptr != end && *major.ptr == '.') {
        const auto minor = std::from_chars(major.ptr + 1, end, out.minor);
        if (minor.ec == std::errc() && minor.ptr == end) return out;
    }
    asset.source().fail(asset.offset_of(key), quoted(key) + " is \"" + escape_for_display(text, 40) +
                                                  "\", expected two numbers such as \"2.0\"");
}

}  // namespace

/// Section 3.2 of the specification: what a file says is needed to read it decides, and where it does not say, the
/// major number of its version. Files of a newer 2.x are read as far as they are known.
void check_asset(const Object& root) {
    const Object asset(root.source(), root.require("asset"), "'asset'");
    const auto refuse = [&](std::string_view key, const std::string& message, const std::string& hint = {}) {
        asset.source().fail(asset.offset_of(key), message, hint);
    };
    const auto text = [&](std::string_view key) { return escape_for_display(asset.string_or(key, ""), 40); };
    const Version version = read_version(asset, "version");
    if (asset.has("minVersion")) {
        const Version needed = read_version(asset, "minVersion");
        if (needed > version) refuse("minVersion", "'minVersion' is beyond 'version'");
        if (needed > kOurs) refuse("minVersion", "to read this takes glTF " + text("minVersion") + ", expected 2.0");
        if (needed.major == kOurs.major) return;
    }
    if (version.major != kOurs.major)
        refuse("version", "this is glTF " + text("version") + ", expected 2.0",
               version < kOurs ? "older files can be converted with gltf-pipeline" : "");
}

}  // namespace steradian::gltf
