// Running the program as a user does.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "support/support.h"

namespace steradian::test {

struct Outcome {
    int code = -1;   ///< exit code
    int signal = 0;  ///< that ended it, 0: none
    std::string out, err;
};

/// The program as a child process; output goes to files in `folder`, which is also its working directory.
class Process {
public:
    Process(const TemporaryFolder& folder, const std::vector<std::string>& arguments, uint64_t max_file_bytes = 0)
        : out_(folder.file("stdout.txt")), err_(folder.file("stderr.txt")) {
        std::vector<std::string> all{STERADIAN_PROGRAM};
        all.insert(all.end(), arguments.begin(), arguments.end());
        std::vector<char*> argv;
        for (std::string& a : all) argv.push_back(a.data());
        argv.push_back(nullptr);
        pid_ = ::fork();
        if (pid_ != 0) return;
        const int null = ::open("/dev/null", O_RDONLY), out = ::open(out_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600),
                  err = ::open(err_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        ::dup2(null, 0), ::dup2(out, 1), ::dup2(err, 2);
        if (::chdir(folder.path().c_str()) != 0) ::_exit(126);
        if (max_file_bytes) limit_files(max_file_bytes);
        ::execv(argv[0], argv.data());
        ::_exit(127);
    }
    ~Process() {
        if (pid_ > 0) ::kill(pid_, SIGKILL), ::waitpid(pid_, nullptr, 0);
    }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    void send(int signal) const { ::kill(pid_, signal); }
    Outcome wait() {
        int status = 0;
        ::waitpid(pid_, &status, 0);
        pid_ = 0;
        Outcome o;
        if (WIFEXITED(status)) o.code = WEXITSTATUS(status);
        if (WIFSIGNALED(status)) o.signal = WTERMSIG(status);
        o.out = slurp(out_), o.err = slurp(err_);
        return o;
    }

private:
    static void limit_files(uint64_t bytes) {
        const rlimit limit{bytes, bytes};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    std::string out_, err_;
    pid_t pid_ = 0;
};

inline Outcome run(const TemporaryFolder& folder, const std::vector<std::string>& arguments) {
    return Process(folder, arguments).wait();
}

}  // namespace steradian::test
