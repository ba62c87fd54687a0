#include "formats/mesh/asset_path.h"

#include <algorithm>

namespace steradian {
namespace {

bool is_slash(char c) { return c == '/' || c == '\\'; }

bool is_absolute(std::string_view name) {
    return !name.empty() && (is_slash(name[0]) || (name.size() >= 2 && name[1] == ':'));
}

}  // namespace

std::string resolve_asset(std::string_view name, const std::string& folder) {
    std::string path(name);
    std::replace(path.begin(), path.end(), '\\', '/');
    if (is_absolute(name) || folder.empty() || folder == ".") return path;
    return folder + (folder.back() == '/' ? "" : "/") + path;
}

bool leaves_folder(std::string_view name) {
    if (is_absolute(name)) return true;
    int depth = 0;
    for (size_t begin = 0; begin <= name.size();) {
        const size_t end = std::min(name.find_first_of("/\\", begin), name.size());
        const std::string_view part = name.substr(begin, end - begin);
        if (part == "..")
            --depth;
        else if (!part.empty() && part != ".")
            ++depth;
        if (depth < 0) return true;
        begin = end + 1;
    }
    return false;
}

std::string folder_of(const std::string& path) {
    const size_t slash = path.find_last_of('/');
    return slash == std::string::npos ? "." : slash == 0 ? "/" : path.substr(0, slash);
}

}  // namespace steradian
