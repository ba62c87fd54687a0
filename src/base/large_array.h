// Memory for large arrays that are read at random: on large pages where the system has them, which saves most of the
// walks through page tables.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace steradian {

/// Throws std::bad_alloc. Aligned to at least 64 bytes.
void* allocate_large(size_t bytes);
void free_large(void* memory, size_t bytes) noexcept;

template <class T>
struct LargeAllocator {
    using value_type = T;
    LargeAllocator() = default;
    template <class U>
    LargeAllocator(const LargeAllocator<U>&) noexcept {}
    T* allocate(size_t count) {
        if (count > size_t(-1) / sizeof(T)) throw std::bad_alloc();
        return static_cast<T*>(allocate_large(count * sizeof(T)));
    }
    void deallocate(T* memory, size_t count) noexcept { free_large(memory, count * sizeof(T)); }
    bool operator==(const LargeAllocator&) const = default;
    /// Elements are written before they are read, by several workers: nothing to initialise.
    template <class U>
    void construct(U* at) noexcept {
        ::new (static_cast<void*>(at)) U;
    }
    template <class U, class... Args>
    void construct(U* at, Args&&... args) {
        ::new (static_cast<void*>(at)) U(static_cast<Args&&>(args)...);
    }
};

/// resize() leaves new elements of trivial types uninitialised.
template <class T>
using LargeArray = std::vector<T, LargeAllocator<T>>;

}  // namespace steradian
