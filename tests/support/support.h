// What the tests of all layers share: the slow tier's switch, the optional folder of outside files, temporary folders.
#pragma once

#include <stdlib.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace steradian::test {

/// Whether the long versions of the tests were asked for: STERADIAN_TEST_ALL=1. Same tests, larger counts.
inline bool run_everything() {
    const char* value = std::getenv("STERADIAN_TEST_ALL");
    return value && *value && std::string_view(value) != "0";
}

/// The first count of the quick tier, or the second one of the long tier.
template <class T>
T by_tier(T quick, T everything) {
    return run_everything() ? everything : quick;
}

/// The root of the source tree (STERADIAN_SOURCE_DIR is set by the build).
inline std::filesystem::path source_folder() { return STERADIAN_SOURCE_DIR; }

/// Test files that are not part of the project: the environment variable STERADIAN_SHARED, or `shared` beside the
/// source tree. A test that needs them is skipped where they are missing, and says so.
inline std::optional<std::filesystem::path> shared_folder() {
    const char* value = std::getenv("STERADIAN_SHARED");
    std::filesystem::path folder = value && *value ? std::filesystem::path(value) : source_folder() / ".." / "shared";
    std::error_code ignored;
    if (!std::filesystem::is_directory(folder, ignored)) return std::nullopt;
    return folder;
}

/// A fresh empty folder that goes away, with what is in it, at the end of the scope.
class TemporaryFolder {
public:
    TemporaryFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "steradian-test-XXXXXX").string();
        if (!::mkdtemp(pattern.data())) throw std::runtime_error("cannot make a temporary folder");
        path_ = pattern;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    /// The path of `name` in the folder, as the library's calls take it.
    std::string file(std::string_view name) const { return (path_ / name).string(); }

private:
    std::filesystem::path path_;
};

/// The bytes of a file; throws (so the test fails) when it cannot be read.
inline std::string slurp(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw std::runtime_error("cannot open " + path.string());
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

inline void spit(const std::filesystem::path& path, std::string_view bytes) {
    std::ofstream out(path, std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!out.flush()) throw std::runtime_error("cannot write " + path.string());
}

}  // namespace steradian::test
