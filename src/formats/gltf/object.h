// Lenient access to the objects of a glTF file: keys that nobody knows may stand there, values of the wrong type may
// not.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/json/reader.h"

namespace steradian::gltf {

using json::Kind;
using json::quoted;
using json::Range;
using json::Source;
using json::Value;

/// One of the arrays at the top of the file whose elements others refer to by number.
struct Table {
    std::string_view key;   ///< "bufferViews"
    std::string_view what;  ///< of one element, for messages: "buffer view"
    std::vector<Value> elements = {};
};

/// Cheap to copy; valid as long as the document.
class Object {
public:
    /// Fails unless the value is an object. `what` must outlive this.
    Object(const Source& source, Value value, std::string_view what);

    const Source& source() const noexcept { return *source_; }
    Value value() const noexcept { return value_; }
    size_t offset() const noexcept { return value_.offset(); }

    std::optional<Value> find(std::string_view key) const;
    bool has(std::string_view key) const { return find(key).has_value(); }
    /// Where a key's value stands, or this object where it has none: for messages.
    size_t offset_of(std::string_view key) const;
    Value require(std::string_view key) const;

    std::optional<Object> object(std::string_view key) const;
    /// Of "extensions".
    std::optional<Object> extension(std::string_view name) const;
    /// The elements of an array, which may be missing.
    std::vector<Value> array(std::string_view key) const;

    double number_or(std::string_view key, double fallback, Range range) const;
    double number(std::string_view key, Range range) const;
    uint64_t integer_or(std::string_view key, uint64_t fallback, uint64_t min, uint64_t max) const;
    bool boolean_or(std::string_view key, bool fallback) const;
    std::string_view string_or(std::string_view key, std::string_view fallback) const;
    /// Exactly `count` numbers; nothing where the key is missing.
    std::optional<std::vector<double>> numbers(std::string_view key, size_t count, Range range) const;
    Vec2 vec2_or(std::string_view key, Vec2 fallback, Range range) const;
    Vec3 vec3_or(std::string_view key, Vec3 fallback, Range range) const;
    Rgb color_or(std::string_view key, Rgb fallback, Range range) const;

    /// The number of an element of a table; fails where there is no such element.
    std::optional<uint32_t> reference(std::string_view key, const Table& table) const;
    uint32_t require_reference(std::string_view key, const Table& table) const;

private:
    const Source* source_;
    Value value_;
    std::string_view what_;
};

/// The same for a number by itself, such as an element of an array.
uint32_t read_reference(const Source& source, Value value, std::string_view what, const Table& table);

/// Fails with what is expected unless the file has its "asset" and is glTF 2.
void check_asset(const Object& root);

}  // namespace steradian::gltf
