#include "base/parallel.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>

namespace steradian {

uint32_t hardware_threads() noexcept { return static_cast<uint32_t>(std::max(1, tbb::info::default_concurrency())); }

void with_threads(uint32_t threads, const std::function<void()>& body) {
    tbb::task_arena arena(threads ? static_cast<int>(threads) : tbb::task_arena::automatic);
    arena.execute([&] {
        const FloatMode mode;
        body();
    });
}

void parallel_for(size_t count, size_t grain, const std::function<void(size_t, size_t)>& body) {
    grain = std::max<size_t>(grain, 1);
    const size_t chunks = count / grain + (count % grain != 0);
    tbb::parallel_for(size_t(0), chunks, [&](size_t chunk) {
        const FloatMode mode;
        const size_t begin = chunk * grain;
        body(begin, std::min(count, begin + grain));
    });
}

void parallel_invoke(const std::function<void()>& a, const std::function<void()>& b) {
    const auto task = [](const std::function<void()>& f) {
        return [&f] {
            const FloatMode mode;
            f();
        };
    };
    tbb::parallel_invoke(task(a), task(b));
}

ThreadLimit::ThreadLimit(uint32_t threads)
    : control_(new tbb::global_control(tbb::global_control::max_allowed_parallelism, std::max<size_t>(1, threads))) {}
ThreadLimit::~ThreadLimit() { delete static_cast<tbb::global_control*>(control_); }

}  // namespace steradian
