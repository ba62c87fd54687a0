// How engines are timed: each repetition runs all of them, in an order that rotates, so that a machine that is shared
// or warms up treats them alike.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "rays.h"

namespace steradian::bench {

/// One thread's way to an engine. The clock runs during trace() only: every engine gets its rays in the form it likes,
/// and in cache, as a renderer that has just made them would hand them over.
class Tracer {
public:
    virtual ~Tracer() = default;
    virtual void load(std::span<const Ray> rays) = 0;  ///< at most a chunk
    virtual void trace() = 0;
    virtual void store(std::span<Hit> hits) = 0;          ///< after closest hits
    virtual void store(std::span<uint8_t> occluded) = 0;  ///< after any hits
};

using MakeTracer = std::function<std::unique_ptr<Tracer>(const RaySet&, size_t chunk)>;

struct Spread {
    double median = 0, lowest = 0, highest = 0;
};
Spread spread_of(std::vector<double> values);

struct Answers {
    std::vector<Hit> hits;
    std::vector<uint8_t> occluded;
};

/// Rays where one hits and the other does not, or where t differs by more than 1e-4 of itself.
size_t count_different(const Answers& a, const Answers& b);

struct Entrant {
    MakeTracer tracer;
    uint32_t threads = 1;  ///< chunks go to whichever is free
};

struct RaceOptions {
    int repetitions = 5;
    size_t chunk = 4096;  ///< rays handed over in one call
    bool wall = false;    ///< the clock on the wall instead of the processor time of the thread
};

struct Lane {
    Spread seconds;  ///< for the whole set; of several threads the mean over them
    Answers answers;
};

/// One result for each entrant.
std::vector<Lane> race(const RaySet& set, const std::vector<Entrant>& entrants, const RaceOptions& options);

}  // namespace steradian::bench
