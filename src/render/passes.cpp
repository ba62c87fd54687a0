#include "render/passes.h"

namespace steradian {

uint64_t Passes::begin_first() {
    const std::lock_guard lock(mutex_);
    units_ = begin_();
    ended_ = units_ == 0;
    return units_;
}

std::optional<uint64_t> Passes::next() {
    std::unique_lock lock(mutex_);
    while (!cancelled_ && !ended_) {
        if (next_ < units_) {
            ++under_way_;
            return next_++;
        }
        if (under_way_ > 0) {
            // Woken by the last unit's end, which a cancel brings about as well.
            pass_done_.wait(lock);
            continue;
        }
        next_ = 0;
        units_ = begin_();
        ended_ = units_ == 0;
        pass_done_.notify_all();
    }
    return std::nullopt;
}

void Passes::end_unit() noexcept {
    const std::lock_guard lock(mutex_);
    if (--under_way_ == 0) pass_done_.notify_all();
}

}  // namespace steradian
