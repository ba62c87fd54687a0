#include "base/hash.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>
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

// The values of the algorithm's author (SMHasher) as they are published with many implementations: all lengths of
// tails.
TEST(MurmurHash3, KnownValues) {
    const std::tuple<std::string_view, uint32_t, uint32_t> known[] = {
        {"", 0, 0},
        {"", 1, 0x514e28b7},
        {"", 0xffffffff, 0x81f16f39},
        {"\xff\xff\xff\xff", 0, 0x76293b50},
        {"\x21\x43\x65\x87", 0, 0xf55b516b},
        {"\x21\x43\x65\x87", 0x5082edee, 0x2362f9de},
        {"\x21\x43\x65", 0, 0x7e4a8634},
        {"\x21\x43", 0, 0xa0f7b07a},
        {"\x21", 0, 0x72661cf4},
        {"aaaa", 0x9747b28c, 0x5a97808a},
        {"aaa", 0x9747b28c, 0x283e0130},
        {"abc", 0, 0xb3dd93fa},
        {"Hello, world!", 0x9747b28c, 0x24884cba},
        {"The quick brown fox jumps over the lazy dog", 0x9747b28c, 0x2fa826cd}};
    for (const auto& [bytes, seed, hash] : known) EXPECT_EQ(murmur_hash3(bytes, seed), hash) << bytes;
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
