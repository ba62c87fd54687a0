#include "progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace steradian::cli {

std::string format_duration(double seconds) {
    const auto total = static_cast<uint64_t>(std::clamp(seconds, 0.0, 3.6e8) + 0.5);
    const uint64_t h = total / 3600, m = total / 60 % 60, s = total % 60;
    return h ? fmt::format("{}:{:02}:{:02}", h, m, s) : fmt::format("{}:{:02}", m, s);
}

std::string format_quantity(double value) {
    const char* prefixes[] = {"", " k", " M", " G", " T"};
    size_t i = 0;
    while (value >= 1000 && i + 1 < std::size(prefixes)) value /= 1000, ++i;
    return fmt::format("{:.3g}{}", value, prefixes[i]);
}

namespace {

std::string time_left(double done, double seconds) {
    return done > 0 ? "ETA " + format_duration(seconds * (1 - done) / done) : "ETA unknown";
}

}  // namespace

ProgressMeter::ProgressMeter(bool quiet)
    : quiet_(quiet), terminal_(::isatty(STDERR_FILENO) == 1), next_(terminal_ ? 0 : 2) {}

void ProgressMeter::show(const RenderProgress& p) {
    if (quiet_ || p.samples_total == 0 || p.seconds < next_) return;
    const double done = double(p.samples_done) / double(p.samples_total);
    print(fmt::format("{:5.1f} %  {} of {} samples  {} rays/s  {} elapsed  {}", 100 * done,
                      format_quantity(double(p.samples_done)), format_quantity(double(p.samples_total)),
                      format_quantity(p.seconds > 0 ? double(p.rays) / p.seconds : 0), format_duration(p.seconds),
                      time_left(done, p.seconds)),
          p.seconds);
}

void ProgressMeter::show_build(double fraction, double seconds) {
    if (quiet_ || seconds < next_) return;
    print(fmt::format("{:5.1f} %  of the hierarchy built  {} elapsed  {}", 100 * fraction, format_duration(seconds),
                      time_left(fraction, seconds)),
          seconds);
}

void ProgressMeter::print(const std::string& line, double seconds) {
    if (terminal_) {
        std::fprintf(stderr, "\r\x1b[K%s", line.c_str());
        line_open_ = true;
        next_ = seconds + 0.1;
    } else {
        std::fprintf(stderr, "%s\n", line.c_str());
        next_ = seconds + std::clamp(seconds / 4, 5.0, 60.0);
    }
    std::fflush(stderr);
}

void ProgressMeter::finish() {
    if (line_open_) std::fputs("\r\x1b[K", stderr);
    line_open_ = false;
}

}  // namespace steradian::cli
