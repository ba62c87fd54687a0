#include "formats/json/reader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "base/text.h"

namespace steradian::json {
namespace {

/// As short as a person would write it.
std::string number_text(double value) {
    std::array<char, 32> buffer;
    const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return error == std::errc() ? std::string(buffer.data(), end) : std::string();
}

std::string range_text(Range range) {
    const bool bounded_above = range.max < 1e30;
    if (range.min == 0 && !bounded_above) return range.open_min ? "greater than 0" : "0 or greater, at most 1e+30";
    std::string out = range.open_min ? "greater than " : "from ";
    out += number_text(range.min);
    if (range.open_min) return out + (range.open_max ? " and less than " : " and at most ") + number_text(range.max);
    return out + (range.open_max ? " to less than " : " to ") + number_text(range.max);
}

bool inside(double x, Range range) {
    if (!(x >= range.min && x <= range.max)) return false;
    return !(range.open_min && x == range.min) && !(range.open_max && x == range.max);
}

[[noreturn]] void wrong_type(const Source& source, Value value, std::string_view what, std::string_view expected) {
    source.fail(value.offset(), std::string(what) + " must be " + std::string(expected) + ", got " + describe(value));
}

}  // namespace

std::string quoted(std::string_view key) { return std::string("'").append(escape_for_display(key, 80)).append("'"); }

std::string describe(Value value) {
    switch (value.kind()) {
        case Kind::number:
            return escape_for_display(value.number_text(), 40);
        case Kind::string:
            return "the string \"" + escape_for_display(value.string(), 60) + "\"";
        case Kind::boolean:
            return value.boolean() ? "true" : "false";
        case Kind::array:
            return "an array of " + std::to_string(value.size());
        default:
            return std::string(kind_name(value.kind()));
    }
}

SourceLocation Source::where(size_t offset) const {
    SourceLocation out = place(offset);
    if (pointers_) out.pointer = pointers_->pointer(offset);
    return out;
}

SourceLocation Source::place(size_t offset) const {
    if (begin_) return {name_, 0, 0, *begin_ + offset, {}};
    if (line_starts_.empty()) {
        line_starts_.push_back(0);
        for (size_t i = 0; i < text_.size(); ++i) {
            const bool lone_cr = text_[i] == '\r' && (i + 1 == text_.size() || text_[i + 1] != '\n');
            if (text_[i] == '\n' || lone_cr) line_starts_.push_back(i + 1);
        }
    }
    const auto line = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset) - 1;
    return {name_,
            static_cast<uint32_t>(line - line_starts_.begin() + 1),
            static_cast<uint32_t>(offset - *line + 1),
            {},
            {}};
}

Error Source::error(size_t offset, std::string message, std::string hint, ErrorCode code) const {
    if (begin_) return {code, std::move(message), where(offset), {}, std::move(hint)};
    Error out = error_at(text_, name_, offset, std::move(message), std::move(hint), code);
    if (pointers_) out.where.pointer = pointers_->pointer(offset);
    return out;
}

void Source::fail(size_t offset, std::string message, std::string hint, ErrorCode code) const {
    throw ReadFailure{error(offset, std::move(message), std::move(hint), code)};
}

void Source::fail(Error error, size_t offset) const {
    const bool about_the_whole_file = error.where.line == 0 && !error.where.byte;
    if (!about_the_whole_file) {
        const std::string namer = "the file is named at " + where(offset).str();
        error.hint = error.hint.empty() ? namer : error.hint + "; " + namer;
        throw ReadFailure{std::move(error)};
    }
    std::string message =
        error.where.file.empty() ? error.message : escape_for_display(error.where.file, 200) + ": " + error.message;
    throw ReadFailure{this->error(offset, std::move(message), std::move(error.hint), error.code)};
}

double read_double(const Source& source, Value value, std::string_view what, Range range) {
    if (!value.is(Kind::number)) wrong_type(source, value, what, "a number");
    const double x = value.number();
    if (!inside(x, range)) wrong_type(source, value, what, range_text(range));
    return x;
}

float read_number(const Source& source, Value value, std::string_view what, Range range) {
    const auto x = static_cast<float>(read_double(source, value, what, range));
    // Rounding to float can reach an excluded end, or step just over an included one, which is meant.
    if ((range.open_min && x <= range.min) || (range.open_max && x >= range.max))
        wrong_type(source, value, what, range_text(range));
    return x;
}

uint64_t read_integer(const Source& source, Value value, std::string_view what, uint64_t min, uint64_t max) {
    const std::string expected = "a whole number from " + std::to_string(min) + " to " + std::to_string(max);
    if (!value.is(Kind::number)) wrong_type(source, value, what, expected);
    const std::string_view text = value.number_text();
    uint64_t x = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
    if (error != std::errc() || end != text.data() + text.size()) {
        // 1e3 and 64.0 are whole numbers too, as long as double holds them exactly; -0 is 0.
        const double d = value.number();
        if (!(d >= 0 && d <= 9007199254740992.0) || d != std::floor(d)) wrong_type(source, value, what, expected);
        x = static_cast<uint64_t>(d);
    }
    if (x < min || x > max) wrong_type(source, value, what, expected);
    return x;
}

std::string_view read_string(const Source& source, Value value, std::string_view what) {
    if (!value.is(Kind::string)) wrong_type(source, value, what, "a string");
    return value.string();
}

