#include "formats/gltf/meshopt.h"

#include <meshoptimizer.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "math/vector.h"

namespace steradian::gltf::meshopt {
namespace {

constexpr uint64_t kMaxCount = 0xffffffffu;

template <class T>
T load(const std::byte* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
}
template <class T>
void store(std::byte* at, T value) {
    std::memcpy(at, &value, sizeof value);
}

/// To the nearest of the whole numbers that T has, half away from zero. NaN becomes 0.
template <class T>
T rounded(double x) {
    constexpr double kMost = sizeof(T) == 1 ? 127 : 32767;
    if (!(x >= -kMost)) return x < 0 ? static_cast<T>(-kMost) : T(0);
    return static_cast<T>(min_of(x, kMost) + (x < 0 ? -0.5 : 0.5));
}

/// A unit vector on the octahedron |x| + |y| + |z| = 1: two coordinates, and what stands for 1. The fourth stays.
template <class T>
void undo_octahedral(std::byte* at) {
    const double one = load<T>(at + 2 * sizeof(T));
    double x = load<T>(at) / one, y = load<T>(at + sizeof(T)) / one;
    const double z = 1 - std::fabs(x) - std::fabs(y), fold = max_of(-z, 0.0);
    x += x >= 0 ? -fold : fold;
    y += y >= 0 ? -fold : fold;
    const double scale = (sizeof(T) == 1 ? 127 : 32767) / std::sqrt(x * x + y * y + z * z);
    store(at, rounded<T>(x * scale));
    store(at + sizeof(T), rounded<T>(y * scale));
    store(at + 2 * sizeof(T), rounded<T>(z * scale));
}

/// A unit quaternion without its largest component: three others, and in the last one the place of the missing and what
/// stands for 1.
void undo_quaternion(std::byte* at) {
    const int last = load<int16_t>(at + 6);
    const double scale = std::sqrt(0.5) / (last | 3);
    std::array<double, 3> q{};
    double rest = 1;
    for (size_t i = 0; i < 3; ++i) {
        q[i] = load<int16_t>(at + 2 * i) * scale;
        rest -= q[i] * q[i];
    }
    const size_t missing = static_cast<size_t>(last & 3);
    store(at + 2 * missing, rounded<int16_t>(std::sqrt(max_of(rest, 0.0)) * 32767));
    for (size_t i = 0; i < 3; ++i) store(at + 2 * ((missing + 1 + i) % 4), rounded<int16_t>(q[i] * 32767));
}

/// A float as 24 bits of mantissa below 8 bits of exponent, both signed.
void undo_exponential(std::byte* at) {
    const auto bits = load<uint32_t>(at);
    const int32_t exponent = static_cast<int32_t>(bits) >> 24, mantissa = static_cast<int32_t>(bits << 8) >> 8;
    const double power = std::bit_cast<double>(static_cast<uint64_t>(1023 + exponent) << 52);
    constexpr double kMost = std::numeric_limits<float>::max();
    store(at, static_cast<float>(clamp_to(mantissa * power, -kMost, kMost)));
}

}  // namespace

Header read_header(const Object& extension) {
    const Source& source = extension.source();
    constexpr std::array<std::string_view, 3> kModes{"ATTRIBUTES", "TRIANGLES", "INDICES"};
    constexpr std::array<std::string_view, 4> kFilters{"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
    Header out;
    out.mode = static_cast<Mode>(json::read_choice(source, extension.require("mode"), "'mode'", kModes));
    if (const auto filter = extension.find("filter"))
        out.filter = static_cast<Filter>(json::read_choice(source, *filter, "'filter'", kFilters));
    out.count = json::read_integer(source, extension.require("count"), "'count'", 1, kMaxCount);
    out.stride = json::read_integer(source, extension.require("byteStride"), "'byteStride'", 1, 256);
    const auto check = [&](bool good, std::string_view key, const std::string& expected) {
        if (!good) source.fail(extension.offset_of(key), quoted(key) + " must be " + expected + " here");
    };
    if (out.mode == Mode::attributes)
        check(out.stride % 4 == 0, "byteStride", "a multiple of 4");
    else
        check(out.stride == 2 || out.stride == 4, "byteStride", "2 or 4");
    if (out.mode == Mode::triangles) check(out.count % 3 == 0, "count", "a multiple of 3");
    if (out.mode != Mode::attributes) check(out.filter == Filter::none, "filter", "NONE");
    if (out.filter == Filter::octahedral) check(out.stride == 4 || out.stride == 8, "byteStride", "4 or 8");
    if (out.filter == Filter::quaternion) check(out.stride == 8, "byteStride", "8");
    return out;
}

std::optional<std::string> decode(const Header& h, std::span<const std::byte> compressed) {
    std::string out(h.bytes(), '\0');
    const auto* from = reinterpret_cast<const unsigned char*>(compressed.data());
    const size_t size = compressed.size();
    const int fault = h.mode == Mode::attributes ? meshopt_decodeVertexBuffer(out.data(), h.count, h.stride, from, size)
                      : h.mode == Mode::triangles
                          ? meshopt_decodeIndexBuffer(out.data(), h.count, h.stride, from, size)
                          : meshopt_decodeIndexSequence(out.data(), h.count, h.stride, from, size);
    if (fault != 0) return std::nullopt;
    undo_filter(h.filter, h.stride, std::as_writable_bytes(std::span(out)));
    return out;
}

void undo_filter(Filter filter, uint64_t stride, std::span<std::byte> data) {
    std::byte* const end = data.data() + data.size();
    switch (filter) {
        case Filter::none:
            return;
        case Filter::octahedral:
            for (std::byte* at = data.data(); at != end; at += stride)
                stride == 4 ? undo_octahedral<int8_t>(at) : undo_octahedral<int16_t>(at);
            return;
        case Filter::quaternion:
            for (std::byte* at = data.data(); at != end; at += stride) undo_quaternion(at);
            return;
        case Filter::exponential:
            for (std::byte* at = data.data(); at != end; at += 4) undo_exponential(at);
            return;
    }
}

}  // namespace steradian::gltf::meshopt
