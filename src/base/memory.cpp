#include "base/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace steradian {
namespace {

constexpr uint64_t kUnknown = uint64_t(1) << 63;

uint64_t subtract(uint64_t limit, uint64_t used) { return limit > used ? limit - used : 0; }

/// The first number in a small text file of the kernel, or after `key` in it.
bool read_number(const char* path, const char* key, uint64_t& out) noexcept {
    std::FILE* file = std::fopen(path, "re");
    if (!file) return false;
    char line[256];
    bool found = false;
    while (!found && std::fgets(line, sizeof line, file)) {
        if (std::strncmp(line, key, std::strlen(key)) != 0) continue;
        unsigned long long value = 0;
        found = std::sscanf(line + std::strlen(key), "%llu", &value) == 1;
        out = value;
    }
    std::fclose(file);
    return found;
}

}  // namespace

uint64_t available_memory() noexcept {
    uint64_t best = kUnknown, value = 0, used = 0;
    if (read_number("/proc/meminfo", "MemAvailable:", value)) best = std::min(best, value * 1024);
    if (read_number("/sys/fs/cgroup/memory.max", "", value) && read_number("/sys/fs/cgroup/memory.current", "", used))
        best = std::min(best, subtract(value, used));
    rlimit limit{};
    if (::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY &&
        read_number("/proc/self/statm", "", used))
        best = std::min(best, subtract(limit.rlim_cur, used * static_cast<uint64_t>(::sysconf(_SC_PAGESIZE))));
    return best;
}

}  // namespace steradian
