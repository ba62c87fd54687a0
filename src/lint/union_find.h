// What hangs together with what.
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

#include "math/vector.h"

namespace steradian::lint_detail {

/// The lowest number of a set stands for it.
class UnionFind {
public:
    explicit UnionFind(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
    uint32_t find(uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(uint32_t a, uint32_t b) {
        a = find(a), b = find(b);
        parent_[max_of(a, b)] = min_of(a, b);
    }

private:
    std::vector<uint32_t> parent_;
};

}  // namespace steradian::lint_detail
