// XXH3-128, streaming; and MurmurHash3 for files that want it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace steradian {

/// Feed values in a fixed order; equal sequences give equal digests on every machine that stores numbers little-endian
/// (the only kind supported).
class Hasher {
public:
    Hasher();
    ~Hasher();
    Hasher(const Hasher&) = delete;
    Hasher& operator=(const Hasher&) = delete;

    void bytes(const void* data, size_t size);

    template <class T>
    requires std::is_arithmetic_v<T> || std::is_enum_v<T>
    void value(T v) { bytes(&v, sizeof v); }
    /// Length first, so that neighbouring strings cannot be confused.
    void text(std::string_view s) {
        value(uint64_t(s.size()));
        bytes(s.data(), s.size());
    }
    /// Elements must have no padding.
    template <class T>
    requires(std::has_unique_object_representations_v<T> ||
             std::is_floating_point_v<T>) void array(std::span<const T> s) {
        value(uint64_t(s.size()));
        bytes(s.data(), s.size_bytes());
    }

    /// 32 hexadecimal digits, most significant first.
    std::string hex() const;

private:
    void* state_;
};

/// MurmurHash3_x86_32 (Appleby 2011), which Cryptomatte names things by.
uint32_t murmur_hash3(std::string_view bytes, uint32_t seed) noexcept;

}  // namespace steradian
