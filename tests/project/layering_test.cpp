#include "project/layering.h"

#include <gtest/gtest.h>

#include "support/support.h"

namespace steradian::test {
namespace {

namespace fs = std::filesystem;

std::string joined(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    return text;
}

/// A source tree of one file with one include line.
std::vector<std::string> faults_of(const std::string& file, const std::string& line) {
    const TemporaryFolder folder;
    const fs::path path = folder.path() / file;
    fs::create_directories(path.parent_path());
    std::ofstream(path) << "// a comment\n" << line << "\n";
    return layering_faults(folder.path());
}

TEST(layering, holds_in_this_source_tree) {
    const std::vector<std::string> faults = layering_faults(source_folder());
    EXPECT_TRUE(faults.empty()) << joined(faults);
}

TEST(layering, arrows_that_point_up_are_found) {
    struct Wrong {
        const char *file, *line;
    };
    for (const Wrong& wrong : {
             Wrong{"src/math/a.h", "#include \"image/tone.h\""},
             Wrong{"src/base/a.cpp", "#include \"math/vector.h\""},
             Wrong{"src/accel/a.cpp", "#include \"scene/validate.h\""},
             Wrong{"src/accel/a.cpp", "#include \"steradian/scene.h\""},
             Wrong{"src/image/sub/a.cpp", "  #  include <scene/validate.h>"},
             Wrong{"src/scene/a.cpp", "#include \"formats/mesh_file.h\""},
             Wrong{"src/shading/a.h", "#include \"steradian/render.h\""},
             Wrong{"src/formats/a.h", "#include \"render/film.h\""},
             Wrong{"src/render/a.h", "#include \"formats/mesh_file.h\""},
             Wrong{"src/render/a.h", "#include \"apps/cli/command.h\""},
             Wrong{"include/steradian/vec.h", "#include \"steradian/image.h\""},
             Wrong{"include/steradian/settings.h", "#include \"steradian/vec.h\""},
             Wrong{"include/steradian/image.h", "#include \"image/tone.h\" // its own layer"},
         }) {
        const auto faults = faults_of(wrong.file, wrong.line);
        EXPECT_EQ(faults.size(), 1u) << wrong.file << ": " << wrong.line << "\n" << joined(faults);
    }
}

TEST(layering, detours_and_strangers_are_found) {
    EXPECT_EQ(faults_of("src/math/a.h", "#include \"../scene/validate.h\"").size(), 1u);
    EXPECT_EQ(faults_of("src/math/a.h", "#include \"src/scene/validate.h\"").size(), 1u);
    EXPECT_EQ(faults_of("src/newlayer/a.h", "").size(), 1u);
    EXPECT_EQ(faults_of("include/steradian/new.h", "").size(), 1u);
    EXPECT_EQ(faults_of("src/math/a.h", "#include \"steradian/unknown.h\"").size(), 1u);
}

TEST(layering, arrows_that_point_down_are_fine) {
    EXPECT_EQ(joined(faults_of("src/render/a.cpp", "#include \"accel/accel.h\"")), "");
    EXPECT_EQ(joined(faults_of("src/accel/a.h", "#include \"steradian/settings.h\"")), "");
    EXPECT_EQ(joined(faults_of("src/shading/a.h", "#include \"shading/surface.h\"")), "");
    EXPECT_EQ(joined(faults_of("apps/cli/a.cpp", "#include \"steradian/steradian.h\"")), "");
    EXPECT_EQ(joined(faults_of("src/base/a.cpp", "#include <tbb/task_arena.h>")), "");
}

}  // namespace
}  // namespace steradian::test
