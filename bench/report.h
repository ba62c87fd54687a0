// Everything that was measured, and how it is told: tables for people, JSON for programs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "race.h"

namespace steradian::bench {

struct Entry {
    std::string setting;
    Spread seconds;
    size_t differ = 0;  ///< rays answered otherwise than by our first setting
};

/// One thread, by its processor time.
struct RayRow {
    std::string mesh, rays;
    bool single = false;  ///< one ray at a time, else batches
    size_t count = 0;
    Entry ours;
    std::optional<Entry> fastest, robust;  ///< of Embree
};

/// By the clock on the wall, for one thread too.
struct ThreadRow {
    std::string mesh, rays;
    size_t count = 0;
    uint32_t threads = 0;
    Entry ours_one, ours_all;
    std::optional<Entry> embree_one, embree_all;
};

/// A setting of Embree in its short trial.
struct TriedRow {
    std::string mesh, rays, build, feed;
    size_t count = 0;
    Spread seconds, ours;
    size_t differ = 0;
};

struct BuildRow {
    std::string mesh;
    size_t triangles = 0;
    uint32_t threads = 0;
    std::string setting;  ///< "Embree ..." or one of ours
    Spread seconds;       ///< one thread: processor time, several: wall
    int64_t bytes = 0;    ///< held by the result, as the engine says
    int64_t counted = 0;  ///< the same as counted from outside
    int64_t peak = 0;     ///< most that was held during the build
};

/// A tree under one and the same kernel of ours, on one thread.
struct TreeRow {
    std::string mesh, rays, tree;
    size_t count = 0;
    Spread seconds, first;                     ///< of it and of our first tree, from the same race
    double node_visits = 0, block_visits = 0;  ///< per ray, for a ray by itself
    double nodes = 0, references = 0;          ///< per triangle
    size_t differ = 0;                         ///< rays answered otherwise than by way of our first tree
};

struct Report {
    std::string machine, date, command;
    std::vector<RayRow> rays;
    std::vector<ThreadRow> threads;
    std::vector<TriedRow> tried;
    std::vector<BuildRow> builds;
    std::vector<TreeRow> trees;
};

Report new_report(const std::vector<std::string>& command);
void print_tables(const Report& report);
std::string to_json(const Report& report);

inline double mega_per_second(size_t count, double seconds) { return double(count) / seconds / 1e6; }

}  // namespace steradian::bench