void expect_array(const Source& source, Value value, std::string_view what, std::span<const size_t> sizes) {
    std::string expected = "an array";
    for (size_t i = 0; i < sizes.size(); ++i) expected += (i ? " or " : " of ") + std::to_string(sizes[i]);
    if (!value.is(Kind::array)) wrong_type(source, value, what, expected);
    if (!sizes.empty() && std::find(sizes.begin(), sizes.end(), value.size()) == sizes.end())
        wrong_type(source, value, what, expected);
}

Vec3 read_vec3(const Source& source, Value value, std::string_view what, Range range) {
    if (!value.is(Kind::array) || value.size() != 3) wrong_type(source, value, what, "an array of 3 numbers");
    Vec3 v;
    int axis = 0;
    for (const Value element : value.elements()) v[axis++] = read_number(source, element, what, range);
    return v;
}

Rgb read_color(const Source& source, Value value, std::string_view what, Range range) {
    if (value.is(Kind::number)) {
        const float grey = read_number(source, value, what, range);
        return {grey, grey, grey};
    }
    if (!value.is(Kind::array) || value.size() != 3)
        wrong_type(source, value, what, "a number or an array of 3 numbers (red, green, blue)");
    const Vec3 v = read_vec3(source, value, what, range);
    return {v.x, v.y, v.z};
}

size_t read_choice(const Source& source, Value value, std::string_view what,
                   std::span<const std::string_view> choices) {
    const std::string_view word = read_string(source, value, what);
    const auto found = std::find(choices.begin(), choices.end(), word);
    if (found == choices.end())
        source.fail(value.offset(), std::string(what) + " cannot be \"" + escape_for_display(word, 60) + "\"",
                    suggestion(word, choices));
    return static_cast<size_t>(found - choices.begin());
}

ObjectReader::ObjectReader(const Source& source, Value value, const ObjectSpec& spec, std::string_view what)
    : source_(&source), value_(value), spec_(&spec), what_(what) {
    if (!value.is(Kind::object)) wrong_type(source, value, what, "an object");
    for (const Member member : value.members()) {
        if (std::find(spec.keys.begin(), spec.keys.end(), member.key) == spec.keys.end())
            source.fail(member.key_offset, "unknown key " + quoted(member.key) + " in " + what_,
                        suggestion(member.key, spec.keys));
        slots_.push_back({member, false});
    }
}

std::optional<Value> ObjectReader::find(std::string_view key) {
    for (Slot& slot : slots_) {
        if (slot.member.key != key) continue;
        slot.asked = true;
        return slot.member.value;
    }
    return std::nullopt;
}

Value ObjectReader::require(std::string_view key) {
    if (const auto value = find(key)) return *value;
    source_->fail(offset(), "missing key " + quoted(key) + " in " + what_);
}

size_t ObjectReader::key_offset(std::string_view key) const {
    const auto slot = std::find_if(slots_.begin(), slots_.end(), [&](const Slot& s) { return s.member.key == key; });
    return slot == slots_.end() ? offset() : slot->member.key_offset;
}

float ObjectReader::number_or(std::string_view key, float fallback, Range range) {
    const auto value = find(key);
    return value ? read_number(*source_, *value, quoted(key), range) : fallback;
}

uint64_t ObjectReader::integer_or(std::string_view key, uint64_t fallback, uint64_t min, uint64_t max) {
    const auto value = find(key);
    return value ? read_integer(*source_, *value, quoted(key), min, max) : fallback;
}

bool ObjectReader::boolean_or(std::string_view key, bool fallback) {
    const auto value = find(key);
    if (!value) return fallback;
    if (!value->is(Kind::boolean)) wrong_type(*source_, *value, quoted(key), "true or false");
    return value->boolean();
}

std::string_view ObjectReader::string_or(std::string_view key, std::string_view fallback) {
    const auto value = find(key);
    return value ? read_string(*source_, *value, quoted(key)) : fallback;
}

size_t ObjectReader::choice_or(std::string_view key, size_t fallback, std::span<const std::string_view> choices) {
    const auto value = find(key);
    return value ? read_choice(*source_, *value, quoted(key), choices) : fallback;
}

Vec3 ObjectReader::vec3_or(std::string_view key, Vec3 fallback, Range range) {
    const auto value = find(key);
    return value ? read_vec3(*source_, *value, quoted(key), range) : fallback;
}

Vec2 ObjectReader::vec2_or(std::string_view key, Vec2 fallback, Range range) {
    const auto value = find(key);
    if (!value) return fallback;
    if (value->is(Kind::number)) {
        const float both = read_number(*source_, *value, quoted(key), range);
        return {both, both};
    }
    if (!value->is(Kind::array) || value->size() != 2)
        wrong_type(*source_, *value, quoted(key), "a number or an array of 2 numbers");
    auto element = value->elements().begin();
    Vec2 v;
    v.x = read_number(*source_, *element, quoted(key), range);
    v.y = read_number(*source_, *++element, quoted(key), range);
    return v;
}

Rgb ObjectReader::color_or(std::string_view key, Rgb fallback, Range range) {
    const auto value = find(key);
    return value ? read_color(*source_, *value, quoted(key), range) : fallback;
}

void ObjectReader::finish() const {
    for (const Slot& slot : slots_)
        if (!slot.asked)
            source_->fail(slot.member.key_offset, quoted(slot.member.key) + " has no effect in " + what_, "remove it");
}

}  // namespace steradian::json
