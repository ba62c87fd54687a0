// Typed access to a JSON tree: what is missing, misspelt, of the wrong type or out of range is an error that points at
// its place. Inside this folder and scene_json errors travel as ReadFailure; the loader's entry point turns them into
// a Result.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/json/document.h"
#include "steradian/vec.h"

namespace steradian::json {

struct ReadFailure {
    Error error;
};

/// The text behind a tree, for messages.
class Source {
public:
    Source(std::string_view text, std::string name) : text_(text), name_(std::move(name)) {}
    /// With JSON pointers in all messages. `begin`: where in the file the text lies, if that is a binary one.
    Source(const Document& document, std::string name, std::optional<uint64_t> begin)
        : text_(document.text()), name_(std::move(name)), pointers_(&document), begin_(begin) {}

    const std::string& name() const noexcept { return name_; }
    /// Fast enough to be asked for every element of a large file.
    SourceLocation where(size_t offset) const;
    /// The same without a pointer, which takes long to find in a large file.
    SourceLocation place(size_t offset) const;
    [[noreturn]] void fail(size_t offset, std::string message, std::string hint = {},
                           ErrorCode code = ErrorCode::bad_input) const;
    /// Passes the value on; an error about a file as a whole ("no such file") is moved to the place that named the
    /// file, one from inside a file keeps its place and gets a hint that says who named it.
    template <class T>
    T take(Result<T> result, size_t offset) const {
        if (!result) fail(std::move(result).error(), offset);
        return std::move(result).value();
    }

    /// Members that lookups have passed, by readers that count: what a file costs, told without a clock.
    uint64_t lookup_steps() const noexcept { return lookup_steps_; }
    void count_lookup_step() const noexcept { ++lookup_steps_; }

private:
    [[noreturn]] void fail(Error error, size_t offset) const;
    Error error(size_t offset, std::string message, std::string hint, ErrorCode code) const;

    std::string_view text_;
    std::string name_;
    const Document* pointers_ = nullptr;
    std::optional<uint64_t> begin_;
    mutable std::vector<size_t> line_starts_;  ///< filled on first use
    mutable uint64_t lookup_steps_ = 0;
};

/// Limits of a number; `open` ends are excluded themselves.
struct Range {
    double min, max;
    bool open_min = false, open_max = false;
};
inline constexpr double kMaxLength = 1e15;   ///< metres; the bound on coordinates, math/ray.h
inline constexpr double kMinLength = 1e-15;  ///< of what must not be zero, so that squares stay normal floats
inline constexpr Range kCoordinate{-kMaxLength, kMaxLength};
inline constexpr Range kLength{kMinLength, kMaxLength};
inline constexpr Range kEnergy{0, 1e30};      ///< radiance, intensity, flux, irradiance
inline constexpr Range kReflectance{0, 1e6};  ///< above 1 is a warning, not an error
inline constexpr Range kAnyAngle{-1e6, 1e6};  ///< degrees

/// The keys that an object of some kind may have. `name` is its definition in docs/scene.schema.json.
struct ObjectSpec {
    std::string_view name;
    std::span<const std::string_view> keys;
};

// Values by themselves. `what` names the value in messages: "'radius'".
float read_number(const Source& source, Value value, std::string_view what, Range range);
double read_double(const Source& source, Value value, std::string_view what, Range range);
uint64_t read_integer(const Source& source, Value value, std::string_view what, uint64_t min, uint64_t max);
std::string_view read_string(const Source& source, Value value, std::string_view what);
Vec3 read_vec3(const Source& source, Value value, std::string_view what, Range range);
/// A number (grey) or three.
Rgb read_color(const Source& source, Value value, std::string_view what, Range range);
/// Fails unless it is an array of one of `sizes`.
void expect_array(const Source& source, Value value, std::string_view what, std::span<const size_t> sizes = {});
/// The index of a string among `choices`.
size_t read_choice(const Source& source, Value value, std::string_view what, std::span<const std::string_view> choices);
/// "got the string "abc"", "got -1": for messages.
std::string describe(Value value);
/// "'key'", escaped.
std::string quoted(std::string_view key);

/// An object whose keys are known. Unknown ones are refused at once. Every key that is present must be asked for
/// before finish(): what nobody asked for has no effect here, and finish() says so.
class ObjectReader {
public:
    ObjectReader(const Source& source, Value value, const ObjectSpec& spec, std::string_view what);

    const Source& source() const noexcept { return *source_; }
    Value value() const noexcept { return value_; }
    size_t offset() const noexcept { return value_.offset(); }
    const std::string& what() const noexcept { return what_; }
    const ObjectSpec& spec() const noexcept { return *spec_; }

    std::optional<Value> find(std::string_view key);
    Value require(std::string_view key);
    /// Of the key itself, which must be present.
    size_t key_offset(std::string_view key) const;

    float number(std::string_view key, Range range) { return read_number(*source_, require(key), quoted(key), range); }
    float number_or(std::string_view key, float fallback, Range range);
    uint64_t integer_or(std::string_view key, uint64_t fallback, uint64_t min, uint64_t max);
    bool boolean_or(std::string_view key, bool fallback);
    std::string_view string(std::string_view key) { return read_string(*source_, require(key), quoted(key)); }
    std::string_view string_or(std::string_view key, std::string_view fallback);
    size_t choice_or(std::string_view key, size_t fallback, std::span<const std::string_view> choices);
    Vec3 vec3(std::string_view key, Range range = kCoordinate) {
        return read_vec3(*source_, require(key), quoted(key), range);
    }
    Vec3 vec3_or(std::string_view key, Vec3 fallback, Range range = kCoordinate);
    /// One number for both, or two.
    Vec2 vec2_or(std::string_view key, Vec2 fallback, Range range);
    Rgb color(std::string_view key, Range range) { return read_color(*source_, require(key), quoted(key), range); }
    Rgb color_or(std::string_view key, Rgb fallback, Range range);

    void finish() const;

private:
    const Source* source_;
    Value value_;
    const ObjectSpec* spec_;
    std::string what_;
    struct Slot {
        Member member;
        bool asked = false;
    };
    std::vector<Slot> slots_;
};

}  // namespace steradian::json
