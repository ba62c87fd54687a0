#include "base/hash.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

namespace steradian {
namespace {

std::string hash_of(const std::string& bytes) {
    Hasher hasher;
    hasher.bytes(bytes.data(), bytes.size());
    return hasher.hex();
}

// Published digests of XXH3-128 with seed 0, in the canonical order.
TEST(Hasher, KnownDigests) {
    EXPECT_EQ(hash_of(""), "99aa06d3014798d86001c324468d497f");
    EXPECT_EQ(hash_of("a"), "a96faf705af16834e6c632b61e964e1f");
    EXPECT_EQ(hash_of("abc"), "06b05ab6733a618578af5f94892f3950");
}

TEST(Hasher, PiecesDoNotMatter) {
    std::string bytes;
    for (int i = 0; i < 5000; ++i) bytes += static_cast<char>(i * 37 + i / 251);
    const std::string whole = hash_of(bytes);
    for (const size_t piece : {1u, 7u, 64u, 255u, 1024u, 4999u}) {
        Hasher hasher;
        for (size_t i = 0; i < bytes.size(); i += piece) hasher.bytes(&bytes[i], std::min(piece, bytes.size() - i));
        EXPECT_EQ(hasher.hex(), whole) << piece;
    }
}

TEST(Hasher, ReadingTheDigestDoesNotDisturbIt) {
    Hasher hasher;
    hasher.text("first");
    (void)hasher.hex();
    hasher.text("second");
    Hasher other;
    other.text("first");
    other.text("second");
    EXPECT_EQ(hasher.hex(), other.hex());
}

TEST(Hasher, NeighbouringStringsAreKeptApart) {
    Hasher a, b;
    a.text("ab");
    a.text("c");
    b.text("a");
    b.text("bc");
    EXPECT_NE(a.hex(), b.hex());
}

TEST(Hasher, ValuesAreTheirLittleEndianBytes) {
    Hasher a;
    a.value(uint32_t(0x64636261));
    a.array(std::span<const uint16_t>(std::vector<uint16_t>{0x6665}));
    EXPECT_EQ(a.hex(), hash_of(std::string("abcd\1\0\0\0\0\0\0\0ef", 14)));
}

}  // namespace
}  // namespace steradian
