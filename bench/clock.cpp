#include "clock.h"

#include <time.h>

namespace steradian::bench {
namespace {

double read(clockid_t clock) {
    timespec now;
    clock_gettime(clock, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

}  // namespace

double thread_seconds() { return read(CLOCK_THREAD_CPUTIME_ID); }
double process_seconds() { return read(CLOCK_PROCESS_CPUTIME_ID); }
double wall_seconds() { return read(CLOCK_MONOTONIC); }

}  // namespace steradian::bench
