// How much memory there is to take.
#pragma once

#include <cstdint>

namespace steradian {

/// Bytes this process can still take without being killed or refused: the smallest of what the system calls available,
/// the control group's limit and RLIMIT_AS, each less what is in use. 2^63 when nothing is known.
uint64_t available_memory() noexcept;

}  // namespace steradian
