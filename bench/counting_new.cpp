#include "counting_new.h"

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

namespace steradian::bench {
namespace {

std::atomic<int64_t> held = 0, peak = 0;

void* counted(void* memory) {
    if (!memory) throw std::bad_alloc();
    const auto size = static_cast<int64_t>(malloc_usable_size(memory));
    const int64_t now = held.fetch_add(size, std::memory_order_relaxed) + size;
    int64_t before = peak.load(std::memory_order_relaxed);
    while (now > before && !peak.compare_exchange_weak(before, now, std::memory_order_relaxed)) {
    }
    return memory;
}

void release(void* memory) noexcept {
    held.fetch_sub(static_cast<int64_t>(malloc_usable_size(memory)), std::memory_order_relaxed);
    std::free(memory);
}

size_t rounded_up(size_t size, size_t alignment) { return (size + alignment - 1) / alignment * alignment; }

}  // namespace

void reset_memory_use() { held = peak = 0; }
MemoryUse memory_use() { return {held, peak}; }

}  // namespace steradian::bench

using steradian::bench::counted;
using steradian::bench::release;

void* operator new(size_t size) { return counted(std::malloc(std::max<size_t>(size, 1))); }
void* operator new(size_t size, std::align_val_t alignment) {
    const auto bytes = static_cast<size_t>(alignment);
    return counted(std::aligned_alloc(bytes, steradian::bench::rounded_up(std::max<size_t>(size, 1), bytes)));
}
void operator delete(void* memory) noexcept { release(memory); }
void operator delete(void* memory, size_t) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete(void* memory, size_t, std::align_val_t) noexcept { release(memory); }
