#include "race.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <thread>

#ifdef __linux__
#include <sched.h>
#endif

#include "clock.h"

namespace steradian::bench {
namespace {

struct Lap {
    const RaySet& set;
    const Entrant& entrant;
    const RaceOptions& options;
    Answers& answers;
    std::atomic<size_t> next = 0;

    /// Seconds that this thread spent in the engine.
    double work() {
        double (*const clock)() = options.wall ? wall_seconds : thread_seconds;
        const std::unique_ptr<Tracer> tracer = entrant.tracer(set, options.chunk);
        double spent = 0;
        for (;;) {
            const size_t begin = next.fetch_add(options.chunk);
            if (begin >= set.rays.size()) return spent;
            const size_t count = std::min(options.chunk, set.rays.size() - begin);
            tracer->load(std::span(set.rays).subspan(begin, count));
            const double started = clock();
            tracer->trace();
            spent += clock() - started;
            if (set.any_hit) {
                tracer->store(std::span(answers.occluded).subspan(begin, count));
            } else {
                tracer->store(std::span(answers.hits).subspan(begin, count));
            }
        }
    }
};

/// This thread to the `index`-th of the processors that it may use. New threads may share one for the whole of a lap
/// where anything else runs on the machine, and an engine that is timed on two processors has to have both.
void take_processor(uint32_t index) {
#ifdef __linux__
    cpu_set_t usable, own;
    if (sched_getaffinity(0, sizeof(usable), &usable) != 0) return;
    CPU_ZERO(&own);
    for (int cpu = 0; cpu < CPU_SETSIZE && CPU_COUNT(&own) == 0; ++cpu)
        if (CPU_ISSET(cpu, &usable) && index-- == 0) CPU_SET(cpu, &own);
    if (CPU_COUNT(&own) == 1) sched_setaffinity(0, sizeof(own), &own);
#else
    static_cast<void>(index);
#endif
}

double run(Lap& lap) {
    if (lap.entrant.threads == 1) return lap.work();
    std::vector<double> spent(lap.entrant.threads);
    std::vector<std::thread> threads;
    for (uint32_t i = 0; i < lap.entrant.threads; ++i)
        threads.emplace_back([&lap, &spent, i] {
            take_processor(i);
            spent[i] = lap.work();
        });
    for (std::thread& thread : threads) thread.join();
    return std::accumulate(spent.begin(), spent.end(), 0.0) / double(spent.size());
}

}  // namespace

Spread spread_of(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return {values[values.size() / 2], values.front(), values.back()};
}

size_t count_different(const Answers& a, const Answers& b) {
    size_t count = 0;
    for (size_t i = 0; i < a.occluded.size(); ++i) count += a.occluded[i] != b.occluded[i];
    for (size_t i = 0; i < a.hits.size(); ++i) {
        const Hit &x = a.hits[i], &y = b.hits[i];
        const bool differ = x.found() != y.found() || (x.found() && std::fabs(x.t - y.t) > 1e-4f * std::fabs(x.t));
        count += differ;
    }
    return count;
}

std::vector<Lane> race(const RaySet& set, const std::vector<Entrant>& entrants, const RaceOptions& options) {
    std::vector<Lane> lanes(entrants.size());
    std::vector<std::vector<double>> times(entrants.size());
    for (Lane& lane : lanes) {
        lane.answers.hits.resize(set.any_hit ? 0 : set.rays.size());
        lane.answers.occluded.resize(set.any_hit ? set.rays.size() : 0);
    }
    for (int repetition = 0; repetition < options.repetitions; ++repetition)
        for (size_t i = 0; i < entrants.size(); ++i) {
            const size_t e = (i + size_t(repetition)) % entrants.size();
            Lap lap{set, entrants[e], options, lanes[e].answers};
            times[e].push_back(run(lap));
        }
    for (size_t e = 0; e < entrants.size(); ++e) lanes[e].seconds = spread_of(times[e]);
    return lanes;
}

}  // namespace steradian::bench
