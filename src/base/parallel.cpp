#include "base/parallel.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace steradian {
namespace {

#if defined(__x86_64__)
uint64_t read_mode() { return _mm_getcsr(); }
void write_mode(uint64_t mode) { _mm_setcsr(static_cast<unsigned>(mode)); }
constexpr uint64_t kMode = 0x1f80;  // all exceptions masked, round to nearest, no flush to zero, no denormals as zero
#elif defined(__aarch64__)
uint64_t read_mode() {
    uint64_t mode;
    asm volatile("mrs %0, fpcr" : "=r"(mode));
    return mode;
}
void write_mode(uint64_t mode) { asm volatile("msr fpcr, %0" : : "r"(mode)); }
constexpr uint64_t kMode = 0;
#else
#error "unsupported machine: x86-64 and aarch64 are"
#endif

/// The order that starting and joining tasks gives, made visible to the thread sanitizer: the packaged TBB is not built
/// with it, so what its scheduler guarantees would be reported as races. Chunks get no order among themselves, so a
/// race between two of them is still found.
class ForkJoin {
public:
    ForkJoin() noexcept { forked_.store(1, std::memory_order_release); }
    ~ForkJoin() { (void)joined_.load(std::memory_order_acquire); }
    ForkJoin(const ForkJoin&) = delete;
    ForkJoin& operator=(const ForkJoin&) = delete;

    void task_begins() noexcept { (void)forked_.load(std::memory_order_acquire); }
    void task_ends() noexcept { joined_.fetch_add(1, std::memory_order_release); }

private:
    std::atomic<uint32_t> forked_{0}, joined_{0};
};

/// What every task runs in.
class TaskScope {
public:
    explicit TaskScope(ForkJoin& order) noexcept : order_(order) { order_.task_begins(); }
    ~TaskScope() { order_.task_ends(); }
    TaskScope(const TaskScope&) = delete;
    TaskScope& operator=(const TaskScope&) = delete;

private:
    ForkJoin& order_;
    FloatMode mode_;
};

}  // namespace

FloatMode::FloatMode() noexcept : saved_(read_mode()) { write_mode(kMode); }
FloatMode::~FloatMode() { write_mode(saved_); }

uint32_t hardware_threads() noexcept { return static_cast<uint32_t>(std::max(1, tbb::info::default_concurrency())); }

void with_threads(uint32_t threads, const std::function<void()>& body) {
    tbb::task_arena arena(threads ? static_cast<int>(threads) : tbb::task_arena::automatic);
    ForkJoin order;
    arena.execute([&] {
        const TaskScope scope(order);
        body();
    });
}

void parallel_for(size_t count, size_t grain, const std::function<void(size_t, size_t)>& body) {
    grain = std::max<size_t>(grain, 1);
    const size_t chunks = count / grain + (count % grain != 0);
    ForkJoin order;
    tbb::parallel_for(size_t(0), chunks, [&](size_t chunk) {
        const TaskScope scope(order);
        const size_t begin = chunk * grain;
        body(begin, std::min(count, begin + grain));
    });
}

void parallel_invoke(const std::function<void()>& a, const std::function<void()>& b) {
    ForkJoin order;
    const auto task = [&order](const std::function<void()>& f) {
        return [&f, &order] {
            const TaskScope scope(order);
            f();
        };
    };
    tbb::parallel_invoke(task(a), task(b));
}

ThreadLimit::ThreadLimit(uint32_t threads)
    : control_(new tbb::global_control(tbb::global_control::max_allowed_parallelism, std::max<size_t>(1, threads))) {}
ThreadLimit::~ThreadLimit() { delete static_cast<tbb::global_control*>(control_); }

}  // namespace steradian
