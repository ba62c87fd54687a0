// The kernels against each other and against brute force, on scenes that random bytes make.
#include <gtest/gtest.h>

#include "hostile.h"
#include "support/support.h"

namespace steradian::test {
namespace {

std::vector<uint8_t> random_bytes(uint64_t seed) {
    Random random(seed);
    std::vector<uint8_t> bytes(40 + random.below(1500));
    for (uint8_t& b : bytes) b = static_cast<uint8_t>(random.bits() >> 56);
    return bytes;
}

TEST(Hostile, EveryKernelGivesTheDefinedAnswer) {
    HostileCounts counts;
    for (uint64_t seed = 0; seed < by_tier<uint64_t>(600, 60'000); ++seed)
        ASSERT_EQ(check_hostile_case(hostile_case(random_bytes(seed)), counts), "") << "seed " << seed;
    std::printf(
        "%zu cases, %zu refused; %zu rays, %zu of them hit, %zu with two hits at one t, %zu only of "
        "cut-outs; %zu hierarchies with opened instances\n",
        counts.cases, counts.refused, counts.rays, counts.hits, counts.ties, counts.cut_outs, counts.opened);
    // The cases say something.
    EXPECT_LT(counts.refused, counts.cases / 3);
    EXPECT_GT(counts.hits, counts.rays / 5);
    EXPECT_GT(counts.ties, counts.rays / 50);
    EXPECT_GT(counts.cut_outs, counts.rays / 50);
    EXPECT_GT(counts.opened, counts.cases);
}

/// No bytes at all, one, the same one many times.
TEST(Hostile, AnyBytesAreACase) {
    HostileCounts counts;
    ASSERT_EQ(check_hostile_case(hostile_case({}), counts), "");
    for (int byte = 0; byte < 256; ++byte)
        for (const size_t size : {1u, 3u, 200u}) {
            const std::vector<uint8_t> bytes(size, static_cast<uint8_t>(byte));
            ASSERT_EQ(check_hostile_case(hostile_case(bytes), counts), "") << size << " times " << byte;
        }
}

}  // namespace
}  // namespace steradian::test
