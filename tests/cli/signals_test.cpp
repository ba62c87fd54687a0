// What signals do to a render: it ends with what is done, at once, or goes on as if nothing had been.
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace steradian::test
