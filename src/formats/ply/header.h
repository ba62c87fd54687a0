// The header of a PLY file.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "formats/mesh/parse_failure.h"

namespace steradian::ply {

enum class Encoding : uint8_t { ascii, little_endian, big_endian };
enum class Scalar : uint8_t { i8, u8, i16, u16, i32, u32, f32, f64 };

inline size_t size_of(Scalar type) {
    constexpr std::array<uint8_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<size_t>(type)];
}
inline bool is_floating(Scalar type) { return type == Scalar::f32 || type == Scalar::f64; }

struct Property {
    std::string_view name;
    Scalar type = Scalar::f32;  ///< of the value, or of a list's items
    bool is_list = false;
    Scalar count_type = Scalar::u8;  ///< of a list's length
};

struct Element {
    std::string_view name;
    uint64_t count = 0;
    size_t offset = 0;  ///< of its name, for messages
    std::vector<Property> properties;

    bool has_lists() const;
    /// Bytes that one of them takes at least: exact in binary files when there are no lists.
    uint64_t least_bytes(Encoding encoding) const;
    /// Index of the property with one of these names, -1 when there is none.
    int find(std::initializer_list<std::string_view> names) const;
};

struct Header {
    Encoding encoding = Encoding::ascii;
    std::vector<Element> elements;
    size_t end_line = 0;  ///< byte of `end_header`, for messages
    size_t size = 0;      ///< of the header in bytes: where the data begin
};

/// Views point into `data`. Throws ParseFailure.
Header read_header(std::string_view data);

}  // namespace steradian::ply
