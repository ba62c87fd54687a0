// `steradian replay`, and the commands that `render` prints for it.
#include <gtest/gtest.h>

#include <sstream>

#include "program.h"
#include "steradian/image_io.h"

namespace steradian::test {
namespace {

class ReplayCommand : public CommandTest {
protected:
    /// The words of a printed command without the program's name.
    static std::vector<std::string> words(const std::string& command) {
        std::istringstream in(command);
        std::vector<std::string> out;
        for (std::string word; in >> word;) out.push_back(word);
        out.erase(out.begin());
        return out;
    }
    static std::string line(const std::string& text, const std::string& start) {
        const size_t at = text.find("\n" + start);
        return at == std::string::npos ? "" : text.substr(at + 1, text.find('\n', at + 1) - at - 1);
    }
};

/// One sample a pixel through the box filter: the pixel is the sample.
TEST_F(ReplayCommand, PrintsTheRadianceOfThePixel) {
    const std::vector<std::string> options{"--spp", "1", "--filter", "box", "--size", "9x7", "--seed", "5"};
    std::vector<std::string> render{"render", "scene.json", "-q", "-o", "a.pfm"};
    render.insert(render.end(), options.begin(), options.end());
    ASSERT_EQ(steradian(render).code, 0);
    const auto image = read_image(folder_.file("a.pfm"));
    ASSERT_TRUE(image.ok());
    for (const auto& [x, y] : {std::pair{4, 3}, {0, 0}, {5, 4}}) {
        std::vector<std::string> replay{"replay", "scene.json", "--sample",
                                        "0",      "--pixel",    std::to_string(x) + "," + std::to_string(y)};
        replay.insert(replay.end(), options.begin(), options.end());
        const Outcome o = steradian(replay);
        ASSERT_EQ(o.code, 0) << o.err;
        std::istringstream in(line(o.out, "radiance "));
        std::string word;
        in >> word;
        for (size_t c = 0; c < 3; ++c) {
            float value = -1;
            in >> value;
            EXPECT_EQ(value, image->pixels[(size_t(y) * 9 + size_t(x)) * 3 + c]);
        }
    }
    expect_files({"a.pfm"});
}

TEST_F(ReplayCommand, RepeatsTheFirefliesThatRenderNames) {
    const Outcome render = steradian({"render", "scene.json", "--fireflies", "2", "--integrator", "path", "--max-depth",
                                      "3", "--size", "8x8", "-o", "a.png", "--json"});
    ASSERT_EQ(render.code, 0) << render.err;
    const size_t begin = render.out.find("\"replay\": \"") + 11;
    const std::string command = render.out.substr(begin, render.out.find('"', begin) - begin);
    EXPECT_NE(render.err.find("firefly ("), std::string::npos);
    EXPECT_NE(render.err.find(command), std::string::npos);
    const size_t at = render.out.find("\"value\": [");
    ASSERT_NE(at, std::string::npos);
    const double red = std::stod(render.out.substr(render.out.find_first_of("0123456789", at + 10)));
    const Outcome o = steradian(words(command));
    ASSERT_EQ(o.code, 0) << o.err;
    const std::string radiance = line(o.out, "radiance ");
    EXPECT_EQ(std::stof(radiance.substr(9)), static_cast<float>(red));
    EXPECT_GT(red, 0);
}

TEST_F(ReplayCommand, EndsTheLineThatReportsABadSample) {
    spit(folder_.file("bright.json"), R"({
      "version": 1, "film": {"resolution": [8, 8]}, "camera": {"position": [0, 0, 5], "look_at": [0, 0, 0]},
      "objects": [{"type": "sphere", "material": {"type": "diffuse", "reflectance": 1e6, "two_sided": true}},
                  {"type": "sphere", "radius": 8, "material": {"type": "diffuse", "reflectance": 1e6, "two_sided": true}}],
      "lights": [{"type": "point", "position": [0, 0, 3], "intensity": 1e30}]})");
    const Outcome render = steradian({"render", "bright.json", "--spp", "4", "-o", "a.exr"});
    ASSERT_EQ(render.code, 0) << render.err;
    const size_t at = render.err.find("steradian replay ");
    ASSERT_NE(at, std::string::npos) << render.err;
    EXPECT_NE(render.err.find(" samples were not finite or negative and were dropped"), std::string::npos);
    const Outcome o = steradian(words(render.err.substr(at, render.err.find('\n', at) - at)));
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_NE(o.out.find("inf"), std::string::npos) << o.out;
}

TEST_F(ReplayCommand, PrintsTheWavelengthWhereGlassDisperses) {
    spit(folder_.file("glass.json"), R"({
      "version": 1, "film": {"resolution": [8, 8]}, "camera": {"position": [0, 0, 5], "look_at": [0, 0, 0]},
      "objects": [{"type": "sphere", "radius": 1, "material": {"type": "glass", "abbe": 20}}],
      "lights": [{"type": "environment", "radiance": 1}]})");
    const Outcome o = steradian({"replay", "glass.json", "--pixel", "4,4", "--sample", "0"});
    ASSERT_EQ(o.code, 0) << o.err;
    const std::string wavelength = line(o.out, "    wavelength ");
    ASSERT_NE(wavelength, "") << o.out;
    const double nanometres = std::stod(wavelength.substr(15));
    EXPECT_TRUE(nanometres >= 390 && nanometres <= 680) << wavelength;
    EXPECT_NE(wavelength.find(" nm, weight "), std::string::npos);
    const Outcome none = steradian({"replay", "scene.json", "--pixel", "16,12", "--sample", "0"});
    ASSERT_EQ(none.code, 0) << none.err;
    EXPECT_EQ(line(none.out, "    wavelength "), "");
}

TEST_F(ReplayCommand, RefusesWhatIsNotThere) {
    const auto expect = [&](const std::vector<std::string>& arguments, const char* message) {
        const Outcome o = steradian(arguments);
        EXPECT_EQ(o.code, 2) << o.err;
        EXPECT_NE(o.err.find(message), std::string::npos) << o.err;
    };
    expect({"replay", "scene.json", "--sample", "0"}, "--pixel");
    expect({"replay", "scene.json", "--sample", "0", "--pixel", "1"}, "X,Y");
    expect({"replay", "scene.json", "--sample", "4", "--pixel", "1,1"},
           "there is no sample 4: a pixel has samples 0 to 3");
    expect({"replay", "scene.json", "--sample", "0", "--pixel", "32,1"}, "there is no pixel 32,1");
    expect({"render", "scene.json", "--fireflies", "10001"}, "--fireflies");
}

}  // namespace
}  // namespace steradian::test
