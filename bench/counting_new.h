// How much memory a piece of work takes: the program's operator new is replaced by one that counts.
#pragma once

#include <cstdint>

namespace steradian::bench {

struct MemoryUse {
    int64_t held = 0;  ///< bytes allocated and not freed since reset_memory_use
    int64_t peak = 0;  ///< the most that was held at once
};
void reset_memory_use();
/// What malloc calls usable, so what a request is rounded up to counts as well. Memory that does not come from operator
/// new is not seen.
MemoryUse memory_use();

}  // namespace steradian::bench
