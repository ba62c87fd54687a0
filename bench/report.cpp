#include "report.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <rapidjson/prettywriter.h>

#include <ctime>
#include <fstream>

#include "base/parallel.h"

namespace steradian::bench {
namespace {

class Json {
public:
    Json() { writer_.SetIndent(' ', 1); }
    std::string text() const { return {buffer_.GetString(), buffer_.GetSize()}; }

    void field(const char* key, const std::string& value) {
        writer_.Key(key);
        writer_.String(value.data(), static_cast<rapidjson::SizeType>(value.size()));
    }
    void field(const char* key, const char* value) { field(key, std::string(value)); }
    void field(const char* key, double value) {
        writer_.Key(key);
        writer_.Double(value);
    }
    void field(const char* key, uint64_t value) {
        writer_.Key(key);
        writer_.Uint64(value);
    }
    void field(const char* key, int64_t value) {
        writer_.Key(key);
        writer_.Int64(value);
    }
    void field(const char* key, uint32_t value) { field(key, uint64_t(value)); }
    void field(const char* key, const Spread& s) {
        object(key, [&] {
            field("median", s.median);
            field("lowest", s.lowest);
            field("highest", s.highest);
        });
    }
    void field(const char* key, const Entry& e) {
        object(key, [&] {
            field("setting", e.setting);
            field("seconds", e.seconds);
            field("differ", uint64_t(e.differ));
        });
    }
    void field(const char* key, const std::optional<Entry>& e) {
        if (e) field(key, *e);
    }
    template <class Body>
    void object(const char* key, const Body& body) {
        if (key) writer_.Key(key);
        writer_.StartObject();
        body();
        writer_.EndObject();
    }
    template <class Rows>
    void rows(const char* key, const Rows& rows) {
        writer_.Key(key);
        writer_.StartArray();
        for (const auto& row : rows) object(nullptr, [&] { write(*this, row); });
        writer_.EndArray();
    }

private:
    rapidjson::StringBuffer buffer_;
    rapidjson::PrettyWriter<rapidjson::StringBuffer> writer_{buffer_};

    static void write(Json& json, const RayRow& row);
    static void write(Json& json, const ThreadRow& row);
    static void write(Json& json, const TriedRow& row);
    static void write(Json& json, const BuildRow& row);
    static void write(Json& json, const TreeRow& row);
};

void Json::write(Json& json, const RayRow& row) {
    json.field("mesh", row.mesh);
    json.field("rays", row.rays);
    json.field("given", row.single ? "one" : "batch");
    json.field("count", uint64_t(row.count));
    json.field("ours", row.ours);
    json.field("embree_fastest", row.fastest);
    json.field("embree_robust", row.robust);
}

void Json::write(Json& json, const ThreadRow& row) {
    json.field("mesh", row.mesh);
    json.field("rays", row.rays);
    json.field("count", uint64_t(row.count));
    json.field("threads", row.threads);
    json.field("ours_one", row.ours_one);
    json.field("ours_all", row.ours_all);
    json.field("embree_one", row.embree_one);
    json.field("embree_all", row.embree_all);
}

void Json::write(Json& json, const TriedRow& row) {
    json.field("mesh", row.mesh);
    json.field("rays", row.rays);
    json.field("build", row.build);
    json.field("feed", row.feed);
    json.field("count", uint64_t(row.count));
    json.field("seconds", row.seconds);
    json.field("ours_seconds", row.ours);
    json.field("differ", uint64_t(row.differ));
}

void Json::write(Json& json, const BuildRow& row) {
    json.field("mesh", row.mesh);
    json.field("triangles", uint64_t(row.triangles));
    json.field("threads", row.threads);
    json.field("setting", row.setting);
    json.field("seconds", row.seconds);
    json.field("bytes", row.bytes);
    json.field("counted", row.counted);
    json.field("peak", row.peak);
}

void Json::write(Json& json, const TreeRow& row) {
    json.field("mesh", row.mesh);
    json.field("rays", row.rays);
    json.field("tree", row.tree);
    json.field("count", uint64_t(row.count));
    json.field("seconds", row.seconds);
    json.field("first_seconds", row.first);
    json.field("node_visits", row.node_visits);
    json.field("block_visits", row.block_visits);
    json.field("nodes", row.nodes);
    json.field("references", row.references);
    json.field("differ", uint64_t(row.differ));
}

std::string processor() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown processor";
}

}  // namespace

Report new_report(const std::vector<std::string>& command) {
    Report report;
    report.machine = fmt::format("{}, {} threads, {}", processor(), hardware_threads(), __VERSION__);
    report.date = fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr)));
    report.command = fmt::format("accel_bench {}", fmt::join(command, " "));
    return report;
}

std::string to_json(const Report& report) {
    Json json;
    json.object(nullptr, [&] {
        json.field("date", report.date);
        json.field("machine", report.machine);
        json.field("command", report.command);
        json.rows("rays", report.rays);
        json.rows("threads", report.threads);
        json.rows("builds", report.builds);
        json.rows("trees", report.trees);
        json.rows("tried", report.tried);
    });
    return json.text() + "\n";
}

}  // namespace steradian::bench
