// The workers: a thin layer over oneTBB, so that one place knows how threads are limited and what state they run in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

namespace steradian {

/// Round to nearest, denormals kept: the mode in which all arithmetic of the project is defined. Host programs change
/// it, so every task sets it for its own duration.
class FloatMode {
public:
    FloatMode() noexcept;
    ~FloatMode();
    FloatMode(const FloatMode&) = delete;
    FloatMode& operator=(const FloatMode&) = delete;

private:
    uint64_t saved_;
};

/// Hardware threads this process may use, at least 1.
uint32_t hardware_threads() noexcept;

/// Runs `body` so that parallel_for and parallel_invoke inside it use at most `threads` workers (0: all). The caller's
/// thread is one of them. Exceptions of `body` pass through. An application that wants more threads than the machine
/// has must hold a tbb::global_control, see ThreadLimit.
void with_threads(uint32_t threads, const std::function<void()>& body);

/// body(begin, end) over chunks of [0, count), each of `grain` indices except the last one: the chunks depend only on
/// the arguments, never on the number of threads.
void parallel_for(size_t count, size_t grain, const std::function<void(size_t, size_t)>& body);

void parallel_invoke(const std::function<void()>& a, const std::function<void()>& b);

/// Process-wide permission for n threads (TBB's own default is the number of cores); for applications, not for
/// libraries.
class ThreadLimit {
public:
    explicit ThreadLimit(uint32_t threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

private:
    void* control_;
};

}  // namespace steradian
