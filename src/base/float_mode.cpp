#include "base/parallel.h"

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace steradian {
namespace {

#if defined(__x86_64__)
uint64_t read_mode() { return _mm_getcsr() & ~0x3fu; }  // without what has happened so far
void write_mode(uint64_t mode) { _mm_setcsr(static_cast<unsigned>(mode)); }
constexpr uint64_t kMode = 0x1f80;  // all exceptions masked, round to nearest, no flush to zero, no denormals as zero
#elif defined(__aarch64__)
uint64_t read_mode() {
    uint64_t mode;
    asm volatile("mrs %0, fpcr" : "=r"(mode));
    return mode;
}
void write_mode(uint64_t mode) { asm volatile("msr fpcr, %0" : : "r"(mode)); }
constexpr uint64_t kMode = 0;
#else
#error "unsupported machine: x86-64 and aarch64 are"
#endif

}  // namespace

// Writing the mode makes the processor wait for all that is on its way, which a single ray would feel.
FloatMode::FloatMode() noexcept : saved_(read_mode()) {
    if (saved_ != kMode) write_mode(kMode);
}
FloatMode::~FloatMode() {
    if (saved_ != kMode) write_mode(saved_);
}

}  // namespace steradian
