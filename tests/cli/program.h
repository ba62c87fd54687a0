// Running the program as a user does.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "support/support.h"

namespace steradian::test {

struct Outcome {
    int code = -1;   ///< exit code
    int signal = 0;  ///< that ended it, 0: none
    std::string out, err;
    uint64_t peak_bytes = 0;  ///< the most memory that was resident
    double cpu_seconds = 0;   ///< of all its threads
};

template <uint64_t kBytes>
void limit_files() {
    const rlimit limit{kBytes, kBytes};
    ::setrlimit(RLIMIT_FSIZE, &limit);
}

template <uint64_t kBytes>
void limit_memory() {
    const rlimit limit{kBytes, kBytes};
    ::setrlimit(RLIMIT_AS, &limit);
}

/// The sanitizers reserve more address space than any limit would leave, and keep what was freed.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

inline void full_stdout() { ::dup2(::open("/dev/full", O_WRONLY), 1); }

/// The program as a child process; output goes to files in `folder`, which is also its working directory.
class Process {
public:
    /// `before` runs in the child, before the program does.
    Process(const TemporaryFolder& folder, const std::vector<std::string>& arguments, void (*before)() = nullptr)
        : out_(folder.file("stdout.txt")), err_(folder.file("stderr.txt")) {
        std::vector<std::string> all{STERADIAN_PROGRAM};
        all.insert(all.end(), arguments.begin(), arguments.end());
        std::vector<char*> argv;
        for (std::string& a : all) argv.push_back(a.data());
        argv.push_back(nullptr);
        std::filesystem::remove(err_);  // shows_progress must not see that of an earlier process
        pid_ = ::fork();
        if (pid_ != 0) return;
        const int null = ::open("/dev/null", O_RDONLY), out = ::open(out_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600),
                  err = ::open(err_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        ::dup2(null, 0), ::dup2(out, 1), ::dup2(err, 2);
        if (::chdir(folder.path().c_str()) != 0) ::_exit(126);
        for (const int number : {SIGINT, SIGTERM, SIGHUP}) ::signal(number, SIG_DFL);  // however the tests were started
        if (before) before();
        ::execv(argv[0], argv.data());
        ::_exit(127);
    }
    ~Process() {
        if (pid_ > 0) ::kill(pid_, SIGKILL), ::waitpid(pid_, nullptr, 0);
    }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    void send(int signal) const { ::kill(pid_, signal); }
    /// Waits for the first line of progress: the render is then under way. False when none comes within two minutes.
    bool shows_progress() const {
        for (int i = 0; i < 2400; ++i) {
            if (std::filesystem::exists(err_) && std::filesystem::file_size(err_) > 0) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
        return false;
    }
    /// Waits for it to stand still after a SIGSTOP; false when it ended before that.
    bool stands_still() {
        int status = 0;
        if (::waitpid(pid_, &status, WUNTRACED) != pid_) return false;
        if (!WIFSTOPPED(status)) pid_ = 0;
        return WIFSTOPPED(status);
    }
    Outcome wait() {
        int status = 0;
        rusage usage{};
        ::wait4(pid_, &status, 0, &usage);
        pid_ = 0;
        Outcome o;
        for (const timeval t : {usage.ru_utime, usage.ru_stime})
            o.cpu_seconds += static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
        o.peak_bytes = static_cast<uint64_t>(usage.ru_maxrss) * 1024;
        if (WIFEXITED(status)) o.code = WEXITSTATUS(status);
        if (WIFSIGNALED(status)) o.signal = WTERMSIG(status);
        o.out = slurp(out_), o.err = slurp(err_);
        return o;
    }

private:
    std::string out_, err_;
    pid_t pid_ = 0;
};

inline Outcome run(const TemporaryFolder& folder, const std::vector<std::string>& arguments) {
    return Process(folder, arguments).wait();
}

inline constexpr const char* kScene = R"({
  "version": 1,
  "render": {"spp": 4},
  "film": {"resolution": [32, 24]},
  "cameras": {"front": {"position": [0, 0, 5], "look_at": [0, 0, 0]}, "side": {"position": [5, 0, 0], "look_at": [0, 0, 0]}},
  "materials": {"white": {"type": "diffuse", "reflectance": [0.8, 0.8, 0.8]}},
  "objects": [{"type": "sphere", "radius": 1, "material": "white"}],
  "lights": [{"type": "environment", "radiance": [1, 1, 1]}, {"type": "point", "position": [2, 2, 2], "flux": [50, 50, 50]}]
})";

/// A folder with scene.json in it.
class CommandTest : public testing::Test {
protected:
    CommandTest() { spit(folder_.file("scene.json"), kScene); }

    Outcome steradian(const std::vector<std::string>& arguments) { return run(folder_, arguments); }
    bool exists(const std::string& name) const { return std::filesystem::exists(folder_.file(name)); }
    /// Nothing but these files is in the folder: no leftovers.
    void expect_files(std::vector<std::string> names) const {
        names.insert(names.end(), {"scene.json", "stdout.txt", "stderr.txt"});
        for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
            EXPECT_NE(std::find(names.begin(), names.end(), entry.path().filename()), names.end()) << entry.path();
    }
    static std::string field(const std::string& json, const std::string& key) {
        const size_t at = json.find("\"" + key + "\":");
        if (at == std::string::npos) return "(no " + key + ")";
        const size_t begin = json.find_first_not_of(" \"", at + key.size() + 3);
        return json.substr(begin, json.find_first_of("\",\n", begin) - begin);
    }

    TemporaryFolder folder_;
};

/// A binary PLY file with a grid of 2 n² triangles.
inline std::string grid_ply(uint32_t n) {
    const uint32_t vertices = (n + 1) * (n + 1), faces = 2 * n * n;
    std::string ply = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(vertices) +
                      "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(faces) +
                      "\nproperty list uchar uint vertex_indices\nend_header\n";
    const auto put = [&](auto value) {
        char bytes[sizeof value];
        std::memcpy(bytes, &value, sizeof value);
        ply.append(bytes, sizeof value);
    };
    for (uint32_t y = 0; y <= n; ++y)
        for (uint32_t x = 0; x <= n; ++x)
            put(static_cast<float>(x)), put(static_cast<float>(y)), put(static_cast<float>(x * 7 % 11));
    for (uint32_t y = 0; y < n; ++y)
        for (uint32_t x = 0; x < n; ++x) {
            const uint32_t a = y * (n + 1) + x, b = a + n + 1;
            put(uint8_t(3)), put(a), put(a + 1), put(b + 1);
            put(uint8_t(3)), put(a), put(b + 1), put(b);
        }
    return ply;
}

}  // namespace steradian::test
