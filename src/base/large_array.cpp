#include "base/large_array.h"

#include <cstdlib>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace steradian {

void* allocate_large(size_t bytes) {
    constexpr size_t kPage = size_t(2) << 20;
    const size_t alignment = bytes >= 2 * kPage ? kPage : 64;
    const size_t rounded = (bytes + alignment - 1) / alignment * alignment;
    void* memory = rounded < bytes ? nullptr : std::aligned_alloc(alignment, rounded);
    if (memory == nullptr) throw std::bad_alloc();
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    if (alignment == kPage) madvise(memory, rounded, MADV_HUGEPAGE);
#endif
    return memory;
}

void free_large(void* memory) noexcept { std::free(memory); }

}  // namespace steradian
