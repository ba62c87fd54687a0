// Moments of animations, as a user asks for them.
#include <gtest/gtest.h>

#include "gltf/gltf_builder.h"
#include "program.h"
#include "steradian/image_io.h"

namespace steradian::test {
namespace {

/// model.glb: a triangle that moves by 2 m a second under a light and before a camera that stand still.
class AnimationCommand : public CommandTest {
protected:
    AnimationCommand() {
        GltfBuilder b;
        const int p = b.floats("VEC3", 3, kTriangle), t = b.floats("SCALAR", 1, {0, 1});
        const int v = b.floats("VEC3", 3, {-1, 0, 0, 1, 0, 0});
        const auto animation = [&](const std::string& name, const std::string& path) {
            return "{\"name\": \"" + name + "\", \"samplers\": [{\"input\": " + std::to_string(t) +
                   ", \"output\": " + std::to_string(v) +
                   "}], \"channels\": [{\"sampler\": 0, \"target\": {\"node\": 0, \"path\": \"" + path + "\"}}]}";
        };
        spit(
            folder_.file("model.glb"),
            b.binary("\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": " + std::to_string(p) +
                     "}}]}], \"cameras\": [{\"type\": \"perspective\", \"perspective\": {\"yfov\": 1, \"znear\": 1}}], "
                     "\"nodes\": [{\"mesh\": 0}, {\"camera\": 0, \"translation\": [0, 0, 5]}], \"animations\": [" +
                     animation("walk", "translation") + "," + animation("grow", "scale") + "]"));
    }
    Outcome render(std::vector<std::string> more) {
        std::vector<std::string> all{"render", "model.glb", "--size", "24x16", "--spp",
                                     "2",      "--env",     "1,1,1",  "--json"};
        all.insert(all.end(), more.begin(), more.end());
        return steradian(all);
    }
    std::string hash(const std::vector<std::string>& more) {
        const Outcome o = render(more);
        EXPECT_EQ(o.code, 0) << o.err;
        return field(o.out, "hash");
    }
};

TEST_F(AnimationCommand, AMomentOfAnAnimation) {
    const std::string still = hash({});
    // Halfway the triangle stands where the file has it.
    EXPECT_EQ(hash({"--animation", "walk", "--frame-time", "0.5"}), still);
    EXPECT_NE(hash({"--animation", "walk", "--frame-time", "0.25"}), still);
    EXPECT_EQ(hash({"--animation", "walk"}), hash({"--animation", "0", "--frame-time", "0"}));
    const Outcome first = render({"--frame-time", "0.5"});
    EXPECT_EQ(field(first.out, "hash"), still);
    EXPECT_NE(first.err.find("the first of 2 animations is shown, 'walk'"), std::string::npos) << first.err;
    EXPECT_NE(first.out.find("(/animations/0)"), std::string::npos) << first.out;
}

TEST_F(AnimationCommand, WhatIsNotThereIsAUsageError) {
    const Outcome unknown = render({"--animation", "fly"});
    EXPECT_EQ(unknown.code, 2);
    EXPECT_NE(unknown.err.find("'walk', 'grow'"), std::string::npos) << unknown.err;
    const Outcome json = steradian({"render", "scene.json", "--frame-time", "1"});
    EXPECT_EQ(json.code, 2);
    EXPECT_NE(json.err.find("no animations"), std::string::npos) << json.err;
    for (const char* time : {"-1", "nan", "1e10", "soon"}) EXPECT_EQ(render({"--frame-time", time}).code, 2) << time;
}

TEST_F(AnimationCommand, InfoNamesThem) {
    const Outcome text = steradian({"info", "model.glb"});
    EXPECT_NE(text.out.find("animations 2: walk, grow"), std::string::npos) << text.out;
    const Outcome json = steradian({"info", "model.glb", "--json"});
    EXPECT_NE(json.out.find("\"animations\""), std::string::npos);
}

TEST_F(AnimationCommand, InfoTellsTheFileFromItsStudioAndNamesVariants) {
    GltfBuilder b;
    const int p = b.floats("VEC3", 3, kTriangle);
    spit(folder_.file("chair.glb"),
         b.binary("\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": " + std::to_string(p) +
                  "}}]}], \"nodes\": [{\"mesh\": 0}], \"extensions\": {\"KHR_materials_variants\": {\"variants\": "
                  "[{\"name\": \"oak\"}, {\"name\": \"ash\"}]}}"));
    const Outcome text = steradian({"info", "chair.glb"});
    EXPECT_EQ(text.code, 0) << text.err;
    EXPECT_NE(text.out.find("objects    1 (1 shapes, 1 meshes)"), std::string::npos) << text.out;
    EXPECT_NE(text.out.find("lights     0 (a neutral studio is added)"), std::string::npos) << text.out;
    EXPECT_NE(text.out.find("variants   2: oak, ash"), std::string::npos) << text.out;
    const std::string json = steradian({"info", "chair.glb", "--json"}).out;
    EXPECT_NE(json.find("\"studio\": true"), std::string::npos) << json;
    EXPECT_NE(json.find("\"variants\": [\n        \"oak\",\n        \"ash\"\n    ]"), std::string::npos) << json;
    EXPECT_NE(json.find("\"lights\": []"), std::string::npos) << json;
}

TEST_F(AnimationCommand, ReplayShowsTheSameMoment) {
    const std::vector<std::string> moment{"--animation", "walk", "--frame-time", "0.25"};
    const auto replay = [&](std::vector<std::string> more) {
        std::vector<std::string> all{"replay", "model.glb", "--size", "24x16",    "--env",
                                     "1,1,1",  "--pixel",   "11,7",   "--sample", "0"};
        all.insert(all.end(), more.begin(), more.end());
        return steradian(all).out;
    };
    EXPECT_NE(replay(moment), replay({}));
    // What a render says of its brightest samples has the moment in it.
    std::vector<std::string> bright = moment;
    bright.insert(bright.end(), {"--fireflies", "1"});
    EXPECT_NE(render(bright).out.find("--animation walk --frame-time 0.25"), std::string::npos);
}

// --- Sequences ---

TEST_F(AnimationCommand, AFrameHasTheBitsOfItsMomentAlone) {
    const Outcome o =
        render({"--animation", "walk", "--frames", "5:7", "--fps", "10", "-o", "f.exr", "-o", "g.###.png"});
    ASSERT_EQ(o.code, 0) << o.err;
    expect_files({"model.glb", "f_0005.exr", "f_0006.exr", "f_0007.exr", "g.005.png", "g.006.png", "g.007.png"});
    EXPECT_EQ(o.out.front(), '[');
    EXPECT_NE(o.err.find("frame 6, 0.6 s (2 of 3)"), std::string::npos) << o.err;
    std::vector<std::string> hashes;
    for (const char* time : {"0.5", "0.6", "0.7"})
        hashes.push_back(hash({"--animation", "walk", "--frame-time", time}));
    for (size_t i = 0; i < 3; ++i) {
        const auto image = read_image(folder_.file("f_000" + std::to_string(5 + i) + ".exr"));
        ASSERT_TRUE(image.ok());
        EXPECT_EQ(image_hash(*image), hashes[i]);
        EXPECT_NE(o.out.find(hashes[i]), std::string::npos);
    }
    EXPECT_NE(hashes[0], hashes[1]);
    // Two ways to write it; 24 frames a second.
    ASSERT_EQ(render({"--animation", "walk", "--frames", "12-12", "-o", "h#.pfm"}).code, 0);
    EXPECT_EQ(image_hash(*read_image(folder_.file("h12.pfm"))), hashes[0]);
}

TEST_F(AnimationCommand, WhatIsSaidOfEveryFrameIsSaidOnce) {
    const Outcome o = render({"--frames", "0:2"});
    ASSERT_EQ(o.code, 0) << o.err;
    const std::string line = "the first of 2 animations";
    const size_t at = o.err.find(line);
    ASSERT_NE(at, std::string::npos) << o.err;
    EXPECT_EQ(o.err.find(line, at + 1), std::string::npos) << o.err;
}

TEST_F(AnimationCommand, SequencesThatMakeNoSense) {
    for (const std::vector<std::string>& wrong : {std::vector<std::string>{"--frames", "7:5"},
                                                  {"--frames", "1:"},
                                                  {"--frames", "a"},
                                                  {"--frames", "1:2:3"},
                                                  {"--frames", "-1:2"},
                                                  {"--frames", "0:1000000"},
                                                  {"--fps", "24"},
                                                  {"--frames", "1:2", "--fps", "0"},
                                                  {"--frames", "1:2", "--frame-time", "1"},
                                                  {"--frames", "1:2", "--turntable", "3"},
                                                  {"--turntable", "0"},
                                                  {"--turntable", "2", "--turn", "10"},
                                                  {"--turntable", "2", "--camera", "0"}}) {
        const Outcome o = render(wrong);
        EXPECT_EQ(o.code, 2) << wrong[1] << o.err;
        EXPECT_FALSE(o.err.empty());
    }
    EXPECT_EQ(steradian({"render", "scene.json", "--frames", "1:2", "-q"}).code, 2);
    expect_files({"model.glb"});
}

TEST_F(AnimationCommand, ASignalLeavesWholePicturesOnly) {
    spit(folder_.file("a_0001.exr"), "precious");
    Process process(folder_, {"render", "model.glb", "--frames", "0:9", "--size", "24x16", "--spp", "1000000000",
                              "--env", "1,1,1", "-o", "a.exr"});
    ASSERT_TRUE(process.shows_progress());
    process.send(SIGINT);
    const Outcome o = process.wait();
    EXPECT_EQ(o.code, 130) << o.err;
    EXPECT_EQ(slurp(folder_.file("a_0001.exr")), "precious");
    expect_files({"model.glb", "a_0001.exr"});
}

TEST_F(AnimationCommand, ATurntableOfScenesOfEveryKind) {
    spit(folder_.file("grid.ply"), grid_ply(4));
    for (const char* scene : {"model.glb", "scene.json", "grid.ply"}) {
        const std::vector<std::string> start{"render", scene, "--size", "24x16", "--spp", "2", "--json"};
        const auto run_with = [&](const std::vector<std::string>& more) {
            std::vector<std::string> all = start;
            all.insert(all.end(), more.begin(), more.end());
            return steradian(all);
        };
        const Outcome o = run_with({"--turntable", "4", "-o", "t.pfm"});
        ASSERT_EQ(o.code, 0) << o.err;
        for (int k = 0; k < 4; ++k) {
            const auto image = read_image(folder_.file("t_000" + std::to_string(k) + ".pfm"));
            ASSERT_TRUE(image.ok());
            EXPECT_EQ(image_hash(*image), field(run_with({"--turn", std::to_string(90 * k)}).out, "hash"))
                << scene << k;
        }
    }
}

TEST_F(AnimationCommand, TheSizeDecidesHowTheModelIsFramed) {
    spit(folder_.file("grid.ply"), grid_ply(4));
    for (const std::vector<std::string>& view : {std::vector<std::string>{}, {"--turn", "30"}}) {
        /// The columns that show something.
        const auto columns = [&](const std::string& size) {
            std::vector<std::string> all{"render", "grid.ply", "--size", size,           "--spp",
                                         "4",      "--env",    "none",   "-o",           "d.pfm",
                                         "-q",     "--filter", "box",    "--integrator", "depth"};
            all.insert(all.end(), view.begin(), view.end());
            EXPECT_EQ(steradian(all).code, 0);
            const Image image = read_image(folder_.file("d.pfm")).value();
            std::vector<uint32_t> out;
            for (uint32_t x = 0; x < image.width; ++x)
                for (uint32_t y = 0; y < image.height; ++y)
                    if (image.pixels[(size_t(y) * image.width + x) * image.channels.size()] > 0) {
                        out.push_back(x);
                        break;
                    }
            return out;
        };
        const std::vector<uint32_t> square = columns("60x60"), high = columns("60x150");
        ASSERT_FALSE(square.empty());
        EXPECT_GT(square.front(), 2u);
        EXPECT_LT(square.back(), 57u);
        EXPECT_NEAR(high.front(), square.front(), 1);
        EXPECT_NEAR(high.back(), square.back(), 1);
    }
}

}  // namespace
}  // namespace steradian::test
