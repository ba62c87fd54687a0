#include "base/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <utility>

#include "base/text.h"

namespace steradian {
namespace {

/// A descriptor that closes itself.
class Descriptor {
public:
    explicit Descriptor(int fd = -1) : fd_(fd) {}
    Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        reset();
        fd_ = std::exchange(other.fd_, -1);
        return *this;
    }
    ~Descriptor() { reset(); }
    int get() const { return fd_; }
    bool open() const { return fd_ >= 0; }
    /// 0, or the errno of close: on some file systems a failed write is only reported here.
    int reset() {
        const int fd = std::exchange(fd_, -1);
        return fd >= 0 && ::close(fd) != 0 && errno != EINTR ? errno : 0;
    }

private:
    int fd_;
};

Error file_error(ErrorCode code, const std::string& path, const std::string& what, int number) {
    return {code, what + ": " + std::strerror(number), {path, 0, 0, {}}, {}, {}};
}

/// What a path that is not a regular file is, for messages; nullptr when it is one.
const char* special_kind(mode_t mode) {
    if (S_ISREG(mode)) return nullptr;
    if (S_ISDIR(mode)) return "a folder";
    if (S_ISFIFO(mode)) return "a pipe";
    if (S_ISCHR(mode) || S_ISBLK(mode)) return "a device";
    if (S_ISSOCK(mode)) return "a socket";
    return "not a regular file";
}

std::string folder_of(const std::string& path) {
    const size_t slash = path.find_last_of('/');
    return slash == std::string::npos ? "." : slash == 0 ? "/" : path.substr(0, slash);
}

}  // namespace

Result<std::string> read_file(const std::string& path, uint64_t max_bytes) {
    const auto fail = [&](ErrorCode code, const std::string& message) -> Error {
        return {code, message, {path, 0, 0, {}}, {}, {}};
    };
    if (path.find('\0') != std::string::npos)
        return fail(ErrorCode::bad_input, "a file name cannot contain a NUL byte");
    struct stat info {};
    if (::stat(path.c_str(), &info) != 0) return file_error(ErrorCode::bad_input, path, "cannot open the file", errno);
    if (const char* kind = special_kind(info.st_mode))
        return fail(ErrorCode::bad_input, std::string("this is ") + kind + ", expected a regular file");
    // O_NONBLOCK: should the file have become a pipe in the meantime, opening it must not wait for a writer.
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (!file.open()) return file_error(ErrorCode::bad_input, path, "cannot open the file", errno);
    if (::fstat(file.get(), &info) != 0 || !S_ISREG(info.st_mode))
        return fail(ErrorCode::bad_input, "expected a regular file");
    const auto size = static_cast<uint64_t>(info.st_size);
    if (size > max_bytes)
        return fail(ErrorCode::resources,
                    "the file has " + std::to_string(size) + " bytes, the limit is " + std::to_string(max_bytes));
    std::string data;
    try {
        data.resize(size);
    } catch (const std::exception&) {
        return fail(ErrorCode::resources,
                    "not enough memory to read the " + std::to_string(size) + " bytes of the file");
    }
    size_t done = 0;
    while (done < data.size()) {
        const ssize_t n = ::read(file.get(), data.data() + done, data.size() - done);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return file_error(ErrorCode::bad_input, path, "cannot read the file", errno);
        if (n == 0) break;  // it became shorter while we were reading
        done += static_cast<size_t>(n);
    }
    data.resize(done);
    return data;
}

struct AtomicFile::State {
    std::string path, temporary;
    Descriptor file;
    ~State() {
        if (!temporary.empty()) ::unlink(temporary.c_str());
    }
};

AtomicFile::AtomicFile(std::unique_ptr<State> state) : state_(std::move(state)) {}
AtomicFile::AtomicFile(AtomicFile&&) noexcept = default;
AtomicFile& AtomicFile::operator=(AtomicFile&&) noexcept = default;
AtomicFile::~AtomicFile() = default;

Result<AtomicFile> AtomicFile::create(const std::string& path) {
    const auto fail = [&](const std::string& message) -> Error {
        return {ErrorCode::resources, message, {path, 0, 0, {}}, {}, {}};
    };
    if (path.empty() || path.find('\0') != std::string::npos) return fail("this is not a usable file name");
    auto state = std::make_unique<State>();
    state->path = path;
    // Through a symbolic link the file that it names is replaced, not the link.
    if (char* real = ::realpath(path.c_str(), nullptr)) {
        state->path = real;
        ::free(real);
    }
    struct stat info {};
    mode_t mode = 0666;
    const bool exists = ::stat(state->path.c_str(), &info) == 0;
    if (exists) {
        if (const char* kind = special_kind(info.st_mode))
            return fail(std::string("cannot write here: this is ") + kind);
        if (::access(state->path.c_str(), W_OK) != 0)
            return file_error(ErrorCode::resources, path, "cannot replace the file", errno);
        mode = info.st_mode & 07777;
    } else if (::lstat(state->path.c_str(), &info) == 0) {
        return fail("cannot write here: this is a symbolic link to nothing");
    }
    const std::string folder = folder_of(state->path);
    for (unsigned attempt = 0; attempt < 100; ++attempt) {
        // Short, so that names near the file system's limit still work.
        std::string temporary =
            folder + "/.steradian-" + std::to_string(::getpid()) + "-" + std::to_string(attempt) + ".tmp";
        state->file = Descriptor(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
        if (state->file.open()) {
            state->temporary = std::move(temporary);
            break;
        }
        if (errno != EEXIST)
            return file_error(ErrorCode::resources, path, "cannot write to the folder " + escape_for_display(folder),
                              errno);
    }
    if (!state->file.open()) return fail("cannot make a temporary file beside it");
    if (exists) (void)::fchmod(state->file.get(), mode);
    return AtomicFile(std::move(state));
}

Status AtomicFile::write(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t n = ::write(state_->file.get(), bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0)
            return file_error(ErrorCode::resources, state_->path, "cannot write the file", n < 0 ? errno : ENOSPC);
        bytes.remove_prefix(static_cast<size_t>(n));
    }
    return Ok{};
}

Status AtomicFile::commit() {
    State& s = *state_;
    if (::fsync(s.file.get()) != 0)
        return file_error(ErrorCode::resources, s.path, "cannot flush the file to the disk", errno);
    if (const int error = s.file.reset())
        return file_error(ErrorCode::resources, s.path, "cannot close the file", error);
    if (::rename(s.temporary.c_str(), s.path.c_str()) != 0)
        return file_error(ErrorCode::resources, s.path, "cannot put the file in place", errno);
    s.temporary.clear();
    // The rename itself must survive a power cut. File systems that cannot sync a folder say EINVAL: nothing to do
    // there.
    const Descriptor folder(::open(folder_of(s.path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (folder.open() && ::fsync(folder.get()) != 0 && errno != EINVAL)
        return file_error(ErrorCode::resources, s.path, "cannot flush the folder to the disk", errno);
    return Ok{};
}

Status replace_file(const std::string& path, std::string_view bytes) {
    auto file = AtomicFile::create(path);
    if (!file) return std::move(file).error();
    if (auto status = file->write(bytes); !status) return status;
    return file->commit();
}

Status check_writable(const std::string& path) {
    auto file = AtomicFile::create(path);
    if (!file) return std::move(file).error();
    return Ok{};
}

}  // namespace steradian
