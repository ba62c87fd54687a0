#include "base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cfenv>
#include <chrono>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace steradian {
namespace {

TEST(ParallelFor, ChunksDependOnTheArgumentsOnly) {
    for (const auto& [count, grain] : {std::pair<size_t, size_t>{0, 4}, {1, 4}, {4, 4}, {5, 4}, {1000, 7}, {3, 0}}) {
        std::mutex mutex;
        std::set<std::pair<size_t, size_t>> chunks, expected;
        parallel_for(count, grain, [&](size_t begin, size_t end) {
            const std::lock_guard lock(mutex);
            EXPECT_TRUE(chunks.emplace(begin, end).second);
        });
        const size_t step = grain ? grain : 1;
        for (size_t begin = 0; begin < count; begin += step) expected.emplace(begin, std::min(count, begin + step));
        EXPECT_EQ(chunks, expected) << count << " by " << grain;
    }
}

TEST(ParallelFor, PassesExceptionsOn) {
    EXPECT_THROW(parallel_for(100, 1,
                              [](size_t begin, size_t) {
                                  if (begin == 50) throw std::runtime_error("x");
                              }),
                 std::runtime_error);
    EXPECT_THROW(with_threads(2, [] { throw std::runtime_error("x"); }), std::runtime_error);
}

TEST(ParallelInvoke, RunsBoth) {
    std::atomic<int> a = 0, b = 0;
    parallel_invoke([&] { ++a; }, [&] { ++b; });
    EXPECT_EQ(a, 1);
    EXPECT_EQ(b, 1);
}

/// How many threads are inside a parallel_for at the same time, once each has waited for `expected` of them.
int threads_together(uint32_t threads, int expected) {
    std::atomic<int> inside = 0, most = 0;
    with_threads(threads, [&] {
        parallel_for(static_cast<size_t>(expected) * 4, 1, [&](size_t, size_t) {
            const int now = ++inside;
            int seen = most;
            while (now > seen && !most.compare_exchange_weak(seen, now)) {
            }
            const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(5);
            while (most < expected && std::chrono::steady_clock::now() < until) std::this_thread::yield();
            --inside;
        });
    });
    return most;
}

// More than the cores of a small machine: it takes the limit and the arena together.
TEST(WithThreads, SevenTakePart) {
    const ThreadLimit limit(7);
    EXPECT_EQ(threads_together(7, 7), 7);
}

TEST(WithThreads, OneIsTheCaller) {
    const auto caller = std::this_thread::get_id();
    bool same = true;
    with_threads(
        1, [&] { parallel_for(100, 1, [&](size_t, size_t) { same = same && std::this_thread::get_id() == caller; }); });
    EXPECT_TRUE(same);
}

TEST(WithThreads, ZeroIsAllAndNestingWorks) {
    EXPECT_GE(hardware_threads(), 1u);
    std::atomic<int> sum = 0;
    with_threads(
        0, [&] { parallel_for(8, 1, [&](size_t, size_t) { parallel_for(8, 1, [&](size_t, size_t) { ++sum; }); }); });
    EXPECT_EQ(sum, 64);
}

/// Volatile, so that the compiler leaves the arithmetic to the machine's mode.
bool rounds_to_nearest() {
    volatile float one = 1, small = 0x1p-25f;
    return one + small == 1.0f && one - small == 1.0f;
}

#if defined(__x86_64__)
bool keeps_denormals() {
    volatile float tiny = 0x1p-126f, half = 0.5f, smallest = 0x1p-149f, many = 0x1p+23f;
    return tiny * half == 0x1p-127f && smallest * many == 0x1p-126f;
}

class HostMode : public testing::Test {
protected:
    HostMode() : saved_(_mm_getcsr()) {}
    ~HostMode() override { _mm_setcsr(saved_); }
    /// Flush to zero, denormals are zero, round up: what a host program may leave behind.
    static void spoil() { _mm_setcsr(0x1f80 | 0x8000 | 0x0040 | 0x4000); }

private:
    unsigned saved_;
};

TEST_F(HostMode, IsSetAndRestored) {
    spoil();
    const unsigned before = _mm_getcsr();
    ASSERT_FALSE(rounds_to_nearest());
    ASSERT_FALSE(keeps_denormals());
    {
        const FloatMode mode;
        EXPECT_TRUE(rounds_to_nearest());
        EXPECT_TRUE(keeps_denormals());
    }
    constexpr unsigned kStickyFlags = 0x3f;
    EXPECT_EQ(_mm_getcsr() & ~kStickyFlags, before & ~kStickyFlags);
}

TEST_F(HostMode, DoesNotReachTheTasks) {
    spoil();
    std::atomic<int> bad = 0;
    const auto check = [&] { bad += !rounds_to_nearest() || !keeps_denormals(); };
    parallel_for(100, 1, [&](size_t, size_t) { check(); });
    parallel_invoke(check, check);
    with_threads(2, check);
    EXPECT_EQ(bad, 0);
    EXPECT_FALSE(keeps_denormals()) << "the host's mode is its own again";
}
#endif

TEST(FloatMode, IsRoundToNearest) {
    const int before = std::fegetround();
    std::fesetround(FE_UPWARD);
    {
        const FloatMode mode;
        EXPECT_TRUE(rounds_to_nearest());
    }
    EXPECT_EQ(std::fegetround(), FE_UPWARD);
    std::fesetround(before);
}

}  // namespace
}  // namespace steradian
