// Files: bounded reading, and replacement as a whole.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "steradian/result.h"

namespace steradian {

/// Reads a regular file. Refuses missing, unreadable and special files (folders, FIFOs, devices) by type, without
/// opening a device, and files over max_bytes; all with code bad_input (resources for the size).
Result<std::string> read_file(const std::string& path, uint64_t max_bytes);

/// A file that appears under its name as a whole when `commit` succeeds, and not at all otherwise: written to a
/// temporary neighbour, flushed to the disk, then renamed over the old one (whose permissions it keeps).
class AtomicFile {
public:
    /// Fails with code resources when the folder is missing or not writable, or the path is not a regular file.
    static Result<AtomicFile> create(const std::string& path);
    AtomicFile(AtomicFile&&) noexcept;
    AtomicFile& operator=(AtomicFile&&) noexcept;
    ~AtomicFile();  ///< removes the temporary file unless committed

    Status write(std::string_view bytes);
    Status commit();

private:
    struct State;
    explicit AtomicFile(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

/// create, write, commit.
Status replace_file(const std::string& path, std::string_view bytes);

/// Whether `replace_file` could work, without leaving anything behind: for checks before a long render.
Status check_writable(const std::string& path);

}  // namespace steradian
