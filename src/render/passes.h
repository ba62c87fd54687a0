// Who works on what: numbered units, pass by pass. The next pass is decided when all units of the one before have
// ended.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>

namespace steradian {

class Passes {
public:
    /// `begin` decides on the next pass and returns how many units it has; 0 when there is no more to do. It is called
    /// by one thread at a time, and no unit is under way meanwhile.
    Passes(std::function<uint64_t()> begin, const std::atomic<bool>& cancelled)
        : begin_(std::move(begin)), cancelled_(cancelled) {}

    /// A unit under way; it has ended when this is destroyed.
    class Unit {
    public:
        Unit(Passes& passes, uint64_t number) noexcept : passes_(passes), number_(number) {}
        Unit(const Unit&) = delete;
        Unit& operator=(const Unit&) = delete;
        ~Unit() { passes_.end_unit(); }
        uint64_t number() const noexcept { return number_; }

    private:
        Passes& passes_;
        uint64_t number_;
    };

    /// Calls work(number of the unit) for one unit after the other, from any number of threads, until there are no
    /// more, the job is cancelled or `work` returns false. Waits where a pass has to end first.
    template <class Work>
    void run(Work work) {
        while (const std::optional<uint64_t> number = next()) {
            const Unit unit(*this, *number);
            if (!work(unit.number())) break;
        }
    }

    /// Decides on the first pass; returns how many units it has.
    uint64_t begin_first();
    /// There was no more to do, and nothing is under way.
    bool ended() const noexcept { return ended_; }

private:
    std::optional<uint64_t> next();
    void end_unit() noexcept;

    const std::function<uint64_t()> begin_;
    const std::atomic<bool>& cancelled_;
    std::atomic<bool> ended_{false};
    std::mutex mutex_;  ///< guards what follows
    std::condition_variable pass_done_;
    uint64_t next_ = 0, units_ = 0, under_way_ = 0;
};

}  // namespace steradian
