// What the commands refuse to replace or to guess, and what becomes of writes that fail.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "program.h"
#include "steradian/image_io.h"

namespace steradian::test {
namespace {

namespace fs = std::filesystem;

class FilesAndArguments : public CommandTest {
protected:
    void expect_usage(const std::vector<std::string>& arguments, const std::string& text) {
        const Outcome o = steradian(arguments);
        EXPECT_EQ(o.code, 2) << text << o.err;
        EXPECT_NE(o.err.find(text), std::string::npos) << o.err;
        EXPECT_EQ(o.err.rfind("error: ", 0), 0u) << o.err;
    }
    void render_to(const std::string& name) {
        ASSERT_EQ(steradian({"render", "scene.json", "--spp", "1", "-q", "-o", name}).code, 0);
    }
};

TEST_F(FilesAndArguments, RenderNeverReplacesWhatTheSceneWasReadFrom) {
    render_to("wood.png");
    std::string scene = kScene;
    scene.insert(scene.find("\"objects\""), R"("textures": {"wood": {"type": "image", "path": "wood.png"}}, )");
    const std::string white = "[0.8, 0.8, 0.8]";
    scene.replace(scene.find(white), white.size(), "\"wood\"");
    spit(folder_.file("wood.json"), scene);
    fs::create_symlink("wood.png", folder_.file("link.png"));
    fs::create_hard_link(folder_.file("wood.png"), folder_.file("hard.png"));
    const std::string before = slurp(folder_.file("wood.png"));
    for (const char* output : {"wood.png", "./wood.png", "link.png", "hard.png"})
        expect_usage({"render", "wood.json", "--spp", "1000000", "-o", output}, "would replace the input");
    expect_usage({"render", "wood.json", "--spp", "1000000"}, "would replace the input");  // by its default name
    EXPECT_EQ(slurp(folder_.file("wood.png")), before);
    EXPECT_EQ(steradian({"render", "wood.json", "--spp", "1", "-q", "-o", "other.png"}).code, 0);
}

TEST_F(FilesAndArguments, ConvertAndDiffNeverReplaceTheirInputs) {
    render_to("a.png"), render_to("b.exr");
    const std::string a = slurp(folder_.file("a.png")), b = slurp(folder_.file("b.exr"));
    expect_usage({"convert", "a.png", "./a.png"}, "would replace the input");
    expect_usage({"diff", "a.png", "b.exr", "--output", "a.png"}, "would replace the input");
    expect_usage({"diff", "a.png", "b.exr", "--output", "./b.exr"}, "would replace the input");
    EXPECT_EQ(slurp(folder_.file("a.png")), a);
    EXPECT_EQ(slurp(folder_.file("b.exr")), b);
    EXPECT_EQ(steradian({"diff", "a.png", "a.png", "--output", "d.pfm"}).code, 0);
}

TEST_F(FilesAndArguments, OptionsForGltfFilesAreRefusedForOthers) {
    const std::vector<std::vector<std::string>> options{{"--variant", "red"},
                                                        {"--gltf-light-units", "photometric"},
                                                        {"--gltf-memory", "10"},
                                                        {"--allow-outside-paths"}};
    spit(folder_.file("m.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    for (const std::vector<std::string>& option : options)
        for (const char* scene : {"scene.json", "m.obj"})
            for (std::vector<std::string> command :
                 {std::vector<std::string>{"render", scene, "--spp", "1", "-o", "a.png"},
                  {"replay", scene, "--pixel", "1,1", "--sample", "0"}}) {
                command.insert(command.end(), option.begin(), option.end());
                expect_usage(command, option[0] + ": this is for glTF files");
            }
    EXPECT_FALSE(exists("a.png"));
    // Where they have an effect they are taken: the name in upper case is one of glTF too.
    spit(folder_.file("m.GLTF"), "{\"asset\": {\"version\": \"2.0\"}, \"nodes\": [{}]}");
    EXPECT_NE(steradian({"render", "m.GLTF", "--gltf-memory", "10", "--spp", "1", "-q", "-o", "a.png"}).code, 2);
}

TEST_F(FilesAndArguments, AnEnvironmentIsTurnedWhereThereIsOne) {
    const std::string with = slurp(folder_.file("scene.json")),
                      light = "{\"type\": \"environment\", \"radiance\": [1, 1, 1]}, ";
    std::string without = with;
    ASSERT_NE(without.find(light), std::string::npos);
    without.replace(without.find(light), light.size(), "");
    spit(folder_.file("without.json"), without);
    const auto render = [](const std::string& scene, const std::vector<std::string>& more) {
        std::vector<std::string> command{"render", scene, "--spp", "1", "-q", "-o", "a.png"};
        command.insert(command.end(), more.begin(), more.end());
        return command;
    };
    for (const char* option : {"--env-rotate", "--env-scale"}) {
        const std::string text = std::string(option) + ": the scene has no environment";
        expect_usage(render("without.json", {option, "2"}), text);
        expect_usage(render("scene.json", {option, "2", "--env", "none"}), text);
        EXPECT_EQ(steradian(render("scene.json", {option, "2"})).code, 0);
        EXPECT_EQ(steradian(render("without.json", {option, "2", "--env", "1,1,1"})).code, 0);
    }
}

TEST_F(FilesAndArguments, OneNewFileIsOneHoweverItIsSpelt) {
    fs::create_directory(folder_.file("sub"));
    fs::create_directory_symlink("sub", folder_.file("alias"));
    for (const char* other : {"./sub/a.png", "alias/a.png", "sub/../sub/a.png"})
        expect_usage({"render", "scene.json", "-o", "sub/a.png", "-o", other}, "given twice");
    EXPECT_EQ(steradian({"render", "scene.json", "-q", "-o", "a.png", "-o", "sub/a.png"}).code, 0);
}

TEST_F(FilesAndArguments, OneFailedOutputDoesNotCostTheOthers) {
    const Outcome o = Process(folder_,
                              {"render", "scene.json", "--size", "200x200", "--spp", "1", "--json", "-o", "a.pfm", "-o",
                               "b.pfm", "-o", "c.png"},
                              limit_files<150000>)
                          .wait();
    EXPECT_EQ(o.code, 4) << o.err;
    EXPECT_NE(o.err.find("a.pfm"), std::string::npos) << o.err;
    EXPECT_NE(o.err.find("b.pfm"), std::string::npos) << o.err;
    EXPECT_TRUE(read_image(folder_.file("c.png")).ok());
    EXPECT_EQ(o.out.find(".pfm"), std::string::npos) << o.out;  // not among the outputs
    expect_files({"c.png"});
}

TEST_F(FilesAndArguments, AFailedWriteToStandardOutputIsAnError) {
    render_to("a.png");
    const auto code = [&](const std::vector<std::string>& arguments) {
        const Outcome o = Process(folder_, arguments, full_stdout).wait();
        EXPECT_NE(o.err.find("standard output"), std::string::npos) << o.err;
        return o.code;
    };
    EXPECT_EQ(code({"render", "scene.json", "-q", "--json"}), 4);
    for (const char* file : {"scene.json", "a.png"}) {
        EXPECT_EQ(code({"info", file}), 4);
        EXPECT_EQ(code({"info", file, "--json"}), 4);
    }
    EXPECT_EQ(code({"diff", "a.png", "a.png"}), 2);
    EXPECT_EQ(code({"--help"}), 4);
}

TEST_F(FilesAndArguments, NumbersAreDecimalAndWhole) {
    const auto field_with = [&](const char* option, const char* value, const char* name) {
        return field(steradian({"render", "scene.json", "-q", "--json", option, value}).out, name);
    };
    EXPECT_EQ(field_with("--spp", "010", "spp"), "10");
    EXPECT_EQ(field_with("--seed", "18446744073709551615", "spp"), "4");
    EXPECT_EQ(field_with("--seed", "010", "hash"), field_with("--seed", "10", "hash"));
    for (const std::vector<std::string>& wrong :
         std::vector<std::vector<std::string>>{{"--spp", "1e3"},
                                               {"--spp", "+4"},
                                               {"--spp", "4 "},
                                               {"--seed", "0x10"},
                                               {"--seed", "18446744073709551616"},
                                               {"--max-depth", "-1"},
                                               {"--max-depth", "4294967297"},
                                               {"--threads", "1025"},
                                               {"--tile-size", "0"},
                                               {"--tile-size", "257"},
                                               {"--bvh-max-depth", "65"}})
        expect_usage({"render", "scene.json", wrong[0], wrong[1]}, wrong[0] + ": expected a whole number from ");
}

/// As "--variant $VARIANT" has it where the variable is not set: as if nothing had been said it would be another
/// picture.
TEST_F(FilesAndArguments, EmptyTextsAreNotTakenForOptionsThatAreNotGiven) {
    for (const char* option : {"--size", "--crop", "--camera", "--env", "--variant", "--animation", "--filter",
                               "--aovs", "--frames", "--time-limit"})
        for (const std::vector<std::string>& words :
             {std::vector<std::string>{option, ""}, std::vector<std::string>{option + std::string("=")}}) {
            std::vector<std::string> arguments{"render", "missing.gltf"};
            arguments.insert(arguments.end(), words.begin(), words.end());
            const Outcome o = steradian(arguments);
            EXPECT_EQ(o.code, 2) << option;
            EXPECT_NE(o.err.find(option), std::string::npos) << o.err;
        }
    expect_usage({"lint", "missing.gltf", "--variant", ""},
                 "error: --variant: the text is empty\n  hint: steradian info names the variants of a file");
    expect_usage({"replay", "missing.gltf", "--pixel", "0,0", "--sample", "0", "--env", ""},
                 "error: --env: the text is empty\n  hint: without --env it is that of the scene");
    expect_usage({"diff", "a.exr", "b.exr", "--output", ""}, "--output: the text is empty");
}

TEST_F(FilesAndArguments, ExposureIsFinite) {
    render_to("a.exr");
    for (const char* wrong : {"nan", "inf", "-inf", "1e400", "101", "bright"}) {
        expect_usage({"render", "scene.json", "-o", "x.png", "--exposure", wrong}, "--exposure: expected a number");
        expect_usage({"convert", "a.exr", "x.png", "--exposure", wrong}, "--exposure: expected a number");
    }
    EXPECT_EQ(steradian({"convert", "a.exr", "x.png", "--exposure", "-1.5"}).code, 0);
}

TEST_F(FilesAndArguments, OptionsWithoutEffectAreRefused) {
    expect_usage({"render", "scene.json", "-o", "a.exr", "--view", "agx"}, "for PNG");
    expect_usage({"render", "scene.json", "-o", "a.exr", "--exposure", "0"}, "for PNG");
    expect_usage({"render", "scene.json", "--json", "--exposure", "1"}, "for PNG");
    expect_usage({"render", "scene.json", "--half"}, "for EXR");
    render_to("a.exr");
    expect_usage({"convert", "a.exr", "b.pfm", "--view", "agx"}, "for PNG");
    expect_usage({"convert", "a.exr", "b.png", "--half"}, "for EXR");
    EXPECT_EQ(steradian({"render", "scene.json", "-o", "b.exr", "-o", "b.png", "--half", "--view", "agx"}).code, 0);
}

TEST_F(FilesAndArguments, VeryWidePicturesAreWrittenAsPng) {
    ASSERT_EQ(steradian({"render", "scene.json", "--size", "1048576x1", "--spp", "1", "-o", "w.png", "-q"}).code, 0);
    const auto image = read_image(folder_.file("w.png"));
    ASSERT_TRUE(image.ok()) << image.error().str();
    EXPECT_EQ(image->width, 1048576u);
}

TEST_F(FilesAndArguments, SignalsIgnoredAtTheStartStayIgnored) {
    Process process(folder_, {"render", "scene.json", "--spp", "1000000000", "-o", "a.exr", "--json"}, [] {
        ::signal(SIGHUP, SIG_IGN);
        ::signal(SIGINT, SIG_IGN);
    });
    ASSERT_TRUE(process.shows_progress());
    process.send(SIGHUP), process.send(SIGINT);
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    process.send(SIGTERM);
    EXPECT_EQ(process.wait().code, 143);
}

TEST_F(FilesAndArguments, JsonIsUtf8WhateverTheFilesAreCalled) {
    spit(folder_.file("\xff.json"), kScene);
    for (const std::vector<std::string>& arguments :
         std::vector<std::vector<std::string>>{{"render", "\xff.json", "-q", "--json", "-o", "\xfe.png"},
                                               {"info", "\xff.json", "--json"},
                                               {"info", "\xfe.png", "--json"}}) {
        const Outcome o = steradian(arguments);
        EXPECT_EQ(o.code, 0) << o.err;
        EXPECT_EQ(o.out.find_first_of("\xff\xfe"), std::string::npos) << o.out;
        EXPECT_NE(o.out.find("\\\\xf"), std::string::npos) << o.out;
    }
}

TEST_F(FilesAndArguments, InfoLooksIntoTheFile) {
    render_to("a.png");
    fs::rename(folder_.file("a.png"), folder_.file("a.dat"));
    const Outcome o = steradian({"info", "a.dat"});
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_NE(o.out.find("a picture (PNG)"), std::string::npos) << o.out;
}

TEST_F(FilesAndArguments, AnUnknownCameraNamesThoseThatThereAre) {
    expect_usage({"render", "scene.json", "--camera", "xyzzyx"}, "the scene has: front, side");
}

TEST_F(FilesAndArguments, WhatNeedsNoSceneIsCheckedBeforeOneIsLoaded) {
    // None of these may look at the scene, which is not there.
    for (const std::vector<std::string>& wrong :
         std::vector<std::vector<std::string>>{{"--size", "10"},
                                               {"--size", "0x10"},
                                               {"--crop", "1,2,3"},
                                               {"--crop", "5,5,5,9"},
                                               {"--size", "20x20", "--crop", "0,0,21,20"},
                                               {"--filter", "gausian"},
                                               {"--filter", "gaussian:x"},
                                               {"--filter", "gaussian:nan"},
                                               {"--filter", "gaussian:inf"},
                                               {"--filter", "gaussian:-1"},
                                               {"--filter", "gaussian:1e300"},
                                               {"--spp", "0"},
                                               {"--threads", "-1"},
                                               {"-o", "a.gif"},
                                               {"-o", "a.png", "-o", "./a.png"}}) {
        std::vector<std::string> arguments{"render", "missing.json"};
        arguments.insert(arguments.end(), wrong.begin(), wrong.end());
        const Outcome o = steradian(arguments);
        EXPECT_EQ(o.code, 2) << wrong[1] << o.err;
        EXPECT_EQ(o.err.find("missing.json"), std::string::npos) << o.err;
    }
    for (const std::vector<std::string>& limit : std::vector<std::vector<std::string>>{
             {"--size", "1000000x1000000"}, {"--crop", "0,0,1000000,1000000"}, {"-o", "nowhere/a.png"}})
        EXPECT_EQ(steradian({"render", "missing.json", limit[0], limit[1]}).code, 4) << limit[1];
    EXPECT_EQ(steradian({"render", "missing.json", "--size", "20x20", "--crop", "0,0,20,20"}).code, 3);
    EXPECT_EQ(steradian({"render", "missing.json", "--crop", "1000,1000,1001,1001"}).code, 3);
}

TEST_F(FilesAndArguments, BoundsOfDiffAreFiniteNumbers) {
    render_to("a.pfm");
    for (const char* option : {"--max-abs", "--max-mse", "--max-rel-mse", "--min-psnr"})
        for (const char* wrong : {"nan", "inf", "1e400", "1.2.3", "", "0x10", "1e"})
            expect_usage({"diff", "a.pfm", "a.pfm", option, wrong}, std::string(option) + ": expected a number");
    for (const char* option : {"--max-abs", "--max-mse", "--max-rel-mse"})
        expect_usage({"diff", "a.pfm", "a.pfm", option, "-1"}, std::string(option) + ": expected a number from 0");
    EXPECT_EQ(steradian({"diff", "a.pfm", "a.pfm", "--max-abs", "0", "--min-psnr", "-5"}).code, 0);
}

TEST_F(FilesAndArguments, ConvertCountsWhatAPngCannotShow) {
    const std::string nan("\0\0\xc0\x7f", 4), infinity("\0\0\x80\x7f", 4), zero(4, '\0');
    const std::string pfm = "PF\n3 1\n-1\n" + nan + zero + nan + zero + infinity + zero + zero + zero + zero;
    spit(folder_.file("odd.pfm"), pfm);
    const Outcome o = steradian({"convert", "odd.pfm", "odd.png"});
    EXPECT_EQ(o.code, 0);
    EXPECT_NE(o.err.find("not finite"), std::string::npos) << o.err;
    EXPECT_NE(o.err.find("(2 times)"), std::string::npos) << o.err;
}

TEST_F(FilesAndArguments, TooLittleMemoryIsSaidAndNothingIsWritten) {
    if (kSanitized) GTEST_SKIP() << "under a sanitizer";
    std::string model;
    for (int i = 0; i < 200000; ++i) model += "v " + std::to_string(i) + " 0 " + std::to_string(i % 7) + "\n";
    for (int i = 3; i <= 200000; ++i) model += "f -" + std::to_string(i) + " 1 " + std::to_string(i) + "\n";
    spit(folder_.file("large.obj"), model);
    const auto expect_refused = [&](void (*limit)()) {
        const Outcome o = Process(folder_, {"render", "large.obj", "-o", "a.png"}, limit).wait();
        EXPECT_EQ(o.signal, 0);
        EXPECT_EQ(o.code, 4) << o.err;
        EXPECT_NE(o.err.find("error: "), std::string::npos) << o.err;
    };
    expect_refused(limit_memory<(40 << 20)>);
    expect_refused(limit_memory<(50 << 20)>);
    expect_refused(limit_memory<(60 << 20)>);
    expect_files({"large.obj"});
}

}  // namespace
}  // namespace steradian::test
