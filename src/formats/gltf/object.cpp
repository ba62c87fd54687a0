#include "formats/gltf/object.h"

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

void check_asset(const Object& root) {
    const Object asset(root.source(), root.require("asset"), "'asset'");
    asset.require("version");
    const std::string_view version = asset.string_or("version", "");
    const auto number = [&](std::string_view key) {
        const std::string_view text = asset.string_or(key, "2.0");
        const size_t dot = text.find('.');
        const auto value = parse_double(text);
        if (!value || dot == text.npos || dot == 0 || dot + 1 == text.size())
            asset.source().fail(asset.offset_of(key), quoted(key) + " is \"" + escape_for_display(text, 40) +
                                                          "\", expected two numbers such as \"2.0\"");
        return *value;
    };
    // Files of a newer 2.x are read as far as they are known.
    if (const double v = number("version"); !(v >= 2 && v < 3))
        asset.source().fail(asset.offset_of("version"),
                            "this is glTF " + escape_for_display(version, 40) + ", expected 2.0",
                            "older files can be converted with gltf-pipeline");
    if (number("minVersion") > number("version"))
        asset.source().fail(asset.offset_of("minVersion"), "'minVersion' is beyond 'version'");
}

}  // namespace steradian::gltf
