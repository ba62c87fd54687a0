// How a build gets on, and whether it is to go on.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <utility>

namespace steradian {

/// What a build says to its caller, and hears: how much is done, and that it is to stop, which is remembered. The
/// caller's functions are called from one thread at a time; a thread that finds another one asking, or that is asked
/// again from within such a function, goes on with what is known.
class BuildMonitor {
public:
    /// `work` is what will be announced in all; without functions nobody asks and nobody is told.
    explicit BuildMonitor(std::function<bool()> asked = {}, std::function<void(double)> told = {}, uint64_t work = 1)
        : asked_(std::move(asked)), told_(std::move(told)), work_(work) {}
    bool poll() {
        if (stop_.load(std::memory_order_relaxed)) return true;
        if (!asked_ && !told_) return false;
        // Not a mutex: one thread may get here twice, when the function waits for tasks that poll.
        if (asking_.exchange(true, std::memory_order_acquire)) return stop_.load(std::memory_order_relaxed);
        if (asked_ && asked_()) stop_.store(true, std::memory_order_relaxed);
        if (!stop_.load(std::memory_order_relaxed)) tell();
        asking_.store(false, std::memory_order_release);
        return stop_.load(std::memory_order_relaxed);
    }
    /// Of the work that was announced.
    void advance(uint64_t work) { done_.fetch_add(work, std::memory_order_relaxed); }

private:
    /// 1 is for the caller, when nothing can go wrong any more.
    void tell() {
        const double fraction = static_cast<double>(done_) / static_cast<double>(work_);
        if (!told_ || fraction <= last_ || fraction >= 1) return;
        last_ = fraction;
        told_(fraction);
    }

    const std::function<bool()> asked_;
    const std::function<void(double)> told_;
    const uint64_t work_;
    std::atomic<uint64_t> done_{0};
    double last_ = 0;  ///< of whoever is asking
    std::atomic<bool> asking_{false}, stop_{false};
};

}  // namespace steradian
