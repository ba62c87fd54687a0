#include <fmt/format.h>

#include "report.h"

namespace steradian::bench {
namespace {

double rate(size_t count, const Entry& entry) { return mega_per_second(count, entry.seconds.median); }

/// How far apart the repetitions were, slowest over fastest.
std::string spread(const Spread& s) { return fmt::format("{:.2f}", s.highest / s.lowest); }

/// Rate, setting, ours ÷ it, spread and differing rays; dashes when there is none.
std::string against(const RayRow& row, const std::optional<Entry>& embree) {
    if (!embree) return " – | – | – | – | – |";
    return fmt::format(" {:.2f} | {} | **{:.2f}** | {} | {} |", rate(row.count, *embree), embree->setting,
                       embree->seconds.median / row.ours.seconds.median, spread(embree->seconds), embree->differ);
}

void print_rays(const std::vector<RayRow>& rows) {
    fmt::print(
        "\nOne thread, millions of rays per second of processor time; ours ÷ Embree's fastest setting and ÷ its "
        "fastest robust one; ± is the slowest repetition over the fastest.\n\n"
        "| mesh | rays | given | Steradian | setting | ± | Embree | setting | ÷ | ± | differ | robust | setting | ÷ | "
        "± | differ | of |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const RayRow& r : rows)
        fmt::print("| {} | {} | {} | {:.2f} | {} | {} |{}{} {} |\n", r.mesh, r.rays, r.single ? "one" : "batch",
                   rate(r.count, r.ours), r.ours.setting, spread(r.ours.seconds), against(r, r.fastest),
                   against(r, r.robust), r.count);
}

void print_threads(const std::vector<ThreadRow>& rows) {
    fmt::print(
        "\nSeveral threads, millions of rays per second by the clock on the wall; scaling is that of all threads over "
        "that of one.\n\n"
        "| mesh | rays | threads | Steradian, one | all | scaling | Embree, one | all | scaling | ÷ Embree, all |\n"
        "|---|---|---|---|---|---|---|---|---|---|\n");
    for (const ThreadRow& r : rows) {
        std::string embree = " – | – | – | – |";
        const double ours_one = rate(r.count, r.ours_one), ours_all = rate(r.count, r.ours_all);
        if (r.embree_all) {
            const double one = rate(r.count, *r.embree_one), all = rate(r.count, *r.embree_all);
            embree = fmt::format(" {:.2f} | {:.2f} | {:.2f} | **{:.2f}** |", one, all, all / one, ours_all / all);
        }
        fmt::print("| {} | {} | {} | {:.2f} | {:.2f} | **{:.2f}** |{}\n", r.mesh, r.rays, r.threads, ours_one, ours_all,
                   ours_all / ours_one, embree);
    }
}

void print_builds(const std::vector<BuildRow>& rows) {
    fmt::print(
        "\nBuilding, milliseconds (one thread: processor time; several: wall), and bytes a triangle that the "
        "result holds as the engine says and as counted from outside; \"beside it\" is the most that was held beyond "
        "the "
        "result on the way, as a share of it.\n\n"
        "| mesh | triangles | threads | builder | ms | ± | held | counted | beside it "
        "|\n|---|---|---|---|---|---|---|---|---|\n");
    for (const BuildRow& r : rows)
        fmt::print("| {} | {} | {} | {} | {:.0f} | {} | {:.1f} | {:.1f} | {:.2f} |\n", r.mesh, r.triangles, r.threads,
                   r.setting, 1e3 * r.seconds.median, spread(r.seconds), double(r.bytes) / double(r.triangles),
                   double(r.counted) / double(r.triangles), double(r.peak - r.counted) / double(r.counted));
}

void print_trees(const std::vector<TreeRow>& rows) {
    fmt::print(
        "\nTrees under one and the same kernel of ours, one thread; ÷ is against the first tree from the same race; "
        "visits are a ray's, counted for one by itself; nodes and references are per triangle.\n\n"
        "| mesh | rays | tree | M/s | ÷ | ± | node visits | block visits | nodes | references | differ | of "
        "|\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const TreeRow& r : rows)
        fmt::print("| {} | {} | {} | {:.2f} | **{:.2f}** | {} | {:.1f} | {:.1f} | {:.3f} | {:.2f} | {} | {} |\n",
                   r.mesh, r.rays, r.tree, mega_per_second(r.count, r.seconds.median),
                   r.first.median / r.seconds.median, spread(r.seconds), r.node_visits, r.block_visits, r.nodes,
                   r.references, r.differ, r.count);
}

void print_tried(const std::vector<TriedRow>& rows) {
    fmt::print(
        "\nEvery setting of Embree in a short trial, one thread; ours ÷ it from the same trial, best repetitions.\n\n"
        "| mesh | rays | built with | given | M/s | ours ÷ | differ | of |\n|---|---|---|---|---|---|---|---|\n");
    for (const TriedRow& r : rows)
        fmt::print("| {} | {} | {} | {} | {:.2f} | {:.2f} | {} | {} |\n", r.mesh, r.rays, r.build, r.feed,
                   mega_per_second(r.count, r.seconds.lowest), r.seconds.lowest / r.ours.lowest, r.differ, r.count);
}

}  // namespace

void print_tables(const Report& report) {
    fmt::print("{}; {}\n\n    {}\n", report.date, report.machine, report.command);
    if (!report.rays.empty()) print_rays(report.rays);
    if (!report.threads.empty()) print_threads(report.threads);
    if (!report.builds.empty()) print_builds(report.builds);
    if (!report.trees.empty()) print_trees(report.trees);
    if (!report.tried.empty()) print_tried(report.tried);
}

}  // namespace steradian::bench
