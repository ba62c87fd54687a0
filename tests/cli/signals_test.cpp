// What signals do to a render: it ends with what is done, at once, or goes on as if nothing had been.
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>

#include <chrono>
#include <thread>

#include "program.h"
#include "steradian/image_io.h"

namespace steradian::test {
namespace {

using Milliseconds = std::chrono::milliseconds;

class RenderSignal : public CommandTest, public testing::WithParamInterface<std::pair<int, int>> {};

TEST_P(RenderSignal, StopsWithWhatIsDone) {
    Process process(folder_, {"render", "scene.json", "--spp", "1000000000", "-o", "a.exr", "--json"});
    ASSERT_TRUE(process.shows_progress());
    const auto begin = std::chrono::steady_clock::now();
    process.send(GetParam().first);
    const Outcome o = process.wait();
    EXPECT_LT(std::chrono::steady_clock::now() - begin,
              std::chrono::seconds(20));  // 2 s are promised, on a machine with nothing else to do
    EXPECT_EQ(o.code, GetParam().second) << o.err;
    EXPECT_EQ(field(o.out, "complete"), "false");
    const auto image = read_image(folder_.file("a.exr"));
    ASSERT_TRUE(image.ok()) << image.error().str();
    EXPECT_EQ(image_hash(*image), field(o.out, "hash"));
    EXPECT_TRUE(image->metadata.count("steradian:partial"));
    expect_files({"a.exr"});
}

INSTANTIATE_TEST_SUITE_P(Each, RenderSignal,
                         testing::Values(std::pair{SIGINT, 130}, std::pair{SIGTERM, 143}, std::pair{SIGHUP, 129}));

class Signals : public CommandTest {};

TEST_F(Signals, ARenderWithATimeLimitStopsWithWhatIsDone) {
    Process process(folder_, {"render", "scene.json", "--time-limit", "10h", "-o", "a.exr", "--json"});
    ASSERT_TRUE(process.shows_progress());
    process.send(SIGINT);
    const Outcome o = process.wait();
    EXPECT_EQ(o.code, 130) << o.err;
    EXPECT_EQ(field(o.out, "complete"), "false");
    EXPECT_EQ(field(o.out, "out_of_time"), "false");
    const auto image = read_image(folder_.file("a.exr"));
    ASSERT_TRUE(image.ok()) << image.error().str();
    EXPECT_TRUE(image->metadata.count("steradian:partial"));
}

TEST_F(Signals, AStoppedAndContinuedRenderMakesTheSamePicture) {
    const std::vector<std::string> arguments{"render", "scene.json", "--size", "128x96",
                                             "--spp",  "256",        "-q",     "--json"};
    const std::string expected = field(steradian(arguments).out, "hash");
    Process process(folder_, arguments);
    int stops = 0;
    for (; stops < 3; ++stops) {
        std::this_thread::sleep_for(Milliseconds(20));
        process.send(SIGSTOP);
        if (!process.stands_still()) break;
        std::this_thread::sleep_for(Milliseconds(20));
        process.send(SIGCONT);
    }
    ASSERT_EQ(stops, 3) << "it ended before it could be stopped";
    const Outcome o = process.wait();
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_EQ(field(o.out, "complete"), "true");
    EXPECT_EQ(field(o.out, "hash"), expected);
}

// Two signals, since one that comes twice at once is delivered once. Either may be the last.
TEST_F(Signals, ASecondSignalEndsTheRenderAtOnceAndLeavesTheFilesAlone) {
    for (const int delay : {0, 10, 150}) {
        spit(folder_.file("a.exr"), "precious");
        Process process(folder_, {"render", "scene.json", "--size", "1500x1500", "--spp", "1000000", "-o", "a.exr"});
        ASSERT_TRUE(process.shows_progress());
        process.send(SIGINT);
        std::this_thread::sleep_for(Milliseconds(delay));
        process.send(SIGTERM);
        const auto begin = std::chrono::steady_clock::now();
        const Outcome o = process.wait();
        EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
        EXPECT_TRUE(o.code == 130 || o.code == 143) << o.code << ", signal " << o.signal;
        // The old file or the whole new one, whatever the second signal met.
        if (slurp(folder_.file("a.exr")) != "precious") {
            const auto image = read_image(folder_.file("a.exr"));
            EXPECT_TRUE(image.ok()) << image.error().str();
        }
    }
}

/// A terminal for the program's messages, where every step is shown at once.
struct Terminal {
    int ours = -1;
    static inline int programs = -1;  ///< its end; what runs in the child cannot capture

    Terminal() { EXPECT_EQ(::openpty(&ours, &programs, nullptr, nullptr, nullptr), 0); }
    ~Terminal() { ::close(ours), ::close(programs); }
    /// Adds to `text` what is shown, until it contains `wanted` or nothing has come for so long.
    bool shows(const std::string& wanted, std::string& text, Milliseconds patience) const {
        char part[4096];
        while (text.find(wanted) == std::string::npos) {
            pollfd wait{ours, POLLIN, 0};
            if (::poll(&wait, 1, int(patience.count())) <= 0) return false;
            const ssize_t size = ::read(ours, part, sizeof(part));
            if (size <= 0) return false;
            text.append(part, size_t(size));
        }
        return true;
    }
};

/// The build of this hierarchy takes seconds: the signal comes long before its end.
TEST_F(Signals, TheBuildOfAHierarchyIsShownAndStops) {
    spit(folder_.file("grid.ply"), grid_ply(700));
    spit(folder_.file("a.exr"), "precious");
    const Terminal terminal;
    Process process(folder_, {"render", "grid.ply", "--bvh", "high-quality", "--threads", "1", "-o", "a.exr"},
                    [] { ::dup2(Terminal::programs, 2); });
    std::string text;
    ASSERT_TRUE(terminal.shows("of the hierarchy built", text, std::chrono::minutes(2))) << text;
    ASSERT_TRUE(terminal.shows("ETA 0:0", text, std::chrono::minutes(2))) << text;
    process.send(SIGINT);
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_TRUE(
        terminal.shows("stopped before the hierarchy was built: nothing was written", text, std::chrono::minutes(2)))
        << text;
    EXPECT_EQ(process.wait().code, 130) << text;
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
    EXPECT_EQ(slurp(folder_.file("a.exr")), "precious");
    expect_files({"a.exr", "grid.ply"});
}

}  // namespace
}  // namespace steradian::test
