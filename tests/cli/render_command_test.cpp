// The command as a user meets it: exit codes, messages, files that appear whole or not at all.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "base/names.h"
#include "program.h"
#include "steradian/image_io.h"

namespace steradian::test {
namespace {

namespace fs = std::filesystem;

class RenderCommand : public CommandTest {};

TEST_F(RenderCommand, WritesEveryFormatWithTheSamePicture) {
    const Outcome o =
        steradian({"render", "scene.json", "-o", "a.exr", "-o", "a.pfm", "-o", "a.hdr", "-o", "a.png", "--json"});
    ASSERT_EQ(o.code, 0) << o.err;
    for (const char* name : {"a.exr", "a.pfm"}) {
        const auto image = read_image(folder_.file(name));
        ASSERT_TRUE(image.ok()) << image.error().str();
        EXPECT_EQ(image_hash(*image), field(o.out, "hash")) << name;
    }
    EXPECT_TRUE(exists("a.hdr") && exists("a.png"));
    EXPECT_EQ(field(o.out, "width"), "32");
    EXPECT_EQ(field(o.out, "complete"), "true");
    EXPECT_EQ(field(o.out, "bad_samples"), "0");
    expect_files({"a.exr", "a.pfm", "a.hdr", "a.png"});
}

TEST_F(RenderCommand, WithoutOutputItWritesAPngNamedLikeTheScene) {
    EXPECT_EQ(steradian({"render", "scene.json", "-q"}).code, 0);
    expect_files({"scene.png"});
}

TEST_F(RenderCommand, AovsGoToTheExrFileAndColourToAll) {
    const Outcome plain = steradian({"render", "scene.json", "-o", "plain.png", "--json"});
    const Outcome o =
        steradian({"render", "scene.json", "--aovs", "normal,depth", "-o", "a.exr", "-o", "a.png", "--json"});
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_EQ(o.err.find("warning"), std::string::npos) << o.err;
    const auto image = read_image(folder_.file("a.exr"));
    ASSERT_TRUE(image.ok()) << image.error().str();
    EXPECT_EQ(image->channels, (std::vector<std::string>{"R", "G", "B", "Z", "N.X", "N.Y", "N.Z"}));
    EXPECT_EQ(image_hash(*image), field(o.out, "hash"));
    EXPECT_EQ(field(o.out, "color_hash"), field(plain.out, "hash"));
    EXPECT_EQ(image_hash(*read_image(folder_.file("a.png"))), image_hash(*read_image(folder_.file("plain.png"))));
    expect_files({"a.exr", "a.png", "plain.png"});
    const Outcome info = steradian({"info", "a.exr"});
    EXPECT_NE(info.out.find("N.X"), std::string::npos) << info.out;
    const Outcome converted = steradian({"convert", "a.exr", "b.png"});
    EXPECT_EQ(converted.code, 0);
    EXPECT_NE(converted.err.find("N.X"), std::string::npos) << converted.err;
    EXPECT_EQ(steradian({"diff", "a.exr", "a.exr"}).code, 0);
}

TEST_F(RenderCommand, AovsWithoutAnExrFileAreRefused) {
    for (const std::vector<std::string>& output : {std::vector<std::string>{"-o", "b.png"}, {"-o", "b.pfm"}}) {
        std::vector<std::string> arguments{"render", "scene.json", "--aovs", "all"};
        arguments.insert(arguments.end(), output.begin(), output.end());
        const Outcome o = steradian(arguments);
        EXPECT_EQ(o.code, 2);
        EXPECT_NE(o.err.find("need an EXR file"), std::string::npos) << o.err;
    }
    const Outcome unknown = steradian({"render", "scene.json", "--aovs", "depth,normals"});
    EXPECT_EQ(unknown.code, 2);
    EXPECT_NE(unknown.err.find("'normal'"), std::string::npos) << unknown.err;
    EXPECT_EQ(steradian({"render", "scene.json", "--aovs", "all", "--integrator", "ao"}).code, 2);
    // The default is a file that can hold them.
    EXPECT_EQ(steradian({"render", "scene.json", "--aovs", "uv", "-q"}).code, 0);
    expect_files({"scene.exr"});
}

TEST_F(RenderCommand, ATimeLimitGivesTheFileOfItsNumberOfSamples) {
    // The scene asks for a few samples only; time is what counts where it is given.
    const Outcome timed = steradian({"render", "scene.json", "--time-limit", "0.3s", "-o", "a.exr", "--json"});
    ASSERT_EQ(timed.code, 0) << timed.err;
    EXPECT_EQ(field(timed.out, "out_of_time"), "true");
    EXPECT_EQ(field(timed.out, "complete"), "true");
    const std::string samples = field(timed.out, "spp");
    EXPECT_EQ(field(timed.out, "min_samples"), samples);
    EXPECT_EQ(field(timed.out, "max_samples"), samples);
    EXPECT_NE(timed.err.find(" " + samples + " samples per pixel in"), std::string::npos) << timed.err;
    ASSERT_EQ(steradian({"render", "scene.json", "--spp", samples, "-o", "b.exr", "-q"}).code, 0);
    EXPECT_TRUE(slurp(folder_.file("a.exr")) == slurp(folder_.file("b.exr")));
    const Outcome most = steradian({"render", "scene.json", "--time-limit", "1h", "--spp", "3", "--json"});
    EXPECT_EQ(field(most.out, "out_of_time"), "false");
    EXPECT_EQ(field(most.out, "max_samples"), "3");
    expect_files({"a.exr", "b.exr"});
}

TEST_F(RenderCommand, ATargetForTheErrorIsReachedOrSaidToBeMissed) {
    const Outcome o = steradian({"render", "scene.json", "--target-error", "0.2", "-o", "a.exr", "--json"});
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_EQ(field(o.out, "certified"), "true");
    EXPECT_EQ(field(o.out, "confidence"), "0.95");
    EXPECT_LE(std::stod(field(o.out, "bound")), 0.2);
    EXPECT_LE(std::stod(field(o.out, "estimate")), std::stod(field(o.out, "bound")));
    EXPECT_LE(std::stod(field(o.out, "min_samples")), std::stod(field(o.out, "mean_samples")));
    EXPECT_LE(std::stod(field(o.out, "mean_samples")), std::stod(field(o.out, "max_samples")));
    EXPECT_NE(o.err.find("target error 0.2 reached"), std::string::npos) << o.err;
    const auto image = read_image(folder_.file("a.exr"));
    ASSERT_TRUE(image.ok());
    EXPECT_EQ(image->metadata.at("steradian:certified").substr(0, 19), "yes: error at most ");

    // With so few pixels and samples it cannot be, and that is said even where nothing else is.
    const Outcome missed = steradian({"render", "scene.json", "--target-error", "0.01", "--spp", "16", "--size",
                                      "40x40", "-q", "--json", "-o", "b.exr"});
    EXPECT_EQ(missed.code, 4);
    EXPECT_EQ(field(missed.out, "certified"), "false");
    EXPECT_EQ(field(missed.out, "complete"), "true");
    EXPECT_NE(missed.err.find("not certified"), std::string::npos) << missed.err;
    expect_files({"a.exr", "b.exr"});

    EXPECT_EQ(steradian({"render", "scene.json", "--target-error", "0.2", "--time-limit", "1s"}).code, 2);
    EXPECT_EQ(steradian({"render", "scene.json", "--target-error", "-1"}).code, 2);
    EXPECT_EQ(steradian({"render", "scene.json", "--target-error", "1e-9"}).code, 2);
    EXPECT_EQ(steradian({"render", "scene.json", "--target-error", "0.2", "--spp", "15"}).code, 2);

    const Outcome with_aovs = steradian({"render", "scene.json", "--target-error", "0.2", "--size", "40x40", "--aovs",
                                         "depth,samples", "-q", "-o", "c.exr"});
    EXPECT_EQ(with_aovs.code, 0) << with_aovs.err;
    EXPECT_NE(steradian({"info", "c.exr"}).out.find("samples.count"), std::string::npos);
}

TEST_F(RenderCommand, ATimeLimitIsATime) {
    for (const char* bad : {"x", "5d", "-1s", "0", "0s", "1e99s", "s", "nan", "1 s", "1s2"}) {
        const Outcome o = steradian({"render", "scene.json", std::string("--time-limit=") + bad, "-o", "c.png"});
        EXPECT_EQ(o.code, 2) << bad;
        EXPECT_NE(o.err.find("--time-limit"), std::string::npos) << o.err;
    }
    for (const char* good : {"1", "1s", "0.02m", "0.001h"})
        EXPECT_EQ(steradian({"render", "scene.json", "--spp", "1", "--time-limit", good, "-o", "c.pfm"}).code, 0)
            << good;
    expect_files({"c.pfm"});
}

TEST_F(RenderCommand, OptionsMayComeBeforeTheScene) {
    EXPECT_EQ(steradian({"render", "-q", "-o", "a.png", "-o", "b.png", "scene.json"}).code, 0);
    expect_files({"a.png", "b.png"});
}

TEST_F(RenderCommand, EqualPicturesAreEqualFiles) {
    ASSERT_EQ(steradian({"render", "scene.json", "-o", "a.exr", "-o", "a.png", "--threads", "1"}).code, 0);
    ASSERT_EQ(steradian({"render", "scene.json", "-o", "b.exr", "-o", "b.png", "--threads", "3", "--tile-size", "5",
                         "--bvh", "median"})
                  .code,
              0);
    EXPECT_EQ(slurp(folder_.file("a.exr")), slurp(folder_.file("b.exr")));
    EXPECT_EQ(slurp(folder_.file("a.png")), slurp(folder_.file("b.png")));
}

TEST_F(RenderCommand, OptionsReachThePicture) {
    const auto hash = [&](std::vector<std::string> options) {
        options.insert(options.begin(), {"render", "scene.json", "--json", "-q"});
        const Outcome o = steradian(options);
        EXPECT_EQ(o.code, 0) << o.err;
        return field(o.out, "hash");
    };
    const std::string plain = hash({});
    EXPECT_EQ(plain, hash({"--spp", "4", "--size", "32x24", "--camera", "front", "--sampler", "sobol", "--seed", "0"}));
    EXPECT_EQ(plain, hash({"--filter", "gaussian:1.5"}));
    for (const std::vector<std::string>& options : std::vector<std::vector<std::string>>{{"--spp", "5"},
                                                                                         {"--size", "33x24"},
                                                                                         {"--camera", "side"},
                                                                                         {"--camera", "1"},
                                                                                         {"--seed", "1"},
                                                                                         {"--sampler", "independent"},
                                                                                         {"--filter", "box"},
                                                                                         {"--filter", "tent:2"},
                                                                                         {"--max-depth", "0"},
                                                                                         {"--crop", "1,1,9,9"}})
        EXPECT_NE(plain, hash(options)) << options[0] << " " << options[1];
}

TEST_F(RenderCommand, UsageErrorsExitWith2AndSayWhatToDo) {
    const auto expect = [&](std::vector<std::string> arguments, const std::string& text) {
        const Outcome o = steradian(arguments);
        EXPECT_EQ(o.code, 2) << text << o.err;
        EXPECT_NE((o.out + o.err).find(text), std::string::npos) << o.err << o.out;
    };
    expect({}, "Examples:");
    expect({"rendre"}, "did you mean 'render'?");
    expect({"render"}, "SCENE is required");
    expect({"render", "scene.json", "--spp", "many"}, "--spp");
    expect({"render", "scene.json", "--spp", "-1"}, "--spp: expected a whole number from 1 to 1000000000, not '-1'");
    expect({"render", "scene.json", "--spp", "0"}, "whole number from 1 to");
    expect({"render", "scene.json", "--spp", "9223372036854775808"}, "whole number from 1 to");
    expect({"render", "scene.json", "--size", "10"}, "WIDTHxHEIGHT");
    expect({"render", "scene.json", "--size", "0x5"}, "at least 1");
    expect({"render", "scene.json", "--sampler", "sobl"}, "did you mean 'sobol'?");
    expect({"render", "scene.json", "--integrator", "Direct"}, "did you mean 'direct'?");
    expect({"render", "scene.json", "--bvh", "meidan"}, "did you mean 'median'?");
    expect({"render", "scene.json", "--isa", "avx22"}, "did you mean 'avx2'?");
    expect({"render", "scene.json", "--isa", "mmx"}, "expected one of auto, scalar, ");
    expect({"render", "scene.json", "--view", "agxx"}, "did you mean 'agx'?");
    expect({"render", "scene.json", "--spps", "4"}, "did you mean '--spp'?");
    expect({"render", "scene.json", "--max-dept=4"}, "did you mean '--max-depth'?");
    expect({"render", "scene.json", "--xylophone"}, "steradian render --help shows what there is");
    expect({"help", "rendre"}, "did you mean 'render'?");
    expect({"render", "scene.json", "--filter", "gausian"}, "did you mean 'gaussian'?");
    expect({"render", "scene.json", "--camera", "frnt"}, "did you mean 'front'?");
    expect({"render", "scene.json", "--crop", "1,2,3"}, "X0,Y0,X1,Y1");
    expect({"render", "scene.json", "--crop", "0,0,33,5"}, "leaves the picture");
    expect({"render", "scene.json", "-o", "a.jpeg"}, "unknown picture format");
    expect({"render", "scene.json", "-o", "a.png", "-o", "a.png"}, "given twice");
    expect({"render", "scene.json", "--threads", "100000"}, "--threads");
    expect_files({});
}

TEST_F(RenderCommand, HelpNamesEveryIntegrator) {
    const std::string help = steradian({"render", "--help"}).out;
    const size_t begin = help.find("--integrator"), end = help.find("--max-depth");
    ASSERT_TRUE(begin < end && end != std::string::npos);
    const std::string about = help.substr(begin, end - begin);
    for (const std::string_view name : names_of<IntegratorKind>())
        EXPECT_NE(about.find(name), std::string::npos) << name << about;
}

TEST_F(RenderCommand, HelpAndVersionExitWith0) {
    for (const std::vector<std::string>& arguments :
         std::vector<std::vector<std::string>>{{"--help"}, {"--version"}, {"render", "--help"}, {"info", "--help"}}) {
        const Outcome o = steradian(arguments);
        EXPECT_EQ(o.code, 0);
        EXPECT_FALSE(o.out.empty());
    }
    EXPECT_EQ(steradian({"help"}).out, steradian({"--help"}).out);
    EXPECT_EQ(steradian({"help", "render"}).out, steradian({"render", "--help"}).out);
    EXPECT_EQ(steradian({"help", "--help"}).code, 0);
}

TEST_F(RenderCommand, BadScenesExitWith3AndLeaveTheOldPictureAlone) {
    spit(folder_.file("old.png"), "precious");
    spit(folder_.file("bad.json"), "{\"version\": 1, \"camra\": {}}");
    const Outcome o = steradian({"render", "bad.json", "-o", "old.png"});
    EXPECT_EQ(o.code, 3);
    EXPECT_EQ(o.err.rfind("bad.json:1:16: error: ", 0), 0u) << o.err;
    EXPECT_NE(o.err.find("did you mean 'camera'?"), std::string::npos) << o.err;
    EXPECT_EQ(slurp(folder_.file("old.png")), "precious");
    EXPECT_EQ(steradian({"render", "missing.json"}).code, 3);
    EXPECT_EQ(steradian({"render", "."}).code, 3);
    EXPECT_EQ(steradian({"render", "/dev/zero"}).code, 3);
    EXPECT_EQ(steradian({"info", "missing.exr"}).code, 3);
    expect_files({"old.png", "bad.json"});
}

TEST_F(RenderCommand, OutputsThatCannotWorkAreRefusedBeforeLoading) {
    fs::create_directory(folder_.file("folder.png"));
    fs::create_symlink("nowhere/x", folder_.file("dangling.png"));
    for (const char* path : {"missing/a.png", "folder.png", "dangling.png", "scene.json/a.png"}) {
        const Outcome o = steradian({"render", "missing.json", "-o", path});
        EXPECT_EQ(o.code, 4) << path << o.err;
        EXPECT_NE(o.err.find(path), std::string::npos) << o.err;
    }
}

TEST_F(RenderCommand, AWriteThatFailsKeepsTheOldFile) {
    spit(folder_.file("a.pfm"), "precious");
    const Outcome o =
        Process(folder_, {"render", "scene.json", "--size", "200x200", "--spp", "1", "-o", "a.pfm"}, limit_files<4096>)
            .wait();
    EXPECT_EQ(o.code, 4) << o.err;
    EXPECT_EQ(slurp(folder_.file("a.pfm")), "precious");
    expect_files({"a.pfm"});
}

TEST_F(RenderCommand, TooLargePicturesAreRefused) {
    EXPECT_EQ(steradian({"render", "scene.json", "--size", "1000000x1000000"}).code, 4);
    EXPECT_EQ(steradian({"render", "scene.json", "--size", "4294967295x1"}).code, 4);
    EXPECT_EQ(steradian({"render", "scene.json", "--size", "99999999999x1"}).code, 2);
}

TEST_F(RenderCommand, StrangeNamesWork) {
    for (const char* name : {"with space.json", "d%20.json", "\xf0\x9f\x90\xb0.json", "\xff\xfe.json", "-dash.json"}) {
        spit(folder_.file(name), kScene);
        const std::string path = name[0] == '-' ? std::string("./") + name : name;
        EXPECT_EQ(steradian({"render", path, "-o", "x.png", "--spp", "1", "-q"}).code, 0) << name;
    }
    const Outcome o = steradian({"render", "\x1b[31mred.json"});
    EXPECT_EQ(o.code, 3);
    EXPECT_EQ(o.err.find('\x1b'), std::string::npos);
}

TEST_F(RenderCommand, TheLocaleDoesNotMatter) {
    const std::string expected = field(steradian({"render", "scene.json", "--json"}).out, "hash");
    for (const char* locale : {"de_DE.UTF-8", "C", "tr_TR.UTF-8"}) {
        ::setenv("LC_ALL", locale, 1);
        EXPECT_EQ(field(steradian({"render", "scene.json", "--json"}).out, "hash"), expected);
    }
    ::unsetenv("LC_ALL");
}

TEST_F(RenderCommand, InfoTellsWhatIsInAScene) {
    const Outcome o = steradian({"info", "scene.json"});
    EXPECT_EQ(o.code, 0) << o.err;
    for (const char* text : {"front, side", "1 point", "1 environment", "32x24"})
        EXPECT_NE(o.out.find(text), std::string::npos) << o.out;
    const Outcome json = steradian({"info", "scene.json", "--json"});
    EXPECT_EQ(field(json.out, "objects"), "1") << json.out;
}

}  // namespace
}  // namespace steradian::test
