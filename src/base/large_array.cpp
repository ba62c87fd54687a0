#include "base/large_array.h"

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace steradian {

namespace {
constexpr size_t kPage = size_t(2) << 20;
size_t alignment_of(size_t bytes) { return bytes >= 2 * kPage ? kPage : 64; }
}  // namespace

void* allocate_large(size_t bytes) {
    const size_t alignment = alignment_of(bytes);
    void* memory = ::operator new(bytes, std::align_val_t(alignment));
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    if (alignment == kPage) madvise(memory, bytes, MADV_HUGEPAGE);  // a wish: it may fail
#endif
    return memory;
}

void free_large(void* memory, size_t bytes) noexcept {
    ::operator delete(memory, std::align_val_t(alignment_of(bytes)));
}

}  // namespace steradian
