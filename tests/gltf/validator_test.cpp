// The files of Khronos' glTF validator, each with the faults that it finds. What becomes of each kind of fault is the
// table of docs/gltf-validation.md, which STERADIAN_WRITE_TABLES=1 writes anew.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>

#include "formats/gltf/object.h"
#include "gltf_builder.h"
#include "support/support.h"

namespace steradian {
namespace {

using namespace test;

constexpr int kError = 0;  ///< the validator's severities go on with warnings, notes and hints

/// Of the errors in a report.
std::set<std::string> error_codes(const std::string& text) {
    const auto document = json::Document::parse(text, "report", 64);
    if (!document) throw std::runtime_error(document.error().str());
    const json::Source source(document->text(), "report");
    std::set<std::string> out;
    const gltf::Object issues = *gltf::Object(source, document->root(), "a report").object("issues");
    for (const json::Value value : issues.array("messages")) {
        const gltf::Object message(source, value, "a message");
        if (message.integer_or("severity", 9, 0, 9) == kError) out.emplace(message.string_or("code", ""));
    }
    return out;
}

struct Row {
    size_t files = 0, refused = 0, warned = 0;
};

std::string table_of(const std::map<std::string, Row>& rows) {
    std::string out =
        "| code | files | refused | loaded with a warning | loaded without |\n| --- | --- | --- | --- | --- |\n";
    for (const auto& [code, row] : rows) {
        out += "| " + code;
        for (const size_t n : {row.files, row.refused, row.warned, row.files - row.refused - row.warned})
            out += " | " + std::to_string(n);
        out += " |\n";
    }
    return out;
}

/// An empty scene is what most of these files are.
bool has_warnings(const LoadedScene& loaded) {
    const auto tells = [](const Warning& w) { return w.message != "the scene has nothing to render"; };
    return !loaded.fidelity.empty() ||
           std::any_of(loaded.diagnostics.warnings().begin(), loaded.diagnostics.warnings().end(), tells);
}

std::vector<std::string> models_in(const std::filesystem::path& folder) {
    std::vector<std::string> out;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const std::string path = entry.path().string();
        if (path.ends_with(".gltf") || path.ends_with(".glb")) out.push_back(path);
    }
    std::sort(out.begin(), out.end());
    return out;
}

TEST(GltfSuite, Validator) {
    const auto shared = shared_folder();
    if (!shared || !std::filesystem::exists(*shared / "suites/gltf_validator"))
        GTEST_SKIP() << "suites/gltf_validator is not there";
    std::map<std::string, Row> rows;
    const std::vector<std::string> models = models_in(*shared / "suites/gltf_validator/base");
    for (const std::string& path : models) {
        const std::set<std::string> codes = error_codes(slurp(path + ".report.json"));
        const auto loaded = load_scene(path);
        for (const std::string& code : codes) {
            Row& row = rows[code];
            ++row.files;
            row.refused += !loaded.ok();
            row.warned += loaded.ok() && has_warnings(*loaded);
        }
        if (loaded.ok()) continue;
        const Error& error = loaded.error();
        // What needs a newer glTF is no fault, and not for us.
        EXPECT_TRUE(!codes.empty() || path.ends_with("min_version_valid.gltf")) << error.str();
        EXPECT_EQ(error.where.file, path);
        EXPECT_TRUE(error.where.byte || error.where.line > 0) << error.str();
        EXPECT_FALSE(error.message.empty()) << path;
    }
    EXPECT_GT(models.size(), 200u);

    const std::string file = source_folder() / "docs/gltf-validation.md", made = table_of(rows);
    std::string page = slurp(file);
    const size_t table = page.find("| code");
    ASSERT_NE(table, page.npos) << file;
    if (std::getenv("STERADIAN_WRITE_TABLES")) spit(file, page.replace(table, page.npos, made));
    EXPECT_EQ(page.substr(table), made) << "STERADIAN_WRITE_TABLES=1 writes docs/gltf-validation.md anew";
}

}  // namespace
}  // namespace steradian
