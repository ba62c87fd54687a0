#include <fmt/format.h>

#include <algorithm>
#include <string_view>

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

/// A line of text, the names of the columns between bars, and a line for each row.
template <class Row, class Format>
void print_table(const char* text, std::string_view columns, const std::vector<Row>& rows, const Format& line_of) {
    if (rows.empty()) return;
    fmt::print("\n{}\n\n{}\n|", text, columns);
    for (auto bars = std::count(columns.begin(), columns.end(), '|'); bars > 1; --bars) fmt::print("---|");
    fmt::print("\n");
    for (const Row& row : rows) fmt::print("{}\n", line_of(row));
}

std::string line_of_rays(const RayRow& r) {
    return fmt::format("| {} | {} | {} | {:.2f} | {} | {} |{}{} {} |", r.mesh, r.rays, r.single ? "one" : "batch",
                       rate(r.count, r.ours), r.ours.setting, spread(r.ours.seconds), against(r, r.fastest),
                       against(r, r.robust), r.count);
}

std::string line_of_threads(const ThreadRow& r) {
    std::string embree = " – | – | – | – |";
    const double ours_one = rate(r.count, r.ours_one), ours_all = rate(r.count, r.ours_all);
    if (r.embree_all) {
        const double one = rate(r.count, *r.embree_one), all = rate(r.count, *r.embree_all);
        embree = fmt::format(" {:.2f} | {:.2f} | {:.2f} | **{:.2f}** |", one, all, all / one, ours_all / all);
    }
    return fmt::format("| {} | {} | {} | {:.2f} | {:.2f} | **{:.2f}** |{}", r.mesh, r.rays, r.threads, ours_one,
                       ours_all, ours_all / ours_one, embree);
}

std::string line_of_build(const BuildRow& r) {
    return fmt::format("| {} | {} | {} | {} | {:.0f} | {} | {:.1f} | {:.1f} | {:.2f} |", r.mesh, r.triangles, r.threads,
                       r.setting, 1e3 * r.seconds.median, spread(r.seconds), double(r.bytes) / double(r.triangles),
                       double(r.counted) / double(r.triangles), double(r.peak - r.counted) / double(r.counted));
}

std::string line_of_tree(const TreeRow& r) {
    return fmt::format("| {} | {} | {} | {:.2f} | **{:.2f}** | {} | {:.1f} | {:.1f} | {:.3f} | {:.2f} | {} | {} |",
                       r.mesh, r.rays, r.tree, mega_per_second(r.count, r.seconds.median),
                       r.first.median / r.seconds.median, spread(r.seconds), r.node_visits, r.block_visits, r.nodes,
                       r.references, r.differ, r.count);
}

std::string line_of_tried(const TriedRow& r) {
    return fmt::format("| {} | {} | {} | {} | {:.2f} | {:.2f} | {} | {} |", r.mesh, r.rays, r.build, r.feed,
                       mega_per_second(r.count, r.seconds.lowest), r.seconds.lowest / r.ours.lowest, r.differ, r.count);
}

}  // namespace

void print_tables(const Report& report) {
    fmt::print("{}; {}\n\n    {}\n", report.date, report.machine, report.command);
    print_table(
        "One thread, millions of rays per second of processor time; ours ÷ Embree's fastest setting and ÷ its fastest "
        "robust one; ± is the slowest repetition over the fastest.",
        "| mesh | rays | given | Steradian | setting | ± | Embree | setting | ÷ | ± | differ | robust | setting | ÷ | "
        "± | differ | of |",
        report.rays, line_of_rays);
    print_table(
        "Several threads, millions of rays per second by the clock on the wall; scaling is that of all threads over "
        "that of one.",
        "| mesh | rays | threads | Steradian, one | all | scaling | Embree, one | all | scaling | ÷ Embree, all |",
        report.threads, line_of_threads);
    print_table(
        "Building, milliseconds (one thread: processor time; several: wall), and bytes a triangle that the result "
        "holds as the engine says and as counted from outside; \"beside it\" is the most that was held beyond the "
        "result on the way, as a share of it.",
        "| mesh | triangles | threads | builder | ms | ± | held | counted | beside it |", report.builds, line_of_build);
    print_table(
        "Trees under one and the same kernel of ours, one thread; ÷ is against the first tree from the same race; "
        "visits are a ray's, counted for one by itself; nodes and references are per triangle.",
        "| mesh | rays | tree | M/s | ÷ | ± | node visits | block visits | nodes | references | differ | of |",
        report.trees, line_of_tree);
    print_table(
        "Every setting of Embree in a short trial, one thread; ours ÷ it from the same trial, best repetitions.",
        "| mesh | rays | built with | given | M/s | ours ÷ | differ | of |", report.tried, line_of_tried);
}

}  // namespace steradian::bench
