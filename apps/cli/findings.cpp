#include "findings.h"

#include <fmt/format.h>

#include <ostream>

namespace steradian::cli {
namespace {

const char* name_of(Severity severity) { return severity == Severity::warning ? "warning" : "note"; }

const char* name_of(ElementKind kind) {
    static constexpr const char* kNames[kElementKinds] = {"image",  "texture", "material", "mesh",   "shape",
                                                          "object", "light",   "camera",   "profile"};
    return kNames[static_cast<size_t>(kind)];
}

void write_place(JsonWriter& w, const SourceLocation& where) {
    if (!where.file.empty()) write_field(w, "file", where.file);
    if (where.line) w.Key("line"), w.Uint(where.line);
    if (where.column) w.Key("column"), w.Uint(where.column);
    if (where.byte) w.Key("byte"), w.Uint64(*where.byte);
    if (!where.pointer.empty()) write_field(w, "pointer", where.pointer);
}

}  // namespace

void print_findings(std::ostream& out, const LintReport& report, const std::string& indent) {
    for (const Finding& finding : report.findings) {
        out << indent << finding.str() << '\n';
        if (!finding.hint.empty()) out << indent << "  hint: " << finding.hint << '\n';
    }
    for (const LintReport::More& more : report.more)
        out << indent << fmt::format("{}: and {} more [{}]\n", name_of(more.severity), more.count, more.rule);
}

void write_findings(JsonWriter& w, const LintReport& report) {
    w.Key("findings"), w.StartArray();
    for (const Finding& finding : report.findings) {
        w.StartObject();
        write_field(w, "rule", finding.rule);
        write_field(w, "severity", name_of(finding.severity));
        write_field(w, "message", finding.message);
        if (!finding.hint.empty()) write_field(w, "hint", finding.hint);
        write_place(w, finding.where);
        if (finding.element) {
            write_field(w, "element", name_of(finding.element->kind));
            w.Key("index"), w.Uint(finding.element->index);
        }
        w.EndObject();
    }
    w.EndArray();
    w.Key("more"), w.StartObject();
    for (const LintReport::More& more : report.more) {
        w.Key(std::string(more.rule).c_str());
        w.Uint64(more.count);
    }
    w.EndObject();
    w.Key("warnings"), w.Uint64(report.count(Severity::warning));
    w.Key("notes"), w.Uint64(report.count(Severity::note));
}

}  // namespace steradian::cli
