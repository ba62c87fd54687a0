// Equal corners of faces become one vertex, numbered in the order of their first use.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace steradian {

/// An open-addressing hash table from three numbers to a running number. It is never iterated, so that the numbering
/// depends on the order of calls only.
class CornerTable {
public:
    using Key = std::array<uint32_t, 3>;
    static constexpr uint32_t kMissing = 0xffffffff;

    explicit CornerTable(size_t expected = 0) {
        size_t slots = 16;
        while (slots < expected + expected / 2) slots *= 2;
        slots_.assign(slots, 0);
    }

    /// The key's number, and whether it is new. At most 2^32 - 2 keys: the caller checks.
    std::pair<uint32_t, bool> number_of(const Key& key) {
        if (4 * (keys_.size() + 1) > 3 * slots_.size()) grow();
        for (size_t slot = hash(key) & (slots_.size() - 1);; slot = (slot + 1) & (slots_.size() - 1)) {
            const uint32_t entry = slots_[slot];
            if (entry == 0) {
                keys_.push_back(key);
                slots_[slot] = static_cast<uint32_t>(keys_.size());
                return {slots_[slot] - 1, true};
            }
            if (keys_[entry - 1] == key) return {entry - 1, false};
        }
    }
    /// The number of a key that was given one; kMissing otherwise.
    uint32_t find(const Key& key) const {
        for (size_t slot = hash(key) & (slots_.size() - 1);; slot = (slot + 1) & (slots_.size() - 1)) {
            const uint32_t entry = slots_[slot];
            if (entry == 0) return kMissing;
            if (keys_[entry - 1] == key) return entry - 1;
        }
    }
    size_t size() const { return keys_.size(); }
    /// In order of their numbers.
    const std::vector<Key>& keys() const { return keys_; }

private:
    static uint64_t mix(uint64_t x) {  // the finaliser of SplitMix64 (Steele et al. 2014)
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
        return x ^ (x >> 31);
    }
    static uint64_t hash(const Key& key) {
        return mix(mix(uint64_t(key[0]) << 32 | key[1]) + 0x9e3779b97f4a7c15u + key[2]);
    }
    void grow() {
        slots_.assign(slots_.size() * 2, 0);
        for (size_t i = 0; i < keys_.size(); ++i) {
            size_t slot = hash(keys_[i]) & (slots_.size() - 1);
            while (slots_[slot] != 0) slot = (slot + 1) & (slots_.size() - 1);
            slots_[slot] = static_cast<uint32_t>(i + 1);
        }
    }

    std::vector<uint32_t> slots_;  ///< number + 1, 0: free; a power of two of them
    std::vector<Key> keys_;
};

}  // namespace steradian
