// The values after the header of a PLY file, one after the other.
#pragma once

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "formats/mesh/parse_failure.h"
#include "formats/ply/header.h"

namespace steradian::ply {

/// Thrown where the data end too early; the reader knows of what.
struct Truncated {};

/// Values written as bytes, each one exact as a double.
template <bool big_endian>
class BinarySource {
public:
    BinarySource(std::string_view data, size_t begin) : data_(data), at_(begin) {}

    size_t position() const { return at_; }
    /// The most values of `bytes` each that can still follow.
    uint64_t room(size_t bytes) const { return (data_.size() - at_) / bytes; }
    double number(Scalar type) {
        switch (type) {
            case Scalar::i8:
                return take<int8_t, uint8_t>();
            case Scalar::u8:
                return take<uint8_t, uint8_t>();
            case Scalar::i16:
                return take<int16_t, uint16_t>();
            case Scalar::u16:
                return take<uint16_t, uint16_t>();
            case Scalar::i32:
                return take<int32_t, uint32_t>();
            case Scalar::u32:
                return take<uint32_t, uint32_t>();
            case Scalar::f32:
                return static_cast<double>(take<float, uint32_t>());
            case Scalar::f64:
                return take<double, uint64_t>();
        }
        return 0;
    }
    void skip(Scalar type, uint64_t count) {
        if (count > room(size_of(type))) throw Truncated{};
        at_ += static_cast<size_t>(count) * size_of(type);
    }
    /// Moves to the first byte that is left over, if any.
    bool at_end() const { return at_ == data_.size(); }

private:
    template <class Value, class Bits>
    Value take() {
        if (data_.size() - at_ < sizeof(Bits)) throw Truncated{};
        unsigned char bytes[sizeof(Bits)];
        std::memcpy(bytes, data_.data() + at_, sizeof(Bits));
        at_ += sizeof(Bits);
        Bits bits = 0;
        for (size_t i = 0; i < sizeof(Bits); ++i)
            bits =
                static_cast<Bits>(bits | static_cast<Bits>(bytes[i]) << (8 * (big_endian ? sizeof(Bits) - 1 - i : i)));
        return std::bit_cast<Value>(bits);
    }

    std::string_view data_;
    size_t at_;
};

/// Values written as words. Line ends count as any other white space.
class AsciiSource {
public:
    AsciiSource(std::string_view data, size_t begin) : data_(data), at_(begin) {}

    size_t position() {
        skip_space();
        return at_;
    }
    uint64_t room(size_t) const { return (data_.size() - at_ + 1) / 2; }
    double number(Scalar type);
    void skip(Scalar, uint64_t count) {
        for (; count > 0; --count) word();
    }
    bool at_end() {
        skip_space();
        return at_ == data_.size();
    }

private:
    static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
    void skip_space() {
        while (at_ < data_.size() && is_space(data_[at_])) ++at_;
    }
    std::string_view word() {
        skip_space();
        if (at_ == data_.size()) throw Truncated{};
        const size_t begin = at_;
        while (at_ < data_.size() && !is_space(data_[at_])) ++at_;
        return data_.substr(begin, at_ - begin);
    }

    std::string_view data_;
    size_t at_;
};

}  // namespace steradian::ply
