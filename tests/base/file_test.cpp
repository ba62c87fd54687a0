#include "base/file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <set>

#include "support/support.h"

namespace steradian {
namespace {

namespace fs = std::filesystem;
using test::slurp;
using test::spit;
using test::TemporaryFolder;

void expect_refused(const std::string& path, ErrorCode code, const std::string& word) {
    const auto result = read_file(path, 1000);
    ASSERT_FALSE(result) << path;
    EXPECT_EQ(result.error().code, code) << path;
    EXPECT_NE(result.error().message.find(word), std::string::npos) << result.error().message;
    EXPECT_EQ(result.error().where.file, path);
}

/// Nothing in the folder but these.
void expect_entries(const fs::path& folder, std::set<std::string> names) {
    std::set<std::string> found;
    for (const auto& entry : fs::directory_iterator(folder)) found.insert(entry.path().filename().string());
    EXPECT_EQ(found, names);
}

/// Runs in a child process, whose limits and death are its own. Gives its wait status.
template <class F>
int in_child(F body) {
    const pid_t child = ::fork();
    if (child == 0) {
        body();
        ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return status;
}

/// What `good` says in a child process that permissions bind: root is above them.
template <class F>
void expect_as_ordinary_user(F good) {
    const int status = in_child([&] {
        if (::geteuid() == 0 && (::setgid(65534) != 0 || ::setuid(65534) != 0)) ::_exit(2);
        ::_exit(good() ? 0 : 1);
    });
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

TEST(ReadFile, ReadsWholeFiles) {
    const TemporaryFolder folder;
    std::string bytes;
    for (int i = 0; i < 1000; ++i) bytes += static_cast<char>(i);
    spit(folder.file("a"), bytes);
    spit(folder.file("empty"), "");
    fs::create_symlink("a", folder.file("link"));
    EXPECT_EQ(*read_file(folder.file("a"), 1000), bytes);
    EXPECT_EQ(*read_file(folder.file("link"), 1000), bytes);
    EXPECT_EQ(*read_file(folder.file("empty"), 0), "");
    const auto long_one = read_file(folder.file("a"), 999);
    ASSERT_FALSE(long_one);
    EXPECT_EQ(long_one.error().code, ErrorCode::resources);
}

TEST(ReadFile, RefusesWhatIsNoFile) {
    const TemporaryFolder folder;
    ASSERT_EQ(::mkfifo(folder.file("pipe").c_str(), 0600), 0);
    fs::create_symlink("nothing", folder.file("dangling"));
    fs::create_symlink("loop", folder.file("loop"));
    fs::create_symlink(folder.file("pipe"), folder.file("link to pipe"));
    expect_refused(folder.file("missing"), ErrorCode::bad_input, "No such file");
    expect_refused(folder.path().string(), ErrorCode::bad_input, "folder");
    expect_refused(folder.file("pipe"), ErrorCode::bad_input, "pipe");  // and does not wait for a writer
    expect_refused(folder.file("link to pipe"), ErrorCode::bad_input, "pipe");
    expect_refused(folder.file("dangling"), ErrorCode::bad_input, "No such file");
    expect_refused(folder.file("loop"), ErrorCode::bad_input, "cannot open");
    expect_refused("/dev/zero", ErrorCode::bad_input, "device");
    expect_refused("/dev/full", ErrorCode::bad_input, "device");
    expect_refused("", ErrorCode::bad_input, "cannot open");
    expect_refused(std::string("a\0b", 3), ErrorCode::bad_input, "NUL");
    expect_refused(folder.file(std::string(5000, 'x')), ErrorCode::bad_input, "too long");
}

TEST(ReadFile, RefusesWhatIsUnreadable) {
    const TemporaryFolder folder;
    const std::string path = folder.file("secret");
    spit(path, "x");
    fs::permissions(folder.path(), fs::perms::all);
    fs::permissions(path, fs::perms::none);
    expect_as_ordinary_user([&] {
        const auto result = read_file(path, 1000);
        return !result && result.error().code == ErrorCode::bad_input &&
               result.error().message.find("denied") != std::string::npos;
    });
}

TEST(ReplaceFile, CreatesAndReplacesAsAWhole) {
    const TemporaryFolder folder;
    const std::string path = folder.file("out");
    ASSERT_TRUE(replace_file(path, "one"));
    EXPECT_EQ(slurp(path), "one");
    ASSERT_EQ(::chmod(path.c_str(), 0640), 0);
    ASSERT_TRUE(replace_file(path, "second"));
    EXPECT_EQ(slurp(path), "second");
    struct stat info {};
    ASSERT_EQ(::stat(path.c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 07777, 0640u);
    expect_entries(folder.path(), {"out"});
}

TEST(AtomicFile, AbandonedLeavesTheOldFile) {
    const TemporaryFolder folder;
    const std::string path = folder.file("out");
    spit(path, "old");
    {
        auto file = AtomicFile::create(path);
        ASSERT_TRUE(file);
        ASSERT_TRUE(file->write("half of the n"));
        EXPECT_EQ(slurp(path), "old");
    }
    EXPECT_EQ(slurp(path), "old");
    expect_entries(folder.path(), {"out"});
}

TEST(AtomicFile, MovesAndSharesAFolder) {
    const TemporaryFolder folder;
    auto a = AtomicFile::create(folder.file("a")), b = AtomicFile::create(folder.file("b"));
    ASSERT_TRUE(a && b);
    ASSERT_TRUE(a->write("A") && b->write("B"));
    AtomicFile moved = *std::move(a);
    *b = std::move(moved);  // what b had is given up
    ASSERT_TRUE(b->commit());
    EXPECT_EQ(slurp(folder.file("a")), "A");
    expect_entries(folder.path(), {"a"});
}

TEST(AtomicFile, FollowsALinkAndRefusesADanglingOne) {
    const TemporaryFolder folder;
    fs::create_directory(folder.file("elsewhere"));
    spit(folder.file("elsewhere/real"), "old");
    fs::create_symlink("elsewhere/real", folder.file("link"));
    ASSERT_TRUE(replace_file(folder.file("link"), "new"));
    EXPECT_TRUE(fs::is_symlink(folder.file("link")));
    EXPECT_EQ(slurp(folder.file("elsewhere/real")), "new");
    expect_entries(folder.file("elsewhere"), {"real"});

    fs::create_symlink("nothing", folder.file("dangling"));
    const auto status = replace_file(folder.file("dangling"), "x");
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, ErrorCode::resources);
    EXPECT_FALSE(fs::exists(folder.file("nothing")));
}

TEST(AtomicFile, RefusesImpossiblePlaces) {
    const TemporaryFolder folder;
    ASSERT_EQ(::mkfifo(folder.file("pipe").c_str(), 0600), 0);
    spit(folder.file("file"), "");
    for (const std::string& path :
         {folder.path().string(), folder.file("pipe"), folder.file("missing/out"), std::string(),
          folder.file("file/out"), std::string("/dev/full"), std::string("a\0b", 3)}) {
        for (const Status& status : {replace_file(path, "x"), check_writable(path)}) {
            ASSERT_FALSE(status) << path;
            EXPECT_EQ(status.error().code, ErrorCode::resources) << path;
        }
    }
    expect_entries(folder.path(), {"file", "pipe"});
}

TEST(AtomicFile, RefusesAReadOnlyFolderOrFile) {
    const TemporaryFolder folder;
    const std::string path = folder.file("file");
    spit(path, "old");
    const auto refused = [](const Status& status) {
        return !status && status.error().code == ErrorCode::resources &&
               status.error().message.find("denied") != std::string::npos;
    };
    fs::permissions(folder.path(), fs::perms::all);
    fs::permissions(path, fs::perms::owner_read | fs::perms::others_read);
    expect_as_ordinary_user([&] { return refused(replace_file(path, "x")); });
    fs::permissions(path, fs::perms::all);
    fs::permissions(folder.path(), fs::perms::owner_all | fs::perms::others_read | fs::perms::others_exec);
    expect_as_ordinary_user([&] {
        return ::geteuid() != 65534 ||
               (refused(check_writable(folder.file("new"))) && refused(replace_file(path, "x")));
    });
    EXPECT_EQ(slurp(path), "old");
    expect_entries(folder.path(), {"file"});
}

TEST(CheckWritable, LeavesNothingBehind) {
    const TemporaryFolder folder;
    ASSERT_TRUE(check_writable(folder.file("new")));
    expect_entries(folder.path(), {});
    spit(folder.file("old"), "old");
    ASSERT_TRUE(check_writable(folder.file("old")));
    EXPECT_EQ(slurp(folder.file("old")), "old");
    expect_entries(folder.path(), {"old"});
}

// The disk is full after 4096 bytes.
TEST(AtomicFile, AFullDiskLeavesTheOldFile) {
    const TemporaryFolder folder;
    const std::string path = folder.file("out");
    spit(path, "old");
    const int status = in_child([&] {
        ::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{4096, 4096};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        const auto result = replace_file(path, std::string(10000, 'x'));
        ::_exit(!result && result.error().code == ErrorCode::resources ? 7 : 1);
    });
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 7);
    EXPECT_EQ(slurp(path), "old");
    expect_entries(folder.path(), {"out"});
}

// Killed at any moment, the file is the old one or the new one; a later run is not disturbed by what is left.
TEST(AtomicFile, AKilledWriterLeavesTheOldFile) {
    const TemporaryFolder folder;
    const std::string path = folder.file("out");
    spit(path, "old");
    const int status = in_child([&] {
        auto file = AtomicFile::create(path);
        (void)file->write("part");
        ::raise(SIGKILL);
    });
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(slurp(path), "old");
    ASSERT_TRUE(replace_file(path, "new"));
    EXPECT_EQ(slurp(path), "new");
}

}  // namespace
}  // namespace steradian
