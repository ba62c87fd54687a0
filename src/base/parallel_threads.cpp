// The same calls on plain threads, for builds with the thread sanitizer: the packaged TBB is not instrumented, so what
// its scheduler orders would be reported as races. Here the sanitizer sees every start and join, and with them every
// race of ours. Correct, but without work stealing: not for use.
#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "base/parallel.h"

namespace steradian {
namespace {

constexpr uint32_t kMostThreads = 32;

std::atomic<uint32_t> g_running{0};
thread_local uint32_t t_threads = 0;  ///< of the innermost with_threads; 0: all

uint32_t limit() { return t_threads ? t_threads : hardware_threads(); }

/// The first exception of several tasks.
class Failure {
public:
    template <class Task>
    void guard(const Task& task) noexcept {
        const FloatMode mode;
        try {
            task();
        } catch (...) {
            const std::lock_guard lock(mutex_);
            if (!first_) first_ = std::current_exception();
        }
    }
    void rethrow() const {
        if (first_) std::rethrow_exception(first_);
    }

private:
    std::mutex mutex_;
    std::exception_ptr first_;
};

/// Runs `task` on `copies` threads, the caller's among them; fewer when many are running already.
template <class Task>
void fork_join(uint32_t copies, const Task& task) {
    Failure failure;
    std::vector<std::thread> threads;
    const uint32_t inherited = t_threads;
    for (uint32_t i = 1; i < copies && g_running < kMostThreads; ++i) {
        ++g_running;
        threads.emplace_back([&, inherited] {
            t_threads = inherited;
            failure.guard(task);
            --g_running;
        });
    }
    failure.guard(task);
    for (std::thread& thread : threads) thread.join();
    failure.rethrow();
}

}  // namespace

uint32_t hardware_threads() noexcept { return std::max(1u, std::thread::hardware_concurrency()); }

void with_threads(uint32_t threads, const std::function<void()>& body) {
    const uint32_t outer = t_threads;
    t_threads = threads;
    Failure failure;
    failure.guard(body);
    t_threads = outer;
    failure.rethrow();
}

void parallel_for(size_t count, size_t grain, const std::function<void(size_t, size_t)>& body) {
    grain = std::max<size_t>(grain, 1);
    const size_t chunks = count / grain + (count % grain != 0);
    std::atomic<size_t> next{0};
    fork_join(static_cast<uint32_t>(std::min<size_t>(limit(), chunks)), [&] {
        for (size_t chunk; (chunk = next.fetch_add(1)) < chunks;)
            body(chunk * grain, std::min(count, (chunk + 1) * grain));
    });
}

void parallel_invoke(const std::function<void()>& a, const std::function<void()>& b) {
    const std::function<void()>* tasks[] = {&a, &b};
    parallel_for(2, 1, [&](size_t i, size_t) { (*tasks[i])(); });
}

ThreadLimit::ThreadLimit(uint32_t) : control_(nullptr) {}
ThreadLimit::~ThreadLimit() = default;

}  // namespace steradian
