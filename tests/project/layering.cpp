#include "project/layering.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <stdexcept>

namespace steradian::test {
namespace {

namespace fs = std::filesystem;

/// What each layer may include directly or through others, besides itself.
const std::map<std::string, std::set<std::string>> kMayUse = {
    {"base", {}},
    {"math", {"base"}},
    {"image", {"math", "base"}},
    {"accel", {"math", "base"}},
    {"scene", {"image", "math", "base"}},
    {"shading", {"scene", "image", "math", "base"}},
    {"render", {"shading", "scene", "image", "accel", "math", "base"}},
    {"formats", {"scene", "image", "math", "base"}},
    {"lint", {"formats", "shading", "scene", "image", "math", "base"}},
    {"apps", {"base", "math", "image", "scene", "accel", "shading", "render", "formats", "lint"}},
};

/// The layer that implements each public header. Settings are plain values that every layer may name.
const std::map<std::string, std::string> kPublicHeaders = {
    {"version.h", "base"},  {"result.h", "base"},    {"settings.h", "base"}, {"vec.h", "math"},
    {"image.h", "image"},   {"image_io.h", "image"}, {"scene.h", "scene"},   {"load.h", "formats"},
    {"render.h", "render"}, {"replay.h", "render"},  {"lint.h", "lint"},     {"steradian.h", "apps"},
};

bool is_source(const fs::path& path) {
    static const std::set<std::string> extensions = {".h", ".hpp", ".inl", ".c", ".cc", ".cpp", ".cxx"};
    return extensions.count(path.extension().string()) != 0;
}

/// Empty when the path belongs to no layer that is known. `relative`: from the root of the source tree.
std::string layer_of_file(const fs::path& relative) {
    auto part = relative.begin();
    const std::string top = part->string();
    if (top == "apps") return "apps";
    if (++part == relative.end()) return {};
    if (top == "src") return kMayUse.count(part->string()) ? part->string() : std::string();
    const auto header = kPublicHeaders.find(relative.filename().string());
    return header == kPublicHeaders.end() ? std::string() : header->second;
}

/// Empty for headers of the system and for those of the same folder.
std::string layer_of_include(const std::string& name) {
    const size_t slash = name.find('/');
    if (slash == std::string::npos) return {};
    const std::string folder = name.substr(0, slash);
    if (folder == "steradian") {
        const auto header = kPublicHeaders.find(name.substr(slash + 1));
        return header == kPublicHeaders.end() ? std::string("unknown") : header->second;
    }
    return kMayUse.count(folder) ? folder : std::string();
}

void check_file(const fs::path& path, const fs::path& relative, std::vector<std::string>& faults) {
    static const std::regex include(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
    const std::string from = layer_of_file(relative);
    if (from.empty()) {
        faults.push_back(relative.string() + ": belongs to no layer; add it to tests/project/layering.cpp");
        return;
    }
    std::ifstream file(path);
    if (!file) throw std::runtime_error("cannot read " + path.string());
    std::string line;
    for (int number = 1; std::getline(file, line); ++number) {
        std::smatch match;
        if (!std::regex_search(line, match, include)) continue;
        const std::string name = match[1];
        const std::string place = relative.string() + ":" + std::to_string(number) + ": ";
        if (name.find("..") != std::string::npos || name.rfind("src/", 0) == 0) {
            faults.push_back(place + "\"" + name + "\" does not start at a layer's name");
            continue;
        }
        if (*relative.begin() == "include" && name.rfind("steradian/", 0) != 0 && !layer_of_include(name).empty()) {
            faults.push_back(place + "a public header must not include the private \"" + name + "\"");
            continue;
        }
        const std::string to = layer_of_include(name);
        if (to.empty() || to == from || kMayUse.at(from).count(to)) continue;
        faults.push_back(place + "'" + from + "' must not include '" + to + "' (" + name + ")");
    }
}

}  // namespace

std::vector<std::string> layering_faults(const fs::path& root) {
    std::vector<fs::path> files;
    for (const char* folder : {"include/steradian", "src", "apps"}) {
        if (!fs::exists(root / folder)) continue;
        for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
            if (entry.is_regular_file() && is_source(entry.path())) files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());

    std::vector<std::string> faults;
    for (const fs::path& file : files) check_file(file, fs::relative(file, root), faults);
    if (files.empty()) faults.push_back(root.string() + ": no sources found");
    return faults;
}

}  // namespace steradian::test
